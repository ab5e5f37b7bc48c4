#include "laws/fluid.hpp"

#include <gtest/gtest.h>

namespace sprekk::laws {
namespace {

TEST(Fluid, DropsAreDifferencesOfDensities) {
  const Fluid fluid{0.3, 2};
  EXPECT_NEAR(fluid.density(5), std::exp(0.9), 1e-15);
  EXPECT_NEAR(fluid.drop(5, 1, 0), (std::exp(0.9) - std::exp(-0.3)) / 0.3, 1e-15 * 10);
}

/// The limit of vanishing compressibility has no cancellation.
TEST(Fluid, NothingCancels) {
  const Fluid none{}, little{1e-30, 0};
  for (const Real lift : {0.0, 3.0}) {
    EXPECT_DOUBLE_EQ(little.drop(1e6 + 1e-3, 1e6, lift), none.drop(1e6 + 1e-3, 1e6, lift));
    EXPECT_DOUBLE_EQ(little.ddrop_da(7, 3, lift), none.ddrop_da(7, 3, lift));
    EXPECT_DOUBLE_EQ(little.ddrop_db(7, 3, lift), none.ddrop_db(7, 3, lift));
  }
}

TEST(Fluid, SlopesAreThoseOfDrops) {
  const Fluid fluid{0.3, 2};
  const Real a = 4, b = 2.5, lift = 0.7, h = 1e-5;
  EXPECT_NEAR(fluid.ddrop_da(a, b, lift), (fluid.drop(a + h, b, lift) - fluid.drop(a - h, b, lift)) / (2 * h), 1e-9);
  EXPECT_NEAR(fluid.ddrop_db(a, b, lift), (fluid.drop(a, b + h, lift) - fluid.drop(a, b - h, lift)) / (2 * h), 1e-9);
}

/// A column at rest, where 1/e is linear in the height, has no driving potential difference.
TEST(Fluid, IsAtRestInAColumn) {
  const Fluid fluid{0.3, 2};
  const auto at = [&](Real height) { return 2 - std::log(1 + 0.3 * 5 * height) / 0.3; };  // rho_0 g = 5, downwards
  EXPECT_NEAR(fluid.drop(at(0.2), at(1.7), -5 * 1.5), 0, 1e-14);
}

}  // namespace
}  // namespace sprekk::laws
