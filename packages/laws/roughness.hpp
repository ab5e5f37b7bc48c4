// Roughness of joints after Barton and co-workers: its scale, and how slip mobilises it.
#pragma once

#include "laws/kinds.hpp"
#include "laws/piecewise_linear.hpp"

#include <cmath>
#include <string>
#include <vector>

namespace sprekk::laws {

/// Scales roughness JRC (degrees per decade) and wall strength JCS (Pa) from samples of the length L_0 to a joint of
/// the length L_n, Barton and Bandis: JRC_n = JRC (L_n/L_0)^(-0.02 JRC), JCS_n = JCS (L_n/L_0)^(-0.03 JRC). Read in the
/// public sources of openCSMP, not in the paper.
inline void scale_roughness(Real& JRC, Real& JCS, Real joint, Real sample) {
  const Real exponent = -0.01 * JRC;
  JRC *= std::pow(joint / sample, 2 * exponent);
  JCS *= std::pow(joint / sample, 3 * exponent);
}

/// The slip, m, at which the strength of a joint of this roughness and length (m) is largest, Barton:
/// L/500 (JRC/L)^0.33. Read in the public sources of openCSMP.
inline Real peak_slip_of(Real JRC, Real length) { return length / 500 * std::pow(JRC / length, 0.33); }

/// The part of the roughness that slip has mobilised, by slip over delta_p: Barton's (1982) table from 0.3 on. Kinks
/// are rounded to within 1e-3.
KOKKOS_INLINE_FUNCTION constexpr PiecewiseLinear<7> mobilised_roughness() {
  return {{0.3, 0.6, 1, 2, 4, 10, 100}, {0, 0.75, 1, 0.85, 0.7, 0.5, 0}, 0.003};
}

/// The part of the residual friction that slip has mobilised: before 0.3 the table's roughness is negative, so that no
/// friction is mobilised without slip. For the negative slip of iterates the line goes on.
KOKKOS_INLINE_FUNCTION constexpr PiecewiseLinear<2> mobilised_friction() { return {{-0.3, 0.3}, {-1, 1}, 0.003}; }

inline Entry roughness_entry() {
  return Entry{"joint roughness coefficient", "-", base::at_least(0),
               "JRC: by so many degrees the angle falls with every decade of the compression"}
      .also_called({"JRC", "roughness"});
}
inline Entry wall_strength_entry() {
  return Entry{"joint wall strength", "Pa", base::positive(),
               "JCS, the compression at which the roughness has no part any more"}
      .also_called({"JCS", "wall strength"});
}
inline Entry length_entry() {
  return Entry{"joint length", "m", base::positive(),
               "L_n: JRC and JCS are of samples, and scaled to joints of this length; absent: they are the joint's own"}
      .may_be_absent();
}
inline Entry sample_entry() {
  return Entry{"sample length", "m", base::positive(), "L_0 of the samples that JRC and JCS were measured on"}.or_else(
      0.1);
}
inline Entry peak_slip_entry() {
  return Entry{"peak slip", "m", base::positive(),
               "delta_p at which all roughness is mobilised; absent: from the joint length"}
      .may_be_absent();
}

}  // namespace sprekk::laws
