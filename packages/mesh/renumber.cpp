#include "mesh/renumber.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

#include "base/check.hpp"

namespace sprekk::mesh {
namespace {

std::vector<GlobalIndex> random_permutation(GlobalIndex n, std::mt19937_64& random) {
  std::vector<GlobalIndex> result(n);
  std::iota(result.begin(), result.end(), GlobalIndex{0});
  for (GlobalIndex i = n - 1; i > 0; --i)  // own shuffle: the result of std::shuffle depends on the library
    std::swap(result[i], result[random() % (i + 1)]);
  return result;
}

/// Positions on the Morton curve through a cube around all `points` [point * dim + component]: bits of the coordinates,
/// interleaved.
std::vector<std::uint64_t> on_curve(const std::vector<Real>& points, int dim) {
  std::array<Real, 3> low, high;
  low.fill(std::numeric_limits<Real>::max());
  high.fill(std::numeric_limits<Real>::lowest());
  for (std::size_t i = 0; i < points.size(); ++i) {
    low[i % dim] = std::min(low[i % dim], points[i]);
    high[i % dim] = std::max(high[i % dim], points[i]);
  }
  Real size = 0;
  for (int d = 0; d < dim; ++d) size = std::max(size, high[d] - low[d]);
  constexpr int bits = 21;  // of a coordinate: three of them fit into 64 bits
  std::vector<std::uint64_t> result(points.size() / dim, 0);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto steps = static_cast<std::uint64_t>((points[i] - low[i % dim]) / size * ((1 << bits) - 1));
    for (int bit = 0; bit < bits; ++bit) result[i / dim] |= (steps >> bit & 1) << (bit * dim + i % dim);
  }
  return result;
}

/// Rank of each entry among `keys`; equal keys keep their order.
std::vector<GlobalIndex> ranks(const std::vector<std::uint64_t>& keys) {
  std::vector<GlobalIndex> order(keys.size()), result(keys.size());
  std::iota(order.begin(), order.end(), GlobalIndex{0});
  std::stable_sort(order.begin(), order.end(), [&](GlobalIndex a, GlobalIndex b) { return keys[a] < keys[b]; });
  for (std::size_t i = 0; i < order.size(); ++i) result[order[i]] = static_cast<GlobalIndex>(i);
  return result;
}

}  // namespace

GlobalMesh in_spatial_order(const GlobalMesh& mesh) {
  const int dim = mesh.dim(), nodes_per_cell = n_nodes(mesh.shape);
  std::vector<Real> centres(mesh.n_cells() * dim, 0);
  for (std::size_t i = 0; i < mesh.cells.size(); ++i)
    for (int d = 0; d < dim; ++d)
      centres[i / nodes_per_cell * dim + d] += mesh.coordinates[mesh.cells[i] * dim + d] / nodes_per_cell;
  auto result = permuted(mesh, ranks(on_curve(mesh.coordinates, dim)), ranks(on_curve(centres, dim)));
  std::stable_sort(result.fracture_faces.begin(), result.fracture_faces.end(),
                   [](const auto& a, const auto& b) { return a.cell[minus] < b.cell[minus]; });
  return result;
}

GlobalMesh permuted(const GlobalMesh& mesh, const std::vector<GlobalIndex>& new_node,
                    const std::vector<GlobalIndex>& new_cell) {
  const int dim = mesh.dim(), nodes_per_cell = n_nodes(mesh.shape);
  SPREKK_CHECK(mesh.tied_to.empty() && mesh.tip.empty(), "permuted: the mesh has tied nodes or tips");
  GlobalMesh result = mesh;
  for (GlobalIndex node = 0; node < mesh.n_nodes(); ++node)
    std::copy_n(&mesh.coordinates[node * dim], dim, &result.coordinates[new_node[node] * dim]);
  for (std::size_t node = 0; node < mesh.parent_node.size(); ++node)
    result.parent_node[new_node[node]] = new_node[mesh.parent_node[node]];
  for (GlobalIndex cell = 0; cell < mesh.n_cells(); ++cell) {
    result.cell_region[new_cell[cell]] = mesh.cell_region[cell];
    for (int k = 0; k < nodes_per_cell; ++k)
      result.cells[new_cell[cell] * nodes_per_cell + k] = new_node[mesh.cells[cell * nodes_per_cell + k]];
  }
  for (auto& face : result.fracture_faces)
    for (auto& cell : face.cell) cell = new_cell[cell];
  for (auto& face : result.boundary_faces) face.cell = new_cell[face.cell];
  return result;
}

GlobalMesh renumbered(const GlobalMesh& mesh, unsigned seed) {
  std::mt19937_64 random(seed);
  const auto new_node = random_permutation(mesh.n_nodes(), random);
  return permuted(mesh, new_node, random_permutation(mesh.n_cells(), random));
}

}  // namespace sprekk::mesh
