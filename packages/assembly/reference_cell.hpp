// Shape functions, face bubbles and quadrature of the reference cells; device code.
//
// Simplices: {xi >= 0, sum xi <= 1}. Quadrilaterals and hexahedra: [-1, 1]^dim. Nodes and faces: see shape.hpp.
#pragma once

#include "base/view.hpp"
#include "mesh/shape.hpp"

#include <type_traits>

namespace sprekk::assembly {

using mesh::Shape;

using mesh::is_simplex;

/// Gauss rule with n points on [-1, 1], exact for degree 2n - 1.
template <int n>
struct Gauss {
  static_assert((n >= 1 && n <= 4) || n == 6, "rules with 1 to 4 and 6 points");
  KOKKOS_INLINE_FUNCTION static Real point(int i) {
    if (n == 1) return 0;
    if (n == 2) return i == 0 ? -0.57735026918962576451 : 0.57735026918962576451;
    if (n == 3) return (i - 1) * 0.77459666924148337704;
    if (n == 6) {
      const Real half[] = {0.23861918608319690863, 0.66120938646626451366, 0.93246951420315202781};
      return i < 3 ? -half[2 - i] : half[i - 3];
    }
    const Real inner = 0.33998104358485626480, outer = 0.86113631159405257522;
    return i == 0 ? -outer : i == 1 ? -inner : i == 2 ? inner : outer;
  }
  KOKKOS_INLINE_FUNCTION static Real weight(int i) {
    if (n == 1) return 2;
    if (n == 2) return 1;
    if (n == 3) return i == 1 ? 8.0 / 9.0 : 5.0 / 9.0;
    if (n == 6) {
      const Real half[] = {0.46791393457269104739, 0.36076157304813860757, 0.17132449237917034504};
      return half[i < 3 ? 2 - i : i - 3];
    }
    return i == 1 || i == 2 ? 0.65214515486254614263 : 0.34785484513745385737;
  }
};

/// Product of Gauss rules with points^dim points, exact for degree 2 points - 1 in each direction. On simplices, the
/// points are collapsed towards a vertex (conical product); the rule is exact for total degree 2 points - dim.
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
    Real rest = 1;  // 1 - sum of the coordinates so far
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

/// Rule with one point at the centroid of a simplex, exact for degree 1.
template <Shape shape>
struct CentroidRule {
  static constexpr int dim = mesh::dimension(shape);
  static constexpr int n = 1;

  KOKKOS_INLINE_FUNCTION static Real at(int, Real (&xi)[dim]) {
    for (int i = 0; i < dim; ++i) xi[i] = 1.0 / (dim + 1);
    return dim == 2 ? 1.0 / 2.0 : 1.0 / 6.0;
  }
};

/// Rule that is exact for the stiffness of affine cells: degree 2 (order - 1) on simplices, else 2 order per direction.
template <Shape shape>
using StiffnessQuadrature =
    std::conditional_t<is_simplex(shape) && mesh::order(shape) == 1, CentroidRule<shape>,
                       Quadrature<shape, is_simplex(shape) ? mesh::dimension(shape) : mesh::order(shape) + 1>>;

/// Rule that is exact on affine cells for products of bubble gradients, and for loads of degree 2 times bubbles.
template <Shape shape>
using BubbleQuadrature =
    Quadrature<shape, mesh::linear(shape) == Shape::tetrahedron || mesh::order(shape) == 2 ? 4 : 3>;

/// Lagrange functions of order 1 or 2, and face bubbles. Simplices, in barycentric coordinates l: corners l (order 1)
/// or l (2 l - 1), edges 4 l_a l_b. Quadrilaterals and hexahedra: products of the functions on [-1, 1] with the nodes
/// -1, 1 (order 1) or -1, 0, 1.
template <Shape shape>
struct ReferenceCell {
  static constexpr int dim = mesh::dimension(shape);
  static constexpr int order = mesh::order(shape);
  static constexpr int n_nodes = mesh::n_nodes(shape);
  static constexpr int n_corners = mesh::n_corners(shape);
  static constexpr int n_face_nodes = mesh::n_face_nodes(shape);

  KOKKOS_INLINE_FUNCTION static void shape_functions(const Real (&xi)[dim], Real (&N)[n_nodes]) {
    if constexpr (is_simplex(shape)) {
      Real l[dim + 1];
      barycentric(xi, l);
      for (int a = 0; a <= dim; ++a) N[a] = order == 1 ? l[a] : l[a] * (2 * l[a] - 1);
      for (int e = 0; e < n_nodes - n_corners; ++e) N[n_corners + e] = 4 * l[edge(e, 0)] * l[edge(e, 1)];
    } else {
      for (int a = 0; a < n_nodes; ++a) {
        N[a] = 1;
        for (int i = 0; i < dim; ++i) N[a] *= lagrange(node_place(a, i), xi[i]);
      }
    }
  }

  KOKKOS_INLINE_FUNCTION static void gradients(const Real (&xi)[dim], Real (&dN)[n_nodes][dim]) {
    if constexpr (is_simplex(shape)) {
      Real l[dim + 1];
      barycentric(xi, l);
      for (int i = 0; i < dim; ++i) {
        for (int a = 0; a <= dim; ++a) dN[a][i] = dl(a, i) * (order == 1 ? 1 : 4 * l[a] - 1);
        for (int e = 0; e < n_nodes - n_corners; ++e) {
          const int a = edge(e, 0), b = edge(e, 1);
          dN[n_corners + e][i] = 4 * (dl(a, i) * l[b] + l[a] * dl(b, i));
        }
      }
    } else {
      for (int a = 0; a < n_nodes; ++a)
        for (int j = 0; j < dim; ++j) {
          dN[a][j] = lagrange_derivative(node_place(a, j), xi[j]);
          for (int i = 0; i < dim; ++i)
            if (i != j) dN[a][j] *= lagrange(node_place(a, i), xi[i]);
        }
    }
  }

  /// Returns the bubble b of a face and sets its reference gradient. On its face, b is 4 l1 l2 (edge), 27 l1 l2 l3
  /// (triangle) or the product of 1 - xi^2 (edge, quadrilateral). b vanishes on all other faces and lies outside the
  /// space of the shape functions:
  ///   triangle 4 l1 l2, of order 2: 4 l1 l2 (1 - l3);  tetrahedron 27 l1 l2 l3;
  ///   else the product of 1 - xi^2 along the face times s (order 1) or s^3 (order 2), with s = 1 on the face and 0
  ///   opposite.
  KOKKOS_INLINE_FUNCTION static Real bubble(int face, const Real (&xi)[dim], Real (&db)[dim]) {
    if constexpr (is_simplex(shape))
      return simplex_bubble(face, xi, db);
    else
      return product_bubble(face, xi, db);
  }

  /// Sets xi to the centre of the reference cell.
  KOKKOS_INLINE_FUNCTION static void centre(Real (&xi)[dim]) {
    for (int i = 0; i < dim; ++i) xi[i] = is_simplex(shape) ? 1.0 / (dim + 1) : 0;
  }

  /// Returns whether all nodes except the corners have the positions of a cell with straight sides (to 1e-6 of an
  /// edge).
  KOKKOS_INLINE_FUNCTION static bool is_straight(const Real (&X)[n_nodes][dim]) {
    Real size = 0;
    for (int i = 0; i < dim; ++i) size += (X[1][i] - X[0][i]) * (X[1][i] - X[0][i]);
    for (int a = n_corners; a < n_nodes; ++a) {
      Real square = 0;
      for (int i = 0; i < dim; ++i) {
        Real off = X[a][i] - X[0][i];
        for (int c = 1; c < n_corners; ++c) off -= corner_share(a, c) * (X[c][i] - X[0][i]);
        square += off * off;
      }
      if (square > 1e-12 * size) return false;
    }
    return true;
  }

  /// Returns whether the cell is an affine map of the reference cell (to 1e-10 of an edge).
  KOKKOS_INLINE_FUNCTION static bool is_affine(const Real (&X)[n_nodes][dim]) {
    Real size = 0;
    for (int i = 0; i < dim; ++i) size += (X[1][i] - X[0][i]) * (X[1][i] - X[0][i]);
    for (int a = 2; a < n_nodes; ++a) {
      Real square = 0;
      for (int i = 0; i < dim; ++i) {
        Real off = X[a][i] - X[0][i];
        for (int k = 0; k < dim; ++k) off -= axis_share(a, k) * (X[axis(k)][i] - X[0][i]);
        square += off * off;
      }
      if (square > 1e-20 * size) return false;
    }
    return true;
  }

  /// Returns component i of a corner of the reference cell.
  KOKKOS_INLINE_FUNCTION static int corner(int a, int i) { return is_simplex(shape) ? a == i + 1 : node_place(a, i); }

  /// Returns the order-1 shape function of corner c at node a, which is not a corner.
  KOKKOS_INLINE_FUNCTION static Real corner_share(int a, int c) {
    if (is_simplex(shape)) return edge(a - n_corners, 0) == c || edge(a - n_corners, 1) == c ? 0.5 : 0;
    Real share = 1;
    for (int i = 0; i < dim; ++i) share *= (1 + node_place(a, i) * node_place(c, i)) / 2.0;
    return share;
  }

 private:
  KOKKOS_INLINE_FUNCTION static void barycentric(const Real (&xi)[dim], Real (&l)[dim + 1]) {
    l[0] = 1;
    for (int i = 0; i < dim; ++i) {
      l[i + 1] = xi[i];
      l[0] -= xi[i];
    }
  }
  /// d l_a / d xi_i
  KOKKOS_INLINE_FUNCTION static Real dl(int a, int i) { return a == 0 ? -1 : a == i + 1 ? 1 : 0; }

  /// Returns corner `end` (0, 1) of the simplex edge with the node n_corners + e.
  KOKKOS_INLINE_FUNCTION static int edge(int e, int end) {
    static constexpr int triangle[][2] = {{0, 1}, {1, 2}, {2, 0}};
    static constexpr int tetrahedron[][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
    return dim == 2 ? triangle[e][end] : tetrahedron[e][end];
  }

  /// Returns component i of a node of the square or cube: -1, 0 or 1.
  KOKKOS_INLINE_FUNCTION static int node_place(int a, int i) {
    static constexpr int square[][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}, {0, -1}, {1, 0}, {0, 1}, {-1, 0}, {0, 0}};
    static constexpr int cube[][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1},  {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1},
                                      {1, 1, 1},    {-1, 1, 1},  {0, -1, -1}, {1, 0, -1},  {0, 1, -1},  {-1, 0, -1},
                                      {0, -1, 1},   {1, 0, 1},   {0, 1, 1},   {-1, 0, 1},  {-1, -1, 0}, {1, -1, 0},
                                      {1, 1, 0},    {-1, 1, 0},  {-1, 0, 0},  {1, 0, 0},   {0, -1, 0},  {0, 1, 0},
                                      {0, 0, -1},   {0, 0, 1},   {0, 0, 0}};
    return dim == 2 ? square[a][i] : cube[a][i];
  }

  /// axis: corner next to corner 0 along axis k. axis_share: position of node a along this edge, 0, 1/2 or 1.
  KOKKOS_INLINE_FUNCTION static int axis(int k) { return is_simplex(shape) || k == 0 ? k + 1 : k + 2; }
  KOKKOS_INLINE_FUNCTION static Real axis_share(int a, int k) {
    if (!is_simplex(shape)) return (1 + node_place(a, k)) / 2.0;
    return a < n_corners ? a == k + 1 : corner_share(a, k + 1);
  }

  /// Returns the Lagrange function on [-1, 1] that is 1 at `place` and 0 at the other nodes.
  KOKKOS_INLINE_FUNCTION static Real lagrange(int place, Real x) {
    if (order == 1) return (1 + place * x) / 2;
    return place == 0 ? 1 - x * x : x * (x + place) / 2;
  }
  KOKKOS_INLINE_FUNCTION static Real lagrange_derivative(int place, Real x) {
    if (order == 1) return place / 2.0;
    return place == 0 ? -2 * x : x + place / 2.0;
  }

  KOKKOS_INLINE_FUNCTION static Real simplex_bubble(int face, const Real (&xi)[dim], Real (&db)[dim]) {
    Real l[dim + 1];
    barycentric(xi, l);
    const int opposite = dim == 2 ? (face + 2) % 3 : face;
    Real b = dim == 2 ? 4 : 27;  // product of the l of the face
    for (int i = 0; i < dim; ++i) db[i] = 0;
    for (int a = 0; a <= dim; ++a) {
      if (a == opposite) continue;
      Real others = dim == 2 ? 4 : 27;
      for (int c = 0; c <= dim; ++c)
        if (c != a && c != opposite) others *= l[c];
      b *= l[a];
      for (int i = 0; i < dim; ++i) db[i] += others * dl(a, i);
    }
    if (order == 1 || dim == 3) return b;
    const Real s = 1 - l[opposite];
    for (int i = 0; i < dim; ++i) db[i] = db[i] * s - b * dl(opposite, i);
    return b * s;
  }

  KOKKOS_INLINE_FUNCTION static Real product_bubble(int face, const Real (&xi)[dim], Real (&db)[dim]) {
    const int axis = dim == 3 ? face / 2 : face % 2 == 0 ? 1 : 0;  // 2D: y-, x+, y+, x-
    const Real sign = dim == 3 ? (face % 2 == 0 ? -1 : 1) : (face == 1 || face == 2 ? 1 : -1);
    const Real s = (1 + sign * xi[axis]) / 2;
    Real factor[dim], slope[dim], b = 1;
    for (int i = 0; i < dim; ++i) {
      factor[i] = 1 - xi[i] * xi[i];
      slope[i] = -2 * xi[i];
    }
    factor[axis] = order == 1 ? s : s * s * s;
    slope[axis] = sign / 2 * (order == 1 ? 1 : 3 * s * s);
    for (int i = 0; i < dim; ++i) b *= factor[i];
    for (int j = 0; j < dim; ++j) {
      db[j] = slope[j];
      for (int i = 0; i < dim; ++i)
        if (i != j) db[j] *= factor[i];
    }
    return b;
  }
};

/// Quadrature of cells that are not straight, see is_straight(); most of them are at crack tips. The rule has n_1d
/// points in each direction of a simplex, of the 2 triangles of a quadrilateral, or of a hexahedron. On triangles and
/// tetrahedra it collapses towards the tip corners (3D: at most two), which have quarter points on all their edges.
/// There, stiffness integrands are smooth in the coordinates of the rule, in triangles polynomials; see
/// move_to_quarter_points(). Hexahedra use the product rule. Rules on parts of a hexahedron would need 8 points for the
/// divergence theorem, and thus for exact linear fields.
template <Shape shape, int n_1d = 6>
class CurvedQuadrature {
 public:
  using Cell = ReferenceCell<shape>;
  static constexpr int dim = Cell::dim, n_pieces = dim == 2 && !is_simplex(shape) ? 2 : 1;
  static constexpr bool collapses = dim == 2 || is_simplex(shape);
  using Rule = Quadrature<!collapses ? shape : dim == 2 ? Shape::triangle : Shape::tetrahedron, n_1d>;
  static constexpr int n = n_pieces * Rule::n;

  /// X: node coordinates [node][component].
  KOKKOS_INLINE_FUNCTION explicit CurvedQuadrature(const Real (&X)[Cell::n_nodes][dim]) {
    if (!collapses) return;
    bool is_tip[Cell::n_corners] = {};
    for (int a = Cell::n_corners; a < Cell::n_nodes; ++a) {
      int ends[2], n_ends = 0;
      for (int c = 0; c < Cell::n_corners; ++c)
        if (Cell::corner_share(a, c) == 0.5) ends[n_ends++] = c;
      if (n_ends < 2) continue;  // node inside a face or the cell
      Real square[2] = {};       // squared distances from the ends
      for (int end = 0; end < 2; ++end)
        for (int i = 0; i < dim; ++i) square[end] += (X[a][i] - X[ends[end]][i]) * (X[a][i] - X[ends[end]][i]);
      for (int end = 0; end < 2; ++end)
        if (square[end] < square[1 - end] / 4) is_tip[ends[end]] = true;
    }
    for (int piece = 0; piece < n_pieces; ++piece)
      for (int pass = 0, next = 0; pass < 2; ++pass)
        for (int k = 0; k <= dim; ++k)
          if (is_tip[corner(piece, k)] == (pass == 0)) corner_[piece][next++] = corner(piece, k);
  }

  /// Sets xi to point q and returns its weight on the reference cell.
  KOKKOS_INLINE_FUNCTION Real at(int q, Real (&xi)[dim]) const {
    if (!collapses) return Rule::at(q, xi);
    Real l[dim];
    const Real weight = Rule::at(q % Rule::n, l) * (is_simplex(shape) ? 1 : 4);
    const int* corner = corner_[q / Rule::n];
    for (int i = 0; i < dim; ++i) {
      xi[i] = Cell::corner(corner[dim], i);
      for (int k = 0; k < dim; ++k) xi[i] += l[k] * (Cell::corner(corner[k], i) - Cell::corner(corner[dim], i));
    }
    return weight;
  }

 private:
  /// Returns corner k of a piece. Pieces of a quadrilateral: 0, 1, 2 and 0, 3, 2.
  KOKKOS_INLINE_FUNCTION static int corner(int piece, int k) { return piece == 1 && k == 1 ? 3 : k; }

  int corner_[n_pieces][dim + 1];  // [piece] corners in the order of the rule, apex first
};

/// Geometry of a cell at one point: spatial gradients, and the volume factor of the point.
template <Shape shape>
struct CellPoint {
  using Cell = ReferenceCell<shape>;
  static constexpr int dim = Cell::dim;
  Real inverse[dim][dim];  ///< d xi / d x
  Real determinant;        ///< det(dx/dxi)
  Real volume;             ///< |determinant|, to be multiplied by the quadrature weight

  /// X: node coordinates [node][component]. dN: reference gradients of the shape functions. The gradients sum to zero,
  /// so X is taken relative to the first node. This avoids cancellation far from the origin.
  KOKKOS_INLINE_FUNCTION CellPoint(const Real (&X)[Cell::n_nodes][dim], const Real (&dN)[Cell::n_nodes][dim]) {
    Real J[dim][dim] = {};
    for (int a = 1; a < Cell::n_nodes; ++a)
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) J[i][j] += (X[a][i] - X[0][i]) * dN[a][j];
    determinant = invert(J);
    volume = determinant < 0 ? -determinant : determinant;
  }

  /// Computes the spatial gradient of a function from its reference gradient g.
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
