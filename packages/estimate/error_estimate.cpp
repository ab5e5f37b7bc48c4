#include "estimate/error_estimate.hpp"

#include "base/check.hpp"

#include <cmath>

namespace sprekk::estimate {

namespace {

constexpr Real solve_tolerance = 1e-6;  ///< of iterative solvers; sufficient for estimates

}  // namespace

ErrorEstimator::ErrorEstimator(assembly::System& system, std::vector<std::unique_ptr<MeshError>> errors, Real start,
                               SolveLinearized solve)
    : system_(system), errors_(std::move(errors)), solve_(std::move(solve)), rates_(start) {}

ErrorEstimate ErrorEstimator::operator()(const State& state) {
  ErrorEstimate estimate;
  estimate.of_outputs.resize(errors_.size());
  bool any_output = false;
  for (const auto& error : errors_) {
    const auto& names = error->names();
    estimate.norms.push_back(error->of_state(state.x, state.t));
    estimate.fields.push_back({.name = names.density,
                               .unit = names.unit + "/m^3",
                               .entity = fields::Entity::cell,
                               .n_components = 1,
                               .values = std::move(estimate.norms.back().density)});
    any_output = any_output || !names.output.empty();
  }
  if (!requested_ && !any_output) return estimate;
  correct(state, estimate);
  if (estimate.correction) add_errors_of_outputs(state, estimate);
  return estimate;
}

/// Adds the storage error of previous steps. With storage M, the rows contain now (M - M_old) - before (M_old -
/// M_older), see assembly::Rates, and M_old has an error too. The exact solution has no artificial storage.
void ErrorEstimator::add_time_history(const State& state, fields::BlockVector& right_side) {
  if (!system_.has_rates()) return;
  const auto [now, before] = rates_.to(state.t, system_.rates());
  const auto artificial = system_.artificially_stored(state.x);
  for (std::size_t b = 0; b < right_side.size(); ++b) {
    right_side[b]->update(now, *artificial[b], 1);
    if (!stored_[0].empty()) right_side[b]->update(now + before, *stored_[0][b], 1);
    if (!stored_[1].empty()) right_side[b]->update(-before, *stored_[1][b], 1);
  }
  stored_[1] = std::move(stored_[0]);
  stored_[0].clear();
}

/// Estimates the errors of unknowns and reactions. With a lifting v of the prescribed unknowns, a reaction is a(u, v) -
/// f(v). Its error is a(dx, v) - rho(v), summed over v: the change of the reaction by dx minus the residual rho in the
/// rows of prescribed unknowns.
void ErrorEstimator::correct(const State& state, ErrorEstimate& estimate) {
  auto right_side = fields::create_like(state.x), x = fields::create_like(state.x);
  for (const auto& error : errors_) error->add_residual(state.x, right_side);
  const auto residual = system_.sums_of_constrained(right_side), reactions = system_.reactions(state.x);
  add_time_history(state, right_side);
  zero_constrained_rows(system_, right_side);
  try {
    for (const auto& error : errors_) error->add_prescribed(state.t, right_side);
  } catch (const Error& error) {  // the same on every rank: a condition has no value between nodes
    estimate.failure = error.what();
    return;
  }
  estimate.failure = solve_(state.x, right_side, x, solve_tolerance);
  if (!estimate.failure.empty()) return;
  if (system_.has_rates()) stored_[0] = system_.stored(state.x, x);
  auto& [dx, outputs, changes] = estimate.correction.emplace();
  dx = fields::create_like(x);
  fields::copy(x, dx);
  for (std::size_t k = 0; k < errors_.size(); ++k) {
    const auto carried = errors_[k]->carried(dx);
    for (std::size_t c = 0; c < carried.size(); ++c) estimate.norms[k].energy[c] += carried[c];
  }
  for (std::size_t b = 0; b < x.size(); ++b) x[b]->update(1, *state.x[b], 1);
  outputs = system_.outputs(x);
  changes = system_.reactions(x);
  for (std::size_t k = 0; k < reactions.size(); ++k)
    for (std::size_t i = 0; i < reactions[k].force.size(); ++i)
      changes[k].force[i] -= reactions[k].force[i] + residual[k].force[i];
}

void ErrorEstimator::add_errors_of_outputs(const State& state, ErrorEstimate& estimate) const {
  for (std::size_t k = 0; k < errors_.size(); ++k) {
    if (errors_[k]->names().output.empty()) continue;
    estimate.of_outputs[k] = errors_[k]->of_output(state, *estimate.correction);
    estimate.fields.push_back(std::move(estimate.of_outputs[k]->field));
  }
}

std::vector<Real> ErrorEstimator::contributions(const Functional& J, const State& state, MeshError& error,
                                                const std::vector<CellErrors>& steps) {
  std::vector<Real> energies(steps.back().energy.size(), 0), result = energies;
  for (const auto& step : steps)
    for (std::size_t c = 0; c < energies.size(); ++c) energies[c] += step.energy[c];
  auto right_side = fields::create_like(state.x), z = fields::create_like(state.x);
  if (!error.goals()->add_derivative(J, state, right_side)) return energies;
  for (auto step = steps.rbegin(); step != steps.rend(); ++step) {
    if (!solve_(state.x, right_side, z, solve_tolerance).empty()) return energies;
    const auto weight = error.goals()->of_adjoint(state.x, z);
    for (std::size_t k = 0; k < weight.components.size(); ++k)
      result[weight.components[k].cell] += std::abs(step->components[k].value * weight.components[k].value);
    for (std::size_t c = 0; c < result.size(); ++c) result[c] += std::sqrt(weight.energy[c] * step->energy[c]);
    if (step + 1 == steps.rend()) break;
    right_side = system_.stored(state.x, z);
    for (auto& block : right_side) block->scale(system_.rates().now);
    zero_constrained_rows(system_, right_side);
  }
  return result;
}

}  // namespace sprekk::estimate
