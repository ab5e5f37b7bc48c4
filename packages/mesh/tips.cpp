#include "mesh/tips.hpp"

#include <algorithm>

#include "mesh/facets.hpp"

namespace sprekk::mesh {

std::vector<char> tip_nodes(const GlobalMesh& mesh) {
  const int n = n_face_corners(mesh.shape);
  const auto free_corners = [&](const GlobalMesh::FractureFace& face, int side) {
    auto nodes = nodes_of_face(mesh, face.cell[side], face.local_face[side]);
    std::for_each(nodes.begin(), nodes.begin() + n, [&](GlobalIndex& node) { node = mesh.free_node(node); });
    return nodes;
  };
  std::vector<char> is_tip(mesh.n_nodes(), 0);
  for (const auto& face : mesh.fracture_faces) {
    const auto one = free_corners(face, minus), other = free_corners(face, plus);
    for (int k = 0; k < n; ++k)
      if (std::find(other.begin(), other.begin() + n, one[k]) != other.begin() + n) is_tip[one[k]] = 1;
  }
  for (GlobalIndex node = mesh.n_free_nodes(); node < mesh.n_nodes(); ++node)
    is_tip[node] = is_tip[mesh.free_node(node)];
  return is_tip;
}

}  // namespace sprekk::mesh
