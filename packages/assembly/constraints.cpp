#include "assembly/constraints.hpp"

#include "base/check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

namespace sprekk::assembly {

Constraints::Constraints(const mesh::Mesh& mesh, const fields::Layout& layout,
                         std::vector<DirichletCondition> conditions)
    : conditions_(std::move(conditions)),
      mask_("constrained", layout.n_owned()),
      values_("prescribed", layout.n_owned()) {
  const int dim = mesh.dim(), n_components = layout.field().n_components;
  std::vector<int> first_entry(layout.n_owned(), -1);
  const auto add = [&](LocalIndex node, int condition, int component) {
    const LocalIndex unknown = mesh.free_node(node) * n_components + component;
    if (unknown >= layout.n_owned()) return;
    Entry entry{unknown, condition, component, {0, 0, 0}};
    std::copy_n(mesh.coordinates.begin() + node * dim, dim, entry.x.begin());
    if (first_entry[unknown] < 0) {
      first_entry[unknown] = static_cast<int>(entries_.size());
      entries_.push_back(entry);
    } else if (entries_[first_entry[unknown]].condition != condition) {
      repeated_.emplace_back(first_entry[unknown], entry);
    }
  };
  for (int k = 0; k < static_cast<int>(conditions_.size()); ++k)
    for (const auto& face : mesh.boundary_faces) {
      const int region = conditions_[k].region;
      if (face.boundary != conditions_[k].boundary || (region >= 0 && mesh.cell_region[face.cell] != region)) continue;
      for (int a = 0; a < mesh::n_face_nodes(mesh.shape); ++a) {
        const int corner = mesh::face_nodes(mesh.shape)[face.local_face][a];
        const LocalIndex node = mesh.cells[face.cell * mesh.nodes_per_cell() + corner];
        for (int c = 0; c < n_components; ++c)
          if (conditions_[k].values[c]) add(node, k, c);
      }
    }
  auto mask = Kokkos::create_mirror_view(mask_);
  for (const auto& entry : entries_) mask(entry.unknown) = 1;
  Kokkos::deep_copy(mask_, mask);
}

Real Constraints::value(const Entry& entry, Real t) const {
  return (*conditions_[entry.condition].values[entry.component])(entry.x, t);
}

void Constraints::evaluate(Real t) {
  auto values = Kokkos::create_mirror_view(values_);
  largest_ = 0;
  for (const auto& entry : entries_) {
    values(entry.unknown) = value(entry, t);
    largest_ = std::max(largest_, std::abs(values(entry.unknown)));
  }
  std::map<std::array<int, 3>, std::string> conflicts;  // one of each pair of conditions and component
  for (const auto& [number, entry] : repeated_) {
    const Real first = values(entry.unknown), second = value(entry, t);
    if (std::abs(first - second) <= 1e-12 * largest_) continue;
    conflicts.try_emplace(
        {entries_[number].condition, entry.condition, entry.component},
        fmt::format(
            "boundary conditions \"{}\" and \"{}\" prescribe {} and {} for component {} of {} at ({}, {}, {}), t = {}; "
            "where they meet they must agree or leave the component free",
            conditions_[entries_[number].condition].name, conditions_[entry.condition].name, first, second,
            "xyz"[entry.component], conditions_[entry.condition].field, entry.x[0], entry.x[1], entry.x[2], t));
  }
  std::string message;
  for (const auto& [place, conflict] : conflicts) message += (message.empty() ? "" : "\n") + conflict;
  SPREKK_CHECK(conflicts.empty(), "{}", message);
  Kokkos::deep_copy(values_, values);
}

}  // namespace sprekk::assembly
