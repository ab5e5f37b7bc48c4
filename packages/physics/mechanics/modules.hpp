// All modules of the mechanics of fractured rock.
#pragma once

#include "physics/mechanics/bulk_momentum.hpp"
#include "physics/mechanics/elastic_foundation.hpp"
#include "physics/mechanics/elastic_plastic_jump.hpp"

#include <map>
#include <string>

namespace sprekk::physics {

struct MechanicsParameters {
  BulkMomentumParameters bulk;
  std::map<std::string, ElasticFoundationParameters> foundations = {};  ///< by their boundary conditions
  Properties<Real> solid_modulus = {};      ///< of cells, see SolidPressureParameters; empty: no rock has one
  Properties<JointParameters> joints = {};  ///< of owned fracture faces, in groups by fractures
  FluidPressure fluid_pressure = {};
  FluidPressure initial_pressure = {};  ///< or, of a fluid of unknown pressure, "face pressure", at the start
  Real start = 0;                       ///< time of the initial state, s
  Real augmentation = 0.3;              ///< see ElasticPlasticJumpParameters
  std::string power_to = "";            ///< see there
};

/// Of the module for jumps.
ElasticPlasticJumpParameters jump_parameters(const mesh::Mesh& mesh, const MechanicsParameters& parameters);

/// What a mesh needs: the momentum of the bulk, with springs under boundaries and a solid pressure where rock is nearly
/// incompressible; with fractures, the traction balance of their sides and the split of their jumps; with enriched tips
/// (mesh::Mesh::enriched), the functions around them. Collective.
std::vector<std::unique_ptr<assembly::Module>> make_mechanics(const mesh::Mesh& mesh,
                                                              const MechanicsParameters& parameters);

}  // namespace sprekk::physics
