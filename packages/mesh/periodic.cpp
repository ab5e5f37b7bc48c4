#include "mesh/periodic.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "base/check.hpp"
#include "base/text.hpp"
#include "mesh/facets.hpp"
#include "mesh/renumber.hpp"
#include "mesh/union_find.hpp"

namespace sprekk::mesh {
namespace {

using BoundaryFace = GlobalMesh::BoundaryFace;

std::vector<BoundaryFace> faces_of(const GlobalMesh& mesh, const std::string& boundary) {
  const auto found = std::find(mesh.boundary_names.begin(), mesh.boundary_names.end(), boundary);
  SPREKK_CHECK(found != mesh.boundary_names.end(), "periodic: \"{}\" is no boundary of the mesh, must be one of {}{}",
               boundary, base::quoted_list(mesh.boundary_names), base::did_you_mean(boundary, mesh.boundary_names));
  const int number = static_cast<int>(found - mesh.boundary_names.begin());
  std::vector<BoundaryFace> faces;
  for (const auto& face : mesh.boundary_faces)
    if (face.boundary == number) faces.push_back(face);
  return faces;
}

Vector mean_centre(const GlobalMesh& mesh, const std::vector<BoundaryFace>& faces) {
  Vector sum{};
  for (const auto& face : faces) sum = sum + face_centre(mesh, face.cell, face.local_face);
  return (1.0 / static_cast<Real>(std::max<std::size_t>(faces.size(), 1))) * sum;
}

/// Ties the nodes of the second boundary to those of the first. Throws an Error if faces or nodes do not match.
void tie_faces(const GlobalMesh& mesh, const std::pair<std::string, std::string>& names, UnionFind& ties) {
  const auto first = faces_of(mesh, names.first), second = faces_of(mesh, names.second);
  SPREKK_CHECK(first.size() == second.size() && !first.empty(),
               "periodic: boundaries \"{}\" and \"{}\" have {} and {} faces; they must match", names.first,
               names.second, first.size(), second.size());
  const Vector shift = mean_centre(mesh, second) - mean_centre(mesh, first);
  const Real tolerance = 1e-6 * norm(shift) / std::pow(static_cast<Real>(mesh.n_cells()), 1.0 / mesh.dim());
  using Key = std::array<long long, 3>;  // centres, rounded to a lattice much finer than the mesh
  const auto key = [&](const Vector& x) {
    return Key{std::llround(x[0] / (100 * tolerance)), std::llround(x[1] / (100 * tolerance)),
               std::llround(x[2] / (100 * tolerance))};
  };
  std::map<Key, const BoundaryFace*> by_centre;
  for (const auto& face : first) by_centre[key(face_centre(mesh, face.cell, face.local_face))] = &face;
  const auto partner = [&](const Vector& x) -> const BoundaryFace* {
    const Key middle = key(x);
    for (int i = 0; i < 27; ++i) {
      const auto found = by_centre.find({middle[0] + i % 3 - 1, middle[1] + i / 3 % 3 - 1, middle[2] + i / 9 - 1});
      if (found != by_centre.end()) return found->second;
    }
    return nullptr;
  };
  const int n = n_face_nodes(mesh.shape);
  for (const auto& face : second) {
    const Vector centre = face_centre(mesh, face.cell, face.local_face);
    const auto* other = partner(centre - shift);
    SPREKK_CHECK(other, "periodic: the face of \"{}\" at ({:.6g}, {:.6g}, {:.6g}) has no partner on \"{}\"",
                 names.second, centre[0], centre[1], centre[2], names.first);
    const auto nodes = nodes_of_face(mesh, face.cell, face.local_face),
               others = nodes_of_face(mesh, other->cell, other->local_face);
    for (int k = 0; k < n; ++k) {
      const Vector x = point(mesh, nodes[k]) - shift;
      const auto match = std::find_if(others.begin(), others.begin() + n,
                                      [&](GlobalIndex node) { return norm(point(mesh, node) - x) < 1000 * tolerance; });
      SPREKK_CHECK(match != others.begin() + n,
                   "periodic: the node of \"{}\" at ({:.6g}, {:.6g}, {:.6g}) has no partner on \"{}\"", names.second,
                   x[0] + shift[0], x[1] + shift[1], x[2] + shift[2], names.first);
      ties.join(nodes[k], *match);
    }
  }
}

}  // namespace

GlobalMesh tie_periodic(const GlobalMesh& mesh, const std::vector<std::pair<std::string, std::string>>& pairs) {
  if (pairs.empty()) return mesh;
  UnionFind ties(mesh.n_nodes());
  for (const auto& pair : pairs) tie_faces(mesh, pair, ties);
  std::vector<GlobalIndex> new_node(mesh.n_nodes()), same_cell(mesh.n_cells()), tied;
  std::iota(same_cell.begin(), same_cell.end(), GlobalIndex{0});
  GlobalIndex n_free = 0;
  for (GlobalIndex node = 0; node < mesh.n_nodes(); ++node) {
    if (ties.find(node) == node)
      new_node[node] = n_free++;
    else
      tied.push_back(node);
  }
  for (std::size_t k = 0; k < tied.size(); ++k) new_node[tied[k]] = n_free + static_cast<GlobalIndex>(k);
  GlobalMesh result = permuted(mesh, new_node, same_cell);
  for (GlobalIndex node : tied) result.tied_to.push_back(new_node[ties.find(node)]);
  return result;
}

}  // namespace sprekk::mesh
