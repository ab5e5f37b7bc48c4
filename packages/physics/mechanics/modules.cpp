#include "physics/mechanics/modules.hpp"

#include "physics/mechanics/interface_traction_balance.hpp"
#include "physics/mechanics/tip_enrichment.hpp"

#include <Teuchos_CommHelpers.hpp>

#include <algorithm>

namespace sprekk::physics {

namespace {

/// How many numbers joints keep of a face, at most. Collective.
int most_kept(const mesh::Mesh& mesh, const std::vector<JointParameters>& joints) {
  int here = 0, all = 0;
  for (const auto& joint : joints) here = std::max(here, joint.law.n_history());
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_MAX, here, Teuchos::outArg(all));
  return all;
}

}  // namespace

ElasticPlasticJumpParameters jump_parameters(const mesh::Mesh& mesh, const MechanicsParameters& parameters) {
  const auto& bulk = parameters.bulk;
  const auto& fluid = parameters.initial_pressure.empty() ? parameters.fluid_pressure : parameters.initial_pressure;
  return {parameters.joints,
          bulk.elasticity,
          bulk.initial_stress,
          bulk.elasticity_of_cell,
          parameters.joint_of_face,
          parameters.augmentation,
          fluid,
          parameters.start,
          most_kept(mesh, parameters.joints)};
}

std::vector<std::unique_ptr<assembly::Module>> make_mechanics(const mesh::Mesh& mesh,
                                                              const MechanicsParameters& parameters) {
  const auto& bulk = parameters.bulk;
  const auto& fluid = parameters.fluid_pressure;
  std::vector<std::unique_ptr<assembly::Module>> modules;
  modules.push_back(make_bulk_momentum(mesh.shape, bulk));
  if (mesh.fracture_names.empty()) return modules;
  modules.push_back(make_interface_traction_balance(
      mesh.shape, {bulk.elasticity, bulk.body_force, bulk.initial_stress, bulk.elasticity_of_cell, fluid}));
  modules.push_back(make_elastic_plastic_jump(mesh, jump_parameters(mesh, parameters)));
  if (mesh.n_global_enriched > 0) modules.push_back(make_tip_enrichment(mesh.shape, bulk, fluid));
  return modules;
}

}  // namespace sprekk::physics
