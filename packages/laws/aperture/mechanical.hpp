// Hydraulic aperture equal to the mechanical aperture.
#pragma once

#include "laws/kinds.hpp"

namespace sprekk::laws {

/// Hydraulic aperture of smooth walls, m: the mechanical aperture a.
struct MechanicalAperture {
  static constexpr const char *name = "mechanical", *meaning = "equal to the mechanical aperture (smooth walls)";
  static std::vector<Parameter<MechanicalAperture>> parameters() { return {}; }

  KOKKOS_INLINE_FUNCTION Real hydraulic(Real a) const { return a; }
  /// Derivative of hydraulic(a).
  KOKKOS_INLINE_FUNCTION Real slope(Real) const { return 1; }
  /// Mechanical aperture a with hydraulic(a) = e.
  Real mechanical(Real e) const { return e; }
};

}  // namespace sprekk::laws
