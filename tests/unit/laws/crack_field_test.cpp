// Crack fields at a curved front.
#include "laws/crack_field.hpp"

#include <gtest/gtest.h>

namespace sprekk::laws {
namespace {

constexpr Elasticity rock{.G = 1.3, .lambda = 0.9};
constexpr Real radius = 2;  // of the front

CrackField field(int mode, Real x1, Real x2) { return crack_fields(rock, x1, x2, 1 / (radius + x1))[mode]; }
Real trace(const CrackField& one) { return one.H[0][0] + one.H[1][1] + one.H[2][2]; }
/// Stress, Pa.
std::array<std::array<Real, 3>, 3> stress(int mode, Real x1, Real x2) {
  const auto one = field(mode, x1, x2);
  std::array<std::array<Real, 3>, 3> s;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      s[i][j] = rock.G * (one.H[i][j] + one.H[j][i]) + (i == j ? rock.lambda * trace(one) : 0);
  return s;
}

/// `force` is the divergence of the stress in cylindrical coordinates, and `slope` the derivative of tr H.
TEST(CrackField, HasTheDivergenceOfItsStress) {
  constexpr Real step = 1e-5, points[][2] = {{0.3, 0.4}, {-0.5, 0.2}, {-0.3, -0.7}};
  for (int mode = 0; mode < 3; ++mode)
    for (const auto& [x1, x2] : points) {
      const Real k = 1 / (radius + x1);
      const auto east = stress(mode, x1 + step, x2), west = stress(mode, x1 - step, x2),
                 north = stress(mode, x1, x2 + step), south = stress(mode, x1, x2 - step), s = stress(mode, x1, x2);
      const auto here = field(mode, x1, x2);
      for (int i = 0; i < 3; ++i) {
        Real force = (east[i][0] - west[i][0] + north[i][1] - south[i][1]) / (2 * step) + k * s[i][0];
        if (i == 0) force -= k * s[2][2];
        if (i == 2) force += k * s[0][2];
        EXPECT_NEAR(here.force[i], force, 1e-8) << mode << i;
      }
      EXPECT_NEAR(here.slope, (trace(field(mode, x1 + step, x2)) - trace(field(mode, x1 - step, x2))) / (2 * step),
                  1e-8)
          << mode;
    }
}

TEST(CrackField, HasFacesWithoutTraction) {
  for (int mode = 0; mode < 3; ++mode)
    for (const Real side : {-1e-15, 1e-15}) {
      const auto s = stress(mode, -0.4, side);
      for (int i = 0; i < 3; ++i) EXPECT_NEAR(s[i][1], 0, 1e-12) << mode << i;
    }
}

}  // namespace
}  // namespace sprekk::laws
