// Solves with the Jacobian no more accurately than Newton's method has use for.
#pragma once

#include "solve/condensed_solve.hpp"

namespace sprekk::solve {

/// While faces change state a Newton step only has to find the states that come next. A solve then ends when two
/// accuracies, the second a hundred times the first (relative residuals 1e-4, 1e-6, ...), lead to the same states, so
/// that none is mistaken for what the exact step leads to; else, or if no face changes, it goes on to the tolerance.
/// Refers to its arguments. All members are collective.
class ForcedSolve {
 public:
  ForcedSolve(BlockProblem& problem, CondensedSolve& solve) : problem_(problem), solve_(solve) {}

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

  BlockProblem& problem_;
  CondensedSolve& solve_;
  BlockVector x_;
};

}  // namespace sprekk::solve
