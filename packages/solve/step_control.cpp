#include "solve/step_control.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::solve {

namespace {

constexpr Real max_shrink = 0.1, min_shrink = 0.5;  // relative to the rejected length
constexpr Real shorter = 0.9;                       // largest length after a rejection, relative to the rejected one
constexpr Real same = 1e-14;                        // relative round-off of times

}  // namespace

std::vector<Real>::const_iterator StepControl::next_stop(Real t) const {
  return std::find_if(stops_.begin(), stops_.end(), [&](Real stop) {
    return stop - t > same * std::max({std::abs(stop), std::abs(t), std::abs(stops_.back() - stops_.front())});
  });
}

Real StepControl::bounded(Real dt) const { return std::clamp(dt, options_.smallest, options_.largest); }

Real StepControl::end_of_step(Real t) const {
  const auto next = next_stop(t);
  const Real stop = next == stops_.end() ? stops_.back() : *next, rest = stop - t;
  constexpr Real slightly = 1.05;  // a slightly longer step is better than an additional one
  if (rest <= slightly * memory_.length) return stop;
  return t + (rest < 2 * memory_.length ? rest / 2 : memory_.length);
}

StepControl::Verdict StepControl::judge(Real dt, const fields::StepErrors& errors, int newton_iterations) {
  Real worst = 0, factor = options_.tolerance && errors.empty() ? 1 : options_.max_growth;
  for (const auto& error : errors) {
    if (options_.tolerance && error.order == fields::StepError::unknown) factor = std::min<Real>(factor, 1);
    if (!options_.tolerance || !(error.value > 0)) continue;
    worst = std::max(worst, error.value / *options_.tolerance);
    factor = std::min(factor, std::pow(options_.aim * *options_.tolerance / error.value, 1 / error.order));
  }
  const bool helped = rejected_dt_ == 0 || dt > 0.8 * rejected_dt_ || worst < 0.8 * worst_;
  const bool can_be_shorter = options_.smallest <= shorter * dt, too_many = n_rejected_ == max_rejections;
  if (worst > 1 && helped && can_be_shorter && !too_many) {
    worst_ = worst;
    rejected_dt_ = dt;
    ++n_rejected_;
    memory_.length = bounded(dt * std::clamp(factor, max_shrink, min_shrink));
    return Verdict::rejected;
  }
  const bool again = rejected_dt_ > 0;
  rejected_dt_ = worst_ = 0;
  n_rejected_ = 0;
  if (options_.iterations) factor = std::min(factor, factor_by_iterations(dt, newton_iterations));
  if (worst > 1) {
    memory_.length = bounded(dt);
    return helped ? Verdict::limited : Verdict::jumped;
  }
  if (again) factor = std::min<Real>(factor, 1);
  const Real next = dt * std::max(factor, max_shrink);
  memory_.length = bounded(
      dt < memory_.length && factor >= 1 ? std::min(std::max(next, memory_.length), options_.max_growth * dt) : next);
  return Verdict::accepted;
}

/// Returns the factor suggested by the iterations; 1 if steps a tenth as long need about as many.
Real StepControl::factor_by_iterations(Real dt, int n) {
  constexpr Real easier = 0.5, harder = 2, much_shorter = 0.1;
  const Real factor = std::sqrt(static_cast<Real>(*options_.iterations) / std::max(1, n));
  const bool alike = factor < 1 && dt <= memory_.judged && n > easier * memory_.judged_iterations &&
                     n < harder * memory_.judged_iterations;
  if (alike && dt < much_shorter * memory_.judged) return 1;
  if (!alike) {
    memory_.judged = dt;
    memory_.judged_iterations = n;
  }
  return factor;
}

void StepControl::resume(const Memory& memory) {
  memory_ = memory;
  memory_.length = bounded(memory.length);
}

void StepControl::shorten(Real dt, Real bend) {
  const Real factor = std::sqrt(options_.aim * options_.tolerance.value_or(bend) / bend);
  memory_.length = bounded(dt * std::clamp(factor, max_shrink, min_shrink));
}

void StepControl::be_careful(Real t) {
  constexpr Real of_last = 0.2, of_rest = 0.02;
  if (const auto stop = next_stop(t); stop != stops_.end())
    memory_.length = bounded(std::min(of_last * memory_.length, of_rest * (*stop - t)));
}

}  // namespace sprekk::solve
