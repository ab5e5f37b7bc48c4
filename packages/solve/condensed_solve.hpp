// Solution with the whole Jacobian: local elimination, linear solver for the remaining blocks, back-substitution.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/timer.hpp"
#include "solve/remaining_solve.hpp"
#include "solve/updated_factors.hpp"

namespace sprekk::solve {

/// Linear solver with data saved between solves: positions, factors or the hierarchy. These are renewed only if values
/// have changed. If only local groups have changed them, factors may be updated instead, see UpdatedFactors. Remaining
/// blocks are solved together. All members are collective unless they return stored data.
class CondensedSolve {
 public:
  CondensedSolve(BlockProblem& problem, const LinearSolverOptions& options,
                 RCP<base::Timers> timers = rcp(new base::Timers));

  /// Prepares solves with the present problem.matrix(). The next solve reports failures.
  void update();

  /// Computes dx = A^-1 b, [block], to the relative residual `tolerance`. Rows of constrained unknowns are dx_i = b_i.
  /// `accuracy`: relative residual with updated factors, see UpdatedFactors::solve().
  LinearReport solve(const BlockVector& b, BlockVector& dx, Real tolerance, Real accuracy = 0);
  bool follows() const { return follows_; }  ///< the last update() has updated factors instead of renewing them

  /// Blocks with Block::advected, or all others.
  enum class Part { advected, others };
  /// Returns whether advected blocks remain after local elimination.
  bool has_advected() const { return !blocks_of(Part::advected).empty(); }
  /// Computes dx = A_cc^-1 b_c for the remaining blocks c of a part, with the present problem.matrix(). b must be zero
  /// in the other part, where dx is the response of eliminated unknowns or zero. update() must precede the next
  /// solve().
  LinearReport solve_part(Part part, const BlockVector& b, BlockVector& dx, Real tolerance);

  Real tolerance() const { return options_.tolerance; }
  bool forcing() const { return forcing_; }
  const ChosenSolver& solver() const { return whole_.solver(); }
  int n_setups() const { return n_setups_; }  ///< number of factorisations or hierarchies of all blocks so far

 private:
  std::vector<int> blocks_of(Part part) const;
  LocalElimination::Status eliminate();
  void set_up();
  LinearReport solve_whole(const BlockVector& c, BlockVector& y, Real tolerance, Real accuracy);
  using Solve = std::function<LinearReport(const BlockVector& c, BlockVector& y)>;
  LinearReport solve_by(const Solve& solve, const BlockVector& b, BlockVector& dx);

  BlockProblem& problem_;
  RCP<base::Timers> timers_;
  LinearSolverOptions options_;
  LocalElimination elimination_;
  RemainingSolve whole_;
  std::unique_ptr<UpdatedFactors> updated_;  // null: the solver is iterative, or see LocalElimination::watch_change()
  bool follows_ = false;                     // the present J is that of updated_, not of the last set-up
  std::map<Part, RemainingSolve> parts_;     // empty before their first use
  bool forcing_;
  bool symmetric_ = false;
  bool outdated_ = false;  // the elimination has changed since the last set-up of all blocks
  int n_setups_ = 0;
  std::string failure_;
};

}  // namespace sprekk::solve
