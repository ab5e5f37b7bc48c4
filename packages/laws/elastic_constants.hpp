// Conversion of elastic constants to Lame's constants.
#pragma once

#include "base/check.hpp"
#include "laws/elasticity.hpp"

#include <cmath>
#include <optional>

namespace sprekk::laws {

/// Elastic constants of a material: Young's modulus E, Poisson's ratio nu, shear modulus G, Lame's first parameter,
/// bulk modulus K. Moduli in Pa.
struct ElasticPair {
  std::optional<Real> E, nu, G, lambda, K;

  int count() const { return E.has_value() + nu.has_value() + G.has_value() + lambda.has_value() + K.has_value(); }
};

/// Computes Lame's constants, Pa, from two constants. Throws an Error if the number of given constants is not two, or
/// if the result is not a stable solid (G > 0, K > 0).
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
