// Chebyshev smoother.
#pragma once

#include "multigrid/rounded_matrix.hpp"

namespace sprekk::multigrid {

/// Approximation of A^-1 for the upper part of the spectrum of A. It is the polynomial in D^-1 A with the smallest
/// residual on [1/15, 1.1] times the largest eigenvalue, with the diagonal D (Adams, Brezina, Hu and Tuminaro 2003).
/// For degree n, the lower end is multiplied by (4/n)^2, so that the residual has a similar size. The smoother uses
/// D^-1/2 A D^-1/2 as a RoundedMatrix, a quarter of the bytes. This is accurate enough, since residuals are computed
/// with A itself. The smoother is linear to double precision, and symmetric for positive definite A. All members are
/// collective unless they return stored data.
class Chebyshev {
 public:
  static constexpr int usual_degree = 4;

  explicit Chebyshev(const NodeMatrix& A);

  /// Copies the values of A and estimates its largest eigenvalue.
  void update(const NodeMatrix& A, int degree = usual_degree);

  /// Doubles the interval until the next update. Eigenvalues are then closer to the real axis, relative to the
  /// interval.
  void widen() { widening_ *= 2; }

  /// Computes x = S b, or x += S b if `add`; b [owned], x [all].
  void apply(const ConstView<Real*>& b, const View<Real*>& x, bool add) const;

  /// Returns w D^-1 with w = 4/3 over the largest eigenvalue of D^-1 A, [all nodes, unknown], for smoothing of
  /// prolongators.
  View<Real*> damped_inverse_diagonal() const;
  int degree() const { return degree_; }
  std::size_t bytes() const { return matrix_.bytes() + 4 * sizeof(Real) * root_.extent(0); }

 private:
  void find_largest_eigenvalue();
  Real dot(const View<Real*>& x, const View<Real*>& y) const;

  int size_, degree_ = usual_degree;
  NodeGraph graph_;
  RoundedMatrix matrix_;  // D^-1/2 A D^-1/2
  View<Real*> root_;      // D^-1/2 [all]
  Real largest_ = 1, widening_ = 1;
  mutable View<Real*> step_, x_, next_;  // scaled by D^1/2 or D^-1/2
};

}  // namespace sprekk::multigrid
