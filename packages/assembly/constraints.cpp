#include "assembly/constraints.hpp"

#include "assembly/one_sided.hpp"
#include "base/check.hpp"
#include "base/host_table.hpp"
#include "mesh/facets.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>

namespace sprekk::assembly {

bool DirichletCondition::applies_at(const std::array<Real, 3>& x) const {
  if (!within) return true;
  const auto& [lower, upper] = *within;
  Real size = 0;
  for (int i = 0; i < 3; ++i) size = std::max({size, std::abs(x[i]), std::abs(lower[i]), std::abs(upper[i])});
  bool inside = true;
  for (int i = 0; i < 3; ++i) inside = inside && x[i] >= lower[i] - 1e-9 * size && x[i] <= upper[i] + 1e-9 * size;
  return inside;
}

void for_each_facet_on_fracture(const mesh::Mesh& mesh, const DirichletCondition& condition,
                                const std::function<void(LocalIndex, const std::array<Real, 3>&)>& visit) {
  const int n = mesh::n_face_corners(mesh.shape);
  for (LocalIndex f = 0; f < mesh.n_fracture_faces(); ++f) {
    const auto& face = mesh.fracture_faces[f];
    if (face.fracture != condition.fracture) continue;
    std::array<bool, 4> inside{};
    for (int k = 0; k < n; ++k) inside[k] = condition.applies_at(mesh::face_corner(mesh, f, k));
    for (int k = 0; k < n; ++k)
      if (inside[k] && (mesh.dim() == 2 || inside[(k + 1) % n]))
        visit(mesh.facets->ridge[f * n + k], mesh::ridge_centre(mesh, f, k));
    if (std::all_of(inside.begin(), inside.begin() + n, [](bool one) { return one; }))
      visit(mesh.facets->fracture_face[f], face.centre);
  }
}

namespace {

/// Collects entries, one per unknown. If several faces apply a condition to one unknown, the smallest direction is
/// used. The result does not depend on the order of the faces.
class Collector {
 public:
  Collector(Constrained& constrained, GlobalIndex n_owned) : constrained_(constrained), n_owned_(n_owned) {}
  void add(const Constrained::Entry& entry) {
    if (entry.unknown < 0 || entry.unknown >= n_owned_) return;
    const auto [found, is_new] = first_.emplace(entry.unknown, static_cast<int>(constrained_.entries.size()));
    if (is_new)
      constrained_.entries.push_back(entry);
    else if (auto& known = constrained_.entries[found->second]; known.condition != entry.condition)
      constrained_.repeated.emplace_back(found->second, entry);
    else
      known.side = std::min(known.side, entry.side);
  }

 private:
  Constrained& constrained_;
  GlobalIndex n_owned_;
  std::unordered_map<GlobalIndex, int> first_;  // entry of an unknown
};

using mesh::operator-;

template <class AnyMesh>
mesh::Vector place(const AnyMesh& mesh, GlobalIndex node) {
  mesh::Vector x{};
  std::copy_n(mesh.coordinates.begin() + node * mesh.dim(), mesh.dim(), x.begin());
  return x;
}

mesh::Vector centre_of(const mesh::GlobalMesh& mesh, const mesh::GlobalMesh::BoundaryFace& face) {
  return mesh::face_centre(mesh, face.cell, face.local_face);
}

mesh::Vector centre_of(const mesh::Mesh& mesh, const mesh::Mesh::BoundaryFace& face) {
  return mesh::face_centre(mesh::face_corners(mesh, face.cell, face.local_face));
}

/// Returns the unknowns below n_owned that conditions prescribe, on a whole mesh or the part of a rank. The nodes are
/// those of boundary faces. entity_of(face, node) returns the entity with the unknowns, or -1.
template <class AnyMesh, class EntityOf>
Constrained find_constrained(const AnyMesh& mesh, int n_components, GlobalIndex n_owned,
                             const std::vector<DirichletCondition>& conditions, const EntityOf& entity_of) {
  Constrained constrained;
  Collector collector(constrained, n_owned);
  const auto has_copies = nodes_with_copies(mesh);
  const auto add = [&](GlobalIndex entity, GlobalIndex node, int condition, int component, const auto& face) {
    Constrained::Entry entry{entity < 0 ? -1 : entity * n_components + component, condition, component,
                             place(mesh, node)};
    if (has_copies[node]) entry.side = centre_of(mesh, face) - entry.x;
    if (conditions[condition].applies_at(entry.x)) collector.add(entry);
  };
  for (int k = 0; k < static_cast<int>(conditions.size()); ++k)
    for (const auto& face : mesh.boundary_faces) {
      const int region = conditions[k].region;
      if (face.boundary != conditions[k].boundary || (region >= 0 && mesh.cell_region[face.cell] != region)) continue;
      for (int a = 0; a < mesh::n_face_nodes(mesh.shape); ++a) {
        const int corner = mesh::face_nodes(mesh.shape)[face.local_face][a];
        const auto node = mesh.cells[face.cell * mesh::n_nodes(mesh.shape) + corner];
        for (int c = 0; c < n_components; ++c)
          if (conditions[k].values[c]) add(entity_of(face, node), node, k, c, face);
      }
    }
  return constrained;
}

template <class AnyMesh>
Constrained find_constrained_nodes(const AnyMesh& mesh, int n_components, GlobalIndex n_owned,
                                   const std::vector<DirichletCondition>& conditions) {
  return find_constrained(mesh, n_components, n_owned, conditions,
                          [&](const auto&, auto node) { return GlobalIndex(mesh.free_node(node)); });
}

/// Returns the prescribed unknowns of a field on cells, with the cell centres.
Constrained find_constrained_cells(const mesh::Mesh& mesh, int n_components, LocalIndex n_owned,
                                   const std::vector<DirichletCondition>& conditions) {
  Constrained constrained;
  Collector collector(constrained, n_owned);
  for (int k = 0; k < static_cast<int>(conditions.size()); ++k)
    for (LocalIndex cell = 0; cell < mesh.n_owned_cells; ++cell)
      for (int c = 0; c < n_components; ++c)
        if (mesh.cell_region[cell] == conditions[k].region && conditions[k].values[c])
          collector.add({GlobalIndex(cell) * n_components + c, k, c, mesh::cell_centre(mesh, cell)});
  return constrained;
}

/// Calls visit(facet, centre) for the facets in a region, once or twice each.
template <class Visit>
void for_each_facet_in(const mesh::Mesh& mesh, int region, const Visit& visit) {
  const int n_faces = mesh::n_faces(mesh.shape);
  const auto& of_cell = mesh.facets->of_cell;
  std::vector<int> outside(mesh.facets->id.size(), 1);  // cells missing for the facet to be in the region
  for (const LocalIndex facet : mesh.facets->fracture_face) outside[facet] = 2;
  std::vector<int> cells(outside.size(), 0);
  for (std::size_t face = 0; face < of_cell.size(); ++face) {
    ++cells[of_cell[face]];
    outside[of_cell[face]] -= mesh.cell_region[face / n_faces] == region;
  }
  for (std::size_t face = 0; face < of_cell.size(); ++face)
    if (cells[of_cell[face]] == 2 && outside[of_cell[face]] <= 0)
      visit(of_cell[face], mesh::face_centre(mesh::face_corners(mesh, static_cast<LocalIndex>(face) / n_faces,
                                                                static_cast<int>(face) % n_faces)));
}

/// Returns the prescribed unknowns of a field on facets, with the facet centres.
Constrained find_constrained_facets(const mesh::Mesh& mesh, int n_components, LocalIndex n_owned,
                                    const std::vector<DirichletCondition>& conditions) {
  Constrained constrained;
  Collector collector(constrained, n_owned);
  const auto add = [&](int k, LocalIndex facet, const mesh::Vector& x) {
    for (int c = 0; c < n_components && facet >= 0; ++c)
      if (conditions[k].values[c]) collector.add({GlobalIndex(facet) * n_components + c, k, c, x});
  };
  for (int k = 0; k < static_cast<int>(conditions.size()); ++k) {
    const int boundary = conditions[k].boundary, region = conditions[k].region, fracture = conditions[k].fracture;
    if (boundary < 0 && fracture >= 0) {
      for_each_facet_on_fracture(mesh, conditions[k], [&](LocalIndex facet, const auto& x) { add(k, facet, x); });
      continue;
    }
    if (boundary < 0) {
      for_each_facet_in(mesh, region, [&](LocalIndex facet, const mesh::Vector& x) { add(k, facet, x); });
      continue;
    }
    for (const auto& face : mesh.boundary_faces)
      if (fracture < 0 && face.boundary == boundary && (region < 0 || mesh.cell_region[face.cell] == region))
        add(k, mesh.facets->of_cell[face.cell * mesh::n_faces(mesh.shape) + face.local_face], centre_of(mesh, face));
    for (const auto& rim : mesh.facets->rims)
      if (rim.boundary == boundary && region < 0 &&
          (fracture < 0 || mesh.fracture_faces[rim.face].fracture == fracture))
        add(k, mesh.facets->ridge[rim.face * mesh::n_face_corners(mesh.shape) + rim.ridge],
            mesh::ridge_centre(mesh, rim.face, rim.ridge));
  }
  return constrained;
}

/// Returns the prescribed unknowns of a field. Fields on enriched nodes: only faces with a tip, since the enrichment is
/// zero on other faces.
Constrained find_constrained(const mesh::Mesh& mesh, const fields::Layout& layout,
                             const std::vector<DirichletCondition>& conditions) {
  const int n_components = layout.field().n_components;
  if (layout.field().entity == fields::Entity::cell)
    return find_constrained_cells(mesh, n_components, layout.n_owned(), conditions);
  if (layout.field().entity == fields::Entity::facet)
    return find_constrained_facets(mesh, n_components, layout.n_owned(), conditions);
  if (layout.field().entity != fields::Entity::enriched_node)
    return find_constrained_nodes(mesh, n_components, layout.n_owned(), conditions);
  return find_constrained(mesh, n_components, layout.n_owned(), conditions, [&](const auto& face, LocalIndex node) {
    const auto nodes = mesh::face_nodes(mesh.shape)[face.local_face];
    const bool has_tip = std::any_of(nodes.begin(), nodes.begin() + mesh::n_face_nodes(mesh.shape), [&](int k) {
      return mesh.tip[mesh.cells[face.cell * mesh.nodes_per_cell() + k]] != 0;
    });
    return GlobalIndex(has_tip ? mesh.enriched[node] : -1);
  });
}

Real largest_of(const std::vector<Real>& values) {
  Real largest = 0;
  for (Real value : values) largest = std::max(largest, std::abs(value));
  return largest;
}

}  // namespace

std::vector<Real> prescribed_values(const Constrained& constrained, const std::vector<DirichletCondition>& conditions,
                                    Real t, std::vector<std::string>& conflicts) {
  const auto value = [&](const Constrained::Entry& entry) {
    return one_sided(*conditions[entry.condition].values[entry.component], entry.x, entry.side, t);
  };
  std::vector<Real> values;
  for (const auto& entry : constrained.entries) values.push_back(value(entry));
  const Real largest = largest_of(values);
  std::map<std::array<int, 3>, std::string> found;  // one message per pair of conditions and component
  for (const auto& [number, entry] : constrained.repeated) {
    const Real first = values[number], second = value(entry);
    if (std::abs(first - second) <= 1e-12 * largest) continue;
    const int condition = constrained.entries[number].condition;
    found.try_emplace(
        {condition, entry.condition, entry.component},
        fmt::format("{} \"{}\" and \"{}\" prescribe {:.6g} and {:.6g} for component {} of {} at ({:.6g}, {:.6g}, "
                    "{:.6g}), t = {:.6g}; where they meet "
                    "they must agree or leave the component free",
                    conditions[condition].boundary < 0 ? "conditions" : "boundary conditions",
                    conditions[condition].name, conditions[entry.condition].name, first, second, "xyz"[entry.component],
                    conditions[condition].field, entry.x[0], entry.x[1], entry.x[2], t));
  }
  for (const auto& [place, conflict] : found) conflicts.push_back(conflict);
  return values;
}

std::vector<std::string> find_conflicts(const mesh::GlobalMesh& mesh, const std::vector<DirichletCondition>& conditions,
                                        Real t) {
  std::vector<std::string> conflicts;
  prescribed_values(find_constrained_nodes(mesh, mesh.dim(), mesh.n_free_nodes() * mesh.dim(), conditions), conditions,
                    t, conflicts);
  return conflicts;
}

Constraints::Constraints(const mesh::Mesh& mesh, const fields::Layout& layout,
                         std::vector<DirichletCondition> conditions)
    : conditions_(std::move(conditions)),
      constrained_(find_constrained(mesh, layout, conditions_)),
      mask_("constrained", layout.n_owned()),
      values_("prescribed", layout.n_owned()) {
  const base::HostTable<char*> mask(mask_);
  for (const auto& entry : constrained_.entries) mask(entry.unknown) = 1;
  mask.on_device();
}

std::vector<contact::Support> Constraints::supports() const {
  std::vector<contact::Support> supports;
  for (const auto& entry : constrained_.entries)
    supports.push_back({static_cast<LocalIndex>(entry.unknown), entry.component});
  return supports;
}

void Constraints::evaluate(Real t) {
  std::vector<std::string> conflicts;
  const auto prescribed = prescribed_values(constrained_, conditions_, t, conflicts);
  SPREKK_CHECK(conflicts.empty(), "{}", fmt::join(conflicts, "\n"));
  largest_ = largest_of(prescribed);
  const base::HostTable<Real*> values(values_);
  for (std::size_t k = 0; k < prescribed.size(); ++k) values(constrained_.entries[k].unknown) = prescribed[k];
  values.on_device();
}

}  // namespace sprekk::assembly
