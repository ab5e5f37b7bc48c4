// Solves with the Jacobian no more accurately than Newton's method has use for.
#pragma once

#include "solve/condensed_solve.hpp"

namespace sprekk::solve {

/// While faces change state a Newton step only has to find the states that come next. A solve then ends when two
/// accuracies, the second a hundred times the first (relative residuals 1e-3, 1e-5, ...), lead to the same states, so
/// that none is mistaken for what the exact step leads to; else it goes on to the tolerance. If no face changes,
/// Newton's method converges about quadratically, and the solve ends well below what the next residual will be for that
/// reason, 0.01 (e / e of the iteration before)^2 with e the largest measure of convergence (as Eisenstat and Walker
/// 1996, choice 2), or well below what ends Newton's method, 0.01 tolerance / e (as Kelley 1995, 6.3); at the second
/// accuracy or below. Refers to its arguments. All members are collective.
class ForcedSolve {
 public:
  ForcedSolve(BlockProblem& problem, CondensedSolve& solve) : problem_(problem), solve_(solve) {}

  /// Before the first iteration of Newton's method, which ends when no measure is above the tolerance.
  void start(Real tolerance) {
    error_ = 0;
    enough_ = tolerance;
  }

  /// Fills problem.matrix() at x; `update` makes ready to solve with it.
  void jacobian(const BlockVector& x);
  void update() { solve_.update(); }

  /// dx <- A^-1 b, of which Newton's step is the opposite, from x to x - dx.
  LinearReport solve(const BlockVector& b, BlockVector& dx, Real tolerance);

  /// y <- A x with A = problem.matrix() but for rows of constrained unknowns, which are identity.
  void apply(const BlockVector& x, BlockVector& y) const;

  Real tolerance() const { return solve_.tolerance(); }

 private:
  std::size_t states_after(const BlockVector& dx) const;
  Real accuracy_without_change(const BlockVector& b);

  BlockProblem& problem_;
  CondensedSolve& solve_;
  BlockVector x_;
  Real error_ = 0;   // of the iteration before: its largest measure; 0: there was none
  Real enough_ = 0;  // what ends Newton's method
};

}  // namespace sprekk::solve
