// Solves with the Jacobian, only as accurate as Newton's method requires.
#pragma once

#include <utility>

#include "solve/condensed_solve.hpp"

namespace sprekk::solve {

/// Inexact linear solves of Newton's method.
/// - Faces change state: the step only has to find the next states. Relative residuals are 1e-3, 1e-5, ... The solve
///   ends if two successive accuracies lead to the same states. This avoids states to which the exact step would not
///   lead. Otherwise the solve continues to the tolerance.
/// - No face changes state: convergence is almost quadratic. The solve ends at the larger of 0.01 (e_k / e_(k-1))^2 (as
///   Eisenstat and Walker 1996, choice 2) and 0.01 tolerance / e_k (as Kelley 1995, 6.3), at most the second accuracy,
///   or 1e-8 with advected blocks. e is the largest measure of convergence. In the first iteration the ratio is 0, or 1
///   with advected blocks, whose rows are not linear.
/// - Direct solver: updated factors have the second kind of accuracy, see UpdatedFactors::solve().
/// Refers to its arguments. All members are collective.
class ForcedSolve {
 public:
  ForcedSolve(BlockProblem& problem, CondensedSolve& solve) : problem_(problem), solve_(solve) {}

  /// Starts Newton's method, which ends when no measure exceeds the tolerance.
  void start(Real tolerance) {
    error_ = 0;
    enough_ = tolerance;
  }

  /// Fills problem.matrix() at x. update() then prepares solves.
  void jacobian(const fields::Evaluation& x);
  void update() { solve_.update(); }

  /// Computes dx = A^-1 b. The Newton step is from x to x - dx.
  LinearReport solve(const BlockVector& b, BlockVector& dx, Real tolerance);
  using Part = CondensedSolve::Part;
  /// Returns whether there are advected blocks.
  bool has_advected() const { return solve_.has_advected(); }
  /// Computes dx = A_cc^-1 b_c for the blocks c of a part; dx = 0 in others. update() must precede the next solve().
  LinearReport solve_part(Part part, const BlockVector& b, BlockVector& dx);
  /// Returns the evaluation at x - dx, once, if the last solve() needed it, else an empty one. Local.
  fields::Evaluation take_end() { return std::exchange(end_, {}); }

  /// Computes y = A x with A = problem.matrix(), except for rows of constrained unknowns, which are identity.
  void apply(const BlockVector& x, BlockVector& y) const;

  Real tolerance() const { return solve_.tolerance(); }

 private:
  std::size_t states_after(const BlockVector& dx);
  Real accuracy_without_change(const BlockVector& b);

  BlockProblem& problem_;
  CondensedSolve& solve_;
  fields::Evaluation x_, end_;
  Real error_ = 0;   // largest measure of the previous iteration; 0: none
  Real enough_ = 0;  // tolerance of Newton's method
};

}  // namespace sprekk::solve
