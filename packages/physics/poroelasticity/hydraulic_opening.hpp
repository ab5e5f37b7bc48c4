// Warnings about prescribed pressures that open fractures.
#pragma once

#include "physics/physics.hpp"

#include <string>
#include <vector>

namespace sprekk::physics {

/// Warns about prescribed pressures of wells, boundaries and fractures above the smallest principal compression of the
/// initial stress at the same place, in 2D of the directions in the plane. Fractures normal to this stress open.
/// Collective.
std::vector<std::string> hydraulic_opening_doubts(const Setting& setting, const std::vector<Real>& times);

}  // namespace sprekk::physics
