// Curves that join points by straight lines.
#pragma once

#include "base/view.hpp"

namespace sprekk::laws {

/// The curve through n points (x_k, y_k), x_k rising, constant outside.
template <int n>
struct PiecewiseLinear {
  static constexpr int size = n;
  Real x[n], y[n];
  Real width = 0;  ///< of rounded corners over x_k; those of neighbours do not overlap

  /// With corners.
  template <class T>
  KOKKOS_INLINE_FUNCTION T sharp(const T& at) const {
    const int k = before(at);
    return k < 0 ? T(y[0]) : T(y[k] + slope(k) * (at - x[k]));
  }
  /// Once continuously differentiable: within e_k = width x_k of a corner a parabola takes its place, which deviates by
  /// (jump of the slope) e_k/4 at the corner. Elsewhere the curve itself.
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
  KOKKOS_INLINE_FUNCTION Real slope(int k) const {  // from point k to the next
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
