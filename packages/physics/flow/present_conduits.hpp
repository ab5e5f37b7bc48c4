// Transmissivities of fracture faces that follow their apertures.
#pragma once

#include "base/types.hpp"
#include "laws/conduit.hpp"

namespace sprekk::physics {

/// Of faces that widen, or by hydraulic apertures that are given: State::coefficients.
///
/// | conduit  | [face] |                               |
/// | aperture | [face] | hydraulic, m; empty: by x     |
struct PresentConduits {
  ConstView<laws::Conduit*> conduit = {};
  ConstView<Real*> aperture = {};

  KOKKOS_INLINE_FUNCTION bool is_given() const { return aperture.extent(0) > 0; }
  /// m^3/(Pa s), and its derivative in the widening, m.
  KOKKOS_INLINE_FUNCTION Real transmissivity(int face, Real widening) const {
    return is_given() ? conduit(face).transmissivity_of(aperture(face)) : conduit(face).transmissivity(widening);
  }
  KOKKOS_INLINE_FUNCTION Real dtransmissivity(int face, Real widening) const {
    return is_given() ? 0 : conduit(face).dtransmissivity(widening);
  }
};

}  // namespace sprekk::physics
