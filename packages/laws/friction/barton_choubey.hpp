// The peak strength of a rough joint.
#pragma once

#include "laws/contact.hpp"
#include "laws/kinds.hpp"

#include <cmath>

namespace sprekk::laws {

/// Bound on |lambda_t|, Pa, under the compression N = -lambda_n, Barton and Choubey (1977):
///   b = N tan(a),  a = phi_r + JRC log10(JCS/N) degrees, kept between phi_r and `steepest`.
/// The cap makes b linear near N = 0, where the logarithm has no bound; b(0) = 0. For N < 0 the line goes on.
struct BartonChoubeyFriction {
  Real roughness = 0;        ///< JRC, degree
  Real wall_strength = 1;    ///< JCS, Pa
  Real residual_angle = 30;  ///< phi_r, degree
  Real steepest = 70;        ///< degree

  static constexpr const char *name = "Barton-Choubey", *meaning = "peak strength of a rough joint, by JRC and JCS";
  static std::vector<Parameter<BartonChoubeyFriction>> parameters() {
    using Law = BartonChoubeyFriction;
    return {{&Law::roughness, Entry{"joint roughness coefficient", "-", base::at_least(0),
                                    "JRC: by so many degrees the angle falls with every decade of the compression"}
                                  .also_called({"JRC", "roughness"})},
            {&Law::wall_strength, Entry{"joint wall strength", "Pa", base::positive(),
                                        "JCS, the compression at which the roughness has no part any more"}
                                      .also_called({"JCS", "wall strength"})},
            {&Law::residual_angle,
             Entry{"residual friction angle", "degree", base::at_least(0).below(90), "phi_r, of the smooth joint"}
                 .also_called({"phi_r", "residual angle"})},
            {&Law::steepest, Entry{"largest friction angle", "degree", base::greater_than(0).below(90),
                                   "that the roughness leads to under small compression"}
                                 .or_else(70)}};
  }
  std::string defect() const {
    return steepest < residual_angle ? "\"largest friction angle\" must not be below \"residual friction angle\"" : "";
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
