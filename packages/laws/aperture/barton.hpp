// The hydraulic aperture of rough walls.
#pragma once

#include "laws/kinds.hpp"
#include "laws/roughness.hpp"

#include <cmath>

namespace sprekk::laws {

/// Hydraulic aperture of joints whose walls are a apart, m, Barton: a^2/JRC^2.5 in micrometres, not above a; 0 for
/// a < 0. The derivative has a jump where a = JRC^2.5 micrometres. Read in the public sources of Lei's Y, not in the
/// paper.
struct BartonAperture {
  Real roughness = 0;  ///< JRC as it is given: of samples
  Real smooth = 0;     ///< from this a on roughness counts no more, m

  static constexpr const char *name = "Barton", *meaning = "smaller, by JRC, the narrower the joint is";
  static std::vector<Parameter<BartonAperture>> parameters() {
    return {{&BartonAperture::roughness, roughness_entry()}};
  }
  void complete() { smooth = 1e-6 * std::pow(roughness, 2.5); }

  KOKKOS_INLINE_FUNCTION Real hydraulic(Real a) const {
    if (!(a > 0)) return 0;
    return a < smooth ? a * a / smooth : a;
  }
  /// Derivative of that.
  KOKKOS_INLINE_FUNCTION Real slope(Real a) const {
    if (!(a > 0)) return 0;
    return a < smooth ? 2 * a / smooth : 1;
  }
};

}  // namespace sprekk::laws
