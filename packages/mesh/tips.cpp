#include "mesh/tips.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "base/check.hpp"
#include "base/over_ranks.hpp"
#include "mesh/exchange.hpp"
#include "mesh/facets.hpp"

namespace sprekk::mesh {
namespace {

using Nodes = std::array<GlobalIndex, max_face_nodes>;

/// Nodes of one side of a fracture face; -1 if not on this rank.
Nodes nodes_of_side(const GlobalMesh& mesh, const GlobalMesh::FractureFace& face, int side) {
  return nodes_of_face(mesh, face.cell[side], face.local_face[side]);
}

Nodes nodes_of_side(const Mesh&, const Mesh::FractureFace& face, int side) {
  Nodes nodes;
  std::copy(face.nodes[side].begin(), face.nodes[side].end(), nodes.begin());
  return nodes;
}

/// Calls use(free node) for the corners of one side of a fracture face, if they are on this rank.
template <class AnyMesh, class Face, class Use>
void for_corners(const AnyMesh& mesh, const Face& face, int side, const Use& use) {
  const auto nodes = nodes_of_side(mesh, face, side);
  for (int k = 0; k < n_face_corners(mesh.shape); ++k)
    if (nodes[k] >= 0) use(mesh.free_node(nodes[k]));
}

/// Copies the values of free nodes to the nodes tied to them.
template <class AnyMesh>
void copy_to_tied(const AnyMesh& mesh, std::vector<char>& values) {
  for (std::size_t node = values.size() - mesh.tied_to.size(); node < values.size(); ++node)
    values[node] = values[mesh.free_node(node)];
}

/// Marks tips. share(values) sends nodal values from ranks with all cells at a node to the other ranks.
template <class AnyMesh, class Share>
std::vector<char> find_tips(const AnyMesh& mesh, const Share& share) {
  std::vector<char> is_tip(mesh.n_nodes(), 0);
  for (const auto& face : mesh.fracture_faces) {
    std::vector<GlobalIndex> one;
    for_corners(mesh, face, minus, [&](GlobalIndex node) { one.push_back(node); });
    for_corners(mesh, face, plus, [&](GlobalIndex node) {
      if (std::find(one.begin(), one.end(), node) != one.end()) is_tip[node] = 1;
    });
  }
  share(is_tip);
  copy_to_tied(mesh, is_tip);
  return is_tip;
}

template <class AnyMesh, class Share>
std::vector<char> find_marks(const AnyMesh& mesh, const Share& share) {
  const auto all = find_tips(mesh, share);
  auto marks = all;
  std::vector<int> n_fracture_faces(mesh.n_nodes(), 0);  // around each free node
  for (const auto& face : mesh.fracture_faces)
    for (int side : {minus, plus}) for_corners(mesh, face, side, [&](GlobalIndex node) { ++n_fracture_faces[node]; });
  share(n_fracture_faces);
  const int n = n_face_corners(mesh.shape), nodes_per_cell = n_nodes(mesh.shape);
  for (GlobalIndex cell = 0; cell < mesh.n_cells(); ++cell)
    for (int f = 0; f < n_faces(mesh.shape); ++f) {
      const auto node = [&](int k) { return mesh.cells[cell * nodes_per_cell + face_nodes(mesh.shape)[f][k]]; };
      int fewest = std::numeric_limits<int>::max();
      bool tips_only = true;
      for (int k = 0; k < n; ++k) {
        tips_only = tips_only && all[node(k)];
        fewest = std::min(fewest, n_fracture_faces[mesh.free_node(node(k))]);
      }
      for (int k = 0; k < n && tips_only; ++k)
        if (n_fracture_faces[mesh.free_node(node(k))] == fewest) marks[node(k)] = marks[mesh.free_node(node(k))] = 0;
    }
  share(marks);
  copy_to_tied(mesh, marks);
  return marks;
}

/// Marks nodes that are not tips but belong to a cell with a tip. The result is correct for owned nodes.
std::vector<char> find_enriched(const Mesh& mesh) {
  const int n = mesh.nodes_per_cell();
  std::vector<char> result(mesh.n_nodes(), 0);
  for (LocalIndex cell = 0; cell < mesh.n_cells(); ++cell) {
    const auto* nodes = &mesh.cells[cell * n];
    const auto is_tip = [&](LocalIndex node) { return mesh.tip[node] != 0; };
    if (std::any_of(nodes, nodes + n, is_tip))
      for (int k = 0; k < n; ++k) result[nodes[k]] = !is_tip(nodes[k]);
  }
  return result;
}

/// Numbers the enriched nodes in the order of the node numbers. Collective.
void number_enriched(Mesh& mesh, const GhostExchange& exchange) {
  const auto is_enriched = find_enriched(mesh);
  const std::vector<GlobalIndex> owned(mesh.node_id.begin(), mesh.node_id.begin() + mesh.n_owned_nodes),
      counts(is_enriched.begin(), is_enriched.begin() + mesh.n_owned_nodes);
  auto ids = sums_before(owned, counts, mesh.comm);
  for (LocalIndex node = 0; node < mesh.n_owned_nodes; ++node)
    if (!counts[node]) ids[node] = -1;
  ids.resize(mesh.n_nodes(), -1);
  exchange(ids);
  mesh.n_owned_enriched = static_cast<LocalIndex>(std::accumulate(counts.begin(), counts.end(), GlobalIndex{0}));
  mesh.n_global_enriched = base::sum_over_ranks<GlobalIndex>(*mesh.comm, mesh.n_owned_enriched);
  mesh.enriched.clear();
  mesh.enriched_id.clear();
  for (const GlobalIndex id : ids) {
    mesh.enriched.push_back(id < 0 ? -1 : static_cast<LocalIndex>(mesh.enriched_id.size()));
    if (id >= 0) mesh.enriched_id.push_back(id);
  }
}

GhostExchange exchange_of_nodes(const Mesh& mesh) {
  SPREKK_CHECK(mesh.tied_to.empty(), "tips: need a mesh without periodic sides once it is distributed");
  return {mesh.node_id, mesh.n_owned_nodes, mesh.comm};
}

}  // namespace

std::vector<char> tip_nodes(const GlobalMesh& mesh) {
  return find_tips(mesh, [](auto&) {});
}

std::vector<char> tip_nodes(const Mesh& mesh) { return find_tips(mesh, exchange_of_nodes(mesh)); }

void mark_tips(GlobalMesh& mesh) {
  mesh.tip = find_marks(mesh, [](auto&) {});
}

void mark_tips(Mesh& mesh) {
  const auto exchange = exchange_of_nodes(mesh);
  mesh.tip = find_marks(mesh, exchange);
  number_enriched(mesh, exchange);
}

}  // namespace sprekk::mesh
