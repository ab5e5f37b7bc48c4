// Chebyshev's iteration as a smoother.
#pragma once

#include "multigrid/rounded_matrix.hpp"

namespace sprekk::multigrid {

/// About A^-1 for the upper part of A's spectrum: the polynomial of D^-1 A whose residual is smallest over
/// [1/15, 1.1] times the largest eigenvalue, D the diagonal (Adams, Brezina, Hu and Tuminaro 2003); of degree n the
/// interval begins at (4/n)^2 of that, so that the residual is about as small. It works with
/// D^-1/2 A D^-1/2 as a RoundedMatrix, a quarter of the bytes: a smoother is not exact anyway, and residuals are
/// computed with A itself. It is linear to double precision, and symmetric of a positive definite A. All members are
/// collective unless they return stored data.
class Chebyshev {
 public:
  static constexpr int usual_degree = 4;

  explicit Chebyshev(const NodeMatrix& A);

  /// Takes the values of A, and looks for its largest eigenvalue.
  void update(const NodeMatrix& A, int degree = usual_degree);

  /// Doubles the interval until the next update: eigenvalues off the real axis are then nearer to it.
  void widen() { widening_ *= 2; }

  /// x <- S b, or x += S b; b [owned], x [all].
  void apply(const ConstView<Real*>& b, const View<Real*>& x, bool add) const;

  /// w D^-1 with w = 4/3 over the largest eigenvalue of D^-1 A, [all nodes, unknown]: what smooths prolongators.
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
  mutable View<Real*> step_, x_, next_;  // times D^1/2 or D^-1/2
};

}  // namespace sprekk::multigrid
