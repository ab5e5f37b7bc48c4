#include "mesh/extents.hpp"

#include "base/over_ranks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprekk::mesh {
namespace {

/// Bounding boxes of nodes over all ranks.
class Boxes {
 public:
  explicit Boxes(std::size_t n) : corners_(6 * n, -std::numeric_limits<Real>::max()) {}

  void add(const Mesh& mesh, LocalIndex node, int box = 0) {
    for (int i = 0; i < mesh.dim(); ++i) {
      const Real x = mesh.coordinates[node * mesh.dim() + i];
      Real* corner = &corners_[6 * box + 2 * i];
      corner[0] = std::max(corner[0], x);
      corner[1] = std::max(corner[1], -x);
    }
  }

  std::vector<Vector> extents(const Mesh& mesh) const {
    const auto all = base::max_over_ranks(*mesh.comm, corners_);
    std::vector<Vector> result(all.size() / 6);
    for (std::size_t box = 0; box < result.size(); ++box)
      for (int i = 0; i < mesh.dim(); ++i) result[box][i] = all[6 * box + 2 * i] + all[6 * box + 2 * i + 1];
    return result;
  }

 private:
  std::vector<Real> corners_;  // [box * 6 + 2 * direction]: largest x, largest -x
};

}  // namespace

Vector domain_extents(const Mesh& mesh) {
  Boxes boxes(1);
  for (LocalIndex node = 0; node < mesh.n_nodes(); ++node) boxes.add(mesh, node);
  return boxes.extents(mesh)[0];
}

Real largest_extent(const Mesh& mesh) {
  const Vector extents = domain_extents(mesh);
  return *std::max_element(extents.begin(), extents.end());
}

Real length_of(const Mesh& mesh, const Mesh::FractureFace& face) { return std::pow(face.area, 1.0 / (mesh.dim() - 1)); }

Real typical_face_area(const Mesh& mesh) {
  const Vector size = domain_extents(mesh);
  const int dim = mesh.dim();
  const Real volume = size[0] * size[1] * (dim == 3 ? size[2] : 1);
  return std::pow(volume / static_cast<Real>(mesh.n_global_cells), (dim - 1.0) / dim);
}

namespace {

template <class Box>
std::vector<Vector> extents_of_faces(const Mesh& mesh, std::size_t n, const Box& box) {
  Boxes boxes(n);
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f)
    for (int k = 0; k < n_face_nodes(mesh.shape); ++k)
      boxes.add(mesh, mesh.fracture_faces[f].nodes[minus][k], box(mesh.fracture_faces[f]));
  return boxes.extents(mesh);
}

}  // namespace

std::vector<Real> parts_of_normals(const GlobalMesh& mesh, int boundary) {
  constexpr Real rounding = 1e-9;
  std::vector<Real> parts(mesh.dim(), 0);
  for (const auto& face : mesh.boundary_faces) {
    if (face.boundary != boundary) continue;
    const auto area = area_vector(mesh, face.cell, face.local_face);
    for (int i = 0; i < mesh.dim(); ++i)
      if (const Real part = std::abs(area[i]) / norm(area); part > rounding) parts[i] = std::max(parts[i], part);
  }
  return parts;
}

std::vector<Vector> fracture_extents(const Mesh& mesh) {
  return extents_of_faces(mesh, mesh.fracture_names.size(), [](const auto& face) { return face.fracture; });
}

std::vector<Vector> single_fracture_extents(const Mesh& mesh) {
  return extents_of_faces(mesh, mesh.single_fractures.size(), [](const auto& face) { return face.single; });
}

}  // namespace sprekk::mesh
