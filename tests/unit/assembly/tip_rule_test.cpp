// Quadrature rules for functions of the square root of the distance to crack tips, and energies of such functions.
#include <gtest/gtest.h>

#include <cmath>

#include "assembly/tip_cell.hpp"
#include "laws/elasticity.hpp"
#include "unit/assembly/dense.hpp"

namespace sprekk::assembly {
namespace {

using mesh::Shape;

template <class F>
Real integral(const std::vector<RulePoint>& rule, const F& f) {
  Real sum = 0;
  for (const auto& point : rule) sum += point.weight * f(point.xi[0], point.xi[1], point.xi[2]);
  return sum;
}

Real gamma(Real x) { return std::tgamma(x); }

TEST(TipRule, IsExactOnTriangles) {
  const auto rule = tip_rule(Shape::triangle, {1, 0, 0}, 5);  // rho = x + y
  const auto over_root = [](Real power) {
    return [power](Real x, Real y, Real) { return std::pow(x, power) / std::sqrt(x + y); };
  };
  EXPECT_NEAR(integral(rule, [](Real, Real, Real) { return 1; }), 0.5, 1e-14);
  EXPECT_NEAR(integral(rule, over_root(0)), 2.0 / 3, 1e-14);
  EXPECT_NEAR(integral(rule, over_root(2)), gamma(3) / gamma(4) / 3.5, 1e-14);
}

TEST(TipRule, IsExactOnTetrahedra) {
  const auto near_corner = tip_rule(Shape::tetrahedron, {0, 1, 0, 0}, 5);  // rho = 1 - x
  EXPECT_NEAR(integral(near_corner, [](Real x, Real, Real) { return 1 / (1 - x); }), 1.0 / 4, 1e-14);
  EXPECT_NEAR(integral(near_corner, [](Real x, Real y, Real) { return y * y / std::sqrt(1 - x); }),
              gamma(3) / gamma(5) / 4.5, 1e-14);
  const auto near_edge = tip_rule(Shape::tetrahedron, {1, 1, 0, 0}, 5);  // rho = y + z
  EXPECT_NEAR(integral(near_edge, [](Real, Real, Real) { return 1; }), 1.0 / 6, 1e-14);
  EXPECT_NEAR(integral(near_edge, [](Real, Real y, Real z) { return 1 / std::sqrt(y + z); }), 4.0 / 15, 1e-14);
  EXPECT_NEAR(integral(near_edge, [](Real x, Real y, Real z) { return x / (y + z); }), 1.0 / 6, 1e-14);
}

TEST(TipRule, OfEdges) {
  EXPECT_NEAR(integral(tip_rule_of_edge({0, 1}, 4), [](Real x, Real, Real) { return 1 / std::sqrt(1 - x); }), 2, 1e-14);
}

/// rho = 1 - (1 - x)(1 - y)/4 on the square with its tip at (-1, -1). The integral of rho^(-1/2) is 4 sum c_k / (k +
/// 1)^2, with (1 - t)^(-1/2) = sum c_k t^k.
TEST(TipRule, OnSquares) {
  Real exact = 0, c = 1;
  for (int k = 0; k < 2000000; ++k) {
    exact += 4 * c / ((k + 1.0) * (k + 1.0));
    c *= (2 * k + 1.0) / (2 * k + 2.0);
  }
  for (int tip = 0; tip < 4; ++tip) {
    std::vector<char> tips(4, 0);
    tips[tip] = 1;
    const Real sx = tip == 1 || tip == 2 ? 1 : -1, sy = tip >= 2 ? 1 : -1;
    const auto rho = [&](Real x, Real y) { return 1 - (1 + sx * x) * (1 + sy * y) / 4; };
    const auto rule = tip_rule(Shape::quadrilateral, tips, 8);
    EXPECT_NEAR(integral(rule, [](Real, Real, Real) { return 1; }), 4, 1e-13);
    EXPECT_NEAR(integral(rule, [&](Real x, Real y, Real) { return 1 / std::sqrt(rho(x, y)); }), exact, 1e-8);
  }
}

/// For an edge of tips, rho = 1 - (1 - x)(1 - y)/4 does not depend on z. In cubes with one tip, rules of two orders
/// agree.
TEST(TipRule, OnCubes) {
  const auto square = tip_rule(Shape::quadrilateral, {1, 0, 0, 0}, 12);
  const auto root = [](Real x, Real y, Real) { return 1 / std::sqrt(1 - (1 - x) * (1 - y) / 4); };
  const auto edge = tip_rule(Shape::hexahedron, {1, 0, 0, 0, 1, 0, 0, 0}, 6);
  EXPECT_NEAR(integral(edge, [](Real, Real, Real) { return 1; }), 8, 1e-13);
  EXPECT_NEAR(integral(edge, root), 2 * integral(square, root), 1e-5);
  const auto corner = [](Real x, Real y, Real z) { return 1 / std::sqrt(1 - (1 - x) * (1 - y) * (1 - z) / 8); };
  const std::vector<char> tip{1, 0, 0, 0, 0, 0, 0, 0};
  EXPECT_NEAR(integral(tip_rule(Shape::hexahedron, tip, 4), corner),
              integral(tip_rule(Shape::hexahedron, tip, 12), corner), 3e-4);
  for (const auto& point : edge)
    for (int i = 0; i < 3; ++i) EXPECT_LE(std::abs(point.xi[i]), 1);
}

/// Stiffness of the nodal functions, the bubble of a face and the tip functions of one cell.
template <Shape shape>
class CellAtTip {
 public:
  using Cell = ReferenceCell<shape>;
  static constexpr int dim = Cell::dim, n = Cell::n_nodes;

  CellAtTip(const std::vector<Real>& corners, int tip) {
    mesh_.shape = shape;
    mesh_.coordinates = corners;
    mesh_.tip.assign(n, 0);
    mesh_.tip[tip] = 1;
    for (int k = 0; k < n; ++k) mesh_.cells.push_back(k);
  }

  /// Returns the smallest eigenvalue, scaled to a unit diagonal. The bubble has the stiffness of its stiffest
  /// direction.
  Real smallest_eigenvalue(int face) const {
    test::Dense K(n_functions * dim, n_functions * dim), of_bubble(dim, dim);
    for_each_cell_point<shape>(
        mesh_, 0, [&](const Real(&xi)[dim], Real volume, const auto&) { add(gradients(face, xi), volume, false, K); });
    const TipCell<shape> tip(mesh_, 0);
    tip.for_each_point([&](const Real(&xi)[dim], Real volume, const auto&, const auto& v) {
      auto all = gradients(face, xi);
      for (int a = 0; a < n; ++a) std::copy_n(v.grad_psi[a], dim, all[n + 1 + a].begin());
      add(all, volume, true, K);
    });
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) of_bubble(i, j) = K(n * dim + i, n * dim + j);
    const Real stiffest = test::eigenvalues(of_bubble).back();
    std::vector<int> used;
    for (int i = 0; i < n_functions * dim; ++i)
      if (K(i, i) > 0) used.push_back(i);
    test::Dense scaled(int(used.size()), int(used.size()));
    for (int k = 0; k < scaled.n_rows; ++k)
      for (int l = 0; l < scaled.n_rows; ++l) {
        const int i = used[k], j = used[l];
        const auto size = [&](int m) { return m / dim == n ? stiffest : K(m, m); };
        scaled(k, l) = i / dim == n && j / dim == n ? Real(i == j) : K(i, j) / std::sqrt(size(i) * size(j));
      }
    return test::eigenvalues(scaled).front();
  }

 private:
  static constexpr int n_functions = 2 * n + 1;
  using Gradients = std::array<std::array<Real, dim>, n_functions>;

  Gradients gradients(int face, const Real (&xi)[dim]) const {
    Real X[n][dim], dN[n][dim], db[dim], g[dim];
    gather_host<shape>(mesh_, 0, X);
    Cell::gradients(xi, dN);
    Cell::bubble(face, xi, db);
    const CellPoint<shape> point(X, dN);
    Gradients all{};
    for (int a = 0; a <= n; ++a) {
      point.gradient(a == n ? db : dN[a], g);
      std::copy_n(g, dim, all[a].begin());
    }
    return all;
  }

  /// Adds the products of nodal functions and bubble, or those with tip functions.
  void add(const Gradients& all, Real volume, bool of_tip, test::Dense& K) const {
    const laws::Elasticity law{1, 1};
    for (int m = 0; m < n_functions; ++m)
      for (int l = 0; l < n_functions; ++l) {
        if ((m > n || l > n) != of_tip) continue;
        Real a[dim], b[dim];
        std::copy_n(all[m].begin(), dim, a);
        std::copy_n(all[l].begin(), dim, b);
        for (int i = 0; i < dim; ++i)
          for (int j = 0; j < dim; ++j) K(m * dim + i, l * dim + j) += volume * law.stiffness(a, b, i, j);
      }
  }

  mesh::Mesh mesh_;
};

/// The rule of tip functions differs from that of nodal functions and bubbles. With four points in each direction of a
/// hexahedron with one tip, some displacements had negative energies, and open faces at such tips no equilibrium.
TEST(TipRule, EnergiesArePositive) {
  constexpr Real round_off = 1e-12;  // rigid motions have no energy
  const std::vector<Real> cube{-1, -1, -1, 1, -1, -1, 1, 1, -1, -1, 1, -1, -1, -1, 1, 1, -1, 1, 1, 1, 1, -1, 1, 1};
  const auto expect_positive = [&](const auto& cell, int n_faces, const char* name) {
    for (int face = 0; face < n_faces; ++face) EXPECT_GT(cell.smallest_eigenvalue(face), -round_off) << name << face;
  };
  for (int tip = 0; tip < 8; ++tip) expect_positive(CellAtTip<Shape::hexahedron>(cube, tip), 6, "hexahedron ");
  for (int tip = 0; tip < 4; ++tip) {
    expect_positive(CellAtTip<Shape::quadrilateral>({-1, -1, 1, -1, 1, 1, -1, 1}, tip), 4, "quadrilateral ");
    expect_positive(CellAtTip<Shape::tetrahedron>({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, tip), 4, "tetrahedron ");
  }
  for (int tip = 0; tip < 3; ++tip)
    expect_positive(CellAtTip<Shape::triangle>({0, 0, 1, 0, 0, 1}, tip), 3, "triangle ");
}

}  // namespace
}  // namespace sprekk::assembly
