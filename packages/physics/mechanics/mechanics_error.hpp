// Spatial error of stress, jumps and reactions.
#pragma once

#include "estimate/mesh_error.hpp"
#include "physics/physics.hpp"

#include <memory>

namespace sprekk::physics {

/// Creates the error estimator of the stress; null without displacements. The energy is |s* - s_h|^2 with the recovered
/// stress s*, see StressRecovery. The residuals of the exact solution are:
///
/// * residual forces of the recovered stress and traction;
/// * errors of prescribed displacements between nodes;
/// * errors on faces where contact begins or ends.
///
/// The error of jumps is an output. Quantities of interest are those of FractureGoals and reactions. Refers to scene,
/// mesh and system. Collective.
std::unique_ptr<estimate::MeshError> make_mechanics_error(const Setting& setting, assembly::System& system);

}  // namespace sprekk::physics
