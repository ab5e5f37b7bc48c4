// Temperatures beyond those that a scene gives.
#pragma once

#include "assembly/module.hpp"
#include "physics/heat/thermal_expansion.hpp"
#include "physics/scene.hpp"

#include <string>
#include <vector>

namespace sprekk::physics {

/// A warning if temperatures of a state are beyond all those that the scene has given until now (initial, on
/// boundaries, in regions, of wells) by more than 1e-3 of their span; else empty. By the maximum principle no exact
/// solution is beyond them on the side to which no source, heat flux or friction heats or cools; only that side is
/// compared. `times`: the start and the ends of all steps until now, s, not empty. Collective.
std::string overshoot_warning(const Setting& setting, const std::vector<Real>& times,
                              const std::vector<GivenTemperature>& given,
                              const std::vector<assembly::OutputField>& outputs);

}  // namespace sprekk::physics
