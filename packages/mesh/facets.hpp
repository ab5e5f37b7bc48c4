// Faces of the cells of a global mesh: their nodes, neighbours, area vectors and frames.
#pragma once

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

using Vector = std::array<Real, 3>;  ///< a point or vector; the last component is 0 in 2D

inline Vector operator+(const Vector& a, const Vector& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vector operator-(const Vector& a, const Vector& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vector operator*(Real s, const Vector& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline Real dot(const Vector& a, const Vector& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Real norm(const Vector& a) { return std::sqrt(dot(a, a)); }
inline Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Vector point(const GlobalMesh& mesh, GlobalIndex node);

/// Nodes of a cell's face in the order of face_nodes(shape); unused entries are -1.
std::array<GlobalIndex, max_face_nodes> nodes_of_face(const GlobalMesh& mesh, GlobalIndex cell, int local_face);

/// The corners of a cell's face, the lowest first; unused entries are -1. The same from both sides.
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

/// The corners of a face in order around it, and how many they are.
struct FaceCorners {
  std::array<Vector, 4> x;
  int n;
};

FaceCorners face_corners(const Mesh& mesh, LocalIndex cell, int local_face);

/// Area times unit normal of a face, outward where the corners are ordered as in face_nodes(); in 2D length times
/// normal. Exact for plane faces.
Vector area_vector(const FaceCorners& corners);
Vector area_vector(const GlobalMesh& mesh, GlobalIndex cell, int local_face);

/// The points, sorted, in which a face with these numbers of points at its corners ends: ridge k is corner k in 2D (the
/// second is -1), the edge from corner k to the next in 3D.
inline std::array<GlobalIndex, 2> ridge_points(const std::array<GlobalIndex, 4>& corners, Shape shape, int k) {
  if (dimension(shape) == 2) return {corners[k], -1};
  const GlobalIndex a = corners[k], b = corners[(k + 1) % n_face_corners(shape)];
  return {a < b ? a : b, a < b ? b : a};
}

/// The middle of ridge k of a fracture face, and its length; 1 in 2D.
Vector ridge_centre(const Mesh& mesh, LocalIndex face, int k);
Real ridge_length(const Mesh& mesh, LocalIndex face, int k);

/// Mean of the corners of a face.
Vector face_centre(const FaceCorners& corners);
Vector face_centre(const GlobalMesh& mesh, GlobalIndex cell, int local_face);

/// Mean of the corners of a cell.
Vector cell_centre(const Mesh& mesh, LocalIndex cell);

/// Rows n, t1, t2 of the frame whose normal n points along `direction`. 2D: t1 = (n_y, -n_x), t2 = 0.
/// 3D: t1 = a x n/|a x n| with a = e_z if |n_z| < 0.9 else e_x, t2 = n x t1.
std::array<Vector, 3> face_frame(const Vector& direction, int dim);

/// For each cell face [cell * n_faces(shape) + local face] the index of the same face in the cell across it, -1 where
/// there is none. Faces are the same if they have the same corners, so both sides of a split fracture count as free.
/// Throws an Error if more than two cells share a face. Linear in the number of cells.
std::vector<GlobalIndex> face_neighbours(const GlobalMesh& mesh);

}  // namespace sprekk::mesh
