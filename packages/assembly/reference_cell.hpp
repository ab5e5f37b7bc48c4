// Shape functions, face bubbles and quadrature of the order-1 cells; device-callable.
//
// Simplices live on {xi >= 0, sum xi <= 1}, quadrilaterals and hexahedra on [-1, 1]^dim; nodes and faces as in shape.hpp.
#pragma once

#include "base/types.hpp"
#include "mesh/shape.hpp"

#include <type_traits>

namespace sprekk::assembly {

using mesh::Shape;

constexpr bool is_simplex(Shape s) { return s == Shape::triangle || s == Shape::tetrahedron; }

/// Gauss rule with n points on [-1, 1], exact for degree 2n - 1.
template <int n>
struct Gauss {
  static_assert(n >= 1 && n <= 4, "rules with 1 to 4 points");
  KOKKOS_INLINE_FUNCTION static Real point(int i) {
    if (n == 1) return 0;
    if (n == 2) return i == 0 ? -0.57735026918962576451 : 0.57735026918962576451;
    if (n == 3) return (i - 1) * 0.77459666924148337704;
    const Real inner = 0.33998104358485626480, outer = 0.86113631159405257522;
    return i == 0 ? -outer : i == 1 ? -inner : i == 2 ? inner : outer;
  }
  KOKKOS_INLINE_FUNCTION static Real weight(int i) {
    if (n == 1) return 2;
    if (n == 2) return 1;
    if (n == 3) return i == 1 ? 8.0 / 9.0 : 5.0 / 9.0;
    return i == 1 || i == 2 ? 0.65214515486254614263 : 0.34785484513745385737;
  }
};

/// points^dim quadrature points: the product of Gauss rules, exact for degree 2 points - 1 in each direction; on simplices
/// the same points collapsed towards a vertex (conical product), exact for total degree 2 points - dim.
template <Shape shape, int points>
struct Quadrature {
  static constexpr int dim = mesh::dimension(shape);
  static constexpr int n = dim == 2 ? points * points : points * points * points;

  /// Sets xi to point q and returns its weight on the reference cell.
  KOKKOS_INLINE_FUNCTION static Real at(int q, Real (&xi)[dim]) {
    const int index[3] = {q % points, (q / points) % points, q / (points * points)};
    Real weight = 1;
    for (int i = 0; i < dim; ++i) {
      xi[i] = Gauss<points>::point(index[i]);
      weight *= Gauss<points>::weight(index[i]);
    }
    if (!is_simplex(shape)) return weight;
    Real rest = 1;  // 1 - the coordinates so far
    for (int i = 0; i < dim; ++i) {
      const Real s = (1 + xi[i]) / 2;
      weight *= 0.5;
      for (int k = 0; k < dim - 1 - i; ++k) weight *= 1 - s;
      xi[i] = rest * s;
      rest *= 1 - s;
    }
    return weight;
  }
};

/// One point at the centroid of a simplex, exact for degree 1.
template <Shape shape>
struct CentroidRule {
  static constexpr int dim = mesh::dimension(shape);
  static constexpr int n = 1;

  KOKKOS_INLINE_FUNCTION static Real at(int, Real (&xi)[dim]) {
    for (int i = 0; i < dim; ++i) xi[i] = 1.0 / (dim + 1);
    return dim == 2 ? 1.0 / 2.0 : 1.0 / 6.0;
  }
};

/// Exact for the stiffness of affine cells: constant on simplices, bilinear squared otherwise.
template <Shape shape>
using StiffnessQuadrature = std::conditional_t<is_simplex(shape), CentroidRule<shape>, Quadrature<shape, 2>>;

/// Exact for products of bubble gradients, and for loads of degree 2 against bubbles, on affine cells.
template <Shape shape>
using BubbleQuadrature = Quadrature<shape, shape == Shape::tetrahedron ? 4 : 3>;

template <Shape shape>
struct ReferenceCell {
  static constexpr int dim = mesh::dimension(shape);
  static constexpr int n_nodes = mesh::n_nodes(shape);
  static constexpr int n_face_nodes = mesh::n_face_nodes(shape);

  /// Corner a of the square or cube, component i: -1 or 1.
  KOKKOS_INLINE_FUNCTION static Real corner(int a, int i) {
    const int layer = a % 4;
    if (i == 0) return layer == 1 || layer == 2 ? 1 : -1;
    if (i == 1) return layer >= 2 ? 1 : -1;
    return a >= 4 ? 1 : -1;
  }

  KOKKOS_INLINE_FUNCTION static void shape_functions(const Real (&xi)[dim], Real (&N)[n_nodes]) {
    if (is_simplex(shape)) {
      N[0] = 1;
      for (int i = 0; i < dim; ++i) {
        N[i + 1] = xi[i];
        N[0] -= xi[i];
      }
    } else {
      for (int a = 0; a < n_nodes; ++a) {
        N[a] = 1;
        for (int i = 0; i < dim; ++i) N[a] *= (1 + corner(a, i) * xi[i]) / 2;
      }
    }
  }

  KOKKOS_INLINE_FUNCTION static void gradients(const Real (&xi)[dim], Real (&dN)[n_nodes][dim]) {
    if (is_simplex(shape)) {
      for (int i = 0; i < dim; ++i) {
        dN[0][i] = -1;
        for (int a = 1; a < n_nodes; ++a) dN[a][i] = a == i + 1 ? 1 : 0;
      }
    } else {
      for (int a = 0; a < n_nodes; ++a)
        for (int j = 0; j < dim; ++j) {
          dN[a][j] = corner(a, j) / 2;
          for (int i = 0; i < dim; ++i)
            if (i != j) dN[a][j] *= (1 + corner(a, i) * xi[i]) / 2;
        }
    }
  }

  /// Face function b of a face and its reference gradient: 4 l1 l2 (triangle), 27 l1 l2 l3 (tetrahedron), the product
  /// of 1 - xi^2 over the face's directions times the linear function that is 1 on the face and 0 on the opposite one
  /// (quadrilateral, hexahedron). b vanishes on all other faces and lies outside the displacement space.
  KOKKOS_INLINE_FUNCTION static Real bubble(int face, const Real (&xi)[dim], Real (&db)[dim]) {
    if (is_simplex(shape)) {
      Real l[n_nodes], dl[n_nodes][dim];
      shape_functions(xi, l);
      gradients(xi, dl);
      const int opposite = dim == 2 ? (face + 2) % 3 : face;
      const Real scale = dim == 2 ? 4 : 27;
      Real b = scale;
      for (int i = 0; i < dim; ++i) db[i] = 0;
      for (int a = 0; a < n_nodes; ++a) {
        if (a == opposite) continue;
        b *= l[a];
        Real others = scale;
        for (int c = 0; c < n_nodes; ++c)
          if (c != a && c != opposite) others *= l[c];
        for (int i = 0; i < dim; ++i) db[i] += others * dl[a][i];
      }
      return b;
    }
    int axis;
    Real sign;
    face_axis(face, axis, sign);
    Real b = 1;
    for (int i = 0; i < dim; ++i) b *= i == axis ? (1 + sign * xi[i]) / 2 : 1 - xi[i] * xi[i];
    for (int j = 0; j < dim; ++j) {
      db[j] = j == axis ? sign / 2 : -2 * xi[j];
      for (int i = 0; i < dim; ++i)
        if (i != j) db[j] *= i == axis ? (1 + sign * xi[i]) / 2 : 1 - xi[i] * xi[i];
    }
    return b;
  }

  /// Mean of b over its (affine) face: 2/3 on edges, 9/20 on triangles, 4/9 on quadrilaterals.
  static constexpr Real bubble_mean = dim == 2 ? 2.0 / 3.0 : shape == Shape::tetrahedron ? 0.45 : 4.0 / 9.0;

  /// The coordinate direction that is constant on a face of the square or cube, and its sign there.
  KOKKOS_INLINE_FUNCTION static void face_axis(int face, int& axis, Real& sign) {
    if (dim == 3) {
      axis = face / 2;
      sign = face % 2 == 0 ? -1 : 1;
    } else {  // y-, x+, y+, x-
      axis = face % 2 == 0 ? 1 : 0;
      sign = face == 1 || face == 2 ? 1 : -1;
    }
  }
};

/// The geometry of one cell at one point: gradients in space and the volume that the point stands for.
template <Shape shape>
struct CellPoint {
  using Cell = ReferenceCell<shape>;
  static constexpr int dim = Cell::dim;
  Real inverse[dim][dim];  ///< d xi / d x
  Real volume;             ///< |det(dx/dxi)|, to be multiplied by the quadrature weight

  /// X: node coordinates [node][component], dN: reference gradients of the shape functions.
  KOKKOS_INLINE_FUNCTION CellPoint(const Real (&X)[Cell::n_nodes][dim], const Real (&dN)[Cell::n_nodes][dim]) {
    Real J[dim][dim] = {};
    for (int a = 0; a < Cell::n_nodes; ++a)
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) J[i][j] += X[a][i] * dN[a][j];
    const Real det = invert(J);
    volume = det < 0 ? -det : det;
  }

  /// Gradient in space of a function with reference gradient g.
  KOKKOS_INLINE_FUNCTION void gradient(const Real (&g)[dim], Real (&out)[dim]) const {
    for (int i = 0; i < dim; ++i) {
      out[i] = 0;
      for (int j = 0; j < dim; ++j) out[i] += g[j] * inverse[j][i];
    }
  }

 private:
  KOKKOS_INLINE_FUNCTION Real invert(const Real (&J)[2][2]) {
    const Real det = J[0][0] * J[1][1] - J[0][1] * J[1][0];
    inverse[0][0] = J[1][1] / det;
    inverse[0][1] = -J[0][1] / det;
    inverse[1][0] = -J[1][0] / det;
    inverse[1][1] = J[0][0] / det;
    return det;
  }
  KOKKOS_INLINE_FUNCTION Real invert(const Real (&J)[3][3]) {
    Real cofactor[3][3];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
        cofactor[i][j] = J[a][c] * J[b][d] - J[a][d] * J[b][c];
      }
    const Real det = J[0][0] * cofactor[0][0] + J[0][1] * cofactor[0][1] + J[0][2] * cofactor[0][2];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) inverse[j][i] = cofactor[i][j] / det;
    return det;
  }
};

}  // namespace sprekk::assembly
