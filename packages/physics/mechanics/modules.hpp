// Modules of the mechanics of fractured rock.
#pragma once

#include "physics/mechanics/bulk_momentum.hpp"
#include "physics/mechanics/elastic_foundation.hpp"
#include "physics/mechanics/elastic_plastic_jump.hpp"

#include <map>
#include <string>

namespace sprekk::physics {

struct MechanicsParameters {
  BulkMomentumParameters bulk;
  std::map<std::string, ElasticFoundationParameters> foundations = {};  ///< [name of the boundary condition]
  fields::Properties<Real> solid_modulus = {};            ///< [cell] see SolidPressureParameters; empty: zero
  fields::Properties<laws::JointParameters> joints = {};  ///< of owned fracture faces, grouped by fractures
  FluidPressure fluid_pressure = {};
  FluidPressure initial_pressure = {};  ///< initial "face pressure" of a fluid with unknown pressure
  Real start = 0;                       ///< time of the initial state, s
  PrescribedSlips prescribed_slips = {};
  Real augmentation = 0.3;    ///< see ElasticPlasticJumpParameters
  std::string power_to = "";  ///< see ElasticPlasticJumpParameters
};

/// Parameters of the module for jumps.
ElasticPlasticJumpParameters jump_parameters(const mesh::Mesh& mesh, const MechanicsParameters& parameters);

/// Creates the modules that a mesh requires: momentum of the bulk, springs under boundaries, and a solid pressure for
/// nearly incompressible rock. With fractures also the traction balance of their sides and the split of their jumps.
/// With enriched tips (mesh::Mesh::enriched) also the tip functions. Collective.
std::vector<std::unique_ptr<assembly::Module>> make_mechanics(const mesh::Mesh& mesh,
                                                              const MechanicsParameters& parameters);

}  // namespace sprekk::physics
