// A fixed-point iteration on many numbers that act on each other, each relaxed by itself.
#pragma once

#include "base/types.hpp"

#include <vector>

namespace sprekk::assembly {

/// The fixed-point iteration y -> g(y) for numbers whose g falls with y, steeply in places: a diagonal secant method
/// with limits on its steps. Each number moves by (g - y)/(1 - s), s being its secant's slope or a share of the
/// steepest one so far; where the residual g - y changed its sign, s is made steeper, for numbers act on each other.
/// If that does not converge within a few steps, groups of numbers oscillate together: then that share grows with each
/// change of sign, from 0.25 to 0.8, and all steps are limited to 1, those of numbers that oscillate to less.
class Relaxation {
 public:
  bool started() const { return !y_.empty(); }
  const std::vector<Real>& y() const { return y_; }
  /// Starts anew, at y.
  void start(std::vector<Real> y);
  /// From y to the next, with g(y). Nothing falls by more than 2.
  void follow(const std::vector<Real>& g);

 private:
  struct Number {
    Real slope = 0, step_limit = 1;
    int n_sign_changes = 0;  // of the residual
    /// The next step, with the residual; after the last one, `moved`, g changed by `change`.
    Real step(Real residual, Real moved, Real change, bool limited);
  };

  std::vector<Real> y_, last_y_, last_g_;  // the latter two empty before the first step
  std::vector<Number> numbers_;
  int n_steps_ = 0;
};

}  // namespace sprekk::assembly
