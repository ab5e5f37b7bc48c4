// Few steps of a Krylov method as approximate inverse.
#pragma once

#include <vector>

#include "fields/matrix.hpp"

namespace sprekk::solve {

/// Approximate inverse of A: some steps of the generalised conjugate residual method (Eisenstat, Elman and Schultz
/// 1983), preconditioned by M. No step increases the residual r in the norm of D^(-1/2) r. The operator is not linear.
/// Memory is allocated once.
class MinimalResidual : public fields::Operator {
 public:
  /// `diagonal`: D; absolute values count, and 1 in place of 0.
  MinimalResidual(RCP<const fields::Operator> A, RCP<const fields::Operator> M, const fields::Vector& diagonal,
                  int n_steps);

  RCP<const fields::Map> getDomainMap() const override { return A_->getDomainMap(); }
  RCP<const fields::Map> getRangeMap() const override { return A_->getRangeMap(); }
  /// Computes y = alpha x + beta y, where x approximates A^-1 b. Collective.
  void apply(const fields::MultiVector& b, fields::MultiVector& y, Teuchos::ETransp, Real alpha,
             Real beta) const override;

 private:
  RCP<const fields::Operator> A_, M_;
  fields::Vector scale_, unscale_;                   // D^(-1/2), D^(1/2)
  mutable fields::Vector x_, r_;                     // r_: scaled
  mutable fields::BlockVector directions_, images_;  // [step] z and D^(-1/2) A z; images are orthonormal
};

/// Returns the same for a matrix and its diagonal. Local.
RCP<const fields::Operator> minimal_residual(const RCP<const fields::Matrix>& A, const RCP<const fields::Operator>& M,
                                             int n_steps);

}  // namespace sprekk::solve
