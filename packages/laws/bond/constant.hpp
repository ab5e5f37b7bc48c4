// Cohesion of faces that touch.
#pragma once

#include "laws/bond/none.hpp"

namespace sprekk::laws {

/// A cohesion c in shear that neither slip nor opening uses up: the bound is c + that of friction as long as the faces
/// touch. No tension.
struct ConstantBond {
  Real shear = 0;  ///< c, Pa

  static constexpr const char *name = "constant cohesion",
                              *meaning = "shear strength of faces that touch, whatever they have slipped; no tension";
  static std::vector<Parameter<ConstantBond>> parameters() {
    return {{&ConstantBond::shear,
             Entry{"cohesion", "Pa", base::at_least(0), "c: what the bond adds to the bound on the shear traction"}}};
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION Cohesion<T> cohesion(const Contact<T>&) const {
    return {T(shear), T(0), T(0), true};
  }
};

}  // namespace sprekk::laws
