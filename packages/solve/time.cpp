#include "solve/time.hpp"

#include "base/parameters.hpp"

#include <algorithm>
#include <utility>

namespace sprekk::solve {

void Time::describe(base::Section& s) {
  s.entry(start, "start", "s", "time of the initial state");
  s.entry(end, "end", "s", "end time of the last step");
  s.entry(steps, "steps", "-", base::between(1, 10000000), "number of equal steps from start to end; absent: 1");
  s.entry(schedule, "schedule", "s",
          "end times of all steps, increasing, in place of end and steps; with tolerance: required end times of steps");
  s.entry(tolerance, "tolerance", "-", base::between(1e-8, 0.5),
          "relative time error of adaptive steps, in place of steps; see docs/use/time_and_solver.md");
  s.entry(newton_iterations, "target Newton iterations", "-", base::between(1, 1000),
          "target number of Newton iterations per adaptive step: more iterations shorten the steps, fewer lengthen "
          "them; the tolerance also limits the length");
  s.entry(first_step, "first step", "s", base::positive(),
          "length of the first adaptive step; absent: a fraction of the total time");
  s.entry(smallest_step, "smallest step", "s", base::positive(),
          "minimum length of adaptive steps, accepted with any error; absent: 1e-9 of the total time, 1e-13 if rates "
          "vary by many orders of magnitude");
  s.entry(largest_step, "largest step", "s", base::positive(),
          "maximum length of adaptive steps; absent: the total time");
  s.choice(scheme, "scheme", {"implicit Euler", "BDF2"},
           "scheme of time derivatives; implicit Euler: first order; BDF2: second order");
  stepping.describe(s);
  if (!s.complete()) return;
  describe_choice(s);
  Real last = start;
  for (Real t : times()) {
    if (!(t > last)) {
      s.fail(schedule ? "schedule" : "end",
             fmt::format("is {} after {}; times must increase, from \"start\" on", t, last));
      break;
    }
    last = t;
  }
  if (schedule && schedule->empty()) s.fail("schedule", "is empty; give at least one time");
}

/// Checks the entries for adaptive steps and reports incompatible ones.
void Time::describe_choice(base::Section& s) const {
  if (chooses_steps() && steps)
    s.fail("steps", fmt::format("is {}: not allowed with \"{}\" for adaptive steps; leave out one of them", *steps,
                                tolerance ? "tolerance" : "target Newton iterations"));
  const std::pair<const char*, const std::optional<Real>&> lengths[] = {
      {"first step", first_step}, {"smallest step", smallest_step}, {"largest step", largest_step}};
  for (const auto& [name, length] : lengths)
    if (length && !chooses_steps())
      s.fail(name, fmt::format("is {} s: needs \"tolerance\" or \"target Newton iterations\"", *length));
  if (smallest_step && largest_step && *smallest_step > *largest_step)
    s.fail("smallest step",
           fmt::format("is {} s, must be at most the \"largest step\", {} s", *smallest_step, *largest_step));
  if (first_step && smallest_step && *first_step < *smallest_step)
    s.fail("first step",
           fmt::format("is {} s, must be at least the \"smallest step\", {} s", *first_step, *smallest_step));
  if (first_step && largest_step && *first_step > *largest_step)
    s.fail("first step",
           fmt::format("is {} s, must be at most the \"largest step\", {} s", *first_step, *largest_step));
}

StepControlOptions Time::control(bool rates, bool evolves) const {
  const Real all = times().back() - start;
  const Real first = rates ? std::min<Real>(1e-3, tolerance.value_or(1e-2) / 100) : 0.03;  // of the total
  const Real largest = largest_step.value_or(all);
  return {.tolerance = tolerance,
          .iterations = newton_iterations,
          .first = std::min(first_step.value_or(first * all), largest),
          .smallest = std::min(smallest_step.value_or((evolves ? 1e-13 : 1e-9) * all), largest),
          .largest = largest,
          .max_growth = scheme == "BDF2" ? 2.28 : 3,  // steps may be 1.05 times longer to meet a time
          .aim = evolves ? 0.5 : 0.8};                // errors that grow with the rate would reject many steps
}

std::vector<Real> Time::times() const {
  if (schedule) return *schedule;
  std::vector<Real> times;
  const int n = steps.value_or(1);
  for (int k = 1; k <= n; ++k) times.push_back(k == n ? end : start + (end - start) * k / n);
  return times;
}

}  // namespace sprekk::solve
