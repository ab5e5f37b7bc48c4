// Unstable slip within a step.
#pragma once

#include "laws/joint.hpp"

namespace sprekk::laws {

/// Unstable slip of a step, m; otherwise 0. Slip is unstable if, at the beginning of the step, the bound falls faster
/// with slip than the rock unloads, 1/`softness`, Pa/m. The state `end` then satisfies the law, but it is not close to
/// the last state, and there may be other solutions between them. 0 for bonded faces that separate further than they
/// slide: their opening drives the slip.
KOKKOS_INLINE_FUNCTION Real runaway_slip(const Joint& law, const Contact<Real>& end, Real softness) {
  if (!(end.slip_of_step > 0) || (law.is_bonded() && end.separation > end.slip_of_step)) return 0;
  const auto bound_after = [&](Real slip) {
    auto at = end;
    at.slip_of_step = slip;
    for (int i = 0; i < 2; ++i) at.plastic_jump[i] = end.last_plastic_jump[i] + slip * end.slip_direction[i];
    at.plastic_slip = norm(at.plastic_jump);
    return law.bound(at);
  };
  const Real little = 1e-4 * end.slip_of_step;
  return (bound_after(0) - bound_after(little)) * softness > little ? end.slip_of_step : 0;
}

}  // namespace sprekk::laws
