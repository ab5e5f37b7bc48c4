#include "mesh/tips.hpp"

#include <algorithm>
#include <limits>

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

void mark_tips(GlobalMesh& mesh) {
  const auto all = tip_nodes(mesh);
  mesh.tip = all;
  std::vector<int> n_fracture_faces(mesh.n_nodes(), 0);  // around each free node
  const int n = n_face_corners(mesh.shape);
  for (const auto& face : mesh.fracture_faces)
    for (int side : {minus, plus}) {
      const auto nodes = nodes_of_face(mesh, face.cell[side], face.local_face[side]);
      for (int k = 0; k < n; ++k) ++n_fracture_faces[mesh.free_node(nodes[k])];
    }
  for (GlobalIndex cell = 0; cell < mesh.n_cells(); ++cell)
    for (int f = 0; f < n_faces(mesh.shape); ++f) {
      const auto nodes = nodes_of_face(mesh, cell, f);
      if (!std::all_of(nodes.begin(), nodes.begin() + n, [&](GlobalIndex node) { return all[node] != 0; })) continue;
      int fewest = std::numeric_limits<int>::max();
      for (int k = 0; k < n; ++k) fewest = std::min(fewest, n_fracture_faces[mesh.free_node(nodes[k])]);
      for (int k = 0; k < n; ++k)
        if (n_fracture_faces[mesh.free_node(nodes[k])] == fewest)
          mesh.tip[nodes[k]] = mesh.tip[mesh.free_node(nodes[k])] = 0;
    }
  for (GlobalIndex node = mesh.n_free_nodes(); node < mesh.n_nodes(); ++node)
    mesh.tip[node] = mesh.tip[mesh.free_node(node)];
}

}  // namespace sprekk::mesh
