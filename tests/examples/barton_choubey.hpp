// A friction law as an example: the peak strength of a rough joint after Barton and Choubey (1977).
#pragma once

#include "laws/joint.hpp"

#include <cmath>

namespace sprekk::examples {

/// Bound on |lambda_t|, Pa, under the compression N = -lambda_n:
///   b = N tan(a),  a = phi_r + JRC log10(JCS/N) degrees, kept between phi_r and `steepest`.
/// The cap makes b linear near N = 0, where the logarithm has no bound; b(0) = 0. For N < 0 the line goes on.
struct BartonChoubeyFriction {
  Real roughness = 0;        ///< JRC, degree
  Real wall_strength = 1;    ///< JCS, Pa
  Real residual_angle = 30;  ///< phi_r, degree
  Real steepest = 70;        ///< degree, between phi_r and 90

  template <class T>
  KOKKOS_INLINE_FUNCTION T bound(const T& lambda_n) const {
    using std::log10, std::tan;
    constexpr Real degree = 3.14159265358979323846 / 180;
    const T N = -lambda_n;
    if (!(N > 0)) return N * tan(steepest * degree);
    if (N >= wall_strength) return N * tan(residual_angle * degree);
    const T angle = residual_angle + roughness * log10(wall_strength / N);
    if (angle > steepest) return N * tan(steepest * degree);
    return N * tan(angle * degree);
  }
};

/// The joint law with this friction; elasticity and gap are the usual ones.
using RoughJoint = laws::JointLaw<laws::TangentialElasticity, BartonChoubeyFriction>;

}  // namespace sprekk::examples
