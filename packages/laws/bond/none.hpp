// Joint without a bond.
#pragma once

#include "laws/contact.hpp"
#include "laws/kinds.hpp"

namespace sprekk::laws {

/// Contribution of a bond to contact and friction.
template <class T>
struct Cohesion {
  T shear = 0;       ///< added to the friction bound, Pa
  T strength = 0;    ///< normal traction up to which the sides stay together, Pa, >= 0
  T tension = 0;     ///< normal traction of separated sides, Pa, >= 0
  bool lost = true;  ///< separated sides transmit no traction
};

/// Joint without bond: no cohesion and no tensile strength.
struct NoBond {
  static constexpr const char *name = "none", *meaning = "no tension, and no shear without compression";
  static std::vector<Parameter<NoBond>> parameters() { return {}; }

  template <class T>
  KOKKOS_INLINE_FUNCTION Cohesion<T> cohesion(const Contact<T>&) const {
    return {};
  }
};

}  // namespace sprekk::laws
