// Dilation of gouge by slip rate, compared with exact solutions.
#include "laws/joint.hpp"
#include "laws/prescribed_jump.hpp"

#include <Sacado.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace sprekk::laws::testing {
namespace {

constexpr Real h = 2e-3, eps = 1e-4, L = 1e-5, V_i = 1e-9;

RateDilatancy typical_law() {
  RateDilatancy law;
  law.coefficient = eps;
  law.thickness = h;
  law.distance = L;
  law.initial_rate = V_i;
  return law;
}

template <class T = Real>
Contact<T> slipped(const T& slip, Real duration, const Real& history) {
  Contact<T> at;
  at.lambda_n = -1e7;
  at.slip_of_step = slip;
  at.duration = duration;
  at.history = {&history, 1};
  return at;
}

/// o = o_ss (1 - exp(-V t/L)) at the rate V, independent of the steps, and exp(-V_i t/L) of it after a return to V_i.
TEST(RateDilatancy, IsExactAtAConstantRate) {
  const auto law = typical_law();
  constexpr Real V = 1e-5, steady = h * eps * 9.210340371976184;  // ln(1e4)
  for (const int n : {1, 7, 100}) {
    Real opening = 0;
    for (int k = 1; k <= n; ++k) {
      law.commit(slipped(2 * L / n, 2 * L / V / n, opening), {&opening});
      EXPECT_NEAR(opening, steady * (1 - std::exp(-2.0 * k / n)), 1e-14 * steady) << n << ' ' << k;
    }
    for (int k = 1; k <= n; ++k) law.commit(slipped(L / n, L / V_i / n, opening), {&opening});
    EXPECT_NEAR(opening, steady * (1 - std::exp(-2.0)) * std::exp(-1.0), 1e-14 * steady) << n;
  }
}

TEST(RateDilatancy, IsSteadyAtTheInitialRateAndConstantWithoutSlip) {
  const auto law = typical_law();
  for (Real slip = 1e-20; slip < 1; slip *= 1e4) {
    EXPECT_NEAR(law.opening(slipped(slip, slip / V_i, Real(0))), 0, 1e-14 * h * eps) << slip;
  }
  for (const Real opening : {-1e-7, 0.0, 3e-6})
    for (const Real slip : {-1e-6, 0.0}) EXPECT_EQ(law.opening(slipped(slip, 1.0, opening)), opening);
  EXPECT_EQ(law.opening(slipped(1e-6, 0.0, 2e-7)), 2e-7);  // outside of a step
}

/// Slips from 1e-300 m, where the derivative grows like the logarithm of the slip.
TEST(RateDilatancy, HasItsDerivative) {
  using Fad = Sacado::Fad::SFad<Real, 1>;
  const auto law = typical_law();
  for (const Real opening : {-1e-7, 0.0, 3e-6})
    for (const Real duration : {1e-3, 1.0, 1e8})
      for (Real slip = 1e-300; slip < 10; slip *= 1e3) {
        const Real derivative = law.opening(slipped(Fad(1, 0, slip), duration, opening)).dx(0);
        const Real steady = h * eps * std::log(slip / (duration * V_i)), m = slip / L;
        const Real exact = h * eps * -std::expm1(-m) / slip + (steady - opening) * std::exp(-m) / L;
        EXPECT_NEAR(derivative, exact, 1e-12 * (h * eps + std::abs(steady) + std::abs(opening)) / L) << slip;
      }
}

/// The normal row of the residual has the opening of the step, with its derivatives; also with prescribed slip.
template <int dim>
void expect_normal_row(Real slip, Real duration) {
  using Fad = Sacado::Fad::SFad<Real, 2 * dim>;
  RateStateFriction<Ageing> friction;
  friction.evolution = 0.015;
  friction.distance = L;
  friction.initial_rate = V_i;
  friction.damping = 4.41e6;
  const NormalGap<RateDilatancy, LinearClosure> gap{1e-5, typical_law(), {1e-11}};
  const JointLaw<LinearShear, RateStateFriction<Ageing>, NormalGap<RateDilatancy, LinearClosure>> law{
      {}, friction, gap};
  const Real history[] = {4e-7, 1, 2, 0.5 * duration, 2.2}, direction[] = {0.6, 0.8}, N = 2e7;
  Real old[dim - 1] = {}, given[dim] = {not_prescribed};
  const auto at = slipped(slip, duration, history[0]);
  auto shifted = at;
  shifted.history = {history + 1, 1};
  shifted.lambda_n = -N;
  const Real b = friction.bound(shifted), opening = typical_law().opening(at);
  Fad w[dim], lambda[dim], R[dim];
  w[0] = Fad(2 * dim, 0, 1e-5 + opening - 1e-11 * N);
  lambda[0] = Fad(2 * dim, dim, -N);
  for (int i = 1; i < dim; ++i) {
    const Real along = dim == 2 ? 1 : direction[i - 1];
    lambda[i] = Fad(2 * dim, dim + i, b * along);
    w[i] = Fad(2 * dim, i, slip * along);
    given[i] = slip * along;
  }
  const Augmentation c{1e9, 1e9};
  EXPECT_EQ(contact_residual<dim>(law, c, w, lambda, old, R, {history, 1}, duration), ContactState::slip);
  EXPECT_NEAR(R[0].val(), 0, 1e-6);
  const Real slope = typical_law().opening(slipped(Sacado::Fad::SFad<Real, 1>(1, 0, slip), duration, history[0])).dx(0);
  for (int i = 1; i < dim; ++i) {
    const Real along = dim == 2 ? 1 : direction[i - 1];
    EXPECT_NEAR(R[0].dx(i), c.normal * slope * along, 1e-9 * c.normal * std::abs(slope)) << slip;
  }
  EXPECT_NEAR(R[0].dx(0), -c.normal, 1e-9 * c.normal);
  EXPECT_EQ(prescribed_residual<dim>(law, c, w, lambda, old, given, R, {history, 1}, duration), ContactState::stick);
  EXPECT_NEAR(R[0].val(), 0, 1e-6);
}

TEST(RateDilatancy, IsPartOfTheResidual) {
  for (const Real slip : {1e-12, 1e-8, 1e-6, 1e-4}) {
    expect_normal_row<2>(slip, 1e-2);
    expect_normal_row<3>(slip, 1e3);
  }
}

}  // namespace
}  // namespace sprekk::laws::testing
