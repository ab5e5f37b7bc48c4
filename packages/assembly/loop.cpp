#include "assembly/loop.hpp"

#include "base/check.hpp"

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
  TableBuilder(std::size_t n_rows, int n_columns)
      : table_("stencil", n_rows, n_columns), host_(Kokkos::create_mirror_view(table_)) {}
  void add(LocalIndex value) {
    host_(row_, column_) = value;
    if (++column_ == static_cast<int>(host_.extent(1))) {
      column_ = 0;
      ++row_;
    }
  }
  ConstView<LocalIndex**> finish() {
    SPREKK_CHECK(row_ == host_.extent(0) || host_.extent(1) == 0, "stencil table filled to row {} of {}", row_,
                 host_.extent(0));
    Kokkos::deep_copy(table_, host_);
    return table_;
  }

 private:
  View<LocalIndex**> table_;
  View<LocalIndex**>::HostMirror host_;
  std::size_t row_ = 0;
  int column_ = 0;
};

/// First unknowns of a field on nodes or on enriched nodes, table by table.
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

/// The numbers in fracture_sides() of the entities of a loop over sides.
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

Stencil face_stencil(const mesh::Mesh& mesh, Loop loop, int n_components) {
  if (loop == Loop::fracture_sides || loop == Loop::tip_sides) {
    const bool two_sided = n_components == 2 * mesh.dim();
    const auto sides = fracture_sides(mesh);
    const auto selected = sides_of(mesh, loop);
    TableBuilder table(selected.size(), 1);
    for (LocalIndex s : selected) table.add(sides[s][0] * n_components + (two_sided ? sides[s][1] * mesh.dim() : 0));
    return {table.finish(), two_sided ? mesh.dim() : n_components};
  }
  SPREKK_CHECK(loop == Loop::fracture_faces, "a field on fracture faces is out of reach of a loop over cells");
  TableBuilder table(mesh.n_owned_fracture_faces, 1);
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) table.add(f * n_components);
  return {table.finish(), n_components};
}

}  // namespace

Stencil make_stencil(const mesh::Mesh& mesh, Loop loop, const Layout& layout) {
  const auto& field = layout.field();
  if (field.entity == Entity::node || field.entity == Entity::enriched_node) return node_stencil(mesh, loop, field);
  SPREKK_CHECK(field.entity == Entity::fracture_face, "field {}: no stencil for cell fields", field.name);
  return face_stencil(mesh, loop, field.n_components);
}

namespace {

auto to_host(const ConstView<LocalIndex**>& table) {
  return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), table);
}
using HostTable = decltype(to_host({}));

/// Which entities of a stencil write an owned row, by the first row of a group.
class Writers {
 public:
  Writers(const Stencil& rows, LocalIndex n_rows) : start_(n_rows + 2, 0) {
    const auto first = to_host(rows.first);
    const auto for_owned = [&](const auto& visit) {
      for (std::size_t e = 0; e < first.extent(0); ++e)
        for (std::size_t r = 0; r < first.extent(1); ++r)
          if (const LocalIndex row = first(e, r); row >= 0 && row < n_rows)
            visit(row, std::array<LocalIndex, 2>{static_cast<LocalIndex>(e), static_cast<LocalIndex>(r)});
    };
    for_owned([&](LocalIndex row, const auto&) { ++start_[row + 2]; });
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    entries_.resize(start_.back());
    for_owned([&](LocalIndex row, const auto& entry) { entries_[start_[row + 1]++] = entry; });
  }

  /// Calls visit(entity, group of the entity) for all that write a group of rows.
  template <class Visit>
  void for_each(LocalIndex first_row, const Visit& visit) const {
    for (LocalIndex k = start_[first_row]; k < start_[first_row + 1]; ++k) visit(entries_[k][0], entries_[k][1]);
  }

 private:
  std::vector<LocalIndex> start_;  // [row + 1]
  std::vector<std::array<LocalIndex, 2>> entries_;
};

}  // namespace

ConstView<LocalIndex***> find_positions(const fields::CrsMatrix& matrix, const Stencil& rows, const Stencil& columns) {
  const auto graph = matrix.getCrsGraph()->getLocalGraphHost();
  const Writers writers(rows, graph.numRows());
  const auto column_first = to_host(columns.first);
  View<LocalIndex***> positions("positions", rows.first.extent(0), rows.first.extent(1), column_first.extent(1));
  auto host = Kokkos::create_mirror_view(positions);
  Kokkos::deep_copy(host, -1);
  std::vector<LocalIndex> position_of(matrix.getColMap()->getNodeNumElements(), 0);  // in the row; else anything
  for (LocalIndex row = 0, n_rows = graph.numRows(); row < n_rows; row += rows.width) {
    const auto begin = graph.row_map(row), length = graph.row_map(row + 1) - begin;
    for (std::size_t k = 0; k < length; ++k) position_of[graph.entries(begin + k)] = static_cast<LocalIndex>(k);
    writers.for_each(row, [&](LocalIndex e, LocalIndex r) {
      for (std::size_t c = 0; c < host.extent(2); ++c) {
        const LocalIndex column = column_first(e, c);
        if (column < 0) continue;
        const LocalIndex k = position_of[column];
        SPREKK_CHECK(static_cast<std::size_t>(k) < length && graph.entries(begin + k) == column,
                     "row {} has no entry for column {}", row, column);
        host(e, r, c) = k;
      }
    });
  }
  Kokkos::deep_copy(positions, host);
  return positions;
}

RCP<fields::CrsMatrix> make_matrix(const Layout& row_layout, const Layout& column_layout,
                                   const std::vector<std::pair<Stencil, Stencil>>& couplings) {
  const int row_width = couplings.front().first.width;
  const LocalIndex n_rows = row_layout.n_owned();
  std::vector<Writers> writers;
  std::vector<HostTable> column_first;
  for (const auto& [rows, columns] : couplings) {
    SPREKK_CHECK(rows.width == row_width, "rows of {} are written in groups of {} and of {}", row_layout.field().name,
                 row_width, rows.width);
    writers.emplace_back(rows, n_rows);
    column_first.push_back(to_host(columns.first));
  }
  std::vector<LocalIndex> end_of(column_layout.ghosted()->getNodeNumElements(), 0);  // of groups that a row has; else 0
  std::vector<LocalIndex> groups, columns;                                           // of a row; of all groups of rows
  using Graph = fields::CrsGraph::local_graph_device_type;
  const Graph::row_map_type::non_const_type row_start("row start", n_rows + 1);
  const auto start = Kokkos::create_mirror_view(row_start);
  for (LocalIndex row = 0; row < n_rows; row += row_width) {
    for (std::size_t k = 0; k < couplings.size(); ++k)
      writers[k].for_each(row, [&](LocalIndex e, LocalIndex) {
        for (std::size_t c = 0; c < column_first[k].extent(1); ++c) {
          const LocalIndex first = column_first[k](e, c);
          if (first < 0) continue;
          if (end_of[first] == 0) groups.push_back(first);
          end_of[first] = std::max(end_of[first], first + couplings[k].second.width);
        }
      });
    std::sort(groups.begin(), groups.end());
    const std::size_t before = columns.size();
    LocalIndex next = 0;  // groups may overlap
    for (LocalIndex first : groups) {
      for (next = std::max(next, first); next < end_of[first]; ++next) columns.push_back(next);
      end_of[first] = 0;
    }
    groups.clear();
    for (int i = 0; i < row_width; ++i) start(row + i + 1) = start(row + i) + columns.size() - before;
  }
  const Graph::entries_type::non_const_type row_columns("columns", start(n_rows));
  const auto entries = Kokkos::create_mirror_view(row_columns);
  auto from = columns.begin();
  for (LocalIndex row = 0; row < n_rows; row += row_width) {
    const auto length = static_cast<std::ptrdiff_t>(start(row + 1) - start(row));
    for (int i = 0; i < row_width; ++i) std::copy_n(from, length, entries.data() + start(row + i));
    from += length;
  }
  Kokkos::deep_copy(row_start, start);
  Kokkos::deep_copy(row_columns, entries);
  const auto graph = rcp(new fields::CrsGraph(row_layout.owned(), column_layout.ghosted(), row_start, row_columns));
  const bool no_ghosts = column_layout.owned()->isSameAs(*column_layout.ghosted());
  graph->expertStaticFillComplete(column_layout.owned(), row_layout.owned(),
                                  no_ghosts ? Teuchos::null : column_layout.import());
  const auto matrix = rcp(new fields::CrsMatrix(graph));
  matrix->fillComplete(column_layout.owned(), row_layout.owned());
  return matrix;
}

}  // namespace sprekk::assembly
