// Isotropic linear elasticity, Wollmann (2024), (5): sigma = 2 G eps + lambda tr(eps) I. Tension is positive; 2D is
// plane strain.
#pragma once

#include "base/view.hpp"

namespace sprekk::laws {

/// Lame's constants, Pa.
struct Elasticity {
  Real G = 0;       ///< shear modulus
  Real lambda = 0;  ///< Lame's first parameter

  Real plane_strain_modulus() const { return 4 * G * (G + lambda) / (lambda + 2 * G); }  ///< E/(1 - nu^2)
  Real youngs_modulus() const { return G * (3 * lambda + 2 * G) / (lambda + G); }

  /// Computes the stress [dim, dim], Pa, of the displacement gradient H_ij = du_i/dx_j:
  /// sigma = 2 G eps + lambda tr(eps) I.
  template <int dim>
  KOKKOS_INLINE_FUNCTION void stress(const Real (&H)[dim][dim], Real (&sigma)[dim][dim]) const {
    Real trace = 0;
    for (int i = 0; i < dim; ++i) trace += H[i][i];
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) sigma[i][j] = G * (H[i][j] + H[j][i]) + (i == j ? lambda * trace : 0);
  }

  /// Stiffness of components i, j for the gradients a, b of two shape functions:
  /// lambda a_i b_j + G (a_j b_i + delta_ij a.b).
  template <int dim>
  KOKKOS_INLINE_FUNCTION Real stiffness(const Real (&a)[dim], const Real (&b)[dim], int i, int j) const {
    Real dot = 0;
    if (i == j)
      for (int k = 0; k < dim; ++k) dot += a[k] * b[k];
    return lambda * a[i] * b[j] + G * (a[j] * b[i] + dot);
  }
  /// Computes the stiffness K_ij for all i, j from the integrals M_ij of a_i b_j.
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

}  // namespace sprekk::laws
