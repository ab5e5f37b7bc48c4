// Solution with the whole Jacobian: local elimination, linear solver for the remaining blocks, back-substitution.
#pragma once

#include "base/timer.hpp"
#include "solve/linear_solver.hpp"
#include "solve/local_elimination.hpp"

namespace sprekk::solve {

/// Linear solver with data saved between solves: positions, factors or the hierarchy. These are renewed only if values
/// have changed. Remaining blocks are solved together. All members are collective unless they return stored data.
class CondensedSolve {
 public:
  CondensedSolve(BlockProblem& problem, const LinearSolverOptions& options,
                 RCP<base::Timers> timers = rcp(new base::Timers));

  /// Prepares solves with the present problem.matrix(). The next solve reports failures.
  void update();

  /// Computes dx = A^-1 b, [block], to the relative residual `tolerance`. Rows of constrained unknowns are dx_i = b_i.
  LinearReport solve(const BlockVector& b, BlockVector& dx, Real tolerance);

  Real tolerance() const { return tolerance_; }
  bool forcing() const { return forcing_; }
  const ChosenSolver& solver() const { return chosen_; }
  int n_setups() const { return n_setups_; }  ///< number of factorisations or hierarchies so far

 private:
  std::vector<Block> remaining() const;
  std::vector<Real> scales() const;
  RCP<const CrsMatrix> joined_matrix();
  LinearSystem system();

  BlockProblem& problem_;
  RCP<base::Timers> timers_;
  LocalElimination elimination_;
  std::shared_ptr<Joined> joined_;
  Blocks blocks_;  // [r * n + s] remaining blocks
  ChosenSolver chosen_;
  std::unique_ptr<JoinedMatrix> matrix_;  // for solvers that read a matrix
  Real tolerance_;
  bool forcing_;
  bool symmetric_ = false;
  int n_setups_ = 0;
  std::string failure_;
};

}  // namespace sprekk::solve
