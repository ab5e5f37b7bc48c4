// Growth of a crack in mixed mode by the largest hoop stress.
#pragma once

#include "base/types.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::laws {

/// Direction in which a crack grows, rad, from the direction ahead of the tip towards the normal, and the intensity of
/// the hoop stress in this direction, in the unit of K.
struct Kink {
  Real angle, intensity;
};

/// Direction of the largest hoop stress at a tip with the intensities K_I of opening and K_II of sliding:
///   tan(angle/2) = -2 K_II/(K_I + (K_I^2 + 8 K_II^2)^(1/2)),
///   intensity = cos^2(angle/2) (K_I cos(angle/2) - 3 K_II sin(angle/2))
/// (Erdogan and Sih 1963). The crack grows if the intensity reaches the toughness. K_II > 0 moves the side of the
/// normal ahead. A negative K_I counts as zero: closed faces have none.
inline Kink largest_hoop(Real K_I, Real K_II) {
  K_I = std::max<Real>(K_I, 0);
  if (K_II == 0) return {0, K_I};
  const Real half = std::atan(-2 * K_II / (K_I + std::sqrt(K_I * K_I + 8 * K_II * K_II))), c = std::cos(half);
  return {2 * half, c * c * (K_I * c - 3 * K_II * std::sin(half))};
}

}  // namespace sprekk::laws
