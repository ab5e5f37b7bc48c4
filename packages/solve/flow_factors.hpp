// Incomplete factors of the matrix of a quantity that a flow carries.
#pragma once

#include "solve/flow_order.hpp"

namespace sprekk::solve {

/// Approximate inverse (L U)^-1 by incomplete factors with one level of fill, ILU(1) (Meijerink and van der Vorst 1977;
/// Saad 2003, 10.3.3), in the order of flow_order(): an entry of the factors is a coupling of A, or the product of two.
/// Downstream first, the factor L contains the small couplings against the flow relative to large diagonals; upstream
/// first, it would contain large ones relative to small diagonals. Couplings between ranks are omitted. If couplings
/// follow a flow without circulation, the factors on one rank are exact. A pivot that is much smaller than the diagonal
/// is replaced by it, and a zero diagonal by 1. Pivots may be negative: where the flow depends on the carried quantity,
/// so may be diagonals and eigenvalues of A.
class FlowFactors : public fields::Operator {
 public:
  /// Factorises the present values of A, a matrix with equal row and domain map. Local.
  explicit FlowFactors(const fields::CrsMatrix& A);

  double bytes() const;  ///< on this rank

  RCP<const fields::Map> getDomainMap() const override { return map_; }
  RCP<const fields::Map> getRangeMap() const override { return map_; }
  /// Computes y = alpha (L U)^-1 b + beta y. Local.
  void apply(const fields::MultiVector& b, fields::MultiVector& y, Teuchos::ETransp, Real alpha,
             Real beta) const override;

 private:
  void factor();

  RCP<const fields::Map> map_;
  std::vector<LocalIndex> order_;      // [position] row
  LocalRows factors_;                  // [position] L without its unit diagonal, and U
  std::vector<std::size_t> diagonal_;  // [position] place of the diagonal
  std::vector<Real> inverse_;          // [position] inverse pivot
  mutable std::vector<Real> z_;        // [position]
};

}  // namespace sprekk::solve
