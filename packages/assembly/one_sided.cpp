#include "assembly/one_sided.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprekk::assembly {

std::vector<char> nodes_with_copies(const mesh::Mesh& mesh) {
  std::vector<char> result(mesh.n_nodes(), 0);
  for (const auto& face : mesh.fracture_faces)
    for (int k = 0; k < mesh::n_face_nodes(mesh.shape); ++k)
      for (const auto& nodes : face.nodes)
        if (nodes[k] >= 0 && face.nodes[0][k] != face.nodes[1][k]) result[nodes[k]] = 1;
  return result;
}

std::vector<char> nodes_with_copies(const mesh::GlobalMesh& mesh) {
  std::vector<char> copies(mesh.n_nodes(), 0), result(mesh.n_nodes(), 0);  // copies of each point, at most 2
  for (GlobalIndex node = 0; node < mesh.n_free_nodes(); ++node) {
    char& count = copies[mesh.point_of(node)];
    count = std::min<char>(2, count + 1);
  }
  for (GlobalIndex node = 0; node < mesh.n_nodes(); ++node) result[node] = copies[mesh.point_of(node)] == 2;
  return result;
}

Real one_sided(const base::Expression& g, const mesh::Vector& x, const mesh::Vector& d, Real t) {
  using mesh::operator+;
  using mesh::operator*;
  const Real at = g(x, t), size = mesh::norm(d);
  if (size == 0 || g.is_constant()) return at;
  const Real rounding = 16 * std::numeric_limits<Real>::epsilon() * mesh::norm(x) / size;
  const Real step = std::max(1e-6, rounding), ratio = 100;
  const Real near = g(x + step * d, t), far = g(x + ratio * step * d, t);
  const Real change = std::abs(near - at);
  const bool breaks = change > 0.5 * std::abs(far - at) && change > 1e-9 * std::max(std::abs(near), std::abs(at));
  return breaks ? near + (near - far) / (ratio - 1) : at;
}

}  // namespace sprekk::assembly
