#include "mesh/tip_frames.hpp"

#include <algorithm>
#include <utility>

namespace sprekk::mesh {

TipFrames::TipFrames(const Mesh& mesh) : mesh_(mesh) {
  if (mesh.tip.empty()) return;
  for (const auto& face : mesh.fracture_faces)
    for (std::size_t k = 0; k < face.nodes[0].size(); ++k)
      if (const LocalIndex node = face.nodes[0][k]; node >= 0 && node == face.nodes[1][k] && mesh.tip[node])
        add(face, static_cast<int>(k));
}

bool TipFrames::find(LocalIndex cell, LocalIndex tip, std::array<Vector, 3>& axes) const {
  const auto found = frames_.find(tip);
  if (found == frames_.end()) return false;
  Vector along{}, normal = found->second.normal, ahead = Real(-1) * found->second.behind;
  if (mesh_.dim() == 3) {
    const Vector other = front(cell, tip, found->second.next);
    along = found->second.along;
    if (!(dot(along, along) > 0)) along = cross(ahead, normal);
    if (dot(other, other) > 0) along = (dot(other, along) < 0 ? Real(-1) : Real(1)) * other;
    along = (1 / norm(along)) * along;
    normal = normal - dot(normal, along) * along;
    ahead = ahead - dot(ahead, along) * along;
  }
  normal = (1 / norm(normal)) * normal;
  ahead = ahead - dot(ahead, normal) * normal;
  ahead = (1 / norm(ahead)) * ahead;
  axes = {ahead, normal, along};
  return true;
}

Vector TipFrames::from_to(LocalIndex a, LocalIndex b) const {
  Vector d{};
  for (int i = 0; i < mesh_.dim(); ++i)
    d[i] = mesh_.coordinates[b * mesh_.dim() + i] - mesh_.coordinates[a * mesh_.dim() + i];
  return d;
}

/// Adds the frame of the tip at the k-th node of a face. Sums the edges whose end nodes both sides share, oriented by
/// the normal. Interior edges cancel because two faces add them in opposite directions.
void TipFrames::add(const Mesh::FractureFace& face, int k) {
  const int dim = mesh_.dim();
  const LocalIndex node = face.nodes[0][k];
  auto& frame = frames_[node];
  Vector from{};
  for (int i = 0; i < dim; ++i) from[i] = face.centre[i] - mesh_.coordinates[node * dim + i];
  frame.normal = frame.normal + face.area * face.frame[0];
  frame.behind = frame.behind + from;
  const int n = n_face_corners(mesh_.shape);
  if (dim == 2 || k >= n) return;
  const int next = (k + 1) % n, last = (k + n - 1) % n;
  const auto to = [&](int other) { return from_to(node, face.nodes[0][other]); };
  const Real sign = dot(cross(to(next), to(last)), face.frame[0]) > 0 ? 1 : -1;
  for (const auto& [other, way] : {std::pair(next, -sign), std::pair(last, sign)})
    if (const LocalIndex end = face.nodes[0][other]; end == face.nodes[1][other]) {
      frame.along = frame.along + way * to(other);
      const auto found = std::find(frame.next.begin(), frame.next.end(), end);
      if (found == frame.next.end())
        frame.next.push_back(end);
      else
        frame.next.erase(found);
    }
}

/// Vector from a tip to the next tip of its front in the same cell; zero if there is none.
Vector TipFrames::front(LocalIndex cell, LocalIndex tip, const std::vector<LocalIndex>& next) const {
  const int n_nodes = mesh_.nodes_per_cell();
  for (int k = 0; k < n_nodes; ++k)
    if (const LocalIndex other = mesh_.cells[cell * n_nodes + k];
        std::find(next.begin(), next.end(), other) != next.end())
      return from_to(tip, other);
  return {};
}

}  // namespace sprekk::mesh
