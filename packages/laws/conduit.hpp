// Flow along a fracture.
#pragma once

#include "base/view.hpp"
#include "laws/aperture_kinds.hpp"

namespace sprekk::laws {

/// One of the kinds.
struct HydraulicAperture : ApertureKinds {
  using ApertureKinds::ApertureKinds;
  KOKKOS_INLINE_FUNCTION Real hydraulic(Real a) const {
    return visit([&](const auto& law) { return law.hydraulic(a); });
  }
  KOKKOS_INLINE_FUNCTION Real slope(Real a) const {
    return visit([&](const auto& law) { return law.slope(a); });
  }
};

/// How well a fracture lets a fluid through along itself. Its hydraulic aperture follows from the mechanical one, a
/// less at the start and what it has widened since, but is not less than that of asperities.
struct Conduit {
  Real aperture = 0;             ///< a at the start, m
  Real least = 0;                ///< of both apertures, m
  Real permeability = 0;         ///< k_t, m^2; 0: that of the cubic law, (hydraulic aperture)^2/12
  Real viscosity = 1;            ///< mu, Pa s
  HydraulicAperture walls = {};  ///< the hydraulic aperture by the mechanical one

  /// What the fracture has room for per area, m.
  KOKKOS_INLINE_FUNCTION Real mechanical_aperture(Real widening = 0) const {
    const Real a = aperture + widening;
    return a > least ? a : least;
  }
  KOKKOS_INLINE_FUNCTION Real hydraulic_aperture(Real widening = 0) const {
    const Real e = walls.hydraulic(aperture + widening);
    return e > least ? e : least;
  }
  /// Hydraulic aperture times k_t/mu, m^3/(Pa s), and its derivative in the widening.
  KOKKOS_INLINE_FUNCTION Real transmissivity(Real widening = 0) const {
    return transmissivity_of(hydraulic_aperture(widening));
  }
  KOKKOS_INLINE_FUNCTION Real transmissivity_of(Real e) const {
    return e * (permeability > 0 ? permeability : e * e / 12) / viscosity;
  }
  KOKKOS_INLINE_FUNCTION Real dtransmissivity(Real widening) const {
    const Real a = aperture + widening, e = walls.hydraulic(a);
    return e > least ? (permeability > 0 ? permeability : e * e / 4) / viscosity * walls.slope(a) : 0;
  }
};

}  // namespace sprekk::laws
