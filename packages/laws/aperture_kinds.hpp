// All laws of the aperture that a fluid flows in; the first is that of joints that name none.
#pragma once

#include "laws/aperture/barton.hpp"
#include "laws/aperture/mechanical.hpp"
#include "laws/kinds.hpp"

namespace sprekk::laws {

// clang-format off

/// Which aperture a fluid flows in where the walls are a apart, m: Real hydraulic(Real a), and its derivative slope(a).
using ApertureKinds = Kinds<
    MechanicalAperture,
    BartonAperture>;

// clang-format on

}  // namespace sprekk::laws
