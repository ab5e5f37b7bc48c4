#include "mesh/intersections.hpp"

#include <Teuchos_CommHelpers.hpp>

#include <algorithm>
#include <map>

#include "mesh/alike_nodes.hpp"

namespace sprekk::mesh {
namespace {

using Nodes = std::vector<GlobalIndex>;  ///< set numbers of the nodes of a ridge: ends, ascending, then the middle

/// Returns whether faces of these fractures, in ascending order, form an intersection.
bool is_intersection_of(const std::vector<int>& fractures) {
  return fractures.size() > 2 || fractures.front() != fractures.back();
}

bool do_meet(std::vector<int>& fractures) {
  std::sort(fractures.begin(), fractures.end());
  return is_intersection_of(fractures);
}

/// Ridges of the fracture faces on one rank.
class LocalRidges {
 public:
  explicit LocalRidges(const Mesh& mesh) : mesh_(mesh), alike_(mesh), in_owned_cell_(mesh.n_nodes(), false) {
    for (LocalIndex i = 0; i < mesh.n_owned_cells * mesh.nodes_per_cell(); ++i) in_owned_cell_[mesh.cells[i]] = true;
    for (const auto& face : mesh.fracture_faces) add(face);
  }

  /// Number of values per ridge of an owned face: its nodes, their coordinates, and the fracture.
  int n_numbers() const { return 4 * n_ridge_nodes() + 1; }

  /// Values of all ridges of owned faces that may be intersections according to the data of this rank.
  std::vector<Real> candidates() {
    std::vector<Real> found;
    for (LocalIndex f = 0; f < mesh_.n_owned_fracture_faces; ++f)
      for (int corner = 0; corner < n_face_corners(mesh_.shape); ++corner) {
        const auto nodes = ridge(mesh_.fracture_faces[f], minus, corner);
        auto& seen = ridges_.at(alike(nodes));
        if (seen.is_whole && !do_meet(seen.fractures)) continue;
        for (GlobalIndex node : alike(nodes)) found.push_back(static_cast<Real>(node));
        for (LocalIndex node : nodes)
          for (int c = 0; c < 3; ++c) found.push_back(c < mesh_.dim() ? mesh_.coordinates[node * mesh_.dim() + c] : 0);
        found.push_back(mesh_.fracture_faces[f].fracture);
      }
    return found;
  }

 private:
  struct Seen {
    std::vector<int> fractures;
    bool is_whole = true;  ///< all cells at the ridge, and thus all its faces, are on this rank
  };

  const Mesh& mesh_;
  AlikeNodes alike_;
  std::vector<bool> in_owned_cell_;
  std::map<Nodes, Seen> ridges_;

  int n_ridge_nodes() const { return mesh_.dim() == 2 ? 1 : order(mesh_.shape) == 1 ? 2 : 3; }

  /// Local nodes of the ridge at a corner of one side of a face. Ends are ordered by their set numbers.
  std::vector<LocalIndex> ridge(const Mesh::FractureFace& face, int side, int corner) const {
    const int n = n_face_corners(mesh_.shape);
    const auto& of_face = face.nodes[side];
    std::vector<LocalIndex> nodes = {of_face[corner], of_face[(corner + 1) % n], of_face[n + corner]};
    nodes.resize(n_ridge_nodes());
    if (mesh_.dim() == 3 && alike_[nodes[0]] > alike_[nodes[1]]) std::swap(nodes[0], nodes[1]);
    return nodes;
  }

  Nodes alike(const std::vector<LocalIndex>& nodes) const {
    Nodes sets;
    for (LocalIndex node : nodes) sets.push_back(alike_[node]);
    return sets;
  }

  void add(const Mesh::FractureFace& face) {
    for (int corner = 0; corner < n_face_corners(mesh_.shape); ++corner) {
      Seen* seen = nullptr;
      for (int side : {minus, plus}) {
        if (face.cell[side] < 0) continue;
        const auto nodes = ridge(face, side, corner);
        seen = &ridges_[alike(nodes)];
        for (LocalIndex node : nodes) seen->is_whole = seen->is_whole && in_owned_cell_[node];
      }
      seen->fractures.push_back(face.fracture);
    }
  }
};

/// Concatenates the values of all ranks on rank 0; empty on other ranks. Collective.
std::vector<Real> gathered(const Comm& comm, std::vector<Real> here) {
  int n = static_cast<int>(here.size());
  if (comm.getRank() > 0) {
    Teuchos::send(comm, n, 0);
    if (n > 0) Teuchos::send(comm, n, here.data(), 0);
    return {};
  }
  for (int rank = 1; rank < comm.getSize(); ++rank) {
    Teuchos::receive(comm, rank, &n);
    here.resize(here.size() + n);
    if (n > 0) Teuchos::receive(comm, rank, n, here.data() + here.size() - n);
  }
  return here;
}

}  // namespace

std::vector<Intersection> intersections(const Mesh& mesh) {
  LocalRidges local(mesh);
  const int n = local.n_numbers(), n_nodes = n / 4;
  const auto numbers = gathered(*mesh.comm, local.candidates());
  std::map<Nodes, Intersection> ridges;
  for (auto it = numbers.begin(); it != numbers.end(); it += n) {
    const Nodes nodes(it, it + n_nodes);
    auto& ridge = ridges[nodes];
    ridge.nodes = nodes;
    ridge.x.resize(n_nodes);
    for (int k = 0; k < n_nodes; ++k) std::copy_n(it + n_nodes + 3 * k, 3, ridge.x[k].begin());
    ridge.fractures.push_back(static_cast<int>(it[n - 1]));
  }
  std::vector<Intersection> result;
  for (auto& [nodes, ridge] : ridges)
    if (do_meet(ridge.fractures)) result.push_back(std::move(ridge));
  return result;
}

std::vector<IntersectionEdge> intersection_edges(const Mesh& mesh) {
  const int n = n_face_corners(mesh.shape);
  std::map<LocalIndex, IntersectionEdge> edges;
  for (LocalIndex f = 0; f < mesh.n_fracture_faces() && mesh.dim() == 3; ++f)
    for (int k = 0; k < n; ++k) {
      const LocalIndex facet = mesh.facets->ridge[f * n + k];
      if (facet >= mesh.facets->n_owned) continue;
      auto& edge = edges.try_emplace(facet, IntersectionEdge{facet, f, k, {}}).first->second;
      edge.fractures.push_back(mesh.fracture_faces[f].fracture);
    }
  std::vector<IntersectionEdge> result;
  for (auto& [facet, edge] : edges)
    if (do_meet(edge.fractures)) result.push_back(std::move(edge));
  return result;
}

bool EdgeAtPoint::is_intersection() const { return is_intersection_of(fractures); }

std::vector<std::vector<EdgeAtPoint>> junctions(const Mesh& mesh) {
  struct Edge {
    std::array<GlobalIndex, 2> points{};
    EdgeAtPoint at_first;
  };
  const int n = n_face_corners(mesh.shape);
  std::map<LocalIndex, Edge> edges;  // by facet
  for (LocalIndex f = 0; f < mesh.n_fracture_faces() && mesh.dim() == 3; ++f) {
    const auto& face = mesh.fracture_faces[f];
    for (int k = 0; k < n; ++k) {
      const LocalIndex facet = mesh.facets->ridge[f * n + k];
      auto& [points, edge] = edges[facet];
      edge.fractures.push_back(face.fracture);
      if (edge.facet >= 0) continue;
      edge.facet = facet;
      edge.to_point = face_corner(mesh, f, k) - ridge_centre(mesh, f, k);
      points = {face.corners[k], face.corners[(k + 1) % n]};
    }
  }
  std::map<GlobalIndex, std::vector<EdgeAtPoint>> at_points;
  for (auto& [facet, edge] : edges) {
    auto& end = edge.at_first;
    if (!do_meet(end.fractures) && end.fractures.size() > 1) continue;
    at_points[edge.points[0]].push_back(end);
    end.to_point = -1.0 * end.to_point;
    at_points[edge.points[1]].push_back(end);
  }
  std::vector<std::vector<EdgeAtPoint>> result;
  for (auto& [point, junction] : at_points)
    if (std::any_of(junction.begin(), junction.end(), [](const auto& edge) { return edge.is_intersection(); }))
      result.push_back(std::move(junction));
  return result;
}

}  // namespace sprekk::mesh
