#include "mesh/partition.hpp"

#include <metis.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <utility>

#include "base/check.hpp"
#include "mesh/facets.hpp"

namespace sprekk::mesh {
namespace {

constexpr idx_t fracture_edge_weight = 4, n_seeds = 10;

/// Graph of the cells in compressed rows, without repeated edges.
struct Graph {
  std::vector<idx_t> offsets, neighbours, edge_weights;
  std::vector<idx_t> weights;  ///< [cell * 2 + constraint]: one cell; number of fracture faces with this minus cell
};

Graph cell_graph(const GlobalMesh& mesh) {
  const int faces_per_cell = n_faces(mesh.shape);
  auto across = face_neighbours(mesh);
  SPREKK_CHECK(across.size() <= static_cast<std::size_t>(std::numeric_limits<idx_t>::max()),
               "partition: {} cells are too many for this METIS, whose indices have {} bits", mesh.n_cells(),
               8 * sizeof(idx_t));
  Graph graph{{0}, {}, {}, {}};
  for (GlobalIndex cell = 0; cell < mesh.n_cells(); ++cell) graph.weights.insert(graph.weights.end(), {1, 0});
  std::vector<bool> is_fracture(across.size(), false);
  for (const auto& face : mesh.fracture_faces) {
    ++graph.weights[2 * face.cell[minus] + 1];
    for (int side : {minus, plus}) {
      const GlobalIndex index = face.cell[side] * faces_per_cell + face.local_face[side];
      across[index] = face.cell[1 - side] * faces_per_cell;
      is_fracture[index] = true;
    }
  }
  for (GlobalIndex cell = 0; cell < mesh.n_cells(); ++cell) {
    std::map<idx_t, idx_t> row;
    for (GlobalIndex face = cell * faces_per_cell; face < (cell + 1) * faces_per_cell; ++face)
      if (across[face] >= 0)
        row[static_cast<idx_t>(across[face] / faces_per_cell)] += is_fracture[face] ? fracture_edge_weight : 1;
    for (const auto& [neighbour, weight] : row) {
      graph.neighbours.push_back(neighbour);
      graph.edge_weights.push_back(weight);
    }
    graph.offsets.push_back(static_cast<idx_t>(graph.neighbours.size()));
  }
  return graph;
}

struct Tolerances {
  double cells, fracture_faces;  ///< largest part / mean
};

/// Partitions the graph with METIS. Without tolerances, only the cells are balanced, as well as METIS can.
std::vector<int> metis_partition(Graph& graph, int n_parts, idx_t seed, const std::optional<Tolerances>& tolerances) {
  const bool recursive = n_parts <= 8;                                    // recommended in the manual of METIS
  const double n_levels = recursive ? std::ceil(std::log2(n_parts)) : 1;  // of bisections; imbalances multiply
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = seed;
  idx_t n_cells = static_cast<idx_t>(graph.offsets.size()) - 1, n_constraints = tolerances ? 2 : 1, parts = n_parts;
  std::vector<real_t> bounds;
  if (tolerances)
    for (double tolerance : {tolerances->cells, tolerances->fracture_faces})
      bounds.push_back(static_cast<real_t>(std::pow(tolerance, 1 / n_levels)));
  std::vector<idx_t> part(n_cells);
  idx_t cut = 0;
  const auto method = recursive ? METIS_PartGraphRecursive : METIS_PartGraphKway;
  const int status = method(&n_cells, &n_constraints, graph.offsets.data(), graph.neighbours.data(),
                            tolerances ? graph.weights.data() : nullptr, nullptr, graph.edge_weights.data(), &parts,
                            nullptr, tolerances ? bounds.data() : nullptr, options, &cut, part.data());
  SPREKK_CHECK(status == METIS_OK, "partition: METIS failed with status {} on {} cells and {} parts", status, n_cells,
               n_parts);
  return {part.begin(), part.end()};
}

/// Sum of the cell weights in each part.
std::vector<idx_t> loads(const Graph& graph, const std::vector<int>& part, int n_parts, int constraint) {
  std::vector<idx_t> result(n_parts, 0);
  for (std::size_t cell = 0; cell < part.size(); ++cell) result[part[cell]] += graph.weights[2 * cell + constraint];
  return result;
}

/// Largest load / mean load; 1 without loads.
double imbalance(const std::vector<idx_t>& loads) {
  const double sum = std::accumulate(loads.begin(), loads.end(), 0.0);
  return sum > 0 ? static_cast<double>(*std::max_element(loads.begin(), loads.end())) *
                       static_cast<double>(loads.size()) / sum
                 : 1;
}

/// Moves a cell of the largest part to each empty part.
void fill_empty_parts(const Graph& graph, std::vector<int>& part, int n_parts) {
  auto n_cells = loads(graph, part, n_parts, 0);
  for (int empty = 0; empty < n_parts; ++empty) {
    if (n_cells[empty] > 0) continue;
    const auto largest = std::max_element(n_cells.begin(), n_cells.end());
    *std::find(part.begin(), part.end(), static_cast<int>(largest - n_cells.begin())) = empty;
    --*largest;
    n_cells[empty] = 1;
  }
}

}  // namespace

std::vector<int> partition(const GlobalMesh& mesh, int n_parts) {
  SPREKK_CHECK(n_parts > 0, "partition: {} parts; needs at least one", n_parts);
  std::vector<int> best(mesh.n_cells(), 0);
  if (n_parts == 1) return best;
  if (mesh.n_cells() <= n_parts) {
    std::iota(best.begin(), best.end(), 0);
    return best;
  }
  // METIS seldom meets two tolerances at once. The code therefore tries several seeds until both are met; otherwise the
  // balance of cells has priority. The tolerances allow for one cell, and for the few fracture faces of a small mesh,
  // per part.
  Graph graph = cell_graph(mesh);
  const double parts = n_parts, n_cells = static_cast<double>(mesh.n_cells()),
               n_faces = std::max(1.0, static_cast<double>(mesh.fracture_faces.size()));
  const Tolerances allowed{1.05 + parts / n_cells, 1.2 + 4 * parts / n_faces};
  const auto excess = [&](const std::vector<int>& part) {
    return std::make_pair(std::max(0.0, imbalance(loads(graph, part, n_parts, 0)) - allowed.cells),
                          std::max(0.0, imbalance(loads(graph, part, n_parts, 1)) - allowed.fracture_faces));
  };
  best = metis_partition(graph, n_parts, 1, std::nullopt);
  auto minimum = excess(best);
  for (idx_t seed = 1; seed <= n_seeds && minimum.first + minimum.second > 0; ++seed)
    if (auto part = metis_partition(graph, n_parts, seed, allowed); excess(part) < minimum) {
      best = std::move(part);
      minimum = excess(best);
    }
  fill_empty_parts(graph, best, n_parts);
  return best;
}

PartitionReport report(const GlobalMesh& mesh, const std::vector<int>& part, int n_parts) {
  std::vector<idx_t> n_cells(n_parts, 0), n_faces(n_parts, 0);
  for (int p : part) ++n_cells[p];
  for (const auto& face : mesh.fracture_faces) ++n_faces[part[face.cell[minus]]];
  const auto range = [](const std::vector<idx_t>& loads) {
    const auto [minimum, maximum] = std::minmax_element(loads.begin(), loads.end());
    return std::array<GlobalIndex, 2>{*minimum, *maximum};
  };
  PartitionReport result{range(n_cells), range(n_faces), imbalance(n_cells), imbalance(n_faces), 0, 0};
  if (n_parts == 1) return result;
  const Graph graph = cell_graph(mesh);
  for (std::size_t cell = 0; cell < part.size(); ++cell)
    for (idx_t k = graph.offsets[cell]; k < graph.offsets[cell + 1]; ++k)
      if (static_cast<idx_t>(cell) < graph.neighbours[k] && part[cell] != part[graph.neighbours[k]]) ++result.edge_cut;
  for (const auto& face : mesh.fracture_faces)
    if (part[face.cell[minus]] != part[face.cell[plus]]) ++result.separated_faces;
  return result;
}

}  // namespace sprekk::mesh
