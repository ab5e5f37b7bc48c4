// Hydraulic aperture of rough joints.
#pragma once

#include "laws/kinds.hpp"
#include "laws/roughness.hpp"

#include <cmath>

namespace sprekk::laws {

/// Hydraulic aperture, m, at the mechanical aperture a, after Barton: a^2/JRC^2.5 in micrometres, at most a, and 0 for
/// negative a. The derivative is discontinuous at a = JRC^2.5 micrometres. The formula was taken from source code
/// (Lei's Y), not from the paper.
struct BartonAperture {
  Real roughness = 0;  ///< JRC as given, that of the sample
  Real smooth = 0;     ///< aperture above which roughness has no effect, m

  static constexpr const char *name = "Barton", *meaning = "smaller than the mechanical aperture, by JRC (rough walls)";
  static std::vector<Parameter<BartonAperture>> parameters() {
    return {{&BartonAperture::roughness, roughness_entry()}};
  }
  void complete() { smooth = 1e-6 * std::pow(roughness, 2.5); }

  KOKKOS_INLINE_FUNCTION Real hydraulic(Real a) const {
    if (!(a > 0)) return 0;
    return a < smooth ? a * a / smooth : a;
  }
  /// Derivative of hydraulic(a).
  KOKKOS_INLINE_FUNCTION Real slope(Real a) const {
    if (!(a > 0)) return 0;
    return a < smooth ? 2 * a / smooth : 1;
  }
  /// Mechanical aperture a with hydraulic(a) = e.
  Real mechanical(Real e) const { return e < smooth ? std::sqrt(e * smooth) : e; }
};

}  // namespace sprekk::laws
