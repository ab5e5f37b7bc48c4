// Length of time steps, from the errors and iterations of the last steps.
#pragma once

#include "fields/step_error.hpp"

#include <optional>
#include <vector>

namespace sprekk::solve {

struct StepControlOptions {
  std::optional<Real> tolerance;  ///< for relative errors
  std::optional<int> iterations;  ///< required number of Newton iterations per step
  Real first = 1, smallest = 0, largest = 1;
  Real max_growth = 3;
  Real aim = 0.8;  ///< errors that steps aim at, relative to the tolerance
};

/// Selection of step lengths. An error e of order p suggests the length dt (aim tolerance/e)^(1/p); the smallest
/// counts. n Newton iterations suggest dt (wanted/n)^(1/2). The length is not reduced further if a tenth of it has not
/// saved iterations. If an error is unknown, a step is at most as long as the previous one.
/// - Steps with an error above the tolerance are rejected. Exceptions: the minimum length, `max_rejections` in
///   succession, or a rejected longer step that was only slightly less accurate (discontinuous loads do not depend on
///   the length).
/// - After a rejection, the next attempt has at most half the length, or the minimum length.
/// - Steps end at the stops, which must increase. The last two steps before a stop are equal, so that none is tiny.
class StepControl {
 public:
  StepControl(const StepControlOptions& options, std::vector<Real> stops)
      : options_(options), stops_(std::move(stops)), memory_{options.first} {}

  static constexpr int max_rejections = 30;

  /// Returns the end of the next step from t.
  Real end_of_step(Real t) const;
  enum class Verdict {
    accepted,
    rejected,  ///< try a shorter step
    jumped,    ///< accepted, since a shorter step does not help
    limited    ///< accepted: minimum length, or `max_rejections` in succession
  };
  /// Judges a step of length dt and sets the length of the next step.
  Verdict judge(Real dt, const fields::StepErrors& errors, int newton_iterations);
  /// Shortens the next attempt after a step of length dt with nonlinear loads. bend: relative deviation from a linear
  /// path.
  void shorten(Real dt, Real bend);
  /// Makes the next step short, because loads change their course at the present time t.
  void be_careful(Real t);

  /// Data for a bitwise equal restart.
  struct Memory {
    Real length;                ///< length of the next step
    Real judged = 0;            ///< longest of the last steps with about the same number of iterations
    int judged_iterations = 0;  ///< iterations of this step
  };
  const Memory& memory() const { return memory_; }
  void resume(const Memory& memory);

 private:
  std::vector<Real>::const_iterator next_stop(Real t) const;
  Real bounded(Real dt) const;
  Real factor_by_iterations(Real dt, int n);

  StepControlOptions options_;
  std::vector<Real> stops_;
  Memory memory_;
  Real worst_ = 0;        // error over tolerance of the last rejected attempt of this step; or 0
  Real rejected_dt_ = 0;  // length of this attempt
  int n_rejected_ = 0;    // rejected attempts of this step
};

}  // namespace sprekk::solve
