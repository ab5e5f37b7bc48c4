// Transmissivities of fracture faces as functions of their apertures.
#pragma once

#include "base/types.hpp"
#include "laws/conduit.hpp"

namespace sprekk::transport {

/// Transmissivities of a face towards its n ends, whose pressures are higher by `rise`, Pa:
///   t_F + w (t_j - t_F),   w = z^2 (3 - 2 z),   z = min(1, 2 min t_j/max t_j),
/// with t_j of laws::Conduit::mean() and the transmissivity t_F of the face. w limits the overshoot of pressures where
/// a front is not resolved.
///
/// | value       | [n]    | m^3/(Pa s)                         |
/// | by_rise     | [n, n] | derivative of value[j] in rise[k]  |
/// | by_widening | [n]    | derivatives in the widening        |
template <int n>
struct EndTransmissivities {
  Real value[n] = {}, by_rise[n][n] = {}, by_widening[n] = {};

  KOKKOS_DEFAULTED_FUNCTION EndTransmissivities() = default;
  KOKKOS_INLINE_FUNCTION EndTransmissivities(const laws::Conduit& along, Real widening, const Real (&rise)[n])
      : EndTransmissivities(along, along.hydraulic_aperture(widening), along.dhydraulic_aperture(widening), widening,
                            rise) {}
  /// With the hydraulic aperture e of the face, m, and its derivative de in the widening.
  KOKKOS_INLINE_FUNCTION EndTransmissivities(const laws::Conduit& along, Real e, Real de, Real widening,
                                             const Real (&rise)[n]) {
    laws::Conduit::Mean t[n];
    int low = 0, high = 0;
    for (int j = 0; j < n; ++j) {
      t[j] = along.mean(e, de, widening, rise[j]);
      if (t[j].value < t[low].value) low = j;
      if (t[j].value > t[high].value) high = j;
    }
    const Real own = along.transmissivity_of(e), own_by_widening = 2 * along.dmean_transmissivity(e, e) * de;
    const bool differ = 2 * t[low].value < t[high].value;
    const Real z = differ ? 2 * t[low].value / t[high].value : 1, w = z * z * (3 - 2 * z);
    const Real by_low = differ ? 12 * z * (1 - z) / t[high].value : 0, by_high = -by_low * z / 2;
    for (int j = 0; j < n; ++j) {
      const Real excess = t[j].value - own;
      value[j] = own + w * excess;
      by_widening[j] = own_by_widening + w * (t[j].by_widening - own_by_widening) +
                       excess * (by_low * t[low].by_widening + by_high * t[high].by_widening);
      by_rise[j][j] = w * t[j].by_rise;
      by_rise[j][low] += excess * by_low * t[low].by_rise;
      by_rise[j][high] += excess * by_high * t[high].by_rise;
    }
  }
};

/// Transmissivities of faces with a widening, or with given hydraulic apertures (State::coefficients).
///
/// | conduit  | [face] |                                      |
/// | aperture | [face] | hydraulic, m; empty: by the widening |
struct PresentConduits {
  ConstView<laws::Conduit*> conduit = {};
  ConstView<Real*> aperture = {};

  KOKKOS_INLINE_FUNCTION bool is_given() const { return aperture.extent(0) > 0; }
  /// Transmissivity, m^3/(Pa s), and its derivative by the widening, m.
  KOKKOS_INLINE_FUNCTION Real transmissivity(int face, Real widening) const {
    return is_given() ? conduit(face).transmissivity_of(aperture(face)) : conduit(face).transmissivity(widening);
  }
  KOKKOS_INLINE_FUNCTION Real dtransmissivity(int face, Real widening) const {
    return is_given() ? 0 : conduit(face).dtransmissivity(widening);
  }
  /// With given apertures, the difference from the face to its ends is the present one, without derivatives. A state
  /// with the given apertures then has the same flow. The derivatives are those of constant transmissivities: the
  /// iteration with given apertures is more robust than Newton's method where joints open.
  template <int n>
  KOKKOS_INLINE_FUNCTION EndTransmissivities<n> at_ends(int face, Real widening, const Real (&rise)[n]) const {
    if (!is_given()) return EndTransmissivities<n>(conduit(face), widening, rise);
    const EndTransmissivities<n> present(conduit(face), aperture(face), 0, widening, rise);
    EndTransmissivities<n> result;
    for (int j = 0; j < n; ++j) result.value[j] = present.value[j];
    return result;
  }
};

}  // namespace sprekk::transport
