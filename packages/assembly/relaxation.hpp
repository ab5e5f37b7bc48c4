// Fixed-point iteration for many coupled numbers with individual relaxation.
#pragma once

#include "base/types.hpp"

#include <vector>

namespace sprekk::assembly {

/// Fixed-point iteration y -> g(y) for numbers whose g decreases with y, steeply in places. The method is a diagonal
/// secant method with limited steps. Each number moves by (g - y)/(1 - s). s is the secant slope, or a fraction of the
/// steepest slope so far if that is steeper. Where the residual g - y changes its sign, s becomes steeper, because
/// numbers interact. If a few steps do not converge, groups of numbers oscillate together. Then the fraction grows with
/// each change of sign, from 0.25 to 0.8. All steps are limited to 1, and steps of oscillating numbers to less.
class Relaxation {
 public:
  bool started() const { return !y_.empty(); }
  const std::vector<Real>& y() const { return y_; }
  /// Restarts the iteration at y.
  void start(std::vector<Real> y);
  /// Moves y to the next iterate, given g(y). No number decreases by more than 2.
  void follow(const std::vector<Real>& g);

 private:
  struct Number {
    Real slope = 0, step_limit = 1;
    int n_sign_changes = 0;  // of the residual
    /// Returns the next step for this residual. `change` is the change of g over the last step `moved`.
    Real step(Real residual, Real moved, Real change, bool limited);
  };

  std::vector<Real> y_, last_y_, last_g_;  // last_y_, last_g_: empty before the first step
  std::vector<Number> numbers_;
  int n_steps_ = 0;
};

}  // namespace sprekk::assembly
