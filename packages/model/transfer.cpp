#include "model/transfer.hpp"

#include <algorithm>
#include <map>

namespace sprekk::model {

namespace {

/// Returns the initial values of the histories that are not zero at the start, by name.
std::map<std::string, View<Real**>> initial_histories(const assembly::System& system) {
  std::map<std::string, View<Real**>> all;
  for (const auto& module : system.modules()) {
    if (!module.initial_values) continue;
    std::vector<View<Real**>> values;
    for (const auto& old : module.history) values.emplace_back(old.label(), old.extent(0), old.extent(1));
    module.initial_values->initial_history(values);
    for (std::size_t h = 0; h < values.size(); ++h)
      all.emplace(module.history_name(module.declaration.history[h]), values[h]);
  }
  return all;
}

/// Returns a - b.
View<Real**> difference(const View<Real**>& a, const View<Real**>& b) {
  const View<Real**> result("difference", a.extent(0), a.extent(1));
  Kokkos::parallel_for(
      "difference", Kokkos::RangePolicy<Execution>(0, a.extent(0)), KOKKOS_LAMBDA(int e) {
        for (std::size_t k = 0; k < a.extent(1); ++k) result(e, k) = a(e, k) - b(e, k);
      });
  return result;
}

}  // namespace

void transfer(const assembly::Prolongation& prolongation, assembly::System& from, const fields::BlockVector& x,
              assembly::System& to, fields::BlockVector& x_to) {
  auto change = from.initial();
  for (std::size_t b = 0; b < x.size(); ++b) change[b]->update(1, *x[b], -1);
  for (std::size_t b = 0; b < x.size(); ++b) {
    const auto& field = from.layouts()[b].field();
    const auto values = fields::by_entity(*change[b], field.n_components);
    for (std::size_t t = 0; t < x_to.size(); ++t) {
      const auto& name = to.layouts()[t].field().name;
      const auto result = fields::by_entity(*x_to[t], to.layouts()[t].field().n_components);
      if (name == field.name) prolongation.add(field, values, result);
      if (name == from.blocks()[b].enriches) prolongation.add_enrichment(field, values, result);
    }
  }
  if (prolongation.has_overlaps()) from.to_conserved(x);
  const auto start = initial_histories(from);
  std::map<std::string, View<Real**>> histories;
  for (const auto& [field, values] : to.histories()) histories.emplace(field.name, values);
  for (const auto& [field, values] : from.histories()) {
    const auto known = start.find(field.name);
    prolongation.add(field, known == start.end() ? values : difference(values, known->second),
                     histories.at(field.name));
  }
  if (prolongation.has_overlaps()) to.from_conserved(x_to);
  auto memory = to.memory();
  const auto before = from.memory();
  memory.t = before.t;
  memory.dt = before.dt;
  memory.calibration = before.calibration;
  memory.errors = before.errors;
  memory.energy = before.energy;
  for (auto& [name, scale] : memory.scales) scale = std::max(scale, before.scales.at(name));
  to.resume(x_to, memory);
}

}  // namespace sprekk::model
