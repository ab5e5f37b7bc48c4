// Flow along a fracture.
#pragma once

#include "base/view.hpp"
#include "laws/aperture_kinds.hpp"

namespace sprekk::laws {

/// One of the laws of the hydraulic aperture. `a` is the mechanical aperture, m.
struct HydraulicAperture : ApertureKinds {
  using ApertureKinds::ApertureKinds;
  KOKKOS_INLINE_FUNCTION Real hydraulic(Real a) const {
    return visit([&](const auto& law) { return law.hydraulic(a); });
  }
  KOKKOS_INLINE_FUNCTION Real slope(Real a) const {
    return visit([&](const auto& law) { return law.slope(a); });
  }
};

/// Hydraulic properties of a fracture. The mechanical aperture is the initial one plus `widening`, m. Both the
/// mechanical and the hydraulic aperture are at least `minimum`, the aperture of the asperities.
struct Conduit {
  Real aperture = 0;             ///< initial mechanical aperture a, m
  Real minimum = 0;              ///< lower bound of both apertures, m
  Real permeability = 0;         ///< k_t, m^2; 0: cubic law, (hydraulic aperture)^2/12
  Real viscosity = 1;            ///< mu, Pa s
  HydraulicAperture walls = {};  ///< law of the hydraulic aperture

  /// Fluid volume per fracture area, m.
  KOKKOS_INLINE_FUNCTION Real mechanical_aperture(Real widening = 0) const {
    const Real a = aperture + widening;
    return a > minimum ? a : minimum;
  }
  /// Hydraulic aperture, m.
  KOKKOS_INLINE_FUNCTION Real hydraulic_aperture(Real widening = 0) const {
    const Real e = walls.hydraulic(aperture + widening);
    return e > minimum ? e : minimum;
  }
  /// Transmissivity, m^3/(Pa s): hydraulic aperture times k_t/mu. dtransmissivity is its derivative in the widening.
  KOKKOS_INLINE_FUNCTION Real transmissivity(Real widening = 0) const {
    return transmissivity_of(hydraulic_aperture(widening));
  }
  KOKKOS_INLINE_FUNCTION Real transmissivity_of(Real e) const {
    return e * (permeability > 0 ? permeability : e * e / 12) / viscosity;
  }
  KOKKOS_INLINE_FUNCTION Real dtransmissivity(Real widening) const {
    const Real a = aperture + widening, e = walls.hydraulic(a);
    return e > minimum ? (permeability > 0 ? permeability : e * e / 4) / viscosity * walls.slope(a) : 0;
  }
};

}  // namespace sprekk::laws
