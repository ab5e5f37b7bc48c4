#include "physics/mechanics.hpp"

#include "physics/interface_traction_balance.hpp"
#include "physics/tip_enrichment.hpp"

namespace sprekk::physics {

std::vector<std::unique_ptr<assembly::Module>> make_mechanics(const mesh::Mesh& mesh,
                                                              const MechanicsParameters& parameters) {
  const auto& [bulk, joints, joint_of_face, fluid, start, augmentation] = parameters;
  std::vector<std::unique_ptr<assembly::Module>> modules;
  modules.push_back(make_bulk_momentum(mesh.shape, bulk));
  if (mesh.fracture_names.empty()) return modules;
  modules.push_back(make_interface_traction_balance(
      mesh.shape, {bulk.elasticity, bulk.body_force, bulk.initial_stress, bulk.elasticity_of_cell, fluid}));
  const bool tips = mesh.n_global_enriched > 0;
  modules.push_back(
      make_elastic_plastic_jump(mesh.shape, {joints, bulk.elasticity, bulk.initial_stress, bulk.elasticity_of_cell,
                                             joint_of_face, augmentation, fluid, start, tips}));
  if (tips) modules.push_back(make_tip_enrichment(mesh.shape, bulk, fluid));
  return modules;
}

}  // namespace sprekk::physics
