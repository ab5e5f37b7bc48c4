#include "model/model.hpp"

#include "mesh/distribute.hpp"
#include "physics/bulk_momentum.hpp"
#include "physics/elastic_plastic_jump.hpp"
#include "physics/interface_traction_balance.hpp"

#include <Teuchos_CommHelpers.hpp>

#include <fmt/ranges.h>

#include <algorithm>
#include <array>

namespace sprekk::model {

namespace {

int index_of(const std::vector<std::string>& names, const std::string& name) {
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

std::array<Real, 3> centre(const mesh::Mesh& mesh, LocalIndex cell) {
  std::array<Real, 3> x{};
  const int n = mesh::n_corners(mesh.shape);
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < mesh.dim(); ++i)
      x[i] += mesh.coordinates[mesh.cells[cell * mesh.nodes_per_cell() + k] * mesh.dim() + i] / n;
  return x;
}

/// The different values of a property, and which of them each entity has; no list of numbers where the group of an
/// entity (region, fracture) tells.
template <class T>
struct Properties {
  std::vector<T> values;
  std::vector<int> number;
};

/// `uniform` and `at(group, entity)` tell of a group whether one value holds everywhere, and the value at an entity's
/// place.
template <class T, class Uniform, class At>
Properties<T> properties(int n_groups, const std::vector<int>& group_of, const Uniform& uniform, const At& at) {
  Properties<T> result;
  bool all_uniform = true;
  for (int group = 0; group < n_groups; ++group) {
    all_uniform = all_uniform && uniform(group);
    result.values.push_back(uniform(group) ? at(group, -1) : T());
  }
  if (all_uniform) return result;
  for (int entity = 0; entity < static_cast<int>(group_of.size()); ++entity) {
    const int group = group_of[entity];
    result.number.push_back(uniform(group) ? group : static_cast<int>(result.values.size()));
    if (!uniform(group)) result.values.push_back(at(group, entity));
  }
  return result;
}

Properties<laws::Elasticity> elasticity(const Scene& scene, const mesh::Mesh& mesh) {
  const auto material = [&](int region) -> const Material& { return scene.material_of(mesh.region_names[region]); };
  return properties<laws::Elasticity>(
      static_cast<int>(mesh.region_names.size()), mesh.cell_region,
      [&](int region) { return material(region).is_uniform(); },
      [&](int region, int cell) {
        return material(region).elasticity(cell < 0 ? std::array<Real, 3>{} : centre(mesh, cell));
      });
}

Properties<physics::JointParameters> joints(const Scene& scene, const mesh::Mesh& mesh) {
  const auto material = [&](int fracture) -> const Material& {
    return scene.materials.at(scene.fractures.at(mesh.fracture_names[fracture]).material);
  };
  std::vector<int> fracture_of;
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) fracture_of.push_back(mesh.fracture_faces[f].fracture);
  return properties<physics::JointParameters>(
      static_cast<int>(mesh.fracture_names.size()), fracture_of,
      [&](int fracture) { return material(fracture).is_uniform(); },
      [&](int fracture, int face) {
        return material(fracture).joint(face < 0 ? std::array<Real, 3>{} : mesh.fracture_faces[face].centre);
      });
}

physics::BodyForce body_force(const Scene& scene, const mesh::Mesh& mesh) {
  physics::BodyForce force{scene.bulk.body_force, scene.bulk.gravity, {}};
  if (force.gravity.empty()) return force;
  for (LocalIndex cell = 0; cell < mesh.n_cells(); ++cell)
    force.density_of_cell.push_back(
        scene.material_of(mesh.region_names[mesh.cell_region[cell]]).density(centre(mesh, cell), 0));
  return force;
}

std::vector<assembly::DirichletCondition> dirichlet_conditions(const Scene& scene, const mesh::Mesh& mesh) {
  std::vector<assembly::DirichletCondition> conditions;
  for (const auto& [name, given] : scene.boundary_conditions) {
    if (given.displacement.empty()) continue;
    assembly::DirichletCondition condition{name, "displacement", index_of(mesh.boundary_names, given.boundary), {}};
    if (given.region) condition.region = index_of(mesh.region_names, *given.region);
    for (const auto& value : given.displacement)
      condition.values.push_back(value.text() == "free" ? std::nullopt : std::make_optional(value));
    conditions.push_back(condition);
  }
  return conditions;
}

assembly::Reference reference(const Scene& scene, const mesh::Mesh& mesh) {
  Real here = 0, modulus = 0, length = 0;
  for (LocalIndex cell = 0; cell < mesh.n_owned_cells; ++cell) {
    const auto& material = scene.material_of(mesh.region_names[mesh.cell_region[cell]]);
    if (cell > 0 && material.is_uniform() && mesh.cell_region[cell] == mesh.cell_region[cell - 1]) continue;
    here = std::max(here, material.elasticity(centre(mesh, cell)).youngs_modulus());
  }
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_MAX, 1, &here, &modulus);
  std::vector<Real> corner(2 * mesh.dim(), -std::numeric_limits<Real>::max()), all(corner.size());
  for (std::size_t k = 0; k < mesh.coordinates.size(); ++k) {
    const std::size_t i = k % mesh.dim();
    corner[2 * i] = std::max(corner[2 * i], mesh.coordinates[k]);
    corner[2 * i + 1] = std::max(corner[2 * i + 1], -mesh.coordinates[k]);
  }
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_MAX, 2 * mesh.dim(), corner.data(), all.data());
  for (int i = 0; i < mesh.dim(); ++i) length = std::max(length, all[2 * i] + all[2 * i + 1]);
  return {modulus, length};
}

}  // namespace

std::vector<std::unique_ptr<assembly::Module>> make_modules(const Scene& scene, const mesh::Mesh& mesh) {
  const auto rock = elasticity(scene, mesh);
  const auto force = body_force(scene, mesh);
  const auto stress = scene.initial_stress();
  physics::BulkMomentumParameters bulk{rock.values, force, {}, stress, rock.number};
  for (const auto& [name, condition] : scene.boundary_conditions)
    if (!condition.traction.empty())
      bulk.tractions.push_back({index_of(mesh.boundary_names, condition.boundary), condition.traction,
                                condition.region ? index_of(mesh.region_names, *condition.region) : -1});
  std::vector<std::unique_ptr<assembly::Module>> modules;
  modules.push_back(physics::make_bulk_momentum(mesh.shape, bulk));
  if (mesh.fracture_names.empty()) return modules;
  modules.push_back(physics::make_interface_traction_balance(mesh.shape, {rock.values, force, stress, rock.number}));
  const auto joint = joints(scene, mesh);
  modules.push_back(
      physics::make_elastic_plastic_jump(mesh.shape, {joint.values, rock.values, stress, rock.number, joint.number}));
  return modules;
}

Model::Model(const Scene& scene, RCP<const Comm> comm)
    : scene_(scene), timers_(rcp(new base::Timers)), time_(scene.time.start) {
  RCP<const mesh::Mesh> mesh;
  {
    const auto scope = timers_->scope("mesh");
    mesh = mesh::make_distributed([&] { return scene_.make_mesh(); }, comm);
  }
  const auto misfits = scene_.misfits({mesh->dim(), mesh->region_names, mesh->boundary_names, mesh->fracture_names});
  SPREKK_CHECK(misfits.empty(), "Sprekk > {}", fmt::join(misfits, "\nSprekk > "));
  std::vector<std::unique_ptr<assembly::Module>> modules;
  base::collectively(*comm, [&] { modules = make_modules(scene_, *mesh); });
  system_ = std::make_unique<assembly::System>(mesh, std::move(modules), dirichlet_conditions(scene_, *mesh),
                                               reference(scene_, *mesh), timers_);
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
