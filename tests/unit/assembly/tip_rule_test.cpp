// Quadrature rules for functions of the square root of the distance to crack tips.
#include <gtest/gtest.h>

#include <cmath>

#include "assembly/tip_rule.hpp"

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

}  // namespace
}  // namespace sprekk::assembly
