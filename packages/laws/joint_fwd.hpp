// Forward declaration of the joint law, for code that passes joints without evaluating them.
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

/// Joint composed of the laws listed in joint_kinds.hpp; see joint.hpp.
using Joint = JointLaw<Shear, Friction, NormalGap<Dilation, Closure>>;

}  // namespace sprekk::laws
