// Process zone of bonds that soften in opening.
#pragma once

#include "laws/joint.hpp"

#include <limits>

namespace sprekk::laws {

/// Length of the process zone behind a front, m, for the modulus E' = E/(1 - nu^2), Pa; infinite without softening.
inline Real process_zone(const Bond& bond, Real modulus) {
  return bond.visit([&](const auto& law) {
    if constexpr (requires { law.process_zone(modulus); }) return law.process_zone(modulus);
    return std::numeric_limits<Real>::infinity();
  });
}

/// Returns the bond with the strengths on a face of length `size`, m, see SharpFrontBond; other bonds are unchanged.
inline Bond on_face(const Bond& bond, Real modulus, Real size) {
  return bond.visit([&](auto law) {
    if constexpr (requires { law.set_zone(modulus, size); }) law.set_zone(modulus, size);
    return Bond(law);
  });
}

}  // namespace sprekk::laws
