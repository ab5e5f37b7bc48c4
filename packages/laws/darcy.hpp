// Darcy's law q = -(k/mu) (grad p - rho g) of a single fluid.
#pragma once

#include "base/view.hpp"

namespace sprekk::laws {

/// Mobility k/mu, m^2/(Pa s): a symmetric positive definite tensor. Only [dim, dim] of it is used.
struct Mobility {
  Real value[3][3] = {};

  static Mobility isotropic(Real m) {
    Mobility result;
    for (int i = 0; i < 3; ++i) result.value[i][i] = m;
    return result;
  }

  /// True if the tensor is positive definite (leading minors).
  bool is_positive(int dim) const {
    const auto& m = value;
    const Real minor = m[0][0] * m[1][1] - m[0][1] * m[0][1];
    const Real det = m[2][2] * minor - m[1][2] * (m[0][0] * m[1][2] - m[0][1] * m[0][2]) +
                     m[0][2] * (m[0][1] * m[1][2] - m[1][1] * m[0][2]);
    return m[0][0] > 0 && minor > 0 && (dim == 2 || det > 0);
  }

  template <int dim>
  KOKKOS_INLINE_FUNCTION Real trace() const {
    Real sum = 0;
    for (int i = 0; i < dim; ++i) sum += value[i][i];
    return sum;
  }
  /// Returns a . (k/mu) b.
  template <int dim>
  KOKKOS_INLINE_FUNCTION Real product(const Real (&a)[dim], const Real (&b)[dim]) const {
    Real sum = 0;
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) sum += a[i] * value[i][j] * b[j];
    return sum;
  }
  /// Returns tr((k/mu)^-1 S) for a symmetric S (Cramer's rule).
  template <int dim>
  KOKKOS_INLINE_FUNCTION Real resistance(const Real (&S)[dim][dim]) const {
    const auto& m = value;
    if constexpr (dim == 2) {
      const Real det = m[0][0] * m[1][1] - m[0][1] * m[0][1];
      return (m[1][1] * S[0][0] + m[0][0] * S[1][1] - 2 * m[0][1] * S[0][1]) / det;
    } else {
      Real det = 0, sum = 0;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const int a = (i + 1) % 3, b = (i + 2) % 3, c = (j + 1) % 3, d = (j + 2) % 3;
          const Real cofactor = m[a][c] * m[b][d] - m[a][d] * m[b][c];
          if (i == 0) det += m[0][j] * cofactor;
          sum += cofactor * S[i][j];
        }
      return sum / det;
    }
  }
};

}  // namespace sprekk::laws
