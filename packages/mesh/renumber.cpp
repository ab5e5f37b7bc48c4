#include "mesh/renumber.hpp"

#include <algorithm>
#include <numeric>
#include <random>
#include <utility>

namespace sprekk::mesh {
namespace {

std::vector<GlobalIndex> random_permutation(GlobalIndex n, std::mt19937_64& random) {
  std::vector<GlobalIndex> result(n);
  std::iota(result.begin(), result.end(), GlobalIndex{0});
  for (GlobalIndex i = n - 1; i > 0; --i)  // own shuffle: the result of std::shuffle depends on the library
    std::swap(result[i], result[random() % (i + 1)]);
  return result;
}

}  // namespace

GlobalMesh permuted(const GlobalMesh& mesh, const std::vector<GlobalIndex>& new_node,
                    const std::vector<GlobalIndex>& new_cell) {
  const int dim = mesh.dim(), nodes_per_cell = n_nodes(mesh.shape);
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
