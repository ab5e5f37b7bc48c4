#include "laws/crossing.hpp"

#include <gtest/gtest.h>

namespace sprekk::laws {
namespace {

/// Interface at an angle (degrees) to a crack along the stress s1, with s3 across.
Interface interface_at(Real degrees, Real s1, Real s3) {
  const Real b = degrees * M_PI / 180, c = std::cos(b), s = std::sin(b);
  return {b, s1 * s * s + s3 * c * c, (s3 - s1) * s * c, s1 * c * c + s3 * s * s};
}

Real margin(Real degrees, Real s1, Real s3, Real strength, Real friction, Real cohesion = 0) {
  return margin_of_crossing(interface_at(degrees, s1, s3), strength,
                            [&](Real normal, Real) { return normal > 0 ? 0 : cohesion - friction * normal; });
}

/// Independent solution by root finding, with three digits.
TEST(Crossing, HasTheMarginOfTheWeakerRay) {
  EXPECT_NEAR(margin(90, -10, -5, 4, 0.6), 0.4, 1e-9);
  EXPECT_NEAR(margin(90, -11, -5, 4, 0.3), -0.2, 1e-9);
  EXPECT_NEAR(margin(90, -7.5, -5, 4, 0.6, 1), 0.233, 5e-4);
  EXPECT_NEAR(margin(75, -14, -5, 3, 0.7), 0.252, 5e-4);
  EXPECT_NEAR(margin(75, -9, -5, 4, 0.6), -0.370, 5e-4);
  EXPECT_NEAR(margin(60, -18, -5, 2, 0.6, 6), 0.216, 5e-4);
  EXPECT_NEAR(margin(60, -12, -5, 2, 1.2, 2), 0.320, 5e-4);
  EXPECT_NEAR(margin(60, -18, -5, 4, 0.6), -0.550, 5e-4);
  EXPECT_NEAR(margin(45, -20, -5, 4, 1), -0.983, 5e-4);
  EXPECT_NEAR(margin(120, -18, -5, 4, 0.6), margin(60, -18, -5, 4, 0.6), 1e-12);
}

/// -s1/(T - s3) > (1 + 1/mu)/3 at a right angle (Renshaw and Pollard 1995).
TEST(Crossing, AgreesWithTheOrthogonalFormula) {
  for (const Real friction : {0.3, 0.6, 1.0})
    for (const Real part : {0.98, 1.02})
      EXPECT_EQ(margin(90, -part * 9 * (1 + 1 / friction) / 3, -5, 4, friction) > 0, part > 1);
}

TEST(Crossing, OfAnInterfaceThatOpensIsImpossible) {
  EXPECT_EQ(margin(90, -1, -5, 4, 0.6), -1);
  EXPECT_GT(margin(90, -1e9, -5, 4, 0.6), 100);
}

}  // namespace
}  // namespace sprekk::laws
