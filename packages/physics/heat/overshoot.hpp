// Detection of temperatures outside of the range of the scene.
#pragma once

#include "assembly/module.hpp"
#include "physics/heat/thermal_expansion.hpp"
#include "physics/scene.hpp"

#include <string>
#include <vector>

namespace sprekk::physics {

/// Warning about temperatures outside of the range of all values given so far: initial values, boundaries, regions and
/// wells. The tolerance is 1e-3 of this range. Empty if there is no overshoot. By the maximum principle, exact
/// solutions stay in the range unless sources, heat fluxes or friction heat or cool the rock. Only bounds that these
/// cannot exceed are checked. `times`: start time and end times of all steps so far, s, not empty. Collective.
std::string overshoot_warning(const Setting& setting, const std::vector<Real>& times,
                              const std::vector<GivenTemperature>& given,
                              const std::vector<assembly::OutputField>& outputs);

}  // namespace sprekk::physics
