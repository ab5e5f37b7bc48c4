// The name of the joint law, for code that hands joints on without evaluating them.
#pragma once

namespace sprekk::laws {

struct Shear;
struct Friction;
struct Dilation;
struct Closure;
template <class Dilation, class Closure>
struct NormalGap;
template <class Elastic, class Friction, class Gap>
struct JointLaw;

/// A joint whose parts are any of the laws in joint_kinds.hpp, see joint.hpp.
using Joint = JointLaw<Shear, Friction, NormalGap<Dilation, Closure>>;

}  // namespace sprekk::laws
