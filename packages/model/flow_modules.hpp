// The modules of a scene's flow.
#pragma once

#include "assembly/module.hpp"
#include "model/scene.hpp"

#include <memory>
#include <vector>

namespace sprekk::model {

/// `initial_jumps` [owned fracture face], along the normal, if the rock deforms. Collective.
std::vector<std::unique_ptr<assembly::Module>> make_flow(const Scene& scene, const mesh::Mesh& mesh,
                                                         const std::vector<Real>& initial_jumps = {});

/// What mechanics and flow are to each other.
std::unique_ptr<assembly::Module> make_coupling(const Scene& scene, const mesh::Mesh& mesh);

/// The pressure that a host gives.
std::unique_ptr<assembly::Module> make_given(const Scene& scene, const mesh::Mesh& mesh);

/// Permeability over viscosity, m^2/(Pa s). Collective.
Real largest_mobility(const Scene& scene, const mesh::Mesh& mesh);

}  // namespace sprekk::model
