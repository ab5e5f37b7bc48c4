// Piecewise linear curves.
#pragma once

#include "base/view.hpp"

namespace sprekk::laws {

/// Piecewise linear curve through n points (x_k, y_k) with increasing x_k. It is constant outside.
template <int n>
struct PiecewiseLinear {
  static constexpr int size = n;
  Real x[n], y[n];
  Real width = 0;  ///< half-width of rounded corners over x_k; neighbours must not overlap

  /// Value of the curve without rounded corners.
  template <class T>
  KOKKOS_INLINE_FUNCTION T sharp(const T& at) const {
    const int k = before(at);
    return k < 0 ? T(y[0]) : T(y[k] + slope(k) * (at - x[k]));
  }
  /// Value of the continuously differentiable curve. Within e_k = width x_k of a corner, a parabola replaces the curve.
  /// The deviation at the corner is (jump of the slope) e_k/4. Elsewhere the curve is unchanged.
  template <class T>
  KOKKOS_INLINE_FUNCTION T operator()(const T& at) const {
    T value = sharp(at);
    const int k = before(at);
    for (const int corner : {k, k + 1}) {
      if (corner < 0 || corner >= n) continue;
      const Real e = width * x[corner];
      const T inside = corner == k ? T(e - (at - x[corner])) : T(e - (x[corner] - at));
      if (inside > 0) value += (slope(corner) - slope(corner - 1)) / (4 * e) * inside * inside;
    }
    return value;
  }

 private:
  KOKKOS_INLINE_FUNCTION Real slope(int k) const {  // from point k to k + 1; 0 outside
    return k < 0 || k >= n - 1 ? 0 : (y[k + 1] - y[k]) / (x[k + 1] - x[k]);
  }
  template <class T>
  KOKKOS_INLINE_FUNCTION int before(const T& at) const {
    int k = -1;
    while (k < n - 1 && !(at < x[k + 1])) ++k;
    return k;
  }
};

}  // namespace sprekk::laws
