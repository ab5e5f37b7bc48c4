// Reported strength of each state of a point.
#include "point_scenes.hpp"

#include <filesystem>

namespace sprekk::tests {
namespace {

/// While a joint slips, its shear traction equals its strength: for all laws of the scenes, in 2D and 3D.
TEST(Strength, IsTheShearTractionOfAJointThatSlips) {
  int n_slips = 0, n_in_3d = 0;
  for (const auto& file : std::filesystem::directory_iterator(source_dir() + "/xml/point")) {
    SCOPED_TRACE(file.path().string());
    for (const auto& curve : laboratory::drive_points(read(file.path().filename())))
      for (const auto& s : curve.states) {
        if (s.contact != laws::ContactState::slip) continue;
        const Real shear = std::hypot(s.traction[1], s.traction.size() > 2 ? s.traction[2] : 0);
        EXPECT_NEAR(s.strength, shear, 1e-12 * std::max(shear, Real(1))) << "t = " << s.t;
        ++n_slips;
        n_in_3d += s.traction.size() > 2;
      }
  }
  EXPECT_GT(n_slips, 100);
  EXPECT_GT(n_in_3d, 10);
}

}  // namespace
}  // namespace sprekk::tests
