// Constant cohesion of closed faces.
#pragma once

#include "laws/bond/none.hpp"

namespace sprekk::laws {

/// Shear cohesion c that slip does not damage. Closed faces have the bound c plus friction. With o_0 > 0, open faces
/// retain the cohesion c (1 - o/o_0) up to the separation o = w_n - g = o_0. There is no tensile strength. With o_0 = 0
/// a face that opens loses c at once; then neither the closed nor the open state may be in equilibrium.
struct ConstantBond {
  Real shear = 0;    ///< c, Pa
  Real opening = 0;  ///< o_0, m

  static constexpr const char *name = "constant cohesion",
                              *meaning =
                                  "shear strength of faces in contact, independent of slip, without tensile strength";
  static std::vector<Parameter<ConstantBond>> parameters() {
    return {{&ConstantBond::shear, Entry{"cohesion", "Pa", base::at_least(0),
                                         "cohesion c, the shear strength of the bond in addition to friction"}},
            {&ConstantBond::opening, Entry{"opening without cohesion", "m", base::at_least(0),
                                           "opening o_0 at which the cohesion reaches zero, after a linear decrease; "
                                           "0: sudden loss, possibly without equilibrium at incipient opening"}
                                         .or_else(0)}};
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION Cohesion<T> cohesion(const Contact<T>& at) const {
    if (!(opening > 0)) return {T(shear), T(0), T(0), true};
    if (!(at.separation < opening)) return {};
    if (!(at.separation > 0)) return {T(shear), T(0), T(0), false};
    return {T(shear * (1 - at.separation / opening)), T(0), T(0), false};
  }
};

}  // namespace sprekk::laws
