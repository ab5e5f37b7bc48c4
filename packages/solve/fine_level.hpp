// Level above multigrid for node fields of order 2.
#pragma once

#include "solve/preconditioner.hpp"

namespace sprekk::solve {

/// Returns whether multigrid needs a finer level for these blocks, of which all except the first enrich the first.
/// Reasons: order 2, or enriching functions with MueLu.
bool needs_fine_level(const BlockOptions& options, const std::vector<Block>& blocks);

class Cycle;

/// Symmetric two-level cycle for a system of such blocks,
///   x = S b,  x += P K P^T (b - A x),  x += S (b - A x).
/// K is multigrid of order 1. P is the interpolation of the first block, zero in enriching blocks. S is a symmetric
/// Gauss-Seidel sweep.
class FineLevel : public Preconditioner {
 public:
  FineLevel(const BlockOptions& options, const std::vector<Block>& blocks);

  bool has_cycles() const override { return order_one_->has_cycles(); }
  int coarse_size() const override { return order_one_->coarse_size(); }
  std::vector<SolverCost> costs() const override;
  void describe(Teuchos::ParameterList& blocks) const override;

 private:
  void prepare(const LinearSystem& system, SolverCost& cost) override;
  bool renew(const LinearSystem& system) override;
  RCP<const fields::Operator> made() const override;
  void set_up_order_one(const LinearSystem& system);

  std::vector<std::string> enriching_;  // names of the enriching blocks
  std::unique_ptr<Preconditioner> order_one_;
  RCP<const Matrix> product_;  // P^T A P
  WholeMatrix matrix_;
  RCP<const Cycle> cycle_;
};

}  // namespace sprekk::solve
