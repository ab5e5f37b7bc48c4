// Friction that depends on slip rate and state: values by hand, derivatives, and the projected slip.
#include "laws/joint.hpp"

#include <Sacado.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace sprekk::laws::testing {
namespace {

constexpr Real N = 50e6;

template <class Evolution>
RateStateFriction<Evolution> typical_law() {
  RateStateFriction<Evolution> law;
  law.direct = 0.01;
  law.evolution = 0.015;
  law.distance = 1e-5;
  law.initial_rate = 1e-6;
  return law;
}

template <class T = Real>
Contact<T> slipped(const T& slip, Real duration, const Real (&history)[6]) {
  Contact<T> at;
  at.lambda_n = -N;
  at.slip_of_step = slip;
  at.duration = duration;
  at.history = {history, 1};
  return at;
}

/// Friction coefficient after a change of the slip rate from 1e-6 to 1e-5 m/s and a further slip, in two steps: a tiny
/// one, so that the rate before counts for nothing, and one that ends at the slip.
template <class Evolution>
Real after_step(Real slip) {
  const auto law = typical_law<Evolution>();
  constexpr Real rate = 1e-5, tiny = 1e-18;
  Real history[6] = {0, 0, 1, 0, 0, 1};
  law.commit(slipped(tiny, tiny / rate, history), {history});
  if (slip == 0) return law.bound(slipped(rate * 1e-16, 1e-16, history)) / N;
  return law.bound(slipped(slip, slip / rate, history)) / N;
}

TEST(RateState, VelocityStepKnownExactly) {
  const Real slips[] = {0, 1e-6, 5e-6, 1e-5, 3e-5};
  const Real ageing[] = {.623025850930, .621682783509, .616468671782, .610404327111, .594040690100};
  const Real slip_law[] = {.623025850930, .619739051790, .609435901368, .601193180294, .590206658957};
  for (int k = 0; k < 5; ++k) {
    EXPECT_NEAR(after_step<Ageing>(slips[k]), ageing[k], 1e-11) << slips[k];
    EXPECT_NEAR(after_step<SlipEvolution>(slips[k]), slip_law[k], 1e-11) << slips[k];
  }
  EXPECT_NEAR(after_step<Ageing>(1e-3), .588487074535, 1e-11);
  EXPECT_NEAR(after_step<SlipEvolution>(1e-3), .588487074535, 1e-11);
}

/// theta grows by the duration of a hold. Friction is that at the rate before the hold.
TEST(RateState, HoldKnownExactly) {
  const auto law = typical_law<Ageing>();
  const std::pair<Real, Real> holds[] = {{1, .601429652697}, {100, .635968429092}, {1e4, .703631321690}};
  for (const auto& [duration, friction] : holds) {
    Real history[6] = {};
    law.commit(slipped(Real(0), duration, history), {history});
    history[3] = 0;
    EXPECT_NEAR(law.bound(slipped(Real(0), 0, history)) / N, friction, 1e-12) << duration;
  }
}

TEST(RateState, StartsFromTheInitialFrictionCoefficient) {
  auto law = typical_law<Ageing>();
  const Real history[6] = {};
  for (const Real friction : {0.05, 0.584, 0.9}) {
    law.initial_friction = friction;
    EXPECT_NEAR(law.bound(slipped(Real(0), 0, history)) / N, friction, 1e-13);
  }
  law.initial_friction = 0;
  law.initial_state = 20;  // twice that of steady slip
  EXPECT_NEAR(law.bound(slipped(Real(0), 0, history)) / N, 0.6 + 0.015 * std::log(2), 1e-9);
}

/// Steady slip at any rate has the friction f0 + (a - b) ln(V/V0), and radiation damping adds eta V.
TEST(RateState, IsFiniteFromSlowestToFastestSlip) {
  for (Real rate = 1e-20; rate < 20; rate *= 10) {
    auto law = typical_law<Ageing>();
    law.initial_rate = rate;
    law.damping = 4.41e6;
    const Real duration = 1e-3 * law.distance / rate, history[6] = {0, 0, duration, 0, 0, duration};
    const auto at = slipped(rate * duration, duration, history);
    const Real logarithm = 0.6 - 0.005 * std::log(rate / 1e-6);
    if (logarithm > 0.05) {
      EXPECT_NEAR((law.bound(at) - law.damping * rate) / N, logarithm, 1e-6) << rate;
    }
    EXPECT_TRUE(std::isfinite(law.hardening(at)));
  }
  const auto law = typical_law<Ageing>();
  const Real history[6] = {};
  EXPECT_EQ(law.bound(slipped(Real(0), 1, history)), 0);
  auto tension = slipped(Real(1e-6), 1, history);
  tension.lambda_n = 1;
  EXPECT_EQ(law.bound(tension), 0);
}

/// The rate at the end of a step, as logarithm, where ln V = 0.1 cos t turns at the start of the step. The state is
/// constant. Without the term of third order, the error is 3e-4.
TEST(RateState, IsOfThirdOrderWhereTheRateTurns) {
  auto law = typical_law<Ageing>();
  law.distance = 1e9;
  constexpr Real dt = 0.1;
  const auto mean = [](Real begin) {  // ln V_m, by Simpson's rule
    const auto V = [](Real t) { return std::exp(0.1 * std::cos(t)); };
    return std::log((V(begin) + 4 * V(begin + dt / 2) + V(begin + dt)) / 6);
  };
  const auto friction = [&](Real rate, const Real(&history)[6]) {
    return law.bound(slipped(law.initial_rate * std::exp(rate) * dt, dt, history)) / N;
  };
  const Real exact = 0.1 * std::cos(dt), steady[6] = {0, exact, dt, exact, exact, dt},
             turning[6] = {0, mean(-dt), dt, 0.1, mean(-2 * dt), dt};
  EXPECT_NEAR((friction(mean(0), turning) - friction(exact, steady)) / law.direct, 0, 1e-5);
}

/// Errors of a step whose rate doubles: that of ln V by its effect on friction in slow slip, and on slip in fast slip;
/// that of the state decreases with the square of the slip.
TEST(RateState, ErrorsOfSlipFrictionAndState) {
  const auto law = typical_law<Ageing>();
  const auto defect = [&](Real m) {
    const Real dt = m * law.distance / (2 * law.initial_rate), history[6] = {0, 0, dt, 0, 0, dt};
    return law.defect_of_step(slipped(m * law.distance, dt, history));
  };
  const Real e = std::log(2) * 1.5 / 4;  // |v - v_1| dt (dt/2 + h)/(2 h (h + dt_1)) with h = dt_1 = dt
  EXPECT_NEAR(defect(1e-4).rate, e * 0.01 / 0.61, 1e-12);
  EXPECT_NEAR(defect(1).rate, e / 2, 1e-12);
  EXPECT_NEAR(defect(1e4).rate, e, 1e-4 * e);
  const Real first = std::log(2) / 12, part = 1e-3 / (1 + 1e-3);
  EXPECT_NEAR(defect(1e-3).state, first * part * part * 5e-4, 1e-12 * first);
  EXPECT_NEAR(defect(1e4).state, first, 1e-3 * first);
}

/// (s dt)^3/4 with s = (b - a')/a' V/L, a' = a + eta V/N; zero on faces that strengthen, by a or by damping.
TEST(RateState, ErrorOfTheGrowthOfInstabilities) {
  auto law = typical_law<Ageing>();
  law.damping = 5e6;
  const Real history[6] = {0, 0, 1, 0};
  const auto growth = [&](Real rate) { return law.defect_of_step(slipped(rate * 2, 2, history)).growth; };
  for (const Real rate : {1e-6, 0.02}) {
    const Real damped = 0.01 + 5e6 * rate / N, exact = std::pow((0.015 / damped - 1) * rate * 2 / 1e-5, 3) / 4;
    EXPECT_NEAR(growth(rate), exact, 1e-12 * exact);
  }
  EXPECT_EQ(growth(0.1), 0);
  law.direct = 0.02;
  EXPECT_EQ(growth(1e-6), 0);
}

/// Derivatives in the slip by hand and by automatic differentiation, and the bound of the decrease.
template <class Law>
void expect_hardening(const Law& law) {
  using Fad = Sacado::Fad::SFad<Real, 1>;
  for (const Real state : {-20.0, 0.0, 15.0})
    for (const Real duration : {1e-3, 1.0, 1e6})
      for (Real slip = 1e-16; slip < 1; slip *= 30) {
        const Real before = std::exp(state / 10), history[6] = {state, -3, 2 * duration, -2, -3.5, before * duration};
        const auto at = slipped(slip, duration, history);
        const Real derivative = law.bound(slipped(Fad(1, 0, slip), duration, history)).dx(0);
        EXPECT_NEAR(law.hardening(at), derivative, 1e-8 * std::abs(derivative) + 1e-8 * N / slip * 1e-3)
            << slip << ' ' << duration << ' ' << state;
        EXPECT_GT(law.hardening(at), -law.softening(at) * N);
      }
}

TEST(RateState, HasTheDerivativeInTheSlip) {
  auto ageing = typical_law<Ageing>();
  ageing.damping = 4.41e6;
  expect_hardening(ageing);
  expect_hardening(typical_law<SlipEvolution>());
}

/// b(S) + N softening S increases over a scan of slips, so that the projected slip is the only root.
template <class Law>
void expect_one_root(const Law& law, Real duration, const Real (&history)[6], Real jump) {
  Real before = 0;
  for (Real x = -12; x < 12; x += 0.1) {
    const auto at = slipped(law.initial_rate * duration * std::exp(history[1] + jump + x), duration, history);
    const Real left = law.bound(at) + N * law.softening(at) * at.slip_of_step;
    ASSERT_GT(law.hardening(at), -N * law.softening(at)) << x;
    ASSERT_GT(left, before) << x;
    before = left;
  }
}

/// Step lengths and rates that change abruptly; the first history turns from slowing to accelerating.
template <class Evolution>
void expect_one_root_for_any_history() {
  auto law = typical_law<Evolution>();
  law.distance = 0.01;
  expect_one_root(law, 1, {0, -4.9, 1 / 1.93, -4.9, 0, 0.54 / 1.93}, 2.4);
  std::mt19937 random(1);
  const auto within = [&](Real size) { return std::uniform_real_distribution<Real>(-size, size)(random); };
  for (int k = 0; k < 3000; ++k) {
    const Real duration = std::exp(within(12)), last = duration * std::exp(within(4)), mean = within(10),
               history[6] = {within(10), mean, last, mean, mean + within(k % 20), last * std::exp(within(4))};
    law.damping = k % 2 * 4.41e6;
    ASSERT_NO_FATAL_FAILURE(expect_one_root(law, duration, history, 0)) << k;
  }
}

TEST(RateState, ProjectedSlipIsTheOnlyRootForAnyHistory) {
  expect_one_root_for_any_history<Ageing>();
  expect_one_root_for_any_history<SlipEvolution>();
}

/// The projection constant is of the size of the softening, and the residual vanishes for the traction of the law.
template <int dim>
void expect_residual(Real slip, Real duration) {
  using Fad = Sacado::Fad::SFad<Real, 2 * dim>;
  auto friction = typical_law<Ageing>();
  friction.damping = 4.41e6;
  const JointLaw<LinearShear, RateStateFriction<Ageing>> law{{1e-11}, friction};
  const Real history[6] = {1, 2, 0.5 * duration, 2.2, 1.7, 0.4 * duration};
  auto at = slipped(slip, duration, history);
  const Real b = law.friction_bound(at), direction[] = {0.6, 0.8};
  Real old[dim - 1] = {};
  Fad w[dim], lambda[dim], R[dim];
  w[0] = Fad(2 * dim, 0, 0.0);
  lambda[0] = Fad(2 * dim, dim, -N);
  for (int i = 1; i < dim; ++i) {
    const Real along = dim == 2 ? 1 : direction[i - 1];
    lambda[i] = Fad(2 * dim, dim + i, b * along);
    w[i] = Fad(2 * dim, i, slip * along + 1e-11 * b * along);
    old[i - 1] = 0;
  }
  const Augmentation c{1e9, 1e9};
  EXPECT_EQ(contact_residual<dim>(law, c, w, lambda, old, R, {history}, duration), ContactState::slip);
  const Real scale = rated_constant(law, at, c.tangential);
  for (int i = 1; i < dim; ++i) EXPECT_NEAR(R[i].val(), 0, 1e-9 * b + 1e-15 * scale) << slip;
  for (int j = 0; j < 2 * dim; ++j) {
    const Real h = j < dim ? 1e-4 * b / scale : 1e-4 * b;
    Real value[2][dim];
    for (int sign = 0; sign < 2; ++sign) {
      Real jump[dim], traction[dim];
      for (int i = 0; i < dim; ++i) {
        jump[i] = w[i].val() + (i == j ? (2 * sign - 1) * h : 0);
        traction[i] = lambda[i].val() + (i == j - dim ? (2 * sign - 1) * h : 0);
      }
      contact_residual<dim>(law, c, jump, traction, old, value[sign], {history}, duration);
    }
    for (int i = 0; i < dim; ++i) {
      const Real difference = (value[1][i] - value[0][i]) / (2 * h);
      EXPECT_NEAR(R[i].dx(j), difference, 1e-3 * std::abs(difference) + 1e-4 * (j < dim ? scale : 1))
          << "row " << i << ", column " << j << ", slip " << slip;
    }
  }
}

TEST(RateState, ResidualVanishesForTheLawAndHasItsDerivatives) {
  for (const Real slip : {1e-18, 1e-12, 1e-8, 1e-6, 1e-4, 1e-2}) {
    expect_residual<2>(slip, 1e-2);
    expect_residual<3>(slip, 1e-2);
    expect_residual<2>(slip, 1e5);
  }
}

/// b = N mu + eta s/dt of a joint beyond its weakening distance.
TEST(RateState, RadiationDampingOfSlipWeakening) {
  const SlipWeakeningFriction friction{0.6, 0.4, 1e-3, 5e6};
  const JointLaw<LinearShear, SlipWeakeningFriction> law{{}, friction};
  const Real history[6] = {2e-3}, old[1] = {}, duration = 1e-2, slip = 1e-3;
  const Real b = 0.4 * N + 5e6 * slip / duration;
  EXPECT_DOUBLE_EQ(law.friction_bound(slipped(slip, duration, history)), b);
  const Real w[] = {0, slip}, lambda[] = {-N, b}, slower[] = {0, slip / 2};
  Real R[2];
  EXPECT_EQ(contact_residual<2>(law, {1e9, 1e9}, w, lambda, old, R, {history}, duration), ContactState::slip);
  EXPECT_NEAR(R[1], 0, 1e-7);
  contact_residual<2>(law, {1e9, 1e9}, slower, lambda, old, R, {history}, duration);
  EXPECT_GT(std::abs(R[1]), 1e4);
  const Real rest[] = {0, 0}, less[] = {-N, 0.39 * N};
  EXPECT_EQ(contact_residual<2>(law, {1e9, 1e9}, rest, less, old, R, {history}, duration), ContactState::stick);
  EXPECT_FALSE(SlipWeakeningFriction().depends_on_rate());
}

}  // namespace
}  // namespace sprekk::laws::testing
