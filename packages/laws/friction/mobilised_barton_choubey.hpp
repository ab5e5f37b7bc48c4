// Strength of a rough joint, with roughness mobilised and worn by slip.
#pragma once

#include "laws/friction/barton_choubey.hpp"

namespace sprekk::laws {

/// Bound on |lambda_t|, Pa, Barton and Choubey (1977) with Barton's mobilised roughness and the path length of slip s:
///   b = N tan(phi_r r(x) + f(x) i(N)),  x = s/delta_p
///   i = JRC log10(JCS/N) degrees,  0 <= i <= steepest - phi_r
/// f and r are the mobilised fractions of roughness and residual friction, see roughness.hpp. At x = 0 the bound is 0:
/// the joint slips under the first shear traction, in addition to the elastic jump. For N < 0 the line at N = 0
/// continues.
struct MobilisedBartonChoubeyFriction : BartonChoubeyFriction {
  static constexpr int n_history = 1;  ///< s, m
  Real peak_slip = 0;                  ///< delta_p, m

  static constexpr const char *name = "mobilised Barton-Choubey",
                              *meaning =
                                  "strength of a rough joint, by JRC and JCS, mobilised and worn by slip (Barton 1982)";
  static std::vector<Parameter<MobilisedBartonChoubeyFriction>> parameters() {
    std::vector<Parameter<MobilisedBartonChoubeyFriction>> all;
    for (const auto& [number, entry] : BartonChoubeyFriction::parameters()) all.push_back({number, entry});
    all.push_back({&MobilisedBartonChoubeyFriction::peak_slip, peak_slip_entry()});
    return all;
  }
  static std::vector<Quantity<MobilisedBartonChoubeyFriction>> quantities() {
    return {accumulated_slip<MobilisedBartonChoubeyFriction>()};
  }
  void complete() {
    BartonChoubeyFriction::complete();
    if (peak_slip == 0 && length > 0) peak_slip = peak_slip_of(roughness, length);
  }
  std::string defect() const {
    return peak_slip > 0 ? BartonChoubeyFriction::defect() : "give either \"peak slip\" or \"joint length\"";
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION T bound(const Contact<T>& at) const {
    using std::log10, std::tan;
    constexpr Real degree = 3.14159265358979323846 / 180;
    static constexpr auto of_friction = mobilised_friction();
    static constexpr auto of_roughness = mobilised_roughness();
    const T N = -at.lambda_n, x = (at.history[0] + at.slip_of_step) / peak_slip;
    T rough = steepest - residual_angle;  // i, degree
    if (N >= wall_strength) {
      rough = 0;
    } else if (N > 0) {
      const T uncapped = roughness * log10(wall_strength / N);
      if (uncapped < rough) rough = uncapped;
    }
    return N * tan(degree * (residual_angle * of_friction(x) + rough * of_roughness(x)));
  }
  KOKKOS_INLINE_FUNCTION void commit(const Contact<Real>& at, const Numbers<Real>& history) const {
    history[0] += at.rubs * at.slip_of_step;
  }
};

}  // namespace sprekk::laws
