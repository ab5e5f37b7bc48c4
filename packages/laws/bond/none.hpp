// Faces that nothing bonds.
#pragma once

#include "laws/contact.hpp"
#include "laws/kinds.hpp"

namespace sprekk::laws {

/// What a bond adds to contact and friction.
template <class T>
struct Cohesion {
  T shear = 0;       ///< added to the friction bound, Pa
  T strength = 0;    ///< the normal traction up to which faces stay together, Pa, not negative
  T tension = 0;     ///< the normal traction of faces that are apart, Pa, not negative
  bool lost = true;  ///< faces that are apart bear no traction
};

struct NoBond {
  static constexpr const char *name = "none", *meaning = "faces bear no tension, and no shear without compression";
  static std::vector<Parameter<NoBond>> parameters() { return {}; }

  template <class T>
  KOKKOS_INLINE_FUNCTION Cohesion<T> cohesion(const Contact<T>&) const {
    return {};
  }
};

}  // namespace sprekk::laws
