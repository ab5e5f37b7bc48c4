#include "model/model.hpp"

#include "mesh/distribute.hpp"
#include "physics/bulk_momentum.hpp"
#include "physics/elastic_plastic_jump.hpp"
#include "physics/interface_traction_balance.hpp"

#include <algorithm>

namespace sprekk::model {

namespace {

int index_of(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

std::vector<laws::Elasticity> elasticity(const Scene& scene, const mesh::Mesh& mesh) {
  return std::vector<laws::Elasticity>(mesh.region_names.size(),
                                       laws::lame_constants(scene.materials.at(scene.bulk.material).elastic));
}

std::vector<assembly::DirichletCondition> dirichlet_conditions(const Scene& scene, const mesh::Mesh& mesh) {
  std::vector<assembly::DirichletCondition> conditions;
  for (const auto& [name, given] : scene.boundary_conditions) {
    if (given.displacement.empty()) continue;
    assembly::DirichletCondition condition{name, "displacement", index_of(mesh.boundary_names, given.boundary), {}};
    for (const auto& value : given.displacement)
      condition.values.push_back(value.text() == "free" ? std::nullopt : std::make_optional(value));
    conditions.push_back(condition);
  }
  return conditions;
}

assembly::Reference reference(const Scene& scene) {
  Real length = 0;
  for (int i = 0; i < scene.dim(); ++i)
    length = std::max(length, scene.mesh.upper_corner[i] - scene.mesh.lower_corner[i]);
  return {laws::lame_constants(scene.materials.at(scene.bulk.material).elastic).youngs_modulus(), length};
}

}  // namespace

std::vector<std::unique_ptr<assembly::Module>> make_modules(const Scene& scene, const mesh::Mesh& mesh) {
  physics::BulkMomentumParameters bulk{elasticity(scene, mesh), scene.bulk.body_force, {}};
  for (const auto& [name, condition] : scene.boundary_conditions)
    if (!condition.traction.empty())
      bulk.tractions.push_back({index_of(mesh.boundary_names, condition.boundary), condition.traction});
  std::vector<std::unique_ptr<assembly::Module>> modules;
  modules.push_back(physics::make_bulk_momentum(mesh.shape, bulk));
  if (mesh.fracture_names.empty()) return modules;
  modules.push_back(physics::make_interface_traction_balance(mesh.shape, {bulk.elasticity, bulk.body_force}));
  physics::ElasticPlasticJumpParameters jump{{}, bulk.elasticity};
  for (const auto& name : mesh.fracture_names)
    jump.joints.push_back(scene.materials.at(scene.fractures.at(name).material).joint());
  modules.push_back(physics::make_elastic_plastic_jump(mesh.shape, jump));
  return modules;
}

Model::Model(const Scene& scene, RCP<const Comm> comm) : scene_(scene), timers_(rcp(new base::Timers)), time_(scene.time.start) {
  RCP<const mesh::Mesh> mesh;
  {
    const auto scope = timers_->scope("mesh");
    mesh = mesh::make_distributed(mesh::make_box(scene_.mesh), comm);
  }
  system_ = std::make_unique<assembly::System>(mesh, make_modules(scene_, *mesh), dirichlet_conditions(scene_, *mesh),
                                               reference(scene_), timers_);
  x_ = system_->initial();
  const auto scope = timers_->scope("set-up of the solver");
  newton_ = std::make_unique<solve::Newton>(*system_, scene_.solver, timers_);
  stepper_ = std::make_unique<solve::TimeStepper>(*system_, *newton_, scene_.time.stepping);
}

solve::StepReport Model::step_to(Real t) {
  const auto scope = timers_->scope("time steps");
  const auto report = stepper_->advance(x_, time_, t);
  time_ = report.time;
  return report;
}

}  // namespace sprekk::model
