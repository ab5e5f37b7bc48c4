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
  /// Mechanical aperture with the hydraulic aperture e, m.
  Real mechanical(Real e) const {
    return visit([&](const auto& law) { return law.mechanical(e); });
  }
};

/// Hydraulic properties of a fracture. The mechanical aperture is the initial one plus `widening`, m. Both the
/// mechanical and the hydraulic aperture are at least `minimum`, the aperture of the asperities.
///
/// A bonded face (`film` > 0, initial aperture 0) contains no fluid until it widens: its mechanical aperture is
/// max(widening, 0). Its hydraulic aperture is `film` before it widens, and at least `minimum` afterwards. The film
/// defines the pressure of the face, which continues that of its neighbours. In a compressible fluid it stores what
/// 1e-4 of its aperture contains.
struct Conduit {
  Real aperture = 0;             ///< initial mechanical aperture a, m
  Real minimum = 0;              ///< lower bound of both apertures, m
  Real permeability = 0;         ///< k_t, m^2; 0: cubic law, (hydraulic aperture)^2/12
  Real viscosity = 1;            ///< mu, Pa s
  HydraulicAperture walls = {};  ///< law of the hydraulic aperture
  Real compliance = 0;           ///< local widening per pressure, m/Pa
  Real film = 0;                 ///< hydraulic aperture of a bonded face, m; 0: not bonded

  /// Returns whether a bonded face has not opened. The limit is above the rounding error of the widening, and so low
  /// that flow through the film needs no large pressure to fill it.
  KOKKOS_INLINE_FUNCTION bool is_sealed(Real widening) const { return film > 0 && !(widening > 2e-8 * film); }
  /// Initial volume of fluid per area without lower bound, and this bound, m.
  KOKKOS_INLINE_FUNCTION Real initial_volume() const { return film > 0 ? aperture + least_volume() : aperture; }
  KOKKOS_INLINE_FUNCTION Real least_volume() const { return film > 0 ? 1e-4 * film : minimum; }

  /// Fluid volume per fracture area, m.
  KOKKOS_INLINE_FUNCTION Real mechanical_aperture(Real widening = 0) const {
    const Real a = initial_volume() + widening, least = least_volume();
    return a > least ? a : least;
  }
  /// Hydraulic aperture, m.
  KOKKOS_INLINE_FUNCTION Real hydraulic_aperture(Real widening = 0) const {
    if (is_sealed(widening)) return film;
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
    const Real e = hydraulic_aperture(widening);
    return 2 * dmean_transmissivity(e, e) * dhydraulic_aperture(widening);
  }
  /// Derivative of hydraulic_aperture() in the widening.
  KOKKOS_INLINE_FUNCTION Real dhydraulic_aperture(Real widening) const {
    const Real a = aperture + widening;
    return !is_sealed(widening) && walls.hydraulic(a) > minimum ? walls.slope(a) : 0;
  }
  /// Transmissivity, m^3/(Pa s), and its derivatives in the widening and in `rise`.
  struct Mean {
    Real value, by_widening, by_rise;
  };
  /// Mean transmissivity over all pressures from that of a face to one that is higher by `rise`, Pa. The hydraulic
  /// aperture is a linear function of the pressure. It is e at the face, with the derivative de in the widening; in a
  /// sealed face it is e at all pressures.
  KOKKOS_INLINE_FUNCTION Mean mean(Real e, Real de, Real widening, Real rise) const {
    if (is_sealed(widening)) return {transmissivity_of(e), 2 * dmean_transmissivity(e, e) * de, 0};
    const Real there = widening + compliance * rise;
    const Real f = e + hydraulic_aperture(there) - hydraulic_aperture(widening);
    if (f < minimum) return {mean_transmissivity(e, minimum), dmean_transmissivity(e, minimum) * de, 0};
    const Real by_f = dmean_transmissivity(f, e), slope = dhydraulic_aperture(there);
    return {mean_transmissivity(e, f),
            dmean_transmissivity(e, f) * de + by_f * (de + slope - dhydraulic_aperture(widening)),
            compliance * by_f * slope};
  }
  /// Mean transmissivity over all hydraulic apertures from e to f.
  KOKKOS_INLINE_FUNCTION Real mean_transmissivity(Real e, Real f) const {
    return (permeability > 0 ? permeability * (e + f) / 2 : (e + f) * (e * e + f * f) / 48) / viscosity;
  }
  /// Derivative of mean_transmissivity() in e.
  KOKKOS_INLINE_FUNCTION Real dmean_transmissivity(Real e, Real f) const {
    return (permeability > 0 ? permeability / 2 : (3 * e * e + 2 * e * f + f * f) / 48) / viscosity;
  }
};

}  // namespace sprekk::laws
