// Fixed-point iteration on flux coefficients, before Newton's method.
#pragma once

#include "fields/block_problem.hpp"

namespace sprekk::solve {

using fields::BlockProblem;
using fields::Evaluation;

/// Picard iteration for coefficients that grow with a high power of an unknown. Newton's method linearises such
/// coefficients where the unknown is small. Injected quantities would remain in one place, where the unknown grows far
/// too large, and reach the neighbours only in the next iterates. A line search rejects this path, since residuals rise
/// by orders of magnitude.
/// - f first uses fixed coefficients, see BlockProblem::lag(). One full Newton step is made per set of coefficients.
/// - If the first step changes the coefficients strongly, it is rejected, and the iteration starts from the largest
///   coefficients. As these are convex functions, iterates from above do not pass over the solution.
/// - When coefficients agree, Newton's method takes over. If one of its steps fails, it is rejected, and the
///   fixed-point iteration continues to 0.3 times the distance.
/// All members are collective except those that return stored data.
class Picard {
 public:
  /// Starts the iteration at x. If f has such coefficients, they lag until this object is destroyed. Refers to the
  /// problem.
  Picard(BlockProblem& problem, const Evaluation& x);
  ~Picard() { problem_.lag(BlockProblem::Lag::none, {}); }
  Picard(const Picard&) = delete;
  Picard& operator=(const Picard&) = delete;

  bool possible() const { return possible_; }  ///< f has such coefficients
  bool lags() const { return lags_; }          ///< coefficients are fixed: zeros of the lagged f are not those of f
  bool fresh() const { return fresh_; }        ///< no step since the start or resume()
  bool agrees() const;                         ///< coefficients agreed closely when Newton's method last took over
  int n_steps() const { return n_; }           ///< number of steps with fixed coefficients

  /// Updates the coefficients after a full step of the lagged f to x. Returns whether the step is rejected.
  bool follow(const Evaluation& x);
  /// Replaces follow() while the lagged problem is not solved: the coefficients remain frozen.
  void freeze() { ++n_; }
  /// Checks a step of f itself from `from` with the step length `step`. Returns whether it is rejected; f then lags
  /// again.
  bool resume(const Evaluation& from, Real step, Real merit, Real merit_before);

 private:
  BlockProblem& problem_;
  bool possible_, lags_;
  Real near_ = 1;  // limit for |ln| of the ratio of coefficients
  int n_ = 0;
  bool fresh_ = true;
};

}  // namespace sprekk::solve
