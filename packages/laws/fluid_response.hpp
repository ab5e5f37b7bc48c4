// Density and viscosity of a fluid as functions of a transported quantity.
#pragma once

#include "base/view.hpp"

#include <cmath>

namespace sprekk::laws {

/// Response of the fluid to a quantity u. The density at reference pressure is d(u) rho_0, the viscosity mu_0/m(u).
/// rho_0 and mu_0 are the values at u_0, where d = m = 1.
///
/// exponential: d = exp(-a (u - u_0)), m = exp(b (u - u_0))
/// table:       cubic between equidistant knots, continuously differentiable; constant beyond the ends
struct FluidResponse {
  /// Factor and its derivative in u.
  struct Factor {
    Real value, slope;
  };
  Real reference = 0;            ///< u_0
  Real expansion = 0;            ///< a, 1/U
  Real thinning = 0;             ///< b, 1/U
  Real first = 0;                ///< u of the first knot
  Real distance = 1;             ///< distance of the knots
  ConstView<Real**> knots = {};  ///< [knot, 4] d, its slope times distance, m, likewise; empty: exponential

  /// Factor d of the density.
  KOKKOS_INLINE_FUNCTION Factor density(Real u) const {
    return knots.extent(0) > 0 ? between(u, 0) : exponential(-expansion, u);
  }
  /// Factor m, the inverse factor of the viscosity.
  KOKKOS_INLINE_FUNCTION Factor mobility(Real u) const {
    return knots.extent(0) > 0 ? between(u, 2) : exponential(thinning, u);
  }
  /// Returns d m, the factor of a mass flow without gravity.
  KOKKOS_INLINE_FUNCTION Factor flow(Real u) const {
    const Factor d = density(u), m = mobility(u);
    return {d.value * m.value, d.slope * m.value + d.value * m.slope};
  }

 private:
  KOKKOS_INLINE_FUNCTION Factor exponential(Real rate, Real u) const {
    const Real value = std::exp(rate * (u - reference));
    return {value, rate * value};
  }
  KOKKOS_INLINE_FUNCTION Factor between(Real u, int column) const {
    const int last = static_cast<int>(knots.extent(0)) - 1;
    const Real s = (u - first) / distance;
    if (!(s > 0)) return {knots(0, column), 0};
    if (s >= last) return {knots(last, column), 0};
    const int k = static_cast<int>(s);
    const Real t = s - k, y0 = knots(k, column), h0 = knots(k, column + 1), y1 = knots(k + 1, column),
               h1 = knots(k + 1, column + 1), rise = y1 - y0;
    const Real a = h0 - rise, b = rise - h1;  // value = y0 + t rise + t (1 - t) (a (1 - t) + b t)
    return {y0 + t * rise + t * (1 - t) * (a * (1 - t) + b * t),
            (rise + (1 - 2 * t) * (a * (1 - t) + b * t) + t * (1 - t) * (b - a)) / distance};
  }
};

}  // namespace sprekk::laws
