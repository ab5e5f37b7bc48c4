#include "solve/factor_cost.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace sprekk::test {
namespace {

using solve::factors_are_cheaper;

/// The work of factors grows with a higher power of the number of unknowns than that of multigrid, and in 3D with a
/// higher one than in 2D: from some size on multigrid is cheaper, in 3D from a smaller one.
TEST(FactorCost, FactorsAreCheaperForSmallMatrices) {
  for (const bool alone : {false, true}) {
    EXPECT_TRUE(factors_are_cheaper({1e3, 2, alone}));
    EXPECT_TRUE(factors_are_cheaper({1e3, 3, alone}));
    EXPECT_TRUE(factors_are_cheaper({2e4, 2, alone}));
    EXPECT_FALSE(factors_are_cheaper({1e7, 2, alone}));
    EXPECT_FALSE(factors_are_cheaper({1e6, 3, alone}));
  }
  EXPECT_TRUE(factors_are_cheaper({2.4e4, 3, true}));
  EXPECT_FALSE(factors_are_cheaper({1.3e4, 3, false}));  // substitutions repeat in all iterations of coupled fields
}

/// Multigrid gains more from ranks than factors.
TEST(FactorCost, RanksFavourMultigrid) {
  EXPECT_TRUE(factors_are_cheaper({2.4e4, 3, true, 1}));
  EXPECT_FALSE(factors_are_cheaper({2.4e4, 3, true, 1000}));
}

/// The entries are those of nested dissection: twice as many unknowns have 2^(4/3) as many entries in 3D.
TEST(FactorCost, GrowsAsInNestedDissection) {
  const auto once = solve::factor_cost({1e4, 3}), twice = solve::factor_cost({2e4, 3});
  EXPECT_NEAR(twice.entries / once.entries, std::pow(2, 4.0 / 3), 1e-12);
  EXPECT_NEAR(twice.operations / once.operations, 4, 1e-12);
  EXPECT_NEAR(solve::factor_cost({2e4, 2}).operations / solve::factor_cost({1e4, 2}).operations, std::pow(2, 1.5),
              1e-12);
}

}  // namespace
}  // namespace sprekk::test
