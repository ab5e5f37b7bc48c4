// Reference cells: numbers of nodes and faces. Coordinates and numbers follow VTK, so output needs no permutation.
#pragma once

#include <array>
#include <type_traits>

namespace sprekk::mesh {

/// Cells of order 1 and 2. Order 2 adds nodes on edges, and on faces and in the interior of quadrilaterals and
/// hexahedra.
enum class Shape {
  triangle,
  quadrilateral,
  tetrahedron,
  hexahedron,
  triangle6,
  quadrilateral9,
  tetrahedron10,
  hexahedron27
};

constexpr int order(Shape s) { return s < Shape::triangle6 ? 1 : 2; }
/// linear() and quadratic() return the cell of order 1 and 2 with the same corners.
constexpr Shape linear(Shape s) { return order(s) == 1 ? s : static_cast<Shape>(static_cast<int>(s) - 4); }
constexpr Shape quadratic(Shape s) { return order(s) == 2 ? s : static_cast<Shape>(static_cast<int>(s) + 4); }
constexpr bool is_simplex(Shape s) { return linear(s) == Shape::triangle || linear(s) == Shape::tetrahedron; }
constexpr int dimension(Shape s) { return linear(s) == Shape::triangle || linear(s) == Shape::quadrilateral ? 2 : 3; }
constexpr int n_corners(Shape s) { return linear(s) == Shape::triangle ? 3 : linear(s) == Shape::hexahedron ? 8 : 4; }
constexpr int n_nodes(Shape s) {
  constexpr int n[] = {3, 4, 4, 8, 6, 9, 10, 27};
  return n[static_cast<int>(s)];
}
constexpr int n_faces(Shape s) { return linear(s) == Shape::triangle ? 3 : linear(s) == Shape::hexahedron ? 6 : 4; }
constexpr int n_face_corners(Shape s) {
  return linear(s) == Shape::tetrahedron ? 3 : linear(s) == Shape::hexahedron ? 4 : 2;
}
constexpr int n_face_nodes(Shape s) {
  constexpr int n[] = {2, 2, 3, 4, 3, 3, 6, 9};
  return n[static_cast<int>(s)];
}
constexpr int max_face_nodes = 9;
/// Shape of order 1 of the faces of 3D cells.
constexpr Shape face_shape(Shape s) { return is_simplex(s) ? Shape::triangle : Shape::quadrilateral; }

using FaceNodes = std::array<std::array<int, max_face_nodes>, 6>;

namespace detail {

constexpr FaceNodes face_nodes(Shape s) {
  FaceNodes faces{};
  for (auto& face : faces)
    for (int& node : face) node = -1;
  const int n = n_face_nodes(s);
  constexpr int triangle[][3] = {{0, 1, 3}, {1, 2, 4}, {2, 0, 5}};
  constexpr int quadrilateral[][3] = {{0, 1, 4}, {1, 2, 5}, {2, 3, 6}, {3, 0, 7}};
  constexpr int tetrahedron[][6] = {{1, 2, 3, 5, 9, 8}, {0, 3, 2, 7, 9, 6}, {0, 1, 3, 4, 8, 7}, {0, 2, 1, 6, 5, 4}};
  constexpr int hexahedron[][9] = {{0, 4, 7, 3, 16, 15, 19, 11, 20}, {1, 2, 6, 5, 9, 18, 13, 17, 21},
                                   {0, 1, 5, 4, 8, 17, 12, 16, 22},  {3, 7, 6, 2, 19, 14, 18, 10, 23},
                                   {0, 3, 2, 1, 11, 10, 9, 8, 24},   {4, 5, 6, 7, 12, 13, 14, 15, 25}};
  for (int f = 0; f < n_faces(s); ++f)
    for (int k = 0; k < n; ++k) switch (linear(s)) {
        case Shape::triangle:
          faces[f][k] = triangle[f][k];
          break;
        case Shape::quadrilateral:
          faces[f][k] = quadrilateral[f][k];
          break;
        case Shape::tetrahedron:
          faces[f][k] = tetrahedron[f][k];
          break;
        default:
          faces[f][k] = hexahedron[f][k];
      }
  return faces;
}

inline constexpr std::array<FaceNodes, 8> all_face_nodes = {
    face_nodes(Shape::triangle),      face_nodes(Shape::quadrilateral), face_nodes(Shape::tetrahedron),
    face_nodes(Shape::hexahedron),    face_nodes(Shape::triangle6),     face_nodes(Shape::quadrilateral9),
    face_nodes(Shape::tetrahedron10), face_nodes(Shape::hexahedron27)};

}  // namespace detail

/// Returns the local nodes of each face [face][k]: corners, then edge nodes in the same order, then the interior node;
/// unused entries are -1. Corners are in order around the face, in 3D counter-clockwise seen from outside. Simplices:
/// face i is opposite to node (i + 2) % 3 in 2D (edge i, i+1) and to node i in 3D. Hexahedra: x-, x+, y-, y+, z-, z+.
constexpr const FaceNodes& face_nodes(Shape s) { return detail::all_face_nodes[static_cast<int>(s)]; }

/// Calls f(std::integral_constant<Shape, c>) with the cell c of order 1 with the same corners. Use it for code that
/// depends on corners and faces only: it is compiled for four cells instead of eight.
template <class F>
auto for_corners(Shape s, const F& f) {
  switch (linear(s)) {
    case Shape::triangle:
      return f(std::integral_constant<Shape, Shape::triangle>());
    case Shape::quadrilateral:
      return f(std::integral_constant<Shape, Shape::quadrilateral>());
    case Shape::tetrahedron:
      return f(std::integral_constant<Shape, Shape::tetrahedron>());
    default:
      return f(std::integral_constant<Shape, Shape::hexahedron>());
  }
}

/// Calls f like for_corners(), for code that depends only on the corners of faces. The shape is a triangle for all 2D
/// cells, a tetrahedron for triangular faces, a hexahedron for quadrilateral faces.
template <class F>
auto for_face_corners(Shape s, const F& f) {
  if (dimension(s) == 2) return f(std::integral_constant<Shape, Shape::triangle>());
  if (is_simplex(s)) return f(std::integral_constant<Shape, Shape::tetrahedron>());
  return f(std::integral_constant<Shape, Shape::hexahedron>());
}

/// Calls f(std::integral_constant<Shape, s>) for a shape known only at run time.
template <class F>
auto for_shape(Shape s, const F& f) {
  if (order(s) == 1) return for_corners(s, f);
  return for_corners(s, [&](auto corners) { return f(std::integral_constant<Shape, quadratic(corners())>()); });
}

}  // namespace sprekk::mesh
