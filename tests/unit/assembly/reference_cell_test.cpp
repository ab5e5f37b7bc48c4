#include "assembly/reference_cell.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/check.hpp"
#include "unit/assembly/dense.hpp"

namespace sprekk::assembly {
namespace {

template <Shape s>
struct ShapeTag {
  static constexpr Shape shape = s;
};

template <class Tag>
class ReferenceCells : public ::testing::Test {
 public:
  static constexpr Shape shape = Tag::shape;
  using Cell = ReferenceCell<shape>;
  static constexpr int dim = Cell::dim, n = Cell::n_nodes;
  using Point = Real[dim];

  static void node(int a, Point& xi) {
    constexpr int square[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                  {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};
    for (int i = 0; i < dim; ++i) xi[i] = is_simplex(shape) ? (a == i + 1 ? 1 : 0) : square[a][i];
  }

  /// Sets xi to the pseudo-random point k inside the cell.
  static void inside(int k, Point& xi) {
    for (int i = 0; i < dim; ++i) {
      const Real random = test::pseudo_random(k, i);
      xi[i] = is_simplex(shape) ? (1 + random) / (2 * dim) : random;
    }
  }

  /// Sets xi to a point of a face by weights of its corners, bilinear for four corners.
  static void on_face(int face, Real s, Real t, Point& xi) {
    const auto corners = mesh::face_nodes(shape)[face];
    const int m = mesh::n_face_nodes(shape);
    const Real triangle[] = {1 - s - t * (1 - s), s, t * (1 - s)};
    const Real square[] = {(1 - s) * (1 - t), s * (1 - t), s * t, (1 - s) * t};
    const Real edge[] = {1 - s, s};
    for (int i = 0; i < dim; ++i) xi[i] = 0;
    for (int k = 0; k < m; ++k) {
      Point corner;
      node(corners[k], corner);
      const Real weight = m == 2 ? edge[k] : m == 3 ? triangle[k] : square[k];
      for (int i = 0; i < dim; ++i) xi[i] += weight * corner[i];
    }
  }
};

using Shapes = ::testing::Types<ShapeTag<Shape::triangle>, ShapeTag<Shape::quadrilateral>, ShapeTag<Shape::tetrahedron>,
                                ShapeTag<Shape::hexahedron>>;
TYPED_TEST_SUITE(ReferenceCells, Shapes, );

TYPED_TEST(ReferenceCells, ShapeFunctionsAreOneAtTheirNodeAndZeroAtOthers) {
  for (int a = 0; a < this->n; ++a) {
    Real xi[TestFixture::dim], N[TestFixture::n];
    this->node(a, xi);
    TestFixture::Cell::shape_functions(xi, N);
    for (int b = 0; b < this->n; ++b) EXPECT_DOUBLE_EQ(N[b], a == b ? 1 : 0);
  }
}

TYPED_TEST(ReferenceCells, ShapeFunctionsReproduceLinearFunctions) {
  constexpr int dim = TestFixture::dim, n = TestFixture::n;
  for (int k = 0; k < 20; ++k) {
    Real xi[dim], corner[dim], N[n], dN[n][dim];
    this->inside(k, xi);
    TestFixture::Cell::shape_functions(xi, N);
    TestFixture::Cell::gradients(xi, dN);
    Real one = 0, x[dim] = {}, d_one[dim] = {}, dx[dim][dim] = {};
    for (int a = 0; a < n; ++a) {
      this->node(a, corner);
      one += N[a];
      for (int i = 0; i < dim; ++i) {
        x[i] += N[a] * corner[i];
        d_one[i] += dN[a][i];
        for (int j = 0; j < dim; ++j) dx[i][j] += corner[i] * dN[a][j];
      }
    }
    EXPECT_NEAR(one, 1, 1e-14);
    for (int i = 0; i < dim; ++i) {
      EXPECT_NEAR(x[i], xi[i], 1e-14);
      EXPECT_NEAR(d_one[i], 0, 1e-14);
      for (int j = 0; j < dim; ++j) EXPECT_NEAR(dx[i][j], i == j ? 1 : 0, 1e-14);
    }
  }
}

TYPED_TEST(ReferenceCells, GradientsAreDerivatives) {
  constexpr int dim = TestFixture::dim, n = TestFixture::n;
  using Cell = typename TestFixture::Cell;
  const Real h = 1e-5;
  for (int k = 0; k < 10; ++k)
    for (int i = 0; i < dim; ++i) {
      Real xi[dim], N[2][n], dN[n][dim], db[dim], none[dim], b[2];
      for (int sign : {0, 1}) {
        this->inside(k, xi);
        xi[i] += sign ? h : -h;
        Cell::shape_functions(xi, N[sign]);
      }
      this->inside(k, xi);
      Cell::gradients(xi, dN);
      for (int a = 0; a < n; ++a) EXPECT_NEAR(dN[a][i], (N[1][a] - N[0][a]) / (2 * h), 1e-9);
      for (int face = 0; face < mesh::n_faces(this->shape); ++face) {
        for (int sign : {0, 1}) {
          this->inside(k, xi);
          xi[i] += sign ? h : -h;
          b[sign] = Cell::bubble(face, xi, none);
        }
        this->inside(k, xi);
        Cell::bubble(face, xi, db);
        EXPECT_NEAR(db[i], (b[1] - b[0]) / (2 * h), 1e-8);
      }
    }
}

TYPED_TEST(ReferenceCells, BubbleVanishesOnTheOtherFacesAndAtAllNodes) {
  Real xi[TestFixture::dim], db[TestFixture::dim];
  for (int face = 0; face < mesh::n_faces(this->shape); ++face) {
    for (int other = 0; other < mesh::n_faces(this->shape); ++other) {
      this->on_face(other, 0.3, 0.6, xi);
      const Real b = TestFixture::Cell::bubble(face, xi, db);
      if (face == other)
        EXPECT_GT(b, 0.1);
      else
        EXPECT_NEAR(b, 0, 1e-15);
    }
    for (int a = 0; a < this->n; ++a) {
      this->node(a, xi);
      EXPECT_NEAR(TestFixture::Cell::bubble(face, xi, db), 0, 1e-15);
    }
  }
}

TYPED_TEST(ReferenceCells, BubbleHasItsMeanOnItsFace) {
  for (int face = 0; face < mesh::n_faces(this->shape); ++face) {
    Real sum = 0, area = 0, xi[TestFixture::dim], db[TestFixture::dim];
    for (int p = 0; p < 4; ++p)
      for (int q = 0; q < 4; ++q) {  // (s, t (1 - s)) covers the triangle with Jacobian 1 - s
        const Real s = (1 + Gauss<4>::point(p)) / 2, t = (1 + Gauss<4>::point(q)) / 2;
        const Real weight = Gauss<4>::weight(p) * Gauss<4>::weight(q) * (this->shape == Shape::tetrahedron ? 1 - s : 1);
        this->on_face(face, s, t, xi);
        sum += weight * TestFixture::Cell::bubble(face, xi, db);
        area += weight;
      }
    EXPECT_NEAR(sum / area,
                TestFixture::dim == 2               ? 2.0 / 3
                : this->shape == Shape::tetrahedron ? 0.45
                                                    : 4.0 / 9,
                1e-14);
  }
}

/// Returns the integral of x^a y^b z^c over the reference cell.
Real exact_integral(Shape shape, int a, int b, int c) {
  const int dim = mesh::dimension(shape);
  if (is_simplex(shape))
    return std::tgamma(a + 1) * std::tgamma(b + 1) * std::tgamma(c + 1) / std::tgamma(a + b + c + dim + 1);
  Real product = 1;
  for (int power : {a, b, dim == 3 ? c : -1}) product *= power < 0 ? 1 : power % 2 ? 0 : 2.0 / (power + 1);
  return product;
}

template <class Rule>
Real integrate(int a, int b, int c) {
  Real sum = 0, xi[Rule::dim];
  for (int q = 0; q < Rule::n; ++q) {
    const Real weight = Rule::at(q, xi);
    sum += weight * std::pow(xi[0], a) * std::pow(xi[1], b) * (Rule::dim == 3 ? std::pow(xi[Rule::dim - 1], c) : 1);
  }
  return sum;
}

/// Checks all monomials of the degree (simplices: total degree, else: per direction), and that degree + 1 is not
/// exact.
template <class Rule>
void expect_exact_to(Shape shape, int degree) {
  const int last = Rule::dim == 3 ? degree : 0;
  for (int a = 0; a <= degree; ++a)
    for (int b = 0; b <= degree; ++b)
      for (int c = 0; c <= last; ++c)
        if (!is_simplex(shape) || a + b + c <= degree) {
          EXPECT_NEAR(integrate<Rule>(a, b, c), exact_integral(shape, a, b, c), 1e-14) << a << b << c;
        }
  Real error = 0;
  for (int a = 0; a <= degree + 1; ++a)
    error =
        std::max(error, std::abs(integrate<Rule>(a, degree + 1 - a, 0) - exact_integral(shape, a, degree + 1 - a, 0)));
  EXPECT_GT(error, 1e-8) << "degree " << degree + 1;
}

TYPED_TEST(ReferenceCells, QuadratureIsExactForTheDegreesItClaims) {
  constexpr Shape shape = TestFixture::shape;
  const int dim = TestFixture::dim;
  const auto degree = [&](int points) { return is_simplex(shape) ? 2 * points - dim : 2 * points - 1; };
  expect_exact_to<Quadrature<shape, 2>>(shape, degree(2));
  expect_exact_to<Quadrature<shape, 3>>(shape, degree(3));
  expect_exact_to<Quadrature<shape, 4>>(shape, degree(4));
  expect_exact_to<Quadrature<shape, 6>>(shape, degree(6));
  if (is_simplex(shape)) expect_exact_to<CentroidRule<shape>>(shape, 1);
}

/// Gradients and volumes of an affine image x = F xi + x0 of the reference cell.
TYPED_TEST(ReferenceCells, CellPointOfAnAffineCell) {
  constexpr int dim = TestFixture::dim, n = TestFixture::n;
  const Real F[3][3] = {{2, 0.3, -0.4}, {-0.5, 1.5, 0.2}, {0.1, 0.6, 0.9}};
  const Real det = dim == 2
                       ? 2 * 1.5 + 0.3 * 0.5
                       : 2 * (1.5 * 0.9 - 0.2 * 0.6) - 0.3 * (-0.5 * 0.9 - 0.2 * 0.1) - 0.4 * (-0.5 * 0.6 - 1.5 * 0.1);
  Real X[n][dim], xi[dim], dN[n][dim], gradient[dim], sum[dim][dim] = {};
  for (int a = 0; a < n; ++a) {
    this->node(a, xi);
    for (int i = 0; i < dim; ++i) {
      X[a][i] = 7 - i;
      for (int j = 0; j < dim; ++j) X[a][i] += F[i][j] * xi[j];
    }
  }
  EXPECT_TRUE(TestFixture::Cell::is_affine(X));
  for (int a = 1; a < n; ++a)
    for (int i = 0; i < dim; ++i) {
      X[a][i] += 1e-8;
      EXPECT_EQ(TestFixture::Cell::is_affine(X), is_simplex(TestFixture::shape)) << a;
      X[a][i] -= 1e-8;
    }
  this->inside(3, xi);
  TestFixture::Cell::gradients(xi, dN);
  const CellPoint<TestFixture::shape> point(X, dN);
  EXPECT_NEAR(point.volume, det, 1e-14);
  for (int a = 0; a < n; ++a) {
    point.gradient(dN[a], gradient);
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) sum[i][j] += X[a][i] * gradient[j];  // gradient of x is the identity
  }
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) EXPECT_NEAR(sum[i][j], i == j ? 1 : 0, 1e-14);
}

}  // namespace
}  // namespace sprekk::assembly
