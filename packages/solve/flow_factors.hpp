// Incomplete factors of the matrix of a quantity that a flow carries.
#pragma once

#include "solve/flow_order.hpp"

namespace sprekk::solve {

/// Approximate inverse (L U)^-1 by incomplete factors without fill, ILU(0) (Meijerink and van der Vorst 1977), in the
/// order of flow_order(). Downstream first, the factor L contains the small couplings against the flow relative to
/// large diagonals; upstream first, it would contain large ones relative to small diagonals. Couplings between ranks
/// are omitted. If couplings follow a flow without circulation, the factors on one rank are exact. A pivot that is much
/// smaller than the diagonal, or of another sign, is replaced by the diagonal, and a zero diagonal by 1.
class FlowFactors : public fields::Operator {
 public:
  /// Copies the present values of A, a matrix with equal row and domain map, and finds their order. Local.
  explicit FlowFactors(const fields::CrsMatrix& A);

  /// Returns the number of owned rows that take from others in the order of the flow.
  LocalIndex n_directed() const { return order_.n_directed; }
  /// Factorises these values. Local.
  void factor();
  double bytes() const;  ///< of factors on this rank

  RCP<const fields::Map> getDomainMap() const override { return map_; }
  RCP<const fields::Map> getRangeMap() const override { return map_; }
  /// Computes y = alpha (L U)^-1 b + beta y. Local.
  void apply(const fields::MultiVector& b, fields::MultiVector& y, Teuchos::ETransp, Real alpha,
             Real beta) const override;

 private:
  void reorder();

  RCP<const fields::Map> map_;
  LocalRows rows_;  // of A, in its order
  FlowOrder order_;
  LocalRows factors_;                  // [position] L without its unit diagonal, and U
  std::vector<std::size_t> diagonal_;  // [position] place of the diagonal
  std::vector<Real> inverse_;          // [position] inverse pivot
  mutable std::vector<Real> z_;        // [position]
};

}  // namespace sprekk::solve
