#include "physics/mechanics/joint_points_laws.hpp"

namespace sprekk::physics {

template struct JointPoints<2>;
template struct JointPoints<3>;

}  // namespace sprekk::physics
