// A level above multigrid: what displacements of order 2 and around crack tips have over those of order 1.
#pragma once

#include "solve/block_solver.hpp"
#include "solve/direct_inverse.hpp"

namespace sprekk::solve {

/// Whether the first of these blocks has a finer level than order 1, and all others enrich it.
bool have_fine_level(const std::vector<Block>& blocks);

/// The symmetric two-level cycle for a system of such blocks,
///   x = S b,  x += P K P^T (b - A x),  x += S (b - A x),
/// with K multigrid on the part of order 1, and P its interpolation: that of the first block, zero in blocks that
/// enrich it. S works on the unknowns that order 1 does not have, and on those that couple to them: of order 2 on all,
/// by a symmetric Gauss-Seidel sweep; of blocks that enrich on those near crack tips, by a direct solve on
/// rank 0.
class FineLevel {
 public:
  FineLevel(const Teuchos::ParameterList& muelu, const std::vector<Block>& blocks);
  /// Makes ready for these values. Throws where a library does. Collective.
  void setup(const LinearSystem& system);
  RCP<const fields::Operator> inverse() const { return cycle_; }
  SolverCost order_one_cost() const { return order_one_->costs().front(); }

 private:
  RCP<BlockSolver> order_one_;
  RCP<CrsMatrix> product_;                  // P^T A P
  std::unique_ptr<JoinedMatrix> smoothed_;  // the rows and columns of S
  RCP<DirectInverse> direct_;               // their inverse, of blocks that enrich
  RCP<const fields::Operator> cycle_;
};

}  // namespace sprekk::solve
