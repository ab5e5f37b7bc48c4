// Nearest point of a polyhedron, compared with geometric solutions and optimality conditions.
#include "contact/least_distance.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace sprekk::contact {
namespace {

using Rows = std::vector<std::vector<Real>>;

TEST(LeastDistance, IsTheOriginWhereNothingExcludesIt) {
  const auto y = least_distance({{1, 0}, {0, 2}}, {-1, -0.5}, 2);
  ASSERT_TRUE(y);
  EXPECT_NEAR((*y)[0], 0, 1e-14);
  EXPECT_NEAR((*y)[1], 0, 1e-14);
  EXPECT_EQ(*least_distance({}, {}, 3), (std::vector<Real>{0, 0, 0}));
}

TEST(LeastDistance, IsTheFootOnAPlaneAndACornerOfTwo) {
  const auto foot = least_distance({{3, 4}}, {10}, 2);  // 10 / 5 along (3, 4) / 5
  ASSERT_TRUE(foot);
  EXPECT_NEAR((*foot)[0], 1.2, 1e-12);
  EXPECT_NEAR((*foot)[1], 1.6, 1e-12);
  const auto corner = least_distance({{1, 0}, {1, 1}, {2, 0}, {1, 0}}, {1, 3, 2, -7}, 2);  // x >= 1 twice, x + y >= 3
  ASSERT_TRUE(corner);
  EXPECT_NEAR((*corner)[0], 1.5, 1e-12);
  EXPECT_NEAR((*corner)[1], 1.5, 1e-12);
}

TEST(LeastDistance, IsNothingWhereNoPointSatisfiesAll) {
  EXPECT_FALSE(least_distance({{1, 0}, {-1, 0}}, {1, 1}, 2));
  EXPECT_FALSE(least_distance({{1, 0}, {0, 1}, {-1, -1}}, {1, 1, -1}, 2));
}

/// Checks that no other admissible point is nearer, along segments from y to many such points.
TEST(LeastDistance, IsNearestAmongMany) {
  std::mt19937 random(7);
  std::normal_distribution<Real> normal;
  for (int n : {2, 3, 6, 12})
    for (int m : {1, 5, 40}) {
      SCOPED_TRACE(testing::Message() << n << " unknowns, " << m << " rows");
      std::vector<Real> inside(n);  // an admissible point exists
      for (Real& value : inside) value = normal(random);
      Rows G(m, std::vector<Real>(n));
      std::vector<Real> h(m, 0);
      for (int k = 0; k < m; ++k) {
        for (Real& value : G[k]) value = normal(random);
        for (int i = 0; i < n; ++i) h[k] += G[k][i] * inside[i];
        h[k] -= 0.1 * std::abs(normal(random));
      }
      for (int k = 0; k < m; k += 3) {  // some rows twice
        G.push_back(G[k]);
        h.push_back(h[k]);
      }
      const auto y = least_distance(G, h, n);
      ASSERT_TRUE(y);
      for (std::size_t k = 0; k < G.size(); ++k) {
        Real value = -h[k];
        for (int i = 0; i < n; ++i) value += G[k][i] * (*y)[i];
        EXPECT_GE(value, -1e-11);
      }
      for (int trial = 0; trial < 2000; ++trial) {
        std::vector<Real> other(n);
        Real step = std::pow(10, -6 * std::generate_canonical<Real, 30>(random)), along = 0;
        for (int i = 0; i < n; ++i) other[i] = (trial % 2 ? inside[i] : (*y)[i]) + step * normal(random);
        for (std::size_t k = 0; k < G.size(); ++k) {
          Real value = -h[k];
          for (int i = 0; i < n; ++i) value += G[k][i] * other[i];
          if (value < 0) goto next;
        }
        for (int i = 0; i < n; ++i) along += (other[i] - (*y)[i]) * (*y)[i];
        EXPECT_GE(along, -1e-10);  // the angle at y is not obtuse
      next:;
      }
    }
}

}  // namespace
}  // namespace sprekk::contact
