// List of the laws of the hydraulic aperture. The first is the default.
#pragma once

#include "laws/aperture/barton.hpp"
#include "laws/aperture/mechanical.hpp"
#include "laws/kinds.hpp"

namespace sprekk::laws {

// clang-format off

/// Hydraulic aperture, m, at the mechanical aperture a, m: Real hydraulic(Real a), its derivative slope(a), and the
/// inverse mechanical(e).
using ApertureKinds = Kinds<
    MechanicalAperture,
    BartonAperture>;

// clang-format on

}  // namespace sprekk::laws
