// A fixed-point iteration on many numbers that act on each other, each relaxed by itself.
#pragma once

#include "base/types.hpp"

#include <vector>

namespace sprekk::assembly {

/// y -> g(y) for numbers y whose g fall, steeply in places. Each moves by (g - y)/(1 - s) with the secant's slope s. The
/// steepest slope is remembered, by a share that falls with each iterate, and made steeper where that went too far, for
/// numbers act on each other. If the iteration does not settle soon, numbers swing in groups, in which each knows only
/// of itself: then one that goes to and fro remembers longer, and all move by 1 at most, by less where they turned back.
class Relaxation {
 public:
  bool started() const { return !y_.empty(); }
  const std::vector<Real>& y() const { return y_; }
  /// Begins at y, without slopes of its past; those of an iteration that is under way are kept.
  void start(std::vector<Real> y);
  /// From y to the next, with the g that y leads to. Nothing falls by more than 2.
  void follow(const std::vector<Real>& g);

 private:
  struct Past {
    Real slope = 0, longest = 1;  // longest: the farthest that it moves next
    int n_turns = 0;
  };
  Real step(Past& past, Real away, Real moved, Real answered) const;

  std::vector<Real> y_, before_, led_to_;  // before_, led_to_: the y before and its g; empty: none
  std::vector<Past> past_;
  int n_ = 0;
};

}  // namespace sprekk::assembly
