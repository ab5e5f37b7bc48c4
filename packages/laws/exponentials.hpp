// Exponentials and logarithms without cancellation near zero, and stiffness functions based on them.
#pragma once

#include "base/view.hpp"

#include <cmath>

namespace sprekk::laws {

/// Returns exp(x) - 1, also with derivatives.
template <class T>
KOKKOS_INLINE_FUNCTION T exponential_less_one(const T& x) {
  using std::exp, std::tanh;
  if (x > 1 || x < -1) return exp(x) - 1;
  const T half = tanh(x / 2);
  return 2 * half / (1 - half);
}

/// Returns ln(1 + x) for x >= 0, also with derivatives.
template <class T>
KOKKOS_INLINE_FUNCTION T logarithm_of_one_and(const T& x) {
  using std::atanh, std::log;
  if (x > 1) return log(1 + x);
  return 2 * atanh(x / (2 + x));
}

/// Factor of a stiffness under the compression N: (1 + N/N_r)^m; 1 for N < 0.
template <class T>
KOKKOS_INLINE_FUNCTION T stiffening(const T& N, Real reference, Real m) {
  using std::pow;
  return N > 0 ? T(pow(1 + N / reference, m)) : T(1);
}

/// Integral of 1/stiffening from 0 to N, Pa; N for N < 0.
template <class T>
KOKKOS_INLINE_FUNCTION T integral_of_softening(const T& N, Real reference, Real m) {
  if (!(N > 0)) return N;
  const T rise = logarithm_of_one_and(T(N / reference));
  if (m == 1) return reference * rise;
  return reference * exponential_less_one(T((1 - m) * rise)) / (1 - m);
}

}  // namespace sprekk::laws
