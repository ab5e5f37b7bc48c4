// A level above multigrid: what displacements of order 2 have over those of order 1.
#pragma once

#include "solve/preconditioner.hpp"

namespace sprekk::solve {

/// Whether multigrid needs a finer level for such blocks, of which all but the first enrich it: of order 2; or MueLu,
/// which does not know enriching functions.
bool needs_fine_level(const BlockOptions& options, const std::vector<Block>& blocks);

class Cycle;

/// The symmetric two-level cycle for a system of such blocks,
///   x = S b,  x += P K P^T (b - A x),  x += S (b - A x),
/// with K multigrid on the part of order 1, P its interpolation: that of the first block, zero in blocks that enrich
/// it, and S a symmetric Gauss-Seidel sweep.
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

  std::vector<std::string> enriching_;  // blocks
  std::unique_ptr<Preconditioner> order_one_;
  RCP<const Matrix> product_;  // P^T A P
  WholeMatrix matrix_;
  RCP<const Cycle> cycle_;
};

}  // namespace sprekk::solve
