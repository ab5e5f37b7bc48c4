// Directions of prescribed slip: which side of a face moves where.
#include "physics/mechanics/prescribed_slip.hpp"

#include "base/check.hpp"
#include "mesh/facets.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sprekk::physics::testing {
namespace {

using mesh::Vector;

/// Expects the axes for a face with the normal n, and opposite ones after exchange of the sides: the jump u+ - u- then
/// changes its sign, and the motion is the same.
void expect_axes(const PrescribedSlip& slip, const Vector& n, int dim, const std::vector<Vector>& expected) {
  for (const Real sign : {1, -1}) {
    const auto axes = slip.axes(mesh::face_frame({sign * n[0], sign * n[1], sign * n[2]}, dim), dim);
    ASSERT_EQ(axes.size(), expected.size());
    for (std::size_t k = 0; k < axes.size(); ++k)
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(axes[k][i], sign * expected[k][i], 1e-14) << k << ", " << i;
  }
}

/// Seen from the side below y = 0, the other side moves to the left, -x. For x = 0, seen from x < 0, to +y.
TEST(PrescribedSlip, IsLeftLateralInThePlane) {
  expect_axes({}, {0, 1, 0}, 2, {{-1, 0, 0}});
  expect_axes({}, {1, 0, 0}, 2, {{0, 1, 0}});
}

/// The plane dips 30 degrees to the east (+x) and strikes north (+y). The hanging wall, above, moves north and up.
TEST(PrescribedSlip, FollowsStrikeAndDip) {
  const Real s = std::sin(M_PI / 6), c = std::cos(M_PI / 6);
  expect_axes({}, {s, 0, c}, 3, {{0, 1, 0}, {-c, 0, s}});
  expect_axes({}, {0, 1, 0}, 3, {{-1, 0, 0}, {0, 0, 1}});  // vertical: the side towards +y counts as above
  expect_axes({}, {1, 0, 0}, 3, {{0, 1, 0}, {0, 0, 1}});
}

/// The side z < 0 moves along the projection of (1, 0, 5) on a horizontal face.
TEST(PrescribedSlip, FollowsAVector) {
  PrescribedSlip slip;
  slip.direction = {1, 0, 5};
  slip.moving_side = {0.1, 0, -1};
  expect_axes(slip, {0, 0, 1}, 3, {{-1, 0, 0}});
}

TEST(PrescribedSlip, RejectsUndefinedDirections) {
  const auto horizontal = mesh::face_frame({0, 0, 1}, 3);
  EXPECT_THROW(PrescribedSlip().axes(horizontal, 3), Error);
  PrescribedSlip slip;
  slip.direction = {0, 0, 1};
  slip.moving_side = {0, 0, 1};
  EXPECT_THROW(slip.axes(horizontal, 3), Error);
  slip.direction = {1, 0, 0};
  slip.moving_side = {0, 1, 0};
  EXPECT_THROW(slip.axes(horizontal, 3), Error);
}

TEST(PrescribedSlip, AppliesInItsBox) {
  PrescribedSlip slip;
  EXPECT_FALSE(slip.contains({0, 0, 0}));  // no slip given
  slip.slip = {base::Expression(1)};
  EXPECT_TRUE(slip.contains({9, 9, 0}));
  slip.lower_corner = {0, 0};
  slip.upper_corner = {1, 2};
  EXPECT_TRUE(slip.contains({1, 2, 0}));
  EXPECT_FALSE(slip.contains({0.5, 2.1, 0}));
}

}  // namespace
}  // namespace sprekk::physics::testing
