// A level above multigrid: what displacements of order 2 and around crack tips have over those of order 1.
#pragma once

#include "multigrid/direct_inverse.hpp"
#include "solve/preconditioner.hpp"

namespace sprekk::solve {

/// Whether the first of these blocks has a finer level than order 1, and all others enrich it.
bool have_fine_level(const std::vector<Block>& blocks);

class Cycle;

/// The symmetric two-level cycle for a system of such blocks,
///   x = S b,  x += P K P^T (b - A x),  x += S (b - A x),
/// with K multigrid on the part of order 1, and P its interpolation: that of the first block, zero in blocks that
/// enrich it. S works on the unknowns that order 1 does not have, and on those that couple to them: of order 2 on all,
/// by a symmetric Gauss-Seidel sweep; of blocks that enrich on those near crack tips, by a DirectInverse (in flat cells
/// with the next nodes, too). This one leaves no residual in its rows, so the next cycle would find none there: a
/// Krylov method that starts from S b does without the first of the two, and finds the same.
class FineLevel : public Preconditioner {
 public:
  FineLevel(const BlockOptions& options, const std::vector<Block>& blocks);

  bool start(const Vector& b, Vector& x) const override;
  bool has_cycles() const override { return order_one_->has_cycles(); }
  int coarse_size() const override { return order_one_->coarse_size(); }
  std::vector<SolverCost> costs() const override;
  void describe(Teuchos::ParameterList& blocks) const override;

 private:
  void prepare(const LinearSystem& system, SolverCost& cost) override;
  bool renew(const LinearSystem& system) override;
  RCP<const fields::Operator> made() const override;
  void set_up_order_one(const LinearSystem& system);

  std::vector<std::string> enriching_;  // blocks
  std::unique_ptr<Preconditioner> order_one_;
  RCP<const Matrix> product_;               // P^T A P
  std::shared_ptr<JoinedMatrix> smoothed_;  // the rows and columns of S
  std::shared_ptr<JoinedRows> rows_;        // the rows of S with all columns
  RCP<multigrid::DirectInverse> direct_;    // the inverse of the former, of blocks that enrich
  RCP<const Cycle> cycle_;
};

}  // namespace sprekk::solve
