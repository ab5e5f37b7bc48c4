// Peak strength of a rough joint.
#pragma once

#include "laws/contact.hpp"
#include "laws/roughness.hpp"

#include <cmath>

namespace sprekk::laws {

/// Bound on |lambda_t|, Pa, under the compression N = -lambda_n, Barton and Choubey (1977):
///   b = N tan(a),  a = phi_r + JRC log10(JCS/N) degrees,  phi_r <= a <= `steepest`
/// The cap bounds the logarithm as N -> 0: b is linear near N = 0, b(0) = 0, and continues linearly for N < 0.
struct BartonChoubeyFriction {
  Real roughness = 0;        ///< JRC, degree
  Real wall_strength = 1;    ///< JCS, Pa
  Real residual_angle = 30;  ///< phi_r, degree
  Real steepest = 70;        ///< largest friction angle, degree
  Real length = 0;           ///< joint length, m; 0: JRC and JCS are values of the joint
  Real sample = 0.1;         ///< sample length of JRC and JCS if length > 0, m

  static constexpr const char *name = "Barton-Choubey",
                              *meaning = "peak strength of a rough joint, by JRC and JCS (Barton and Choubey 1977)";
  static std::vector<Parameter<BartonChoubeyFriction>> parameters() {
    using Law = BartonChoubeyFriction;
    return {{&Law::roughness, roughness_entry()},
            {&Law::wall_strength, wall_strength_entry()},
            {&Law::residual_angle, Entry{"residual friction angle", "degree", base::at_least(0).below(90),
                                         "residual friction angle phi_r of the smooth joint; typical: 25 to 35"}
                                       .also_called({"phi_r", "residual angle"})},
            {&Law::steepest, Entry{"largest friction angle", "degree", base::greater_than(0).below(90),
                                   "largest friction angle of the rough joint, at small compression"}
                                 .or_else(70)},
            {&Law::length, length_entry()},
            {&Law::sample, sample_entry()}};
  }
  std::string defect() const {
    return steepest < residual_angle ? "\"largest friction angle\" must not be below \"residual friction angle\"" : "";
  }
  void complete() {
    if (length > 0) scale_roughness(roughness, wall_strength, length, sample);
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION T bound(const Contact<T>& at) const {
    using std::log10, std::tan;
    constexpr Real degree = 3.14159265358979323846 / 180;
    const T N = -at.lambda_n;
    if (!(N > 0)) return N * tan(steepest * degree);
    if (N >= wall_strength) return N * tan(residual_angle * degree);
    const T angle = residual_angle + roughness * log10(wall_strength / N);
    if (angle > steepest) return N * tan(steepest * degree);
    return N * tan(angle * degree);
  }
};

}  // namespace sprekk::laws
