// Section Time of a scene: time steps of a run.
#pragma once

#include "solve/step_control.hpp"
#include "solve/time_stepping.hpp"

#include <optional>
#include <string>
#include <vector>

namespace sprekk::solve {

struct Time {
  Real start = 0, end = 1;
  std::optional<int> steps;  ///< absent: one, if their lengths are not chosen adaptively
  std::optional<std::vector<Real>> schedule;
  std::optional<Real> tolerance;         ///< relative error, for adaptive step lengths
  std::optional<int> newton_iterations;  ///< target per step, for adaptive step lengths
  std::optional<Real> first_step, smallest_step, largest_step;
  std::string scheme = "implicit Euler";  ///< or BDF2, for storage rates
  TimeSteppingOptions stepping;
  void describe(base::Section& section);
  /// Control of adaptive steps. `rates`: the state depends on the length of the steps. `evolves`: rates may change by
  /// many orders of magnitude.
  StepControlOptions control(bool rates, bool evolves) const;
  bool chooses_steps() const { return tolerance || newton_iterations; }
  std::vector<Real> times() const;  ///< ends of all steps, s; for adaptive steps, the prescribed times

 private:
  void describe_choice(base::Section& section) const;
};

}  // namespace sprekk::solve
