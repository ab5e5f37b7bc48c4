#include "laws/joint_points_laws.hpp"

namespace sprekk::laws {

template struct JointPoints<2>;
template struct JointPoints<3>;

}  // namespace sprekk::laws
