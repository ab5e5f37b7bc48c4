// Temperatures beyond those that a scene gives.
#pragma once

#include "assembly/module.hpp"
#include "physics/scene.hpp"

#include <string>
#include <vector>

namespace sprekk::physics {

/// A warning if temperatures of a state are beyond those that the scene gives now (initial, on boundaries, in regions,
/// of wells) by more than 1e-3 of their span, which no exact solution is; else empty. Empty also where heat comes from
/// sources, given heat fluxes or friction, and where a given temperature is an expression. Collective.
std::string overshoot_warning(const Scene& scene, const mesh::Mesh& mesh,
                              const std::vector<assembly::OutputField>& outputs);

}  // namespace sprekk::physics
