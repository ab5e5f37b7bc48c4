// Rates of stored quantities, from the states at the ends of time steps.
#pragma once

#include "base/types.hpp"

namespace sprekk::assembly {

/// Coefficients of the rate dM/dt at the end of a step of length dt: now (M - M_old) - before (M_old - M_older).
///
/// implicit Euler: now = 1/dt, before = 0; first order
/// bdf2: w = dt/dt_before, now = (1 + 2w)/(1 + w)/dt, before = w^2/(1 + w)/dt; second order (Hairer, Norsett and Wanner
/// 1993, III.5). BDF2 is stable for w < 1 + sqrt(2). The first step, and steps that grow faster, use implicit Euler.
struct Rates {
  enum class Scheme { implicit_euler, bdf2 };
  Real now = 0, before = 0;  ///< 1/s

  /// Returns the coefficients of a step. dt_before = 0: no previous step.
  static Rates of(Scheme scheme, Real dt, Real dt_before) {
    const Real w = dt_before > 0 ? dt / dt_before : fastest_growth;
    if (scheme == Scheme::implicit_euler || w >= fastest_growth) return {1 / dt, 0};
    return {(1 + 2 * w) / (1 + w) / dt, w * w / (1 + w) / dt};
  }

 private:
  static constexpr Real fastest_growth = 2.4;
};

}  // namespace sprekk::assembly
