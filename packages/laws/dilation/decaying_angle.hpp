// Dilation with an angle that decreases with slip.
#pragma once

#include "laws/contact.hpp"
#include "laws/exponentials.hpp"
#include "laws/kinds.hpp"

namespace sprekk::laws {

/// Opening by slip, m. The slope decays exponentially with u = |u_t^p| from tan(theta) to tan(theta_r):
///   tan(theta_r) u + (tan(theta) - tan(theta_r)) D (1 - exp(-u/D))
/// Without a residual angle it is at most D tan(theta). As a function of u it is reversed with the slip.
struct DecayingDilation {
  Real tangent = 0, residual = 0;  ///< tan(theta), tan(theta_r)
  Real distance = 1;               ///< D, m

  static constexpr const char *name = "decaying angle",
                              *meaning = "at an angle that decreases exponentially with the slip";
  static std::vector<Parameter<DecayingDilation>> parameters() {
    using Law = DecayingDilation;
    return {
        {&Law::tangent,
         Entry{"dilation angle", "degree", base::at_least(0).below(90), "dilation angle theta without slip"}.converted(
             tangent_of_degrees)},
        {&Law::residual, Entry{"residual dilation angle", "degree", base::at_least(0).below(90),
                               "residual dilation angle at large slip"}
                             .or_else(0)
                             .converted(tangent_of_degrees)},
        {&Law::distance, Entry{"dilation decay distance", "m", base::positive(),
                               "slip distance D of the exponential decay of the dilation angle"}}};
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION T opening(const Contact<T>& at) const {
    return residual * at.plastic_slip -
           (tangent - residual) * distance * exponential_less_one(T(-at.plastic_slip / distance));
  }
};

}  // namespace sprekk::laws
