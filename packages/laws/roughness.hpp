// Roughness of joints after Barton and co-workers: scale effect and mobilisation by slip.
#pragma once

#include "laws/kinds.hpp"
#include "laws/piecewise_linear.hpp"

#include <cmath>

namespace sprekk::laws {

/// Scales the roughness JRC (degrees per decade) and the wall strength JCS (Pa) from the sample length L_0 to the joint
/// length L_n (Barton and Bandis 1982):
///   JRC_n = JRC (L_n/L_0)^(-0.02 JRC),  JCS_n = JCS (L_n/L_0)^(-0.03 JRC)
/// The formulas were taken from the source code of openCSMP, not from the paper.
inline void scale_roughness(Real& JRC, Real& JCS, Real joint, Real sample) {
  const Real exponent = -0.01 * JRC;
  JRC *= std::pow(joint / sample, 2 * exponent);
  JCS *= std::pow(joint / sample, 3 * exponent);
}

/// Slip at peak strength, m, of a joint of this roughness and length (m), after Barton: L/500 (JRC/L)^0.33. The formula
/// was taken from the source code of openCSMP.
inline Real peak_slip_of(Real JRC, Real length) { return length / 500 * std::pow(JRC / length, 0.33); }

/// Mobilised fraction f of the roughness as a function of slip/delta_p: Barton's (1982) table for arguments of at least
/// 0.3. Corners are rounded; f changes by less than 1e-3.
KOKKOS_INLINE_FUNCTION constexpr PiecewiseLinear<7> mobilised_roughness() {
  return {{0.3, 0.6, 1, 2, 4, 10, 100}, {0, 0.75, 1, 0.85, 0.7, 0.5, 0}, 0.003};
}

/// Mobilised fraction r of the residual friction as a function of slip/delta_p. It replaces the negative roughness of
/// Barton's table below 0.3, so there is no friction without slip. For negative slip (iterates) it continues linearly
/// to -0.3.
KOKKOS_INLINE_FUNCTION constexpr PiecewiseLinear<2> mobilised_friction() { return {{-0.3, 0.3}, {-1, 1}, 0.003}; }

inline Entry roughness_entry() {
  return Entry{"joint roughness coefficient", "-", base::at_least(0),
               "joint roughness coefficient JRC, the decrease of the friction angle in degrees per decade of "
               "compression; from 0 (smooth) to 20 (rough) (Barton and Choubey 1977)"}
      .also_called({"JRC", "roughness"});
}
inline Entry wall_strength_entry() {
  return Entry{"joint wall strength", "Pa", base::positive(),
               "joint wall compressive strength JCS, the compression at which roughness has no effect; for fresh walls "
               "the uniaxial compressive strength of the rock (Barton and Choubey 1977)"}
      .also_called({"JCS", "wall strength"});
}
inline Entry length_entry() {
  return Entry{"joint length", "m", base::positive(),
               "length L_n of the joint, to which JRC and JCS of samples are scaled (Barton and Bandis 1982); absent: "
               "no scaling"}
      .may_be_absent();
}
inline Entry sample_entry() {
  return Entry{"sample length", "m", base::positive(), "length L_0 of the samples with the measured JRC and JCS"}
      .or_else(0.1);
}
inline Entry peak_slip_entry() {
  return Entry{"peak slip", "m", base::positive(),
               "slip delta_p at full mobilisation of the roughness; absent: from the joint length; typical: 1 % of the "
               "joint length (Barton and Choubey 1977)"}
      .may_be_absent();
}

}  // namespace sprekk::laws
