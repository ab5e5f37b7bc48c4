// Solves with the whole Jacobian: local elimination, a linear solver for what remains, and back-substitution.
#pragma once

#include "base/timer.hpp"
#include "solve/linear_solver.hpp"
#include "solve/local_elimination.hpp"

namespace sprekk::solve {

/// What is kept between solves: positions, factors or the hierarchy; renewed only when values have changed. All members
/// are collective unless they return stored data. Blocks that remain after elimination are solved for together.
class CondensedSolve {
 public:
  CondensedSolve(BlockProblem& problem, const LinearSolverOptions& options,
                 RCP<base::Timers> timers = rcp(new base::Timers));

  /// Makes ready to solve with the present problem.matrix(). What fails is reported by the next solve.
  void update();

  /// dx <- A^-1 b, rows of constrained unknowns being dx_i = b_i. [block]
  LinearReport solve(const BlockVector& b, BlockVector& dx, Real tolerance);

  Real tolerance() const { return tolerance_; }
  bool forcing() const { return forcing_; }
  const ChosenSolver& solver() const { return chosen_; }
  int n_setups() const { return n_setups_; }  ///< factorisations or hierarchies made so far

 private:
  std::vector<Block> remaining() const;
  std::vector<Real> scales() const;
  RCP<const CrsMatrix> joined_matrix();
  LinearSystem system();

  BlockProblem& problem_;
  RCP<base::Timers> timers_;
  LocalElimination elimination_;
  std::shared_ptr<Joined> joined_;
  Blocks blocks_;  // [r * n + s] of those that remain
  ChosenSolver chosen_;
  std::unique_ptr<JoinedMatrix> matrix_;  // of solvers that read it
  Real tolerance_;
  bool forcing_;
  bool symmetric_ = false;
  int n_setups_ = 0;
  std::string failure_;
};

}  // namespace sprekk::solve
