// Fluid with a density exponential in the pressure.
#pragma once

#include "base/view.hpp"

#include <cmath>

namespace sprekk::laws {

/// Density rho = rho_0 e with e = exp(c (p - p_0)). Then (rho/rho_0) grad p = grad(e)/c, so the flow between two points
/// has a closed form. For small c there is no cancellation. c = 0 is a fluid of constant density.
struct Fluid {
  Real compressibility = 0;     ///< c, 1/Pa
  Real reference_pressure = 0;  ///< p_0, Pa

  /// Relative density e.
  KOKKOS_INLINE_FUNCTION Real density(Real p) const {
    return compressibility == 0 ? 1 : std::exp(compressibility * (p - reference_pressure));
  }
  /// Driving pressure difference of the mass flow over rho_0 from a to b, Pa: (e_a - e_b)/c + e_a e_b lift, with lift =
  /// rho_0 g . (x_b - x_a). It is zero between points of a fluid at rest, where d(1/e) = -c rho_0 g . dx.
  KOKKOS_INLINE_FUNCTION Real drop(Real a, Real b, Real lift) const {
    if (compressibility == 0) return a - b + lift;
    return density(b) * (std::expm1(compressibility * (a - b)) / compressibility + density(a) * lift);
  }
  /// Pressure difference, Pa, of a fluid at rest from a point with pressure p: -ln(1 - c e lift)/c.
  KOKKOS_INLINE_FUNCTION Real head(Real p, Real lift) const {
    return compressibility == 0 ? lift : -std::log1p(-compressibility * density(p) * lift) / compressibility;
  }
  /// Derivatives of drop() in the pressures at a and b.
  KOKKOS_INLINE_FUNCTION Real ddrop_da(Real a, Real b, Real lift) const {
    return density(a) * (1 + compressibility * density(b) * lift);
  }
  KOKKOS_INLINE_FUNCTION Real ddrop_db(Real a, Real b, Real lift) const {
    return -density(b) * (1 - compressibility * density(a) * lift);
  }
};

}  // namespace sprekk::laws
