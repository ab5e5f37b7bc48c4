#include "mesh/partition.hpp"

#include <metis.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "base/check.hpp"
#include "mesh/facets.hpp"

namespace sprekk::mesh {
namespace {

/// The cell graph in compressed rows, without repeated edges.
struct Graph {
  std::vector<idx_t> offsets, neighbours;
};

Graph cell_graph(const GlobalMesh& mesh) {
  const int faces_per_cell = n_faces(mesh.shape);
  auto across = face_neighbours(mesh);
  SPREKK_CHECK(across.size() <= static_cast<std::size_t>(std::numeric_limits<idx_t>::max()),
               "partition: {} cells are too many for this METIS, whose indices have {} bits", mesh.n_cells(),
               8 * sizeof(idx_t));
  for (const auto& face : mesh.fracture_faces)
    for (int side : {minus, plus})
      across[face.cell[side] * faces_per_cell + face.local_face[side]] = face.cell[1 - side] * faces_per_cell;

  Graph graph{{0}, {}};
  for (GlobalIndex cell = 0; cell < mesh.n_cells(); ++cell) {
    const auto row = static_cast<std::ptrdiff_t>(graph.neighbours.size());
    for (int f = 0; f < faces_per_cell; ++f)
      if (const GlobalIndex other = across[cell * faces_per_cell + f]; other >= 0)
        graph.neighbours.push_back(static_cast<idx_t>(other / faces_per_cell));
    std::sort(graph.neighbours.begin() + row, graph.neighbours.end());
    graph.neighbours.erase(std::unique(graph.neighbours.begin() + row, graph.neighbours.end()), graph.neighbours.end());
    graph.offsets.push_back(static_cast<idx_t>(graph.neighbours.size()));
  }
  return graph;
}

}  // namespace

std::vector<int> partition(const GlobalMesh& mesh, int n_parts) {
  SPREKK_CHECK(n_parts > 0, "partition: {} parts; needs at least one", n_parts);
  std::vector<int> part(mesh.n_cells(), 0);
  if (n_parts == 1) return part;
  if (mesh.n_cells() <= n_parts) {
    std::iota(part.begin(), part.end(), 0);
    return part;
  }
  Graph graph = cell_graph(mesh);
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 1;
  idx_t n_cells = static_cast<idx_t>(mesh.n_cells()), n_constraints = 1, parts = n_parts, cut = 0;
  std::vector<idx_t> result(mesh.n_cells());
  const auto method = n_parts <= 8 ? METIS_PartGraphRecursive : METIS_PartGraphKway;  // as its manual advises
  const int status = method(&n_cells, &n_constraints, graph.offsets.data(), graph.neighbours.data(), nullptr, nullptr,
                            nullptr, &parts, nullptr, nullptr, options, &cut, result.data());
  SPREKK_CHECK(status == METIS_OK, "partition: METIS failed with status {} on {} cells and {} parts", status,
               mesh.n_cells(), n_parts);
  std::copy(result.begin(), result.end(), part.begin());
  return part;
}

}  // namespace sprekk::mesh
