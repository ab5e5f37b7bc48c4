// Dilation up to a maximum opening.
#pragma once

#include "laws/contact.hpp"
#include "laws/kinds.hpp"

namespace sprekk::laws {

/// Opening by slip, m: tan(theta) u with u = |u_t^p|, up to the height h. Beyond h it is constant, because rough faces
/// ride on the tips of their asperities. A parabola within 5 % of h joins both lines; it is below them by up to 0.0125
/// h. As a function of u, dilation is reversed with the slip.
struct LimitedDilation {
  Real tangent = 0;  ///< tan(theta)
  Real height = 1;   ///< h, m

  static constexpr const char *name = "limited", *meaning = "proportional to the slip, up to a largest opening";
  static std::vector<Parameter<LimitedDilation>> parameters() {
    using Law = LimitedDilation;
    return {{&Law::tangent, Entry{"dilation angle", "degree", base::at_least(0).below(90),
                                  "dilation angle theta below the largest dilation"}
                                .converted(tangent_of_degrees)},
            {&Law::height, Entry{"largest dilation", "m", base::positive(), "largest opening h by slip"}}};
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION T opening(const Contact<T>& at) const {
    const Real part = 0.05;
    const T x = tangent * at.plastic_slip / height;
    if (x <= 1 - part) return tangent * at.plastic_slip;
    if (x >= 1 + part) return T(height);
    return height * (1 - (1 + part - x) * (1 + part - x) / (4 * part));
  }
};

}  // namespace sprekk::laws
