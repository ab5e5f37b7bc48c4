#include "assembly/rates.hpp"

#include <gtest/gtest.h>

namespace sprekk::assembly {
namespace {

using Scheme = Rates::Scheme;

/// Returns the rate of M at t, computed from states at t, t - dt and t - dt - dt_before.
template <class Stored>
Real rate(Scheme scheme, const Stored& M, Real t, Real dt, Real dt_before) {
  const auto rates = Rates::of(scheme, dt, dt_before);
  return rates.now * (M(t) - M(t - dt)) - rates.before * (M(t - dt) - M(t - dt - dt_before));
}

TEST(Rates, AreExactOfParabolasInStepsOfAnyLength) {
  const auto parabola = [](Real t) { return 3 - 2 * t + 5 * t * t; };
  for (const Real ratio : {0.01, 0.5, 1.0, 1.7, 2.3}) {
    const Real t = 4, dt_before = 0.3, dt = ratio * dt_before;
    EXPECT_NEAR(rate(Scheme::bdf2, parabola, t, dt, dt_before), -2 + 10 * t, 1e-11) << ratio;
  }
}

TEST(Rates, AreThoseOfEulerInTheFirstStepAndAfterOneThatIsMuchShorter) {
  for (const Real dt_before : {0.0, 0.1}) {
    const auto rates = Rates::of(Scheme::bdf2, 0.5, dt_before);
    EXPECT_EQ(rates.now, 2);
    EXPECT_EQ(rates.before, 0);
  }
  const auto rates = Rates::of(Scheme::implicit_euler, 0.5, 0.5);
  EXPECT_EQ(rates.now, 2);
  EXPECT_EQ(rates.before, 0);
}

}  // namespace
}  // namespace sprekk::assembly
