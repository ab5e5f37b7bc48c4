#include "assembly/order_one.hpp"

#include "mesh/cell_geometry.hpp"

#include <Teuchos_CommHelpers.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace sprekk::assembly {
namespace {

using fields::CrsMatrix;
using fields::Map;

std::vector<char> find_corners(const mesh::Mesh& mesh) {
  std::vector<char> is_corner(mesh.n_nodes(), 0);
  const int n = mesh.nodes_per_cell();
  for (LocalIndex cell = 0; cell < mesh.n_cells(); ++cell)
    for (int k = 0; k < mesh::n_corners(mesh.shape); ++k) is_corner[mesh.free_node(mesh.cells[cell * n + k])] = 1;
  return is_corner;
}

LocalIndex n_owned_corners(const mesh::Mesh& mesh, const std::vector<char>& is_corner) {
  return static_cast<LocalIndex>(std::count(is_corner.begin(), is_corner.begin() + mesh.n_owned_nodes, 1));
}

RCP<const Map> corner_map(const mesh::Mesh& mesh, LocalIndex n_owned, int width) {
  const auto unknown = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  return rcp(new const Map(unknown, static_cast<std::size_t>(n_owned) * width, 0, mesh.comm));
}

/// Returns the global corner number of each local free node, -1 for other nodes. Collective.
std::vector<GlobalIndex> number_corners(const mesh::Mesh& mesh, const std::vector<char>& is_corner) {
  const fields::Layout nodes({"corner", fields::Entity::node, 1, ""}, mesh);
  const auto map = corner_map(mesh, n_owned_corners(mesh, is_corner), 1);
  fields::Vector owned(nodes.owned()), all(nodes.ghosted());  // doubles represent these integers exactly
  {
    const auto view = owned.getLocalViewHost(Tpetra::Access::OverwriteAll);
    LocalIndex next = 0;
    for (LocalIndex node = 0; node < mesh.n_owned_nodes; ++node)
      view(node, 0) = is_corner[node] ? static_cast<Real>(map->getGlobalElement(next++)) : -1;
  }
  all.doImport(owned, *nodes.import(), Tpetra::INSERT);
  const auto view = all.getLocalViewHost(Tpetra::Access::ReadOnly);
  std::vector<GlobalIndex> numbers;
  for (LocalIndex node = 0; node < mesh.n_free_nodes; ++node)
    numbers.push_back(static_cast<GlobalIndex>(view(node, 0)));
  return numbers;
}

/// Weights of the cell's corners in the position of each node of the cell.
class Shares {
 public:
  using Corners = std::array<Real, 8>;

  explicit Shares(const mesh::Mesh& mesh)
      : mesh_(mesh), edges_(mesh::CellGeometry(mesh.shape).edges()), corners_(mesh::corners_of_nodes(mesh.shape)) {}

  std::vector<Corners> of(LocalIndex cell) const {
    std::vector<Corners> shares(corners_.size(), Corners{});
    for (int k = 0; k < mesh::n_corners(mesh_.shape); ++k) shares[k][k] = 1;
    for (const auto& edge : edges_) {
      const Real t = distance(cell, edge.from, edge.middle) / distance(cell, edge.from, edge.to);
      shares[edge.middle][edge.from] = 1 - t;
      shares[edge.middle][edge.to] = t;
    }
    for (std::size_t node = 0; node < corners_.size(); ++node)
      if (is_inside(corners_[node])) shares[node] = inside(corners_[node], shares);
    return shares;
  }

 private:
  static bool has(unsigned set, int corner) { return (set >> corner) & 1u; }
  static int size(unsigned set) { return std::popcount(set); }
  static bool is_inside(unsigned set) { return size(set) > 2; }  // nodes inside a face (4 corners) or cell (8 corners)

  /// Returns the weights for a node inside a face or cell, from the corners and the nodes on edges (serendipity).
  Corners inside(unsigned set, const std::vector<Corners>& shares) const {
    Corners result{};
    const Real of_edge = size(set) == 4 ? 0.5 : 0.25;
    for (int k = 0; k < 8; ++k)
      if (has(set, k)) result[k] -= 0.25;
    for (const auto& edge : edges_)
      if (has(set, edge.from) && has(set, edge.to))
        for (int k = 0; k < 8; ++k) result[k] += of_edge * shares[edge.middle][k];
    return result;
  }

  Real distance(LocalIndex cell, int a, int b) const {
    const int dim = mesh_.dim(), n = mesh_.nodes_per_cell();
    Real square = 0;
    for (int i = 0; i < dim; ++i) {
      const Real d = mesh_.coordinates[mesh_.cells[cell * n + a] * dim + i] -
                     mesh_.coordinates[mesh_.cells[cell * n + b] * dim + i];
      square += d * d;
    }
    return std::sqrt(square);
  }

  const mesh::Mesh& mesh_;
  std::vector<mesh::CellGeometry::Edge> edges_;
  std::vector<unsigned> corners_;
};

}  // namespace

RCP<const CrsMatrix> interpolation_from_corners(const mesh::Mesh& mesh, const fields::Layout& layout) {
  const int width = layout.field().n_components, n = mesh.nodes_per_cell();
  const auto is_corner = find_corners(mesh);
  const auto numbers = number_corners(mesh, is_corner);
  const auto P = rcp(new CrsMatrix(layout.owned(), 8));
  const Shares shares(mesh);
  std::vector<char> is_done(mesh.n_owned_nodes, 0);
  for (LocalIndex cell = 0; cell < mesh.n_cells(); ++cell) {
    const auto of_nodes = shares.of(cell);
    for (int a = 0; a < n; ++a) {
      const LocalIndex node = mesh.free_node(mesh.cells[cell * n + a]);
      if (node >= mesh.n_owned_nodes || is_done[node]) continue;
      is_done[node] = 1;
      for (int i = 0; i < width; ++i) {
        std::vector<GlobalIndex> columns;
        std::vector<Real> values;
        for (int k = 0; k < mesh::n_corners(mesh.shape); ++k) {
          if (of_nodes[a][k] == 0) continue;
          columns.push_back(numbers[mesh.free_node(mesh.cells[cell * n + k])] * width + i);
          values.push_back(of_nodes[a][k]);
        }
        P->insertGlobalValues(layout.owned()->getGlobalElement(node * width + i),
                              Teuchos::ArrayView<const GlobalIndex>(columns.data(), columns.size()),
                              Teuchos::ArrayView<const Real>(values.data(), values.size()));
      }
    }
  }
  P->fillComplete(corner_map(mesh, n_owned_corners(mesh, is_corner), width), layout.owned());
  return P;
}

RCP<const fields::MultiVector> at_corners(const mesh::Mesh& mesh, const fields::MultiVector& of_nodes) {
  const auto is_corner = find_corners(mesh);
  const auto result =
      rcp(new fields::MultiVector(corner_map(mesh, n_owned_corners(mesh, is_corner), 1), of_nodes.getNumVectors()));
  const auto from = of_nodes.getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto to = result->getLocalViewHost(Tpetra::Access::OverwriteAll);
  LocalIndex next = 0;
  for (LocalIndex node = 0; node < mesh.n_owned_nodes; ++node) {
    if (!is_corner[node]) continue;
    for (std::size_t i = 0; i < from.extent(1); ++i) to(next, i) = from(node, i);
    ++next;
  }
  return result;
}

}  // namespace sprekk::assembly
