#include "model/goals.hpp"

#include "base/over_ranks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprekk::model {

using assembly::OutputField;

namespace {

/// Minimum share of the absolute sum in the error of a sum with cancellation. Tractions cancel almost completely when
/// faces exchange load.
constexpr Real cancelled_jumps = 0.3, cancelled_tractions = 0.1;
/// Share of the slipping area that must differ from the previous weighing to compute new weights.
constexpr Real changed = 0.1;

const OutputField& named(const std::vector<OutputField>& outputs, const std::string& name) {
  return *std::find_if(outputs.begin(), outputs.end(), [&](const auto& o) { return o.name == name; });
}

bool has(const std::vector<OutputField>& outputs, const std::string& name) {
  return std::any_of(outputs.begin(), outputs.end(), [&](const auto& o) { return o.name == name; });
}

/// Vector of a face in its frame: n, t1, t2.
std::array<Real, 3> of_face(const OutputField& field, LocalIndex f) {
  std::array<Real, 3> v{};
  std::copy_n(&field.values[f * field.n_components], field.n_components, v.begin());
  return v;
}

Real tangential(const std::array<Real, 3>& v) { return std::hypot(v[1], v[2]); }

}  // namespace

Goals::Goals(Model& model) : model_(model) {}

std::vector<LocalIndex> Goals::faces_of(const Quantity& quantity) const {
  const auto& mesh = model_.mesh();
  const auto& names = quantity.fractures;
  std::vector<LocalIndex> faces;
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f)
    if (names.empty() ||
        std::find(names.begin(), names.end(), mesh.fracture_names[mesh.fracture_faces[f].fracture]) != names.end())
      faces.push_back(f);
  return faces;
}

void Goals::follow_slip(const std::vector<OutputField>& outputs, const ErrorEstimate& estimate) {
  if (estimate.improved.empty() || model_.mesh().fracture_names.empty() || !has(outputs, "plastic jump local")) return;
  const auto &plastic = named(outputs, "plastic jump local"), &jump = named(outputs, "jump local"),
             &better = named(estimate.improved, "jump local");
  const int dim = plastic.n_components;
  lacks_.resize(model_.mesh().n_owned_fracture_faces);
  slips_.assign(lacks_.size(), 0);
  plastic_.resize(plastic.values.size());
  for (std::size_t f = 0; f < lacks_.size(); ++f) {
    const auto face = static_cast<LocalIndex>(f);
    if (std::equal(&plastic_[f * dim], &plastic_[f * dim] + dim, &plastic.values[f * dim])) continue;
    slips_[f] = 1;
    const auto p = of_face(plastic, face), v = of_face(jump, face), w = of_face(better, face);
    const std::array<Real, 3> d = {0, w[1] - v[1], w[2] - v[2]};
    lacks_[f] = {(p[1] * d[1] + p[2] * d[2]) / std::max(tangential(p), std::numeric_limits<Real>::min()),
                 tangential(d)};
  }
  plastic_ = plastic.values;
}

/// Estimates a quantity from sums over faces: area, value, signed and absolute error.
Goals::Estimate Goals::of_fractures(const Quantity& quantity, const std::vector<OutputField>& outputs,
                                    const ErrorEstimate& estimate) const {
  const bool is_mean = quantity.what == "slip" || quantity.what == "opening", known = !estimate.improved.empty();
  const auto& now = named(outputs, is_mean ? "jump local" : "traction local");
  const auto& better = known ? named(estimate.improved, now.name) : now;
  const auto& slip = named(outputs, "slip");
  std::array<Real, 4> sums{};
  for (const LocalIndex f : faces_of(quantity)) {
    const auto v = of_face(now, f), w = of_face(better, f);
    const std::array<Real, 3> d = {w[0] - v[0], w[1] - v[1], w[2] - v[2]};
    Real value, error, size;
    if (quantity.what == "slip") {
      value = slip.values[f];
      error = known ? lacks_[f].along : 0;
      size = known ? lacks_[f].size : 0;
    } else if (quantity.what == "shear force") {
      value = tangential(v);
      error = tangential(w) - tangential(v);
      size = tangential(d);
    } else {
      const Real sign = quantity.what == "opening" ? 1 : -1;
      value = sign * v[0];
      error = sign * d[0];
      size = std::abs(d[0]);
    }
    const Real area = model_.mesh().fracture_faces[f].area;
    const std::array<Real, 4> terms = {1, value, error, size};
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += area * terms[k];
  }
  sums = base::sum_over_ranks(*model_.mesh().comm, sums);
  const Real whole = is_mean ? sums[0] : 1;
  if (!known) return {sums[1] / whole, std::numeric_limits<Real>::infinity()};
  return {sums[1] / whole,
          std::max(std::abs(sums[2]), (is_mean ? cancelled_jumps : cancelled_tractions) * sums[3]) / whole};
}

Goals::Estimate Goals::of_boundary(const Quantity& quantity, const ErrorEstimate& estimate) const {
  const auto& conditions = model_.scene().boundary_conditions;
  const auto component = static_cast<std::size_t>(quantity.component[0] - 'x');
  const auto sum = [&](const std::vector<assembly::Reaction>& reactions) {
    Real all = 0;
    for (const auto& reaction : reactions)
      if (reaction.called.name == "reactions" && component < reaction.force.size() && reaction.region < 0 &&
          conditions.at(reaction.condition).boundary == quantity.boundary)
        all += reaction.force[component];
    return all;
  };
  const bool known = !estimate.reactions.empty();
  return {sum(model_.system().reactions(model_.state())),
          known ? std::abs(sum(estimate.reactions)) : std::numeric_limits<Real>::infinity()};
}

/// Returns for each owned cell a bound of its contribution to the error of the quantity, up to a factor. For mean jumps
/// it is the product of two energy norms: of the stress error, and of the stress error under unit forces at the faces.
/// For other quantities it is the square of the first norm.
std::vector<Real> Goals::energies(const Quantity& quantity, const std::vector<OutputField>& outputs,
                                  const ErrorEstimate& estimate, ErrorEstimator& estimator) const {
  const bool is_slip = quantity.what == "slip";
  if (!is_slip && quantity.what != "opening") return estimate.energy;
  const auto& mesh = model_.mesh();
  const auto& plastic = named(outputs, "plastic jump local");
  std::vector<Real> d(mesh.n_owned_fracture_faces * mesh.dim(), 0);
  for (const LocalIndex f : faces_of(quantity)) {
    const auto p = of_face(plastic, f);
    const Real size = tangential(p);
    if (!is_slip) d[f * mesh.dim()] = 1;
    for (int i = 1; i < mesh.dim() && is_slip && size > 0; ++i) d[f * mesh.dim() + i] = p[i] / size;
  }
  const auto weight = estimator.answer_energy(d);
  auto result = estimate.energy;
  for (std::size_t c = 0; c < weight.size(); ++c) result[c] = std::sqrt(result[c] * weight[c]);
  return result;
}

bool Goals::others_slip() const {
  std::array<Real, 2> areas{};  // slipping in one or both states, and in exactly one
  for (std::size_t f = 0; f < slips_.size(); ++f) {
    const bool before = !weighted_.empty() && weighted_[f];
    const Real area = model_.mesh().fracture_faces[f].area;
    areas[0] += slips_[f] || before ? area : 0;
    areas[1] += (slips_[f] != 0) != before ? area : 0;
  }
  areas = base::sum_over_ranks(*model_.mesh().comm, areas);
  return areas[1] > changed * areas[0];
}

bool Goals::need(bool last) const {
  const auto& quantities = model_.scene().accuracy->quantities;
  return last || model_.system().has_rates() ||
         std::any_of(quantities.begin(), quantities.end(), [](const auto& q) { return q.second.what == "slip"; });
}

/// Adds a quantity of a balance with its own error estimate; returns false for other quantities.
bool Goals::add_flux(const std::string& name, const Quantity& quantity, const ErrorEstimate& estimate,
                     ErrorEstimator& estimator, bool last) {
  if (quantity.what == "flux") {
    const auto& now = fluxes_.back().front();
    estimates_[name] = {now.whole, now.error};
    add_to_bound(name, now.energy);
    return true;
  }
  if (quantity.is_of_outputs() || quantity.what == "stress") return false;
  if (!last) return true;
  const auto of_functional = estimator.of_functional(quantity, estimate);
  estimates_[name] = {of_functional->value, std::abs(of_functional->lack)};
  auto& bound = bounds_[name];
  if (!estimate.lacks.empty())
    bound = estimator.has_shares() ? estimator.shares(quantity, fluxes_) : all_energies(estimate.energy);
  bound.resize(model_.mesh().n_owned_cells, 0);
  return true;
}

void Goals::add_to_bound(const std::string& name, const std::vector<Real>& shares) {
  auto& bound = bounds_[name];
  bound.resize(shares.size(), 0);
  for (std::size_t c = 0; c < bound.size(); ++c) bound[c] = std::max(bound[c], shares[c]);
}

/// Adds the energies of the fluxes of all steps to those of the stress [owned cell]. Each kind is scaled to the same
/// sum over the mesh.
std::vector<Real> Goals::all_energies(const std::vector<Real>& of_stress) const {
  std::vector<Real> result(model_.mesh().n_owned_cells, 0);
  const auto add = [&](const std::vector<Real>& energies) {
    Real sum = 0;
    for (const Real one : energies) sum += one;
    sum = base::sum_over_ranks(*model_.mesh().comm, sum);
    for (std::size_t c = 0; c < energies.size() && sum > 0; ++c) result[c] += energies[c] / sum;
  };
  add(of_stress);
  for (std::size_t k = 0; k < fluxes_.back().size(); ++k) {
    std::vector<Real> energies(result.size(), 0);
    for (const auto& step : fluxes_)
      for (std::size_t c = 0; c < energies.size(); ++c) energies[c] += step[k].energy[c];
    add(energies);
  }
  return result;
}

void Goals::add(const std::vector<OutputField>& outputs, const ErrorEstimate& estimate, ErrorEstimator& estimator,
                bool last) {
  follow_slip(outputs, estimate);
  if (!model_.system().has_rates()) fluxes_.clear();
  fluxes_.push_back(estimate.fluxes);
  for (auto& flux : fluxes_.back())
    if (!estimator.has_shares()) flux.parts.clear();
  for (const auto& [name, quantity] : model_.scene().accuracy->quantities) {
    if (add_flux(name, quantity, estimate, estimator, last)) continue;
    estimates_[name] = quantity.what == "stress"     ? Estimate{estimate.stress_norm, estimate.stress}
                       : quantity.what == "reaction" ? of_boundary(quantity, estimate)
                                                     : of_fractures(quantity, outputs, estimate);
  }
}

void Goals::weigh(const std::vector<OutputField>& outputs, const ErrorEstimate& estimate, ErrorEstimator& estimator,
                  bool last) {
  const bool others = others_slip();
  if (others || last) weighted_ = slips_;
  for (const auto& [name, quantity] : model_.scene().accuracy->quantities) {
    if (!quantity.is_of_outputs() && quantity.what != "stress") continue;  // already evaluated in add()
    if (!last && !(others && quantity.what == "slip")) continue;
    auto energies = this->energies(quantity, outputs, estimate, estimator);
    if (!fluxes_.back().empty()) energies = all_energies(energies);
    add_to_bound(name, energies);
  }
}

std::vector<Real> Goals::indicators(const std::map<std::string, Real>& weights) const {
  std::vector<Real> result(model_.mesh().n_owned_cells, 0);
  for (const auto& [name, weight] : weights) {
    const auto& bound = bounds_.at(name);
    Real sum = 0;
    for (const Real share : bound) sum += share;
    sum = base::sum_over_ranks(*model_.mesh().comm, sum);
    for (std::size_t c = 0; c < bound.size() && sum > 0; ++c) result[c] = std::max(result[c], weight * bound[c] / sum);
  }
  return result;
}

std::vector<LocalIndex> marked(const Comm& comm, const std::vector<Real>& indicators, Real theta) {
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

}  // namespace sprekk::model
