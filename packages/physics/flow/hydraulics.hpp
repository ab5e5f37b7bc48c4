// Hydraulic data of fractures in the initial state.
#pragma once

#include "physics/physics.hpp"
#include "transport/fracture_flow.hpp"

#include <vector>

namespace sprekk::physics {

/// Hydraulic data of local fracture faces. Throws an Error if an aperture is not positive. Collective.
std::vector<transport::FractureFlowParameters::Face> hydraulics(const Setting& setting);

}  // namespace sprekk::physics
