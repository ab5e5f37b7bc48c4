#include "mesh/facets.hpp"

#include <algorithm>
#include <utility>

#include "base/check.hpp"

namespace sprekk::mesh {
namespace {

FaceCorners corners_of(const GlobalMesh& mesh, GlobalIndex cell, int local_face) {
  const auto nodes = nodes_of_face(mesh, cell, local_face);
  FaceCorners result{{}, n_face_corners(mesh.shape)};
  for (int k = 0; k < result.n; ++k) result.x[k] = point(mesh, nodes[k]);
  return result;
}

}  // namespace

Vector point(const GlobalMesh& mesh, GlobalIndex node) {
  Vector x{};
  std::copy_n(&mesh.coordinates[node * mesh.dim()], mesh.dim(), x.begin());
  return x;
}

std::array<GlobalIndex, max_face_nodes> nodes_of_face(const GlobalMesh& mesh, GlobalIndex cell, int local_face) {
  std::array<GlobalIndex, max_face_nodes> nodes;
  const auto local = face_nodes(mesh.shape)[local_face];
  for (int k = 0; k < max_face_nodes; ++k)
    nodes[k] = local[k] < 0 ? -1 : mesh.cells[cell * n_nodes(mesh.shape) + local[k]];
  return nodes;
}

FaceCorners face_corners(const Mesh& mesh, LocalIndex cell, int local_face) {
  FaceCorners result{{}, n_face_corners(mesh.shape)};
  for (int k = 0; k < result.n; ++k) {
    const LocalIndex node = mesh.cells[cell * mesh.nodes_per_cell() + face_nodes(mesh.shape)[local_face][k]];
    std::copy_n(&mesh.coordinates[node * mesh.dim()], mesh.dim(), result.x[k].begin());
  }
  return result;
}

Vector area_vector(const FaceCorners& corners) {
  const auto edge = [&](int from, int to) { return corners.x[to] - corners.x[from]; };
  switch (corners.n) {
    case 2:
      return {edge(0, 1)[1], -edge(0, 1)[0], 0};
    case 3:
      return 0.5 * cross(edge(0, 1), edge(0, 2));
    default:
      return 0.5 * cross(edge(0, 2), edge(1, 3));
  }
}

Vector face_corner(const Mesh& mesh, LocalIndex face, int k) {
  const auto& fracture = mesh.fracture_faces[face];
  const int side = fracture.cell[minus] >= 0 ? minus : plus;
  Vector x{0, 0, 0};
  std::copy_n(&mesh.coordinates[fracture.nodes[side][k % n_face_corners(mesh.shape)] * mesh.dim()], mesh.dim(),
              x.begin());
  return x;
}

Vector ridge_centre(const Mesh& mesh, LocalIndex face, int k) {
  const Vector a = face_corner(mesh, face, k);
  return mesh.dim() == 2 ? a : 0.5 * (a + face_corner(mesh, face, k + 1));
}

Real ridge_length(const Mesh& mesh, LocalIndex face, int k) {
  return mesh.dim() == 2 ? 1 : norm(face_corner(mesh, face, k + 1) - face_corner(mesh, face, k));
}

Vector place(const FaceCorners& corners, const std::array<Real, 3>& xi) {
  const auto& x = corners.x;
  if (corners.n == 2) return x[0] + xi[0] * (x[1] - x[0]);
  if (corners.n == 3) return x[0] + xi[0] * (x[1] - x[0]) + xi[1] * (x[2] - x[0]);
  const Real a = (1 + xi[0]) / 2, b = (1 + xi[1]) / 2;
  return (1 - a) * ((1 - b) * x[0] + b * x[3]) + a * ((1 - b) * x[1] + b * x[2]);
}

Vector face_centre(const FaceCorners& corners) {
  Vector sum{};
  for (int k = 0; k < corners.n; ++k) sum = sum + corners.x[k];
  return (1.0 / corners.n) * sum;
}

Vector area_vector(const GlobalMesh& mesh, GlobalIndex cell, int local_face) {
  return area_vector(corners_of(mesh, cell, local_face));
}

Vector face_centre(const GlobalMesh& mesh, GlobalIndex cell, int local_face) {
  return face_centre(corners_of(mesh, cell, local_face));
}

Vector cell_centre(const Mesh& mesh, LocalIndex cell) {
  Vector x{};
  const int n = n_corners(mesh.shape), dim = mesh.dim();
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < dim; ++i) x[i] += mesh.coordinates[mesh.cells[cell * mesh.nodes_per_cell() + k] * dim + i] / n;
  return x;
}

std::array<Vector, 3> face_frame(const Vector& direction, int dim) {
  const Vector n = (1 / norm(direction)) * direction;
  if (dim == 2) return {n, Vector{n[1], -n[0], 0}, Vector{}};
  const Vector across = cross(std::abs(n[2]) < 0.9 ? Vector{0, 0, 1} : Vector{1, 0, 0}, n);
  const Vector t1 = (1 / norm(across)) * across;
  return {n, t1, cross(n, t1)};
}

std::vector<GlobalIndex> face_neighbours(const GlobalMesh& mesh) {
  const int faces_per_cell = n_faces(mesh.shape);
  const GlobalIndex n = mesh.n_cells() * faces_per_cell;
  const auto corners_of = [&](GlobalIndex face) {
    return sorted_corners(mesh, face / faces_per_cell, static_cast<int>(face % faces_per_cell));
  };
  // Hash table of faces by their corners, with one chain per value: first[hash] -> next[face] -> ... -> -1.
  std::size_t n_hashes = 1;
  while (4 * n_hashes < static_cast<std::size_t>(n)) n_hashes *= 2;
  std::vector<GlobalIndex> first(n_hashes, -1), next(n, -1), neighbour(next);
  for (GlobalIndex face = 0; face < n; ++face) {
    const auto corners = corners_of(face);
    GlobalIndex& start = first[SortedCornersHash()(corners) & (n_hashes - 1)];
    GlobalIndex other = start;
    while (other >= 0 && corners_of(other) != corners) other = next[other];
    if (other < 0) {
      next[face] = std::exchange(start, face);
      continue;
    }
    SPREKK_CHECK(neighbour[other] < 0, "mesh: cells {}, {} and {} share one face; at most two may",
                 neighbour[other] / faces_per_cell, other / faces_per_cell, face / faces_per_cell);
    neighbour[face] = other;
    neighbour[other] = face;
  }
  return neighbour;
}

}  // namespace sprekk::mesh
