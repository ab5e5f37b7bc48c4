#include "physics/mechanics/modules.hpp"

#include "base/over_ranks.hpp"
#include "physics/mechanics/interface_traction_balance.hpp"
#include "physics/mechanics/solid_pressure.hpp"
#include "physics/mechanics/spring_origin.hpp"
#include "physics/mechanics/tip_enrichment.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sprekk::physics {

namespace {

/// Largest number of history variables per face. Collective.
int max_history(const mesh::Mesh& mesh, const std::vector<laws::JointParameters>& joints) {
  int here = 0;
  for (const auto& joint : joints) here = std::max(here, joint.law.n_history(mesh.dim()));
  return base::max_over_ranks(*mesh.comm, here);
}

/// Returns whether friction of any rank depends on the slip rate. Collective.
bool depends_on_rate(const mesh::Mesh& mesh, const std::vector<laws::JointParameters>& joints) {
  const auto depends = [](const auto& joint) { return joint.law.depends_on_rate(); };
  return base::on_any_rank(*mesh.comm, std::any_of(joints.begin(), joints.end(), depends));
}

/// Quantities that joints of any rank provide. Collective.
std::vector<laws::JointQuantity> reported_quantities(const mesh::Mesh& mesh,
                                                     const std::vector<laws::JointParameters>& joints) {
  const auto all = laws::joint_quantities();
  std::vector<Real> reported(all.size());
  for (const auto& joint : joints)
    if (joint.law.n_history() > 0)
      for (std::size_t k = 0; k < all.size(); ++k)
        if (reported[k] == 0 && laws::quantity_of(joint.law, all[k].name)) reported[k] = 1;
  reported = base::max_over_ranks(*mesh.comm, reported);
  std::vector<laws::JointQuantity> result;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (reported[k] > 0) result.push_back(all[k]);
  return result;
}

/// Name of a spring module, unique for its location. History names must not contain "/".
std::string module_name(const std::string& condition, const mesh::Mesh& mesh,
                        const ElasticFoundationParameters& foundation) {
  auto name = fmt::format("elastic foundation of {} on {}", condition, mesh.boundary_names[foundation.boundary]);
  if (foundation.region >= 0) name += " at " + mesh.region_names[foundation.region];
  std::replace(name.begin(), name.end(), '/', ':');
  return name;
}

}  // namespace

ElasticPlasticJumpParameters jump_parameters(const mesh::Mesh& mesh, const MechanicsParameters& parameters) {
  const auto& bulk = parameters.bulk;
  const auto& fluid = parameters.initial_pressure.empty() ? parameters.fluid_pressure : parameters.initial_pressure;
  return {.joints = parameters.joints,
          .elasticity = bulk.elasticity,
          .initial_stress = bulk.initial_stress,
          .augmentation = parameters.augmentation,
          .fluid_pressure = fluid,
          .start = parameters.start,
          .prescribed_slips = parameters.prescribed_slips,
          .n_history = max_history(mesh, parameters.joints.values),
          .depends_on_rate = depends_on_rate(mesh, parameters.joints.values),
          .quantities = reported_quantities(mesh, parameters.joints.values),
          .power_to = parameters.power_to};
}

std::vector<std::unique_ptr<assembly::Module>> make_mechanics(const mesh::Mesh& mesh,
                                                              const MechanicsParameters& parameters) {
  const auto& bulk = parameters.bulk;
  const auto& fluid = parameters.fluid_pressure;
  std::vector<std::unique_ptr<assembly::Module>> modules;
  modules.push_back(make_bulk_momentum(mesh.shape, bulk));
  for (const auto& [name, foundation] : parameters.foundations)
    modules.push_back(make_spring_origin(make_elastic_foundation(mesh, foundation), module_name(name, mesh, foundation),
                                         foundation.stiffness, bulk.keeps_stress));
  if (!parameters.solid_modulus.values.empty())
    modules.push_back(make_solid_pressure({.elasticity = bulk.elasticity, .modulus = parameters.solid_modulus}));
  if (mesh.fracture_names.empty()) return modules;
  modules.push_back(make_interface_traction_balance(mesh.shape, {.elasticity = bulk.elasticity,
                                                                 .body_force = bulk.body_force,
                                                                 .initial_stress = bulk.initial_stress,
                                                                 .fluid_pressure = fluid}));
  modules.push_back(make_elastic_plastic_jump(mesh, jump_parameters(mesh, parameters)));
  if (mesh.n_global_enriched > 0) modules.push_back(make_tip_enrichment(mesh.shape, bulk, fluid));
  return modules;
}

}  // namespace sprekk::physics
