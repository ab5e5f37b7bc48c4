// The search for a zero terminates for every function; it finds the zero of a non-decreasing function.
#include "contact/zero_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace sprekk::contact {
namespace {

constexpr Real infinity = std::numeric_limits<Real>::infinity(), nan = std::numeric_limits<Real>::quiet_NaN();

/// Returns the finished search; fails if the search needs more than `max_values` values.
ZeroSearch searched(const std::function<Real(Real)>& f, Real first = 0.1, Real reach = 1e3) {
  ZeroSearch search(f(0), first, reach);
  int n_values = 0;
  for (; !search.done() && n_values <= ZeroSearch::max_values; ++n_values) search.next(f(search.s));
  EXPECT_LE(n_values, ZeroSearch::max_values);
  EXPECT_TRUE(search.done());
  return search;
}

TEST(ZeroSearch, FindsTheZeroToATenthOfTheValueAtTheStart) {
  for (const auto& f : {std::function<Real(Real)>([](Real s) { return s - 2; }),
                        {[](Real s) { return s * s - 300; }},
                        {[](Real s) { return std::atan(1e3 * (s - 0.7)); }},
                        {[](Real s) { return 1e-30 * (s - 5); }}}) {
    const auto search = searched(f);
    EXPECT_FALSE(search.lost());
    EXPECT_LE(std::abs(f(search.s)), 0.1 * std::abs(f(0)));
  }
}

/// A function that is never above zero within reach has no zero.
TEST(ZeroSearch, IsLostBeyondReach) {
  EXPECT_TRUE(searched([](Real) { return -1; }).lost());
  EXPECT_TRUE(searched([](Real s) { return s - 2e3; }).lost());
}

TEST(ZeroSearch, StaysWhereNothingPulls) {
  for (const Real start : {0.0, 1.0, infinity, nan}) {
    const auto search = searched([&](Real) { return start; });
    EXPECT_EQ(search.s, 0);
    EXPECT_FALSE(search.lost());
  }
}

/// For a function with a jump through zero, the result is next to the jump.
TEST(ZeroSearch, EndsAtAJump) {
  const auto search = searched([](Real s) { return s < 3 ? -1 : 10; });
  EXPECT_FALSE(search.lost());
  EXPECT_NEAR(search.s, 3, 1e-2);
}

/// Another block has moved: only the first value is below zero, and the steps towards 0 become too small.
TEST(ZeroSearch, EndsWhereTheZeroHasGone) {
  for (const Real start : {-1e-20, -1e-300, -std::numeric_limits<Real>::denorm_min()}) {
    const auto search = searched([&](Real s) { return s == 0 ? start : 1; });
    EXPECT_FALSE(search.lost());
    EXPECT_GE(search.s, 0);
    EXPECT_LT(search.s, 0.1);
  }
  bool first = true;
  const auto search = searched([&](Real) { return std::exchange(first, false) ? -1e-20 : 1; });
  EXPECT_GE(search.s, 0);
}

TEST(ZeroSearch, EndsOnWhatIsNotMonotone) {
  EXPECT_FALSE(searched([](Real s) { return s < 1 ? -1 : s < 2 ? 1 : -1; }).lost());
  EXPECT_FALSE(searched([](Real s) { return std::sin(1e3 * s) - 0.5; }).lost());
  int n = 0;
  searched([&](Real) { return n++ % 2 == 0 ? -1 : 1; });
  n = 0;
  searched([&](Real) { return n++ % 3 == 0 ? -1e-300 : 1e300; });
}

TEST(ZeroSearch, IsLostWhereAValueIsNoNumber) {
  for (const Real wrong : {infinity, nan}) EXPECT_TRUE(searched([&](Real s) { return s == 0 ? -1 : wrong; }).lost());
  searched([](Real s) { return s > 5 ? infinity : -1; });
  searched([](Real) { return -infinity; });
}

TEST(ZeroSearch, EndsFromAnyFirstStep) {
  for (const Real first : {0.0, -1.0, 1e-320, infinity, nan}) searched([](Real s) { return s - 1; }, first);
  searched([](Real) { return -1; }, 1e-300, infinity);
}

}  // namespace
}  // namespace sprekk::contact
