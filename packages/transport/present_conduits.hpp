// Transmissivities of fracture faces as functions of their apertures.
#pragma once

#include "base/types.hpp"
#include "laws/conduit.hpp"

namespace sprekk::transport {

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
};

}  // namespace sprekk::transport
