// Accuracy of time steps: errors of the rates and curvature of the loads.
#pragma once

#include "assembly/rate_errors.hpp"
#include "assembly/rate_history.hpp"
#include "fields/step_error.hpp"

#include <functional>
#include <utility>
#include <vector>

namespace sprekk::assembly {

/// Estimates errors of steps. Refers to the structure.
class StepAccuracy {
 public:
  /// Starts at the state x of a run of this duration, s. Collective.
  StepAccuracy(const Structure& structure, Rates::Scheme scheme, const fields::BlockVector& x, Real duration);

  /// Updates the largest errors by those of the step of length dt to x. `state`: at x, with the histories before the
  /// commit. Collective.
  void commit(const fields::BlockVector& x, Real dt, const State& state);
  /// Returns and clears the step errors since the last call or resume(): the largest error of each name.
  fields::StepErrors take() { return std::exchange(errors_, {}); }
  /// Returns the deviation of loads(s) from a linear path, 0 <= s <= 1 over the step, relative to the largest change of
  /// the loads in a step so far. Collective.
  Real bend(const std::function<fields::BlockVector(Real)>& loads);
  /// Restarts the rate errors, see RateErrors::forget.
  void forget(bool abrupt) { rate_errors_.forget(abrupt); }

  std::vector<std::pair<fields::Field, View<Real**>>> histories() const { return rate_errors_.histories(); }
  /// Return and restore data for a checkpoint.
  std::vector<Real> memory() const;
  void resume(const fields::BlockVector& x, const std::vector<Real>& memory);

 private:
  const Structure& structure_;
  RateErrors rate_errors_;
  fields::BlockVector committed_x_;
  std::vector<Real> load_change_;  // [block] loads, then [block] prescribed values: largest change in a step
  fields::StepErrors errors_;
};

}  // namespace sprekk::assembly
