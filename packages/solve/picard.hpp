// Fixed-point iteration on coefficients of fluxes, on the way to where Newton's method converges.
#pragma once

#include "fields/block_problem.hpp"

namespace sprekk::solve {

using fields::BlockProblem;
using fields::BlockVector;

/// Newton's method linearises a coefficient that grows with a high power of an unknown where that is small. What enters
/// in a step then stays in one place, where the unknown grows far too large, in the next iterate in its neighbours, and
/// so on; and a search for less residual forbids the way, on which residuals rise by orders of magnitude. So f first
/// takes coefficients as given, see BlockProblem::lag(), and one full Newton step is made for each new set of them. If
/// the first step goes far, it is taken back, and coefficients start from the largest: where they are convex, iterates
/// that come from above do not pass over the solution. Once they agree, Newton's method takes over; a step of it that
/// comes no nearer is taken back, and the fixed-point iteration goes on, to three tenths of the distance. All members
/// are collective but for those that return what is stored.
class Picard {
 public:
  /// Refers to the problem, whose f lags from now on, at x, if it has such coefficients, until the end of its life.
  Picard(BlockProblem& problem, const BlockVector& x);
  ~Picard() { problem_.lag(BlockProblem::Lag::none, {}); }
  Picard(const Picard&) = delete;
  Picard& operator=(const Picard&) = delete;

  bool possible() const { return possible_; }  ///< f has such coefficients
  bool lags() const { return lags_; }          ///< they are not those of x: its zeros are not those of f
  bool fresh() const { return fresh_; }        ///< no step was made since it began or was resumed
  bool agrees() const;                         ///< coefficients differed by little when Newton's method last took over
  int n_steps() const { return n_; }           ///< while it lagged

  /// After a full step of the f that lags, to x. True if the step is to be taken back.
  bool follow(const BlockVector& x);
  /// Instead of follow(), while the lagged problem is not yet solved: the coefficients are frozen.
  void hold() { ++n_; }
  /// After a step of f itself from `from`, of which the search took the part `step`. True if it is to be taken back: f
  /// lags again.
  bool resume(const BlockVector& from, Real step, Real merit, Real merit_before);

 private:
  BlockProblem& problem_;
  bool possible_, lags_;
  Real near_ = 1;  // |ln| of the ratio of coefficients
  int n_ = 0;
  bool fresh_ = true;
};

}  // namespace sprekk::solve
