#include "laws/elastic_constants.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace sprekk::laws {
namespace {

struct Constants {
  Real E, nu, G, lambda, K;
};

Constants constants(Real E, Real nu) {
  return {E, nu, E / (2 * (1 + nu)), E * nu / ((1 + nu) * (1 - 2 * nu)), E / (3 * (1 - 2 * nu))};
}

/// Returns the pair of constants with the indices i and j in (E, nu, G, lambda, K).
ElasticPair pair_of(const Constants& all, int i, int j) {
  ElasticPair pair;
  const auto give = [&](int k) {
    std::optional<Real>* const members[] = {&pair.E, &pair.nu, &pair.G, &pair.lambda, &pair.K};
    const Real values[] = {all.E, all.nu, all.G, all.lambda, all.K};
    *members[k] = values[k];
  };
  give(i);
  give(j);
  return pair;
}

TEST(LameConstants, AllTenPairsDescribeOneSolid) {
  for (const auto& all : {constants(25e9, 0.2), constants(1, 0.45), constants(3, -0.3)})
    for (int i = 0; i < 5; ++i)
      for (int j = i + 1; j < 5; ++j) {
        const auto e = lame_constants(pair_of(all, i, j));
        EXPECT_NEAR(e.G, all.G, 1e-12 * all.E) << i << ", " << j;
        EXPECT_NEAR(e.lambda, all.lambda, 1e-12 * all.E) << i << ", " << j;
        EXPECT_NEAR(e.youngs_modulus(), all.E, 1e-12 * all.E);
      }
}

std::string error_of(const ElasticPair& pair) {
  try {
    lame_constants(pair);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(LameConstants, RefuseAnyOtherNumberOfConstants) {
  ElasticPair pair;
  EXPECT_NE(error_of(pair).find("0 elastic constants"), std::string::npos);
  pair.E = 1;
  EXPECT_NE(error_of(pair).find("1 elastic constants"), std::string::npos);
  pair.nu = 0.2;
  EXPECT_EQ(error_of(pair), "");
  pair.K = 1;
  EXPECT_NE(error_of(pair).find("3 elastic constants"), std::string::npos);
}

TEST(LameConstants, RefuseSolidsThatAreNotStable) {
  const auto refused = [](const Constants& all, int i, int j) { return !error_of(pair_of(all, i, j)).empty(); };
  for (int other : {0, 2, 3, 4}) EXPECT_TRUE(refused({1, 0.5, 1, 1, 1}, 1, other)) << other;  // incompressible
  EXPECT_TRUE(refused({1, 0.6, 0, 0, 0}, 0, 1));
  EXPECT_TRUE(refused({1, -1.1, 0, 0, 0}, 0, 1));
  EXPECT_TRUE(refused({-1, 0.2, 0, 0, 0}, 0, 1));
  EXPECT_TRUE(refused({4, 0, 1, 0, 0}, 0, 2));   // E > 3 G
  EXPECT_TRUE(refused({10, 0, 0, 0, 1}, 0, 4));  // E > 9 K
  EXPECT_TRUE(refused({0, 0, 3, -2, 0}, 2, 3));  // K = 0
  EXPECT_TRUE(refused({0, 0, -1, 3, 0}, 2, 3));
  EXPECT_TRUE(refused({0, 0, 0, 2, 1}, 3, 4));  // G < 0
  EXPECT_TRUE(refused({0, 0, 0, 0, 0}, 1, 3));  // nu = 0 does not determine G
}

template <int dim>
void expect_consistent() {
  const Elasticity law{2, 3};
  const Real a_all[] = {0.3, -1.2, 0.7}, b_all[] = {1.1, 0.4, -0.5};
  Real a[dim], b[dim];
  std::copy_n(a_all, dim, a);
  std::copy_n(b_all, dim, b);
  Real M[dim][dim], K[dim][dim];
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) M[i][j] = a[i] * b[j];
  law.stiffness(M, K);
  for (int j = 0; j < dim; ++j) {
    Real H[dim][dim] = {}, sigma[dim][dim];
    for (int k = 0; k < dim; ++k) H[j][k] = b[k];  // gradient of e_j times a function with gradient b
    law.stress(H, sigma);
    for (int i = 0; i < dim; ++i) {
      Real product = 0;
      for (int k = 0; k < dim; ++k) product += sigma[i][k] * a[k];
      EXPECT_NEAR(law.stiffness(a, b, i, j), product, 1e-14);
      EXPECT_NEAR(K[i][j], product, 1e-14);
      EXPECT_NEAR(law.stiffness(a, b, i, j), law.stiffness(b, a, j, i), 1e-14);
      for (int k = 0; k < dim; ++k) EXPECT_EQ(sigma[i][k], sigma[k][i]);
    }
  }
}

TEST(Elasticity, StiffnessIsTheDerivativeOfTheStress) {
  expect_consistent<2>();
  expect_consistent<3>();
}

TEST(Elasticity, StressOfKnownStrains) {
  const Elasticity law{2, 3};
  Real sigma[3][3];
  law.stress<3>({{0.1, 0, 0}, {0, 0, 0}, {0, 0, 0}}, sigma);
  EXPECT_DOUBLE_EQ(sigma[0][0], 0.7);  // (lambda + 2 G) eps
  EXPECT_DOUBLE_EQ(sigma[1][1], 0.3);
  law.stress<3>({{0, 0.1, 0}, {-0.1, 0, 0}, {0, 0, 0}}, sigma);  // a rotation
  for (const auto& row : sigma)
    for (Real value : row) EXPECT_EQ(value, 0);
  law.stress<3>({{0, 0, 0.1}, {0, 0, 0}, {0, 0, 0}}, sigma);
  EXPECT_DOUBLE_EQ(sigma[0][2], 0.2);
  EXPECT_DOUBLE_EQ(sigma[2][0], 0.2);
  EXPECT_EQ(sigma[0][0], 0);
}

}  // namespace
}  // namespace sprekk::laws
