// Reference cells: node and face numbering. Coordinates and numbering follow VTK, so that output needs no permutation.
#pragma once

#include <array>

namespace sprekk::mesh {

enum class Shape { triangle, quadrilateral, tetrahedron, hexahedron };

constexpr int dimension(Shape s) { return s == Shape::triangle || s == Shape::quadrilateral ? 2 : 3; }
constexpr int n_nodes(Shape s) {
  return s == Shape::triangle ? 3 : s == Shape::hexahedron ? 8 : 4;
}
constexpr int n_faces(Shape s) { return s == Shape::triangle ? 3 : s == Shape::hexahedron ? 6 : 4; }
constexpr int n_face_nodes(Shape s) { return s == Shape::tetrahedron ? 3 : s == Shape::hexahedron ? 4 : 2; }

/// Local nodes of each face, in order around the face, seen from outside counter-clockwise in 3D; unused entries are -1.
/// Simplex face i is the face opposite to node (i + n_nodes - 1) % n_nodes in 2D (edge i, i+1) and opposite to node i in
/// 3D; hexahedron faces are x-, x+, y-, y+, z-, z+.
constexpr std::array<std::array<int, 4>, 6> face_nodes(Shape s) {
  switch (s) {
    case Shape::triangle: return {{{0, 1, -1, -1}, {1, 2, -1, -1}, {2, 0, -1, -1}}};
    case Shape::quadrilateral: return {{{0, 1, -1, -1}, {1, 2, -1, -1}, {2, 3, -1, -1}, {3, 0, -1, -1}}};
    case Shape::tetrahedron: return {{{1, 2, 3, -1}, {0, 3, 2, -1}, {0, 1, 3, -1}, {0, 2, 1, -1}}};
    default:
      return {{{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}}};
  }
}

}  // namespace sprekk::mesh
