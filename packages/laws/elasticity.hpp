// Isotropic linear elasticity: sigma = 2 G eps + lambda tr(eps) I, in 2D plane strain; Wollmann (2024), (5), tension
// positive.
#pragma once

#include "base/check.hpp"
#include "base/types.hpp"

#include <cmath>
#include <optional>

namespace sprekk::laws {

/// Lame's constants, Pa.
struct Elasticity {
  Real G = 0;       ///< shear modulus
  Real lambda = 0;  ///< Lame's first parameter

  Real youngs_modulus() const { return G * (3 * lambda + 2 * G) / (lambda + G); }

  /// sigma = 2 G eps + lambda tr(eps) I for the displacement gradient H_ij = du_i/dx_j. [dim, dim], Pa.
  template <int dim>
  KOKKOS_INLINE_FUNCTION void stress(const Real (&H)[dim][dim], Real (&sigma)[dim][dim]) const {
    Real trace = 0;
    for (int i = 0; i < dim; ++i) trace += H[i][i];
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) sigma[i][j] = G * (H[i][j] + H[j][i]) + (i == j ? lambda * trace : 0);
  }

  /// The stiffness that ties the gradients a, b of two shape functions, for components i, j:
  /// lambda a_i b_j + G (a_j b_i + delta_ij a.b).
  template <int dim>
  KOKKOS_INLINE_FUNCTION Real stiffness(const Real (&a)[dim], const Real (&b)[dim], int i, int j) const {
    Real dot = 0;
    if (i == j)
      for (int k = 0; k < dim; ++k) dot += a[k] * b[k];
    return lambda * a[i] * b[j] + G * (a[j] * b[i] + dot);
  }
  /// The same for integrals M_ij of a_i b_j, for all i, j.
  template <int dim>
  KOKKOS_INLINE_FUNCTION void stiffness(const Real (&M)[dim][dim], Real (&K)[dim][dim]) const {
    Real trace = 0;
    for (int k = 0; k < dim; ++k) trace += M[k][k];
    for (int i = 0; i < dim; ++i) {
      for (int j = 0; j < dim; ++j) K[i][j] = lambda * M[i][j] + G * M[j][i];
      K[i][i] += G * trace;
    }
  }
};

/// Any two of Young's modulus E, Poisson's ratio nu, shear modulus G, Lame's first parameter, bulk modulus K.
struct ElasticPair {
  std::optional<Real> E, nu, G, lambda, K;

  int count() const { return E.has_value() + nu.has_value() + G.has_value() + lambda.has_value() + K.has_value(); }
};

/// Lame's constants from exactly two given constants. Throws Error if the count is not two or if the result is not a
/// stable solid (G > 0, K > 0).
inline Elasticity lame_constants(const ElasticPair& p) {
  SPREKK_CHECK(p.count() == 2, "{} elastic constants given, exactly two are needed", p.count());
  Elasticity e;
  if (p.G && p.lambda) {
    e = {*p.G, *p.lambda};
  } else if (p.E && p.nu) {
    e = {*p.E / (2 * (1 + *p.nu)), *p.E * *p.nu / ((1 + *p.nu) * (1 - 2 * *p.nu))};
  } else if (p.E && p.G) {
    e = {*p.G, *p.G * (*p.E - 2 * *p.G) / (3 * *p.G - *p.E)};
  } else if (p.E && p.lambda) {
    const Real root = std::sqrt(*p.E * *p.E + 9 * *p.lambda * *p.lambda + 2 * *p.E * *p.lambda);
    e = {(*p.E - 3 * *p.lambda + root) / 4, *p.lambda};
  } else if (p.E && p.K) {
    e = {3 * *p.K * *p.E / (9 * *p.K - *p.E), 3 * *p.K * (3 * *p.K - *p.E) / (9 * *p.K - *p.E)};
  } else if (p.nu && p.G) {
    e = {*p.G, 2 * *p.G * *p.nu / (1 - 2 * *p.nu)};
  } else if (p.nu && p.lambda) {
    SPREKK_CHECK(*p.nu != 0, "Poisson's ratio 0 and Lame's first parameter do not determine the shear modulus");
    e = {*p.lambda * (1 - 2 * *p.nu) / (2 * *p.nu), *p.lambda};
  } else if (p.nu && p.K) {
    e = {3 * *p.K * (1 - 2 * *p.nu) / (2 * (1 + *p.nu)), 3 * *p.K * *p.nu / (1 + *p.nu)};
  } else if (p.G && p.K) {
    e = {*p.G, *p.K - 2 * *p.G / 3};
  } else {
    e = {3 * (*p.K - *p.lambda) / 2, *p.lambda};
  }
  const Real K = e.lambda + 2 * e.G / 3;
  SPREKK_CHECK(std::isfinite(e.G) && std::isfinite(K) && e.G > 0 && K > 0,
               "the elastic constants give shear modulus {} Pa and bulk modulus {} Pa; both must be positive", e.G, K);
  return e;
}

}  // namespace sprekk::laws
