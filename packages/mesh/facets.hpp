// Faces of the cells of a global mesh: their nodes, neighbours, area vectors and frames.
#pragma once

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

using Vector = std::array<Real, 3>;  ///< point or vector; the last component is 0 in 2D

inline Vector operator+(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vector operator*(Real s, const Vector& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline Real dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Real norm(const Vector& a) { return std::sqrt(dot(a, a)); }
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Coordinates of a node, m.
Vector point(const GlobalMesh& mesh, GlobalIndex node);

/// Nodes of one face of a cell, in the order of face_nodes(shape); unused entries are -1.
std::array<GlobalIndex, max_face_nodes> nodes_of_face(const GlobalMesh& mesh, GlobalIndex cell, int local_face);

/// Corners of a face in ascending order, thus equal from both sides; unused entries are -1.
using SortedCorners = std::array<GlobalIndex, 4>;

struct SortedCornersHash {
  std::size_t operator()(const SortedCorners& corners) const {
    std::size_t hash = 0;
    for (const GlobalIndex corner : corners) hash = (hash ^ static_cast<std::size_t>(corner)) * 0x9e3779b97f4a7c15ull;
    return hash ^ (hash >> 29);
  }
};

inline SortedCorners sorted_corners(const GlobalMesh& mesh, GlobalIndex cell, int local_face) {
  SortedCorners corners{-1, -1, -1, -1};
  const int n = n_face_corners(mesh.shape);
  const auto& local = face_nodes(mesh.shape)[local_face];
  const GlobalIndex* const nodes = &mesh.cells[cell * n_nodes(mesh.shape)];
  for (int k = 0; k < n; ++k) {
    corners[k] = nodes[local[k]];
    for (int j = k; j > 0 && corners[j] < corners[j - 1]; --j) std::swap(corners[j], corners[j - 1]);
  }
  return corners;
}

/// Coordinates of the corners of a face, m, in order around the face, and their number.
struct FaceCorners {
  std::array<Vector, 4> x;
  int n;
};

/// Corners of one face of a local cell, in the order of face_nodes().
FaceCorners face_corners(const Mesh& mesh, LocalIndex cell, int local_face);

/// Area times unit normal of a face, m^2 (2D: length times normal, m). The vector points outward if the corners have
/// the order of face_nodes(). It is exact for plane faces.
Vector area_vector(const FaceCorners& corners);
Vector area_vector(const GlobalMesh& mesh, GlobalIndex cell, int local_face);

/// Points at ridge k of a face with the given points at its corners, in ascending order. In 2D, ridge k is corner k,
/// and the second entry is -1. In 3D, it is the edge from corner k to the next.
inline std::array<GlobalIndex, 2> ridge_points(const std::array<GlobalIndex, 4>& corners, Shape shape, int k) {
  if (dimension(shape) == 2) return {corners[k], -1};
  const GlobalIndex a = corners[k], b = corners[(k + 1) % n_face_corners(shape)];
  return {a < b ? a : b, a < b ? b : a};
}

/// Corner k of a fracture face, cyclic, m.
Vector face_corner(const Mesh& mesh, LocalIndex face, int k);

/// ridge_centre() returns the midpoint of ridge k of a fracture face, ridge_length() its length, m; 1 in 2D.
Vector ridge_centre(const Mesh& mesh, LocalIndex face, int k);
Real ridge_length(const Mesh& mesh, LocalIndex face, int k);

/// Mean of the corners of a face.
Vector face_centre(const FaceCorners& corners);
/// Point of a face at coordinates on the reference edge [0, 1], triangle, or square [-1, 1]^2.
Vector place(const FaceCorners& corners, const std::array<Real, 3>& xi);
Vector face_centre(const GlobalMesh& mesh, GlobalIndex cell, int local_face);

/// Mean of the corners of a cell.
Vector cell_centre(const Mesh& mesh, LocalIndex cell);

/// Rows n, t1, t2 of the frame whose normal n points along `direction`. 2D: t1 = (n_y, -n_x), t2 = 0.
/// 3D: t1 = a x n/|a x n| with a = e_z if |n_z| < 0.9 else e_x, t2 = n x t1.
std::array<Vector, 3> face_frame(const Vector& direction, int dim);

/// Adjacent faces: [cell * n_faces(shape) + local face] index of the same face in the adjacent cell, -1 without one.
/// Two faces are the same if they have the same corners. The sides of a split fracture therefore have no adjacent face.
/// The cost is linear in the number of cells. Throws an Error if more than two cells share a face.
std::vector<GlobalIndex> face_neighbours(const GlobalMesh& mesh);

}  // namespace sprekk::mesh
