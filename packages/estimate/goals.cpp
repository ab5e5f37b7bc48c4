#include "estimate/goals.hpp"

#include "base/check.hpp"
#include "base/over_ranks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprekk::estimate {

Goals::Goals(ErrorEstimator& estimator, std::map<std::string, Functional> quantities)
    : estimator_(estimator),
      quantities_(std::move(quantities)),
      steps_(estimator.errors().size()),
      have_changed_(estimator.errors().size(), 0) {
  for (const auto& [name, J] : quantities_) owners_.emplace(name, owner_of(J));
}

Goals::Owner Goals::owner_of(const Functional& J) const {
  for (std::size_t k = 0; k < estimator_.errors().size(); ++k) {
    if (error(k).names().name == J.what) return {k, true};
    if (auto* goals = error(k).goals(); goals && goals->knows(J.what)) return {k, false};
  }
  throw Error(fmt::format("no error estimate of the quantity \"{}\"", J.what));
}

bool Goals::need(bool last) const {
  return last || estimator_.system().has_rates() ||
         std::any_of(quantities_.begin(), quantities_.end(), [&](const auto& one) {
           const auto& owner = owners_.at(one.first);
           return !owner.is_norm && error(owner.error).goals()->has_history(one.second);
         });
}

bool Goals::any_balance() const {
  const auto& errors = estimator_.errors();
  return std::any_of(errors.begin(), errors.end(), [](const auto& error) { return error->names().is_balance; });
}

void Goals::add(const State& state, const ErrorEstimate& estimate, bool last) {
  const auto* correction = estimate.correction ? &*estimate.correction : nullptr;
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    if (!is_balance(k) || !estimator_.system().has_rates()) steps_[k].clear();
    if (k < estimate.norms.size()) steps_[k].push_back(estimate.norms[k]);
    if (!is_alone() && !steps_[k].empty()) steps_[k].back().components.clear();
    if (auto* goals = error(k).goals()) have_changed_[k] = goals->follow(state, correction);
  }
  for (const auto& [name, J] : quantities_) {
    const auto& owner = owners_.at(name);
    if (owner.is_norm) {
      if (const auto k = owner.error; k < estimate.norms.size())
        estimates_[name] = {estimate.norms[k].whole, estimate.norms[k].error};
    } else if (last || !is_balance(owner.error)) {
      auto& result = estimates_[name] = error(owner.error).goals()->evaluate(J, state, correction);
      result.error = std::abs(result.error);
    }
  }
}

void Goals::weigh(const State& state, const ErrorEstimate& estimate, bool last) {
  for (const auto& [name, J] : quantities_) {
    const auto& owner = owners_.at(name);
    const auto k = owner.error;
    const bool changes = !owner.is_norm && have_changed_[k] && error(k).goals()->has_history(J);
    if (!last && !changes && !(owner.is_norm && is_balance(k))) continue;
    auto& bound = bounds_[name];
    bound.resize(estimator_.system().mesh().n_owned_cells, 0);
    if (is_balance(k) && !owner.is_norm && !estimate.correction) continue;
    const auto shares = contributions(J, owner, state);
    for (std::size_t c = 0; c < bound.size(); ++c) bound[c] = std::max(bound[c], shares[c]);
  }
}

/// Returns for each owned cell a bound of its contribution to the error of the quantity, up to a factor. Functionals of
/// balances have an adjoint problem in time only if there are no other errors.
std::vector<Real> Goals::contributions(const Functional& J, const Owner& owner, const State& state) {
  const auto k = owner.error;
  if (is_balance(k)) {
    if (owner.is_norm) return steps_[k].back().energy;
    if (is_alone()) return estimator_.contributions(J, state, error(k), steps_[k]);
  }
  std::vector<Real> energies;
  if (!owner.is_norm && !is_balance(k)) {
    energies = estimator_.contributions(J, state, error(k), steps_[k]);
  } else {
    for (std::size_t j = 0; j < steps_.size(); ++j)
      if (!is_balance(j)) energies = steps_[j].back().energy;
  }
  return any_balance() ? with_balances(energies) : energies;
}

/// Adds the energies of the balances in all steps to those of another error [owned cell]. Each kind is scaled to the
/// same sum over the mesh.
std::vector<Real> Goals::with_balances(const std::vector<Real>& energies) const {
  const auto& mesh = estimator_.system().mesh();
  std::vector<Real> result(mesh.n_owned_cells, 0);
  const auto add = [&](const std::vector<Real>& some) {
    Real sum = 0;
    for (const Real one : some) sum += one;
    sum = base::sum_over_ranks(*mesh.comm, sum);
    for (std::size_t c = 0; c < some.size() && sum > 0; ++c) result[c] += some[c] / sum;
  };
  add(energies);
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    if (!is_balance(k)) continue;
    std::vector<Real> all(result.size(), 0);
    for (const auto& step : steps_[k])
      for (std::size_t c = 0; c < all.size(); ++c) all[c] += step.energy[c];
    add(all);
  }
  return result;
}

std::vector<Real> Goals::indicators(const std::map<std::string, Real>& weights) const {
  const auto& mesh = estimator_.system().mesh();
  std::vector<Real> result(mesh.n_owned_cells, 0);
  for (const auto& [name, weight] : weights) {
    const auto& bound = bounds_.at(name);
    Real sum = 0;
    for (const Real share : bound) sum += share;
    sum = base::sum_over_ranks(*mesh.comm, sum);
    for (std::size_t c = 0; c < bound.size() && sum > 0; ++c) result[c] = std::max(result[c], weight * bound[c] / sum);
  }
  return result;
}

std::vector<LocalIndex> mark_cells(const Comm& comm, const std::vector<Real>& indicators, Real theta) {
  constexpr int per_octave = 8, n_bins = 64 * per_octave;
  constexpr Real offset = 0.377;  // no bin ends at a round number
  const auto bin = [&](Real value) { return static_cast<int>(std::floor(per_octave * std::log2(value) + offset)); };
  int highest = std::numeric_limits<int>::min();
  for (const Real value : indicators)
    if (value > 0) highest = std::max(highest, bin(value));
  highest = base::max_over_ranks(comm, highest);
  std::vector<long long> counts(n_bins, 0);  // starting at the highest bin
  const auto place = [&](Real value) { return value > 0 ? highest - bin(value) : n_bins; };
  for (const Real value : indicators)
    if (const int k = place(value); k < n_bins) ++counts[k];
  counts = base::sum_over_ranks(comm, counts);
  const auto size = [&](int k) { return static_cast<Real>(counts[k]) * std::exp2(-static_cast<Real>(k) / per_octave); };
  Real all = 0, so_far = 0;
  for (int k = 0; k < n_bins; ++k) all += size(k);
  int last = 0;
  for (so_far = size(0); last + 1 < n_bins && so_far < theta * all; so_far += size(last)) ++last;
  std::vector<LocalIndex> cells;
  for (std::size_t c = 0; c < indicators.size(); ++c)
    if (place(indicators[c]) <= last) cells.push_back(static_cast<LocalIndex>(c));
  return cells;
}

}  // namespace sprekk::estimate
