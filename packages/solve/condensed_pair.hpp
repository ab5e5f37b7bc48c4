// Approximate inverse of a block together with another block condensed into it.
#pragma once

#include "solve/preconditioner.hpp"

namespace sprekk::solve {

/// Preconditioner of blocks F and K, where K is condensed into F and its own matrix is almost diagonal. K is
/// eliminated:
///   y_F = S^-1 (x_F - A_FK D^-1 x_K),   y_K = D^-1 (x_K - A_KF y_F),   S approximates A_FF - A_FK D^-1 A_KF
/// D is the diagonal of A_KK. D and A_FF include BlockProblem::schur(), the contributions of other blocks. S^-1 is two
/// cycles of multigrid. If fractures are much more conductive than rock, one cycle is too inaccurate. Additional
/// iterations of the whole system would cost more than a second cycle. S^-1 of an advected block, or
/// with factors, is one application of its method.
class CondensedPair : public Preconditioner {
 public:
  CondensedPair(const BlockOptions& options, const std::vector<Block>& pair);

  bool is_symmetric() const override { return false; }
  bool can_be_reused() const override { return false; }
  std::vector<SolverCost> costs() const override { return multigrid_->costs(); }
  void describe(Teuchos::ParameterList& blocks) const override;

 private:
  void prepare(const LinearSystem& pair, SolverCost& cost) override;
  RCP<const fields::Operator> made() const override { return inverse_; }
  void fill_S(const LinearSystem& pair, const Vector& D_inverse);
  void subtract_product(const CrsMatrix& FK, const CrsMatrix& KF);

  Block first_;
  std::string second_;
  int n_cycles_;
  std::unique_ptr<Preconditioner> multigrid_;
  RCP<CrsMatrix> S_;
  RCP<const Matrix> rows_of_S_;
  RCP<const fields::Operator> inverse_;
};

}  // namespace sprekk::solve
