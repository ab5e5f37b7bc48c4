// How fast what modules store changes, from states at the ends of time steps.
#pragma once

#include "base/types.hpp"

namespace sprekk::assembly {

/// dM/dt at the end of a step of length dt, with M_old at its start: now (M - M_old) - before (M_old - M_older).
///
/// implicit Euler: now = 1/dt, before = 0, of first order
/// bdf2: with w = dt/dt_before, now = (1 + 2w)/(1 + w)/dt, before = w^2/(1 + w)/dt, of second order (Hairer, Norsett
/// and Wanner 1993, III.5). It is stable while w < 1 + sqrt(2); steps that grow faster, and the first one, are Euler's.
struct Rates {
  enum class Scheme { implicit_euler, bdf2 };
  Real now = 0, before = 0;  ///< 1/s

  /// dt_before = 0: there was no step before.
  static Rates of(Scheme scheme, Real dt, Real dt_before) {
    const Real w = dt_before > 0 ? dt / dt_before : fastest_growth;
    if (scheme == Scheme::implicit_euler || w >= fastest_growth) return {1 / dt, 0};
    return {(1 + 2 * w) / (1 + w) / dt, w * w / (1 + w) / dt};
  }

 private:
  static constexpr Real fastest_growth = 2.4;
};

}  // namespace sprekk::assembly
