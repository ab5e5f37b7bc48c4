// Time integration rates between the states that are evaluated.
#pragma once

#include "assembly/rates.hpp"

#include <cmath>

namespace sprekk::estimate {

/// Records the times of evaluated states.
class StepRates {
 public:
  explicit StepRates(Real start) : time_(start) {}

  /// Rates of the step to t. `last`: the rates of the system. After a bisected step, returns implicit Euler over the
  /// whole step.
  assembly::Rates to(Real t, const assembly::Rates& last) {
    using assembly::Rates;
    const Real dt = t - time_;
    const auto same = [&](const Rates& rates) { return std::abs(rates.now - last.now) <= 1e-6 * last.now; };
    const Rates euler{1 / dt, 0}, bdf2 = Rates::of(Rates::Scheme::bdf2, dt, dt_);
    time_ = t;
    dt_ = dt;
    return dt > 0 && last.before > 0 && same(bdf2) ? bdf2 : dt > 0 ? euler : Rates{};
  }

 private:
  Real time_, dt_ = 0;
};

}  // namespace sprekk::estimate
