// How long time steps are, from what the last ones erred in and how hard they were to solve.
#pragma once

#include "fields/step_error.hpp"

#include <optional>
#include <vector>

namespace sprekk::solve {

struct StepControlOptions {
  std::optional<Real> tolerance;  ///< of relative errors
  std::optional<int> iterations;  ///< of Newton's method, that a step is to take
  Real first = 1, smallest = 0, largest = 1;
  Real most_growth = 3;
};

/// Errors e of order p suggest the length dt (aim tolerance/e)^(1/p), the least of all of them; n Newton iterations
/// suggest dt (wanted/n)^(1/2), but no shorter one where a tenth of the length has not saved any; where an error is
/// unknown a step is no longer than the one before. Steps with an error above the tolerance are to be rejected, unless
/// no shorter one is allowed, or one was tried and is hardly better (loads that jump at a time do so in steps of any
/// length), or `most_rejections` were in a row. The attempt after a rejected one is at most 0.9 times as long. Stops,
/// increasing, are met; the last two steps before one are equal, so that none is tiny.
class StepControl {
 public:
  StepControl(const StepControlOptions& options, std::vector<Real> stops)
      : options_(options), stops_(std::move(stops)), memory_{options.first} {}

  static constexpr int most_rejections = 30;

  /// The end of the next step, from t.
  Real end_of_step(Real t) const;
  enum class Verdict {
    accepted,
    rejected,  ///< a shorter one is to be tried
    jumped,    ///< accepted, for a shorter step does not help
    limited    ///< accepted: no shorter step is allowed, or `most_rejections` were in a row
  };
  /// Of a step of length dt, and sets the length of the next one.
  Verdict judge(Real dt, const fields::StepErrors& errors, int newton_iterations);
  /// Loads within a step of length dt are not straight, with this error: the next attempt is shorter.
  void shorten(Real dt, Real bend);
  /// Loads turn at the present time t: the next step is short.
  void be_careful(Real t);

  /// What goes on after a restart, to any bit.
  struct Memory {
    Real length;                ///< that the next step is to have
    Real judged = 0;            ///< the longest step of the last that took about as many iterations
    int judged_iterations = 0;  ///< those of it
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
  Real worst_ = 0;        // error over tolerance of the attempt that was rejected last, in this step; or 0
  Real rejected_dt_ = 0;  // its length
  int n_rejected_ = 0;    // attempts in this step
};

}  // namespace sprekk::solve
