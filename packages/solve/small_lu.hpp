// LU factors of small dense matrices of single entities; device code.
#pragma once

#include <cfloat>
#include <cmath>

#include "base/types.hpp"

namespace sprekk::solve {

inline constexpr int max_small_size = 16;

KOKKOS_INLINE_FUNCTION void exchange(Real& x, Real& y) {
  const Real saved = x;
  x = y;
  y = saved;
}

/// Replaces a [m, m] (row by row) by its LU factors. Rows are exchanged as for an equilibrated matrix: columns scaled
/// by column_scale, rows to a largest entry of 1. The entries themselves are not scaled. Returns false if a pivot is
/// below the round-off of its terms or not finite.
KOKKOS_INLINE_FUNCTION bool lu_factor(int m, Real* a, int* pivot, const Real* column_scale) {
  Real weight[max_small_size], magnitude[max_small_size * max_small_size];
  for (int i = 0; i < m; ++i) {
    Real largest = 0;
    for (int j = 0; j < m; ++j) {
      magnitude[i * m + j] = std::fabs(a[i * m + j]);
      largest = std::fmax(largest, magnitude[i * m + j] * column_scale[j]);
    }
    if (!(largest > 0)) return false;
    weight[i] = 1 / largest;
  }
  for (int k = 0; k < m; ++k) {
    int p = k;
    for (int i = k + 1; i < m; ++i)
      if (std::fabs(a[i * m + k]) * weight[i] > std::fabs(a[p * m + k]) * weight[p]) p = i;
    if (!(std::fabs(a[p * m + k]) > 4 * m * DBL_EPSILON * magnitude[p * m + k])) return false;
    pivot[k] = p;
    if (p != k) {
      for (int j = 0; j < m; ++j) {
        exchange(a[k * m + j], a[p * m + j]);
        exchange(magnitude[k * m + j], magnitude[p * m + j]);
      }
      exchange(weight[k], weight[p]);
    }
    for (int i = k + 1; i < m; ++i) {
      const Real l = a[i * m + k] /= a[k * m + k];
      if (l == 0) continue;
      for (int j = k + 1; j < m; ++j) {
        const Real term = l * a[k * m + j];
        a[i * m + j] -= term;
        magnitude[i * m + j] += std::fabs(term);
      }
    }
  }
  return true;
}

/// Computes b = A^-1 b for n columns. [m, n]
KOKKOS_INLINE_FUNCTION void lu_solve(int m, const Real* lu, const int* pivot, Real* b, int n = 1) {
  const auto subtract = [=](int i, int j) {
    if (lu[i * m + j] == 0) return;
    for (int c = 0; c < n; ++c) b[i * n + c] -= lu[i * m + j] * b[j * n + c];
  };
  for (int k = 0; k < m; ++k)
    for (int c = 0; c < n && pivot[k] != k; ++c) exchange(b[k * n + c], b[pivot[k] * n + c]);
  for (int i = 1; i < m; ++i)
    for (int j = 0; j < i; ++j) subtract(i, j);
  for (int i = m - 1; i >= 0; --i) {
    for (int j = i + 1; j < m; ++j) subtract(i, j);
    for (int c = 0; c < n; ++c) b[i * n + c] /= lu[i * m + i];
  }
}

/// Computes b = A^-1 b with one step of iterative refinement. Each component is then accurate, even if much smaller
/// than the others.
KOKKOS_INLINE_FUNCTION void lu_solve_refined(int m, const Real* a, const Real* lu, const int* pivot, Real* b) {
  Real x[max_small_size];
  for (int i = 0; i < m; ++i) x[i] = b[i];
  lu_solve(m, lu, pivot, x);
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) b[i] -= a[i * m + j] * x[j];
  lu_solve(m, lu, pivot, b);
  for (int i = 0; i < m; ++i) b[i] += x[i];
}

}  // namespace sprekk::solve
