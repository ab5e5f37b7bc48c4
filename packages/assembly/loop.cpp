#include "assembly/loop.hpp"

#include "base/check.hpp"
#include "base/host_table.hpp"
#include "mesh/intersections.hpp"

#include <algorithm>
#include <numeric>

namespace sprekk::assembly {

using fields::Entity;
using fields::Layout;

std::vector<std::array<LocalIndex, 2>> fracture_sides(const mesh::Mesh& mesh) {
  std::vector<std::array<LocalIndex, 2>> sides;
  for (LocalIndex f = 0; f < mesh.n_fracture_faces(); ++f)
    for (int side : {mesh::minus, mesh::plus})
      if (mesh.fracture_faces[f].cell[side] >= 0) sides.push_back({f, side});
  return sides;
}

std::vector<std::array<LocalIndex, 2>> neighbours(const mesh::Mesh& mesh) {
  const int n_faces = mesh::n_faces(mesh.shape);
  const auto& facets = *mesh.facets;
  std::vector<std::array<LocalIndex, 2>> of_facet(facets.id.size(), {-1, -1});
  for (LocalIndex cell = 0; cell < mesh.n_cells(); ++cell)
    for (int k = 0; k < n_faces; ++k) {
      auto& [first, second] = of_facet[facets.of_cell[cell * n_faces + k]];
      (first < 0 ? first : second) = cell;
    }
  for (const LocalIndex facet : facets.fracture_face) of_facet[facet] = {-1, -1};
  of_facet.erase(std::remove_if(of_facet.begin(), of_facet.end(), [](const auto& pair) { return pair[1] < 0; }),
                 of_facet.end());
  for (auto& [first, second] : of_facet)
    if (mesh.cell_id[second] < mesh.cell_id[first]) std::swap(first, second);
  return of_facet;
}

bool has_tip(const mesh::Mesh& mesh, LocalIndex cell) {
  if (mesh.tip.empty()) return false;
  const auto first = mesh.cells.begin() + cell * mesh.nodes_per_cell();
  return std::any_of(first, first + mesh.nodes_per_cell(), [&](LocalIndex node) { return mesh.tip[node] != 0; });
}

std::vector<LocalIndex> tip_cells(const mesh::Mesh& mesh) {
  std::vector<LocalIndex> cells;
  for (LocalIndex cell = 0; cell < mesh.n_cells(); ++cell)
    if (has_tip(mesh, cell)) cells.push_back(cell);
  return cells;
}

std::vector<LocalIndex> tip_sides(const mesh::Mesh& mesh) {
  const auto sides = fracture_sides(mesh);
  std::vector<LocalIndex> result;
  for (std::size_t s = 0; s < sides.size(); ++s)
    if (has_tip(mesh, mesh.fracture_faces[sides[s][0]].cell[sides[s][1]])) result.push_back(static_cast<LocalIndex>(s));
  return result;
}

namespace {

/// Fills a table with rows of equal length, entity by entity.
class TableBuilder {
 public:
  TableBuilder(std::size_t n_rows, int n_columns) : table_("stencil", n_rows, n_columns) {}
  void add(LocalIndex value) {
    table_(row_, column_) = value;
    if (++column_ == static_cast<int>(table_.extent(1))) {
      column_ = 0;
      ++row_;
    }
  }
  ConstView<LocalIndex**> finish() {
    SPREKK_CHECK(row_ == table_.extent(0) || table_.extent(1) == 0, "stencil table filled to row {} of {}", row_,
                 table_.extent(0));
    return table_.on_device();
  }

 private:
  base::HostTable<LocalIndex**> table_;
  std::size_t row_ = 0;
  int column_ = 0;
};

/// Builds stencils of fields on nodes or enriched nodes.
class NodeStencils {
 public:
  NodeStencils(const mesh::Mesh& mesh, const fields::Field& field)
      : mesh_(mesh), enriched_(field.entity == Entity::enriched_node), width_(field.n_components) {}

  Stencil of_cells(const std::vector<LocalIndex>& cells) const {
    const int n = mesh_.nodes_per_cell();
    TableBuilder table(cells.size(), n);
    for (LocalIndex cell : cells)
      for (int a = 0; a < n; ++a) table.add(first(mesh_.cells[cell * n + a]));
    return {table.finish(), width_};
  }

  Stencil of_fracture_faces() const {
    const int n = mesh::n_face_nodes(mesh_.shape);
    TableBuilder table(mesh_.n_owned_fracture_faces, 2 * n);
    for (LocalIndex f = 0; f < mesh_.n_owned_fracture_faces; ++f) {
      const auto& nodes = mesh_.fracture_faces[f].nodes;
      for (int side : {mesh::minus, mesh::plus}) {
        const bool absent = enriched_ && std::none_of(nodes[side].begin(), nodes[side].begin() + n,
                                                      [&](LocalIndex node) { return mesh_.tip[node] != 0; });
        for (int k = 0; k < n; ++k) table.add(absent ? -1 : first(nodes[side][k]));
      }
    }
    return {table.finish(), width_};
  }

  Stencil of_boundary_faces() const {
    const int n = mesh::n_face_nodes(mesh_.shape);
    TableBuilder table(mesh_.boundary_faces.size(), n);
    for (const auto& face : mesh_.boundary_faces)
      for (int k = 0; k < n; ++k)
        table.add(
            first(mesh_.cells[face.cell * mesh_.nodes_per_cell() + mesh::face_nodes(mesh_.shape)[face.local_face][k]]));
    return {table.finish(), width_};
  }

 private:
  LocalIndex first(LocalIndex node) const {
    if (!enriched_) return mesh_.free_node(node) * width_;
    const LocalIndex number = mesh_.enriched.empty() ? -1 : mesh_.enriched[node];
    return number < 0 ? -1 : number * width_;
  }

  const mesh::Mesh& mesh_;
  bool enriched_;
  int width_;
};

/// Returns the indices in fracture_sides() of the entities of a loop over sides.
std::vector<LocalIndex> sides_of(const mesh::Mesh& mesh, Loop loop) {
  if (loop == Loop::tip_sides) return tip_sides(mesh);
  std::vector<LocalIndex> all(fracture_sides(mesh).size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

Stencil node_stencil(const mesh::Mesh& mesh, Loop loop, const fields::Field& field) {
  const NodeStencils stencils(mesh, field);
  std::vector<LocalIndex> cells;
  switch (loop) {
    case Loop::fracture_faces:
      return stencils.of_fracture_faces();
    case Loop::boundary_faces:
      return stencils.of_boundary_faces();
    case Loop::cells:
      cells.resize(mesh.n_cells());
      std::iota(cells.begin(), cells.end(), 0);
      break;
    case Loop::tip_cells:
      cells = tip_cells(mesh);
      break;
    default:
      const auto sides = fracture_sides(mesh);
      for (LocalIndex s : sides_of(mesh, loop)) cells.push_back(mesh.fracture_faces[sides[s][0]].cell[sides[s][1]]);
  }
  return stencils.of_cells(cells);
}

/// Returns the stencil of a field on cells or facets.
Stencil cell_stencil(const mesh::Mesh& mesh, Loop loop, const fields::Field& field) {
  const int n_faces = mesh::n_faces(mesh.shape), width = field.n_components;
  const bool on_cells = field.entity == Entity::cell;
  if (loop == Loop::boundary_faces) {
    TableBuilder table(mesh.boundary_faces.size(), 1);
    for (const auto& face : mesh.boundary_faces)
      table.add((on_cells ? face.cell : mesh.facets->of_cell[face.cell * n_faces + face.local_face]) * width);
    return {table.finish(), width};
  }
  if (!on_cells && (loop == Loop::fracture_cells || loop == Loop::fracture_faces)) {
    const bool ends = loop == Loop::fracture_cells;
    const LocalIndex n = ends ? mesh.n_fracture_faces() : mesh.n_owned_fracture_faces;
    const int n_ridges = ends ? mesh::n_face_corners(mesh.shape) : 0;
    TableBuilder table(n, 1 + n_ridges);
    for (LocalIndex f = 0; f < n; ++f) {
      table.add(mesh.facets->fracture_face[f] * width);
      for (int k = 0; k < n_ridges; ++k) table.add(mesh.facets->ridge[f * n_ridges + k] * width);
    }
    return {table.finish(), width};
  }
  if (loop == Loop::fracture_sides || loop == Loop::tip_sides) {
    const auto sides = fracture_sides(mesh);
    const auto selected = sides_of(mesh, loop);
    TableBuilder table(selected.size(), 1);
    for (LocalIndex s : selected) {
      const auto [f, side] = sides[s];
      table.add((on_cells ? mesh.fracture_faces[f].cell[side] : mesh.facets->fracture_face[f]) * width);
    }
    return {table.finish(), width};
  }
  if (!on_cells && loop == Loop::junctions) {
    std::vector<LocalIndex> facets;
    for (const auto& junction : mesh::junctions(mesh))
      mesh::for_each_pair(junction, [&](const auto& a, const auto& b) {
        facets.insert(facets.end(), {a.facet, b.facet});
      });
    TableBuilder table(facets.size() / 2, 2);
    for (const LocalIndex facet : facets) table.add(facet * width);
    return {table.finish(), width};
  }
  if (!on_cells && loop == Loop::facets) {
    TableBuilder table(mesh.facets->n_owned, 1);
    for (LocalIndex facet = 0; facet < mesh.facets->n_owned; ++facet) table.add(facet * width);
    return {table.finish(), width};
  }
  if (on_cells && loop == Loop::neighbours) {
    const auto pairs = neighbours(mesh);
    TableBuilder table(pairs.size(), 2);
    for (const auto& pair : pairs)
      for (const LocalIndex cell : pair) table.add(cell * width);
    return {table.finish(), width};
  }
  if (on_cells && loop == Loop::tip_cells) {
    const auto cells = tip_cells(mesh);
    TableBuilder table(cells.size(), 1);
    for (LocalIndex cell : cells) table.add(cell * width);
    return {table.finish(), width};
  }
  SPREKK_CHECK(loop == Loop::cells, "field {}: no stencil in this loop", field.name);
  TableBuilder table(mesh.n_cells(), on_cells ? 1 : n_faces);
  for (LocalIndex cell = 0; cell < mesh.n_cells(); ++cell) {
    if (on_cells) table.add(cell * width);
    for (int k = 0; k < n_faces && !on_cells; ++k) table.add(mesh.facets->of_cell[cell * n_faces + k] * width);
  }
  return {table.finish(), width};
}

Stencil face_stencil(const mesh::Mesh& mesh, Loop loop, int n_components) {
  if (loop == Loop::fracture_sides || loop == Loop::tip_sides) {
    const bool two_sided = n_components == 2 * mesh.dim();
    const auto sides = fracture_sides(mesh);
    const auto selected = sides_of(mesh, loop);
    TableBuilder table(selected.size(), 1);
    for (LocalIndex s : selected) table.add(sides[s][0] * n_components + (two_sided ? sides[s][1] * mesh.dim() : 0));
    return {table.finish(), two_sided ? mesh.dim() : n_components};
  }
  SPREKK_CHECK(loop == Loop::fracture_faces || loop == Loop::fracture_cells,
               "a field on fracture faces is out of reach of a loop over cells");
  const LocalIndex n = loop == Loop::fracture_faces ? mesh.n_owned_fracture_faces : mesh.n_fracture_faces();
  TableBuilder table(n, 1);
  for (LocalIndex f = 0; f < n; ++f) table.add(f * n_components);
  return {table.finish(), n_components};
}

}  // namespace

Stencil make_stencil(const mesh::Mesh& mesh, Loop loop, const Layout& layout) {
  const auto& field = layout.field();
  switch (field.entity) {
    case Entity::cell:
    case Entity::facet:
      return cell_stencil(mesh, loop, field);
    case Entity::fracture_face:
      return face_stencil(mesh, loop, field.n_components);
    default:
      return node_stencil(mesh, loop, field);
  }
}

const Stencil& Stencils::of(Loop loop, int field) {
  const std::pair key(loop, field);
  if (const auto found = made_.find(key); found != made_.end()) return found->second;
  auto& stencil = made_.emplace(key, make_stencil(*mesh_, loop, (*layouts_)[field])).first->second;
  if (keeps_writers_) stencil.writers = writers_.emplace_back(std::make_shared<std::shared_ptr<const Writers>>());
  return stencil;
}

void Stencils::forget_writers() {
  writers_.clear();
  keeps_writers_ = false;
}

}  // namespace sprekk::assembly
