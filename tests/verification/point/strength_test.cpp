// Reported strength of each state of a point.
#include "point_scenes.hpp"

#include <filesystem>

namespace sprekk::tests {
namespace {

Real norm(const std::vector<Real>& v) { return std::hypot(v[1], v.size() > 2 ? v[2] : 0); }

/// While a joint slips, its shear traction equals its strength: for all laws of the scenes, in 2D and 3D. If the
/// strength depends on the logarithm of the slip rate, the round-off of the plastic jump p changes it by at most the
/// traction times eps |p|/S, where S is the slip of the step.
TEST(Strength, IsTheShearTractionOfAJointThatSlips) {
  int n_slips = 0, n_in_3d = 0;
  for (const auto& file : std::filesystem::directory_iterator(source_dir() + "/xml/point")) {
    SCOPED_TRACE(file.path().string());
    for (const auto& curve : laboratory::drive_points(read(file.path().filename()))) {
      std::vector<Real> before(3, 0);
      for (const auto& s : curve.states) {
        auto step = s.plastic;
        for (std::size_t k = 0; k < step.size(); ++k) step[k] -= before[k];
        before = s.plastic;
        if (s.contact != laws::ContactState::slip) continue;
        const Real shear = norm(s.traction);
        Real bound = 1e-12 * std::max(shear, Real(1));
        if (!s.quantities.empty())  // depends on the slip rate
          bound += shear * std::numeric_limits<Real>::epsilon() * norm(s.plastic) / norm(step);
        EXPECT_NEAR(s.strength, shear, bound) << "t = " << s.t;
        ++n_slips;
        n_in_3d += s.traction.size() > 2;
      }
    }
  }
  EXPECT_GT(n_slips, 100);
  EXPECT_GT(n_in_3d, 10);
}

}  // namespace
}  // namespace sprekk::tests
