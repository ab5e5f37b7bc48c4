// Warnings about pressures that open fractures.
#pragma once

#include "physics/physics.hpp"

#include <string>
#include <vector>

namespace sprekk::physics {

/// Warns about prescribed pressures of wells, boundaries and fractures above the smallest principal compression of the
/// initial stress at the same place, in 2D of the directions in the plane. Fractures normal to this stress open.
/// Collective.
std::vector<std::string> hydraulic_opening_doubts(const Setting& setting, const std::vector<Real>& times);

/// Warns if wells with a given rate raise the pressure in fractures above this compression. Fractures with an
/// `unbroken` part or a `toughness` open by design; scenes with them have no such warning. Collective.
std::vector<std::string> opening_by_rate_doubts(const Setting& setting,
                                                const std::vector<assembly::OutputField>& outputs);

}  // namespace sprekk::physics
