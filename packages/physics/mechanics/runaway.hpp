// Slip that runs away within a step.
#pragma once

#include "laws/joint.hpp"

namespace sprekk::physics {

/// The slip of a step, m, at whose beginning the bound fell faster with slip than what shears the face unloads, by
/// 1/`softness` Pa/m; else 0. Then the state at the end of the step, `end`, is not near the last one: it obeys the law,
/// and so may others between.
KOKKOS_INLINE_FUNCTION Real runaway_slip(const laws::Joint& law, const laws::Contact<Real>& end, Real softness) {
  if (!(end.slip_of_step > 0)) return 0;
  const auto bound_after = [&](Real slip) {
    auto at = end;
    at.slip_of_step = slip;
    for (int i = 0; i < 2; ++i) at.plastic_jump[i] = end.last_plastic_jump[i] + slip * end.slip_direction[i];
    at.plastic_slip = laws::norm(at.plastic_jump);
    return law.bound(at);
  };
  const Real little = 1e-4 * end.slip_of_step;
  return (bound_after(0) - bound_after(little)) * softness > little ? end.slip_of_step : 0;
}

}  // namespace sprekk::physics
