#include "physics/mechanics/fracture_goals.hpp"

#include "base/over_ranks.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace sprekk::physics {

namespace {

using assembly::OutputField;

/// Minimum share of the absolute sum in the error of a sum with cancellation. Tractions cancel almost completely when
/// faces exchange load.
constexpr Real cancelled_jumps = 0.3, cancelled_tractions = 0.1;
/// Share of the slipping area that must differ from the previous change.
constexpr Real changed_area = 0.1;

const OutputField* find(const std::vector<OutputField>& outputs, const std::string& name) {
  const auto found = std::find_if(outputs.begin(), outputs.end(), [&](const auto& o) { return o.name == name; });
  return found == outputs.end() ? nullptr : &*found;
}

/// Vector of a face in its frame: n, t1, t2.
std::array<Real, 3> of_face(const OutputField& field, LocalIndex f) {
  std::array<Real, 3> v{};
  std::copy_n(&field.values[f * field.n_components], field.n_components, v.begin());
  return v;
}

Real tangential(const std::array<Real, 3>& v) { return std::hypot(v[1], v[2]); }

}  // namespace

bool FractureGoals::knows(const std::string& what) {
  return is_mean_jump(what) || what == "normal force" || what == "shear force";
}

std::vector<LocalIndex> FractureGoals::faces_of(const estimate::Functional& J) const {
  const auto& names = J.fractures;
  std::vector<LocalIndex> faces;
  for (LocalIndex f = 0; f < mesh_.n_owned_fracture_faces; ++f)
    if (names.empty() ||
        std::find(names.begin(), names.end(), mesh_.fracture_names[mesh_.fracture_faces[f].fracture]) != names.end())
      faces.push_back(f);
  return faces;
}

bool FractureGoals::follow(const Outputs& outputs, const Outputs* corrected) {
  const auto* plastic = find(outputs, "plastic jump local");
  if (corrected && !mesh_.fracture_names.empty() && plastic) {
    const auto &jump = *find(outputs, "jump local"), &better = *find(*corrected, "jump local");
    const int dim = plastic->n_components;
    slip_errors_.resize(mesh_.n_owned_fracture_faces);
    slips_.assign(slip_errors_.size(), 0);
    plastic_.resize(plastic->values.size());
    for (std::size_t f = 0; f < slip_errors_.size(); ++f) {
      const auto face = static_cast<LocalIndex>(f);
      if (std::equal(&plastic_[f * dim], &plastic_[f * dim] + dim, &plastic->values[f * dim])) continue;
      slips_[f] = 1;
      const auto p = of_face(*plastic, face), v = of_face(jump, face), w = of_face(better, face);
      const std::array<Real, 3> d = {0, w[1] - v[1], w[2] - v[2]};
      slip_errors_[f] = {(p[1] * d[1] + p[2] * d[2]) / std::max(tangential(p), std::numeric_limits<Real>::min()),
                         tangential(d)};
    }
    plastic_ = plastic->values;
  }
  std::array<Real, 2> areas{};  // slipping now or at the last change, and in exactly one of both
  for (std::size_t f = 0; f < slips_.size(); ++f) {
    const bool before = !noticed_.empty() && noticed_[f];
    const Real area = mesh_.fracture_faces[f].area;
    areas[0] += slips_[f] || before ? area : 0;
    areas[1] += (slips_[f] != 0) != before ? area : 0;
  }
  areas = base::sum_over_ranks(*mesh_.comm, areas);
  const bool changes = areas[1] > changed_area * areas[0];
  if (changes) noticed_ = slips_;
  return changes;
}

/// Computes sums over faces: area, value, signed and absolute error.
estimate::Estimate FractureGoals::evaluate(const estimate::Functional& J, const Outputs& outputs,
                                           const Outputs* corrected) const {
  const bool is_mean = is_mean_jump(J.what);
  const auto& now = *find(outputs, is_mean ? "jump local" : "traction local");
  const auto& better = corrected ? *find(*corrected, now.name) : now;
  const auto& slip = *find(outputs, "slip");
  std::array<Real, 4> sums{};
  for (const LocalIndex f : faces_of(J)) {
    const auto v = of_face(now, f), w = of_face(better, f);
    const std::array<Real, 3> d = {w[0] - v[0], w[1] - v[1], w[2] - v[2]};
    Real value, error, size;
    if (J.what == "slip") {
      value = slip.values[f];
      error = corrected ? slip_errors_[f].along : 0;
      size = corrected ? slip_errors_[f].size : 0;
    } else if (J.what == "shear force") {
      value = tangential(v);
      error = tangential(w) - tangential(v);
      size = tangential(d);
    } else {
      const Real sign = J.what == "opening" ? 1 : -1;
      value = sign * v[0];
      error = sign * d[0];
      size = std::abs(d[0]);
    }
    const Real area = mesh_.fracture_faces[f].area;
    const std::array<Real, 4> terms = {1, value, error, size};
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] += area * terms[k];
  }
  sums = base::sum_over_ranks(*mesh_.comm, sums);
  const Real whole = is_mean ? sums[0] : 1;
  if (!corrected) return {sums[1] / whole, std::numeric_limits<Real>::infinity()};
  return {sums[1] / whole,
          std::max(std::abs(sums[2]), (is_mean ? cancelled_jumps : cancelled_tractions) * sums[3]) / whole};
}

std::vector<Real> FractureGoals::directions(const estimate::Functional& J, const Outputs& outputs) const {
  const bool is_slip = J.what == "slip";
  const int dim = mesh_.dim();
  const auto& plastic = *find(outputs, "plastic jump local");
  std::vector<Real> d(mesh_.n_owned_fracture_faces * dim, 0);
  for (const LocalIndex f : faces_of(J)) {
    const auto p = of_face(plastic, f);
    const Real size = tangential(p);
    if (!is_slip) d[f * dim] = 1;
    for (int i = 1; i < dim && is_slip && size > 0; ++i) d[f * dim + i] = p[i] / size;
  }
  return d;
}

}  // namespace sprekk::physics
