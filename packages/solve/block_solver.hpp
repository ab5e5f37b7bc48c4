// Approximate inverses of single blocks: the preconditioners of Krylov's method.
#pragma once

#include "solve/linear_solver.hpp"
#include "solve/solver_cost.hpp"

namespace sprekk::solve {

class BlockSolver {
 public:
  explicit BlockSolver(const std::string& name) : cost_(std::make_shared<SolverCost>()) { cost_->name = name; }
  virtual ~BlockSolver() = default;

  /// Makes ready for these values; the graph must stay as it was. Throws where a library does. Collective.
  void setup(const DiagonalBlock& block) {
    timed(cost_->setup_seconds, [&] { prepare(block, *cost_); });
    ++cost_->n_setups;
  }
  /// About the inverse of the block's matrix, without the system's scale. The object may change at every set-up.
  RCP<const fields::Operator> inverse() const { return rcp(new CountedOperator(prepared(), cost_)); }
  /// Whether cells are so flat that smoothing has to be better than elsewhere. Known after the first set-up.
  virtual bool flat() const { return false; }
  /// Its own and those of what it uses.
  virtual std::vector<SolverCost> costs() const { return {*cost_}; }

 protected:
  virtual void prepare(const DiagonalBlock& block, SolverCost& cost) = 0;
  virtual RCP<const fields::Operator> prepared() const = 0;

 private:
  std::shared_ptr<SolverCost> cost_;
};

/// Multigrid for blocks with coordinates, below a fine level if they have one; Gauss-Seidel within a rank for others.
/// `muelu` goes over the defaults.
RCP<BlockSolver> make_block_solver(const Teuchos::ParameterList& muelu, const Block& block);

/// Whether multigrid of a block is MueLu's: where any of its parameters is given, or nodes have too many unknowns.
bool takes_muelu(const Teuchos::ParameterList& muelu, const Block& block);

/// Multigrid on what its coordinates and near null space belong to.
RCP<BlockSolver> make_multigrid(const Teuchos::ParameterList& muelu, const Block& block);

/// All that MueLu is told of a block.
Teuchos::ParameterList multigrid_parameters(const Teuchos::ParameterList& muelu, const Block& block);

}  // namespace sprekk::solve
