#include "laws/joint_start.hpp"

#include "base/check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprekk::laws {

namespace {

/// Shear traction during slip, Pa: the root of b(shear) = shear, if damage grows with the shear traction.
Real sliding_traction(const Joint& law, Contact<Real> at) {
  const auto bound = [&](Real shear) {
    at.shear = shear;
    return std::max(law.bound(at), Real(0));
  };
  Real low = 0, high = bound(0);
  if (bound(high) >= high) return high;
  for (;;) {
    const Real middle = low + (high - low) / 2;
    if (!(middle > low && middle < high)) return middle;
    (bound(middle) >= middle ? low : high) = middle;
  }
}

/// Sets the history variables after a slip from rest to the plastic jump of `at`.
void slip_from_rest(const JointParameters& joint, Contact<Real> at, std::vector<Real>& history) {
  at.slip_of_step = std::max(joint.slip_path, at.plastic_slip);
  for (int i = 0; i < 2; ++i) {
    at.last_plastic_jump[i] = 0;
    if (at.plastic_slip > 0) at.slip_direction[i] = at.plastic_jump[i] / at.plastic_slip;
  }
  at.shear = sliding_traction(joint.law, at);
  joint.law.commit(at, {history.data()});
}

Real size_of_shear(const std::array<Real, 3>& traction) { return std::hypot(traction[1], traction[2]); }

}  // namespace

JointStart start_of(const JointParameters& joint, const std::array<Real, 3>& traction, int dim) {
  const auto& law = joint.law;
  JointStart start;
  start.history.resize(std::max(law.n_history(dim), 1));
  Contact<Real> at{.dim = dim, .history = {start.history.data()}};
  at.plastic_slip = std::hypot(joint.plastic_jump[0], joint.plastic_jump[1]);
  for (int k = 0; k < 2; ++k) at.plastic_jump[k] = at.last_plastic_jump[k] = joint.plastic_jump[k];
  at.lambda_n = std::min(traction[0], Real(0));
  if (joint.in_situ) slip_from_rest(joint, at, start.history);
  start.strength = law.is_bonded() ? law.cohesion(at).strength : 0;
  const bool is_bonded = traction[0] > 0 && traction[0] <= start.strength;
  if (is_bonded) at.lambda_n = traction[0];
  if (is_bonded || traction[0] < 0) start.traction = traction;
  at.shear = size_of_shear(traction);
  start.closure = law.closure(at);
  start.jump[0] = law.normal_gap(at);
  const Real compliance = law.compliance(Contact<Real>{.lambda_n = at.lambda_n, .dim = dim, .history = at.history});
  at.lambda_n = traction[0];
  start.bound = law.bound(at);
  for (int k = 1; k < dim; ++k) start.jump[k] = joint.plastic_jump[k - 1] + compliance * start.traction[k];
  return start;
}

Real normal_compliance(const Joint& law, const JointStart& start) {
  constexpr Real part = 1e-4;
  const Real traction = start.traction[0];
  if (!(traction < 0)) return law.gap.closure.initial_compliance();
  const auto closure = [&](Real at) {
    return law.closure(Contact<Real>{.lambda_n = at, .history = {start.history.data()}});
  };
  return (closure((1 + part) * traction) - closure((1 - part) * traction)) / (2 * part * traction);
}

Real least_opening(const Joint& law) {
  constexpr Real any_compression = 1e100;  // Pa
  const Real zero = 0;                     // all history variables
  if (n_history(law.gap.dilation) > 0) return std::numeric_limits<Real>::lowest();
  return law.gap.initial + law.closure(Contact<Real>{.lambda_n = -any_compression, .history = {&zero, 0}});
}

Real cohesive_zone(const Joint& law, const Elasticity& rock, Real compression, int dim) {
  const Real weakening = if_rated<Real>(law.friction, [](const auto& one) { return one.weakening(); });
  const Real stiffness = dim == 3 ? rock.G : rock.plane_strain_modulus() / 2;
  if (!(compression * weakening > 0)) return std::numeric_limits<Real>::infinity();
  return 9 * M_PI / 32 * stiffness / (compression * weakening);
}

void check_start(const JointParameters& joint, const JointStart& start, const std::array<Real, 3>& traction) {
  constexpr Real rounding = 1e-9;
  const Real shear = size_of_shear(traction), slip = std::hypot(joint.plastic_jump[0], joint.plastic_jump[1]);
  SPREKK_CHECK(traction[0] <= (1 + rounding) * start.strength + rounding * shear,
               "the initial normal traction is a tension of {:.6g} Pa; it must be {}", traction[0],
               start.strength > 0 ? fmt::format("at most the tensile strength of the bond, {:.6g} Pa", start.strength)
                                  : "compressive or 0");
  SPREKK_CHECK(joint.law.never_slips() || joint.law.depends_on_rate() || shear <= (1 + rounding) * start.bound,
               "the initial shear traction is {:.6g} Pa under the normal traction {:.6g} Pa; it must be at most the "
               "strength of the joint, {:.6g} Pa",
               shear, traction[0], std::max(start.bound, Real(0)));
  SPREKK_CHECK(joint.slip_path == 0 || joint.slip_path >= (1 - rounding) * slip,
               "\"slip path\": is {:.6g} m; it must be at least the size of the plastic jump, {:.6g} m",
               joint.slip_path, slip);
}

JointParameters unloaded(const JointParameters& measured, const std::array<Real, 3>& traction, int dim) {
  JointParameters joint = measured;
  const auto first = start_of(measured, traction, dim);
  const Real closed = measured.initial_aperture - (first.jump[0] - first.closure);
  joint.law.gap.closure = joint.law.gap.closure.visit([&](const auto& law) {
    if constexpr (requires { law.in_situ(Real(), Real()); })
      return Closure(law.in_situ(std::max(-traction[0], Real(0)), closed));
    else
      return Closure(law);
  });
  const auto start = start_of(joint, traction, dim);
  joint.initial_aperture -= start.jump[0];
  SPREKK_CHECK(
      joint.initial_aperture >= 0,
      "slip opens the joint by {:.6g} m, more than its aperture {:.6g} m plus its closure {:.6g} m: there is no "
      "unloaded joint; the aperture must be at least {:.6g} m",
      start.jump[0] - start.closure, measured.initial_aperture, -start.closure, start.jump[0]);
  return joint;
}

Real overlap_compression(const JointParameters& joint, const JointStart& start) {
  constexpr Real largest = 1e15;  // Pa, beyond any load
  const auto aperture = [&](Real compression) {
    const Contact<Real> at{.lambda_n = -compression, .history = {start.history.data()}};
    return joint.initial_aperture + start.jump[0] - start.closure + joint.law.closure(at);
  };
  Real low = std::max(-start.traction[0], Real(1)), high = low;
  while (high < largest && aperture(high) >= 0) high *= 2;
  if (aperture(high) >= 0) return std::numeric_limits<Real>::infinity();
  while (high - low > 1e-12 * high) {
    const Real middle = low + (high - low) / 2;
    (aperture(middle) < 0 ? high : low) = middle;
  }
  return low;
}

Real smaller_aperture(const JointParameters& joint, const JointStart& start) {
  return joint.law.gap.closure.visit([&](const auto& law) {
    if constexpr (requires { law.smaller_aperture(Real()); })
      return law.smaller_aperture(-start.traction[0]);
    else
      return Real(0);
  });
}

}  // namespace sprekk::laws
