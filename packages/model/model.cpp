#include "model/model.hpp"

#include "assembly/geometry.hpp"
#include "base/any_rank.hpp"
#include "base/text.hpp"
#include "mesh/distribute.hpp"
#include "mesh/facets.hpp"
#include "mesh/number_facets.hpp"
#include "model/fingerprint.hpp"
#include "model/flow_modules.hpp"
#include "model/properties.hpp"
#include "model/scene_check.hpp"
#include "model/uniqueness.hpp"
#include "physics/poroelasticity/given_pressure.hpp"
#include "physics/mechanics/mechanics.hpp"

#include <Teuchos_CommHelpers.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace sprekk::model {

namespace {

/// Mean over a fracture face whose cell on side minus is local.
Real mean(const mesh::Mesh& mesh, const mesh::Mesh::FractureFace& face, const Material::Value& value) {
  Real sum = 0, total = 0;
  mesh::for_shape(mesh.shape, [&](auto shape) {
    assembly::for_each_face_point<shape()>(mesh, face.cell[mesh::minus], face.local_face[mesh::minus],
                                           [&](const auto&, Real area, const auto& x) {
                                             sum += area * value(x, 0);
                                             total += area;
                                           });
  });
  return sum / total;
}

/// The law of a face is that at its centre, with the mean of its gap and of the jump that it starts with: jumps are
/// means, too.
Properties<physics::JointParameters> joints(const Scene& scene, const mesh::Mesh& mesh) {
  const auto section = [&](int fracture) -> const Fracture& {
    return scene.fractures.at(mesh.fracture_names[fracture]);
  };
  const auto material = [&](int fracture) -> const Material& { return scene.materials.at(section(fracture).material); };
  std::vector<int> fracture_of;
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) fracture_of.push_back(mesh.fracture_faces[f].fracture);
  return properties<physics::JointParameters>(
      static_cast<int>(mesh.fracture_names.size()), fracture_of,
      [&](int fracture) {
        const auto& jump = section(fracture).plastic_jump;
        return material(fracture).is_uniform() &&
               std::all_of(jump.begin(), jump.end(), [](const auto& value) { return value.is_constant(); });
      },
      [&](int fracture, int f) {
        const auto& jump = section(fracture).plastic_jump;
        auto joint = at_place(scene, material(fracture), [&] {
          return material(fracture).joint(f < 0 ? std::array<Real, 3>{} : mesh.fracture_faces[f].centre);
        });
        for (std::size_t k = 0; k < jump.size(); ++k)
          joint.plastic_jump[k] = f < 0 ? jump[k]({}, 0) : mean(mesh, mesh.fracture_faces[f], jump[k]);
        if (f < 0) return joint;
        const auto& face = mesh.fracture_faces[f];
        if (const auto& gap = material(fracture).initial_gap; !gap.is_constant())
          joint.law.gap.initial = mean(mesh, face, gap);
        return joint;
      });
}

physics::BodyForce body_force(const Scene& scene, const mesh::Mesh& mesh) {
  physics::BodyForce force{scene.bulk.body_force, scene.bulk.gravity, {}};
  if (force.gravity.empty()) return force;
  for (LocalIndex cell = 0; cell < mesh.n_cells(); ++cell)
    force.density_of_cell.push_back(
        (*scene.material_of(mesh.region_names[mesh.cell_region[cell]]).density)(mesh::cell_centre(mesh, cell), 0));
  return force;
}

/// The element of that name, or an Error that lists those there are.
template <class T, class Name>
T& named(std::vector<T>& all, const std::string& name, const Name& name_of, const char* what) {
  std::vector<std::string> names;
  for (auto& element : all) {
    names.push_back(name_of(element));
    if (names.back() == name) return element;
  }
  throw Error(fmt::format("there is no {} \"{}\", but {}{}", what, name, base::quoted_list(names),
                          base::did_you_mean(name, names)));
}

/// The name of a block's unknowns in a checkpoint.
std::string key_of(const fields::Block& block) { return "unknowns: " + block.name; }

/// A vector's values by entity and component.
View<Real**> entries(fields::Vector& vector, int n_components) {
  const auto local = vector.getLocalViewDevice(Tpetra::Access::ReadWrite);
  return View<Real**>(local.data(), local.extent(0) / n_components, n_components);
}

void redistribute(const fields::Vector& from, fields::Vector& to) {
  to.doImport(from, fields::Import(from.getMap(), to.getMap()), Tpetra::REPLACE);
}

physics::MechanicsParameters mechanics(const Scene& scene, const mesh::Mesh& mesh) {
  const auto rock = elasticity(scene, mesh);
  physics::BulkMomentumParameters bulk{
      rock.values, body_force(scene, mesh), {}, scene.initial_stress(mesh.region_names), rock.number};
  for (const auto& [name, condition] : scene.boundary_conditions)
    if (!condition.traction.empty())
      bulk.tractions.push_back({index_of(mesh.boundary_names, condition.boundary), condition.traction,
                                condition.region ? index_of(mesh.region_names, *condition.region) : -1});
  if (mesh.fracture_names.empty()) return {bulk};
  const auto joint = joints(scene, mesh);
  physics::FluidPressure initial;
  if (scene.has_unknown_pressure()) initial.value.assign(mesh.fracture_names.size(), scene.initial_pressure());
  return {bulk,
          joint.values,
          joint.number,
          scene.fluid_pressure(mesh.fracture_names),
          initial,
          scene.has_unknown_pressure(),
          scene.time.start,
          scene.augmentation};
}

}  // namespace

std::vector<std::unique_ptr<assembly::Module>> make_modules(const Scene& scene, const mesh::Mesh& mesh) {
  if (!scene.deforms()) return make_flow(scene, mesh);
  physics::MechanicsParameters parameters;
  base::collectively(*mesh.comm, [&] { parameters = mechanics(scene, mesh); });
  auto modules = physics::make_mechanics(mesh, parameters);
  if (scene.host_fluid) {
    modules.push_back(scene.host_fluid->unknown ? make_coupling(scene, mesh) : make_given(scene, mesh));
    return modules;
  }
  if (!scene.flow) return modules;
  std::vector<Real> widths;
  base::collectively(*mesh.comm, [&] {
    for (const auto& jump : physics::initial_jumps(mesh, physics::jump_parameters(mesh, parameters)))
      widths.push_back(jump[0]);
  });
  for (auto& module : make_flow(scene, mesh, widths)) modules.push_back(std::move(module));
  modules.push_back(make_coupling(scene, mesh));
  return modules;
}

std::unique_ptr<physics::StressRecovery> make_stress_recovery(const Scene& scene, RCP<const mesh::Mesh> mesh,
                                                              const physics::ByField<const fields::Layout*>& layouts) {
  const auto rock = elasticity(scene, *mesh);
  return physics::make_stress_recovery(mesh, layouts, rock.values, rock.number);
}

namespace {

/// A condition on the end of a fracture that is not on its boundary would hold nowhere. Collective.
void check_ends(const Scene& scene, const mesh::Mesh& mesh) {
  const auto n = mesh.boundary_names.size();
  std::vector<int> here(n * mesh.fracture_names.size(), 0), anywhere(here.size());
  if (mesh.facets.is_null() || here.empty()) return;
  for (const auto& rim : mesh.facets->rims) here[mesh.fracture_faces[rim.face].fracture * n + rim.boundary] = 1;
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_MAX, static_cast<int>(here.size()), here.data(), anywhere.data());
  for (const auto& [name, condition] : scene.boundary_conditions) {
    if (!condition.fracture) continue;
    const auto first = anywhere.begin() + index_of(mesh.fracture_names, *condition.fracture) * n;
    std::vector<std::string> ends;
    for (std::size_t b = 0; b < n; ++b)
      if (first[b]) ends.push_back(mesh.boundary_names[b]);
    SPREKK_CHECK(first[index_of(mesh.boundary_names, condition.boundary)],
                 "{}: Sprekk > Boundary conditions > {} > \"fracture\": \"{}\" does not end on \"{}\"; it ends on {}",
                 scene.origin, name, *condition.fracture, condition.boundary,
                 ends.empty() ? "no boundary" : base::quoted_list(ends));
  }
}

}  // namespace

Model::Model(const Scene& scene, RCP<const Comm> comm, const ModuleFactory& more_modules)
    : timers_(rcp(new base::Timers)), time_(scene.time.start) {
  auto draft = prepared(scene);
  RCP<const mesh::Mesh> mesh;
  std::string unheld;  // by the scene, but perhaps by modules; known where the whole mesh is
  {
    const auto scope = timers_->scope("mesh");
    mesh = mesh::make_distributed([&] { return checked_mesh(draft, more_modules ? &unheld : nullptr); }, comm);
    mesh = draft.value.refined(mesh);
    if (draft.value.has_unknown_pressure()) mesh = mesh::with_facets(mesh);
  }
  scene_ = std::move(draft.value);
  check_ends(scene_, *mesh);
  std::vector<std::unique_ptr<assembly::Module>> modules;
  base::collectively(*comm, [&] {
    modules = make_modules(scene_, *mesh);
    if (more_modules)
      for (auto& module : more_modules(*mesh)) modules.push_back(std::move(module));
    const bool held = std::any_of(modules.begin(), modules.end(), [](const auto& m) { return m->holds_bodies(); });
    SPREKK_CHECK(unheld.empty() || held, "{}: {}", scene_.origin, unheld);
  });
  std::vector<assembly::DirichletCondition> conditions;
  for (const char* field : {"displacement", "face pressure"})
    for (auto& condition : dirichlet_conditions(scene_.boundary_conditions, group_names(*mesh), field))
      conditions.push_back(std::move(condition));
  for (const auto& [name, region] : scene_.regions)
    for (const char* field : {"pressure", "face pressure"})
      if (region.pressure)
        conditions.push_back({"Regions > " + name, field, -1, {*region.pressure}, index_of(mesh->region_names, name)});
  system_ = std::make_unique<assembly::System>(
      mesh, std::move(modules), conditions, timers_,
      scene_.time.scheme == "BDF2" ? assembly::Rates::Scheme::bdf2 : assembly::Rates::Scheme::implicit_euler);
  x_ = system_->initial();
  start_solver();
}

void Model::start_solver() {
  const auto scope = timers_->scope("set-up of the solver");
  stepper_.reset();
  newton_.reset();
  newton_ = std::make_unique<solve::Newton>(*system_, scene_.solver, timers_);
  stepper_ = std::make_unique<solve::TimeStepper>(*system_, *newton_, scene_.time.stepping);
}

solve::StepReport Model::step_to(Real t) {
  SPREKK_CHECK(t > time_, "a step to t = {} is no step forward: the model is at t = {}", t, time_);
  const auto scope = timers_->scope("time steps");
  beginning_ = beginning();
  auto report = stepper_->advance(x_, time_, t);
  if (report.converged || report.stopped) return report;
  if (const auto doubt = friction_doubt(scene_); !doubt.empty()) report.reason += "; " + doubt;
  const bool changes = base::any_rank(*mesh().comm, [&] {
    return std::find(report.unsettled.begin(), report.unsettled.end(), 1) != report.unsettled.end();
  });
  if (!changes) return report;  // it fails for another reason
  if (const auto doubt = dilation_doubt(scene_, mesh()); !doubt.empty()) report.reason += "; " + doubt;
  return report;
}

Model::Beginning Model::beginning() {
  Beginning now{fields::create_like(x_), {}, system_->memory(), time_};
  fields::copy(x_, now.x);
  for (const auto& [field, values] : system_->histories()) {
    now.histories.emplace_back(field.name, values.extent(0), values.extent(1));
    Kokkos::deep_copy(now.histories.back(), values);
  }
  return now;
}

void Model::take_back() {
  SPREKK_CHECK(beginning_.has_value(), "there is no step to take back, at t = {}", time_);
  fields::copy(beginning_->x, x_);
  std::size_t k = 0;
  for (const auto& [field, values] : system_->histories()) Kokkos::deep_copy(values, beginning_->histories[k++]);
  time_ = beginning_->time;
  system_->resume(x_, beginning_->memory);
  beginning_.reset();
}

void Model::set_fluid_pressure(const std::vector<Real>& rock, const std::vector<Real>& fractures) {
  physics::GivenPressure* given = nullptr;
  for (const auto& module : system_->modules())
    if (auto* found = dynamic_cast<physics::GivenPressure*>(module.get())) given = found;
  SPREKK_CHECK(given, "{}: the pressure of a fluid is set, but the scene has no host_fluid whose pressure is given",
               scene_.origin);
  base::collectively(*mesh().comm, [&] {
    const std::size_t n_cells = mesh().n_owned_cells, n_faces = mesh().n_owned_fracture_faces;
    SPREKK_CHECK(rock.size() == n_cells && fractures.size() == n_faces,
                 "pressures of {} cells and {} fracture faces are given, a rank has {} and {}", rock.size(),
                 fractures.size(), n_cells, n_faces);
    for (const auto* values : {&rock, &fractures})
      for (const Real p : *values) SPREKK_CHECK(std::isfinite(p), "a given pressure is {}", p);
  });
  const auto above = [&](std::vector<Real> values, fields::Entity entity) {
    for (Real& p : values) p -= scene_.host_fluid->initial_pressure;
    return with_ghosts(mesh(), entity, values);
  };
  given->set(above(rock, fields::Entity::cell), above(fractures, fields::Entity::fracture_face));
}

FieldView Model::field(const std::string& name) {
  std::vector<FieldView> all;
  for (std::size_t b = 0; b < x_.size(); ++b) {
    const auto& field = system_->layouts()[b].field();
    all.push_back({field, entries(*x_[b], field.n_components)});
  }
  for (const auto& [field, values] : system_->histories()) all.push_back({field, values});
  return named(
      all, name, [](const FieldView& f) { return f.field.name; }, "field");
}

assembly::OutputField Model::output(const std::string& name) {
  auto all = system_->outputs(x_);
  return named(
      all, name, [](const assembly::OutputField& f) { return f.name; }, "output");
}

io::Checkpoint Model::save() {
  io::Checkpoint checkpoint;
  for (std::size_t b = 0; b < x_.size(); ++b)
    checkpoint.vectors[key_of(system_->blocks()[b])] = rcp(new fields::Vector(*x_[b], Teuchos::Copy));
  for (const auto& [field, values] : system_->histories()) {
    const auto vector = rcp(new fields::Vector(fields::owned_map(field, mesh())));
    Kokkos::deep_copy(entries(*vector, field.n_components), values);
    checkpoint.vectors[field.name] = vector;
  }
  const auto memory = system_->memory();
  checkpoint.content = {{"time", time_},
                        {"dt", memory.dt},
                        {"scales", memory.scales},
                        {"calibration", memory.calibration},
                        {"scene", fingerprint(scene_, *system_)}};
  start_solver();
  return checkpoint;
}

void Model::restore(const io::Checkpoint& checkpoint) {
  beginning_.reset();
  const auto& content = checkpoint.content;
  check_fingerprint(content.at("scene"), fingerprint(scene_, *system_));
  for (std::size_t b = 0; b < x_.size(); ++b)
    redistribute(*checkpoint.vectors.at(key_of(system_->blocks()[b])), *x_[b]);
  for (const auto& [field, values] : system_->histories()) {
    fields::Vector vector(fields::owned_map(field, mesh()));
    redistribute(*checkpoint.vectors.at(field.name), vector);
    Kokkos::deep_copy(values, entries(vector, field.n_components));
  }
  time_ = content.at("time");
  system_->resume(x_, {time_, content.at("dt"), content.at("scales"), content.at("calibration")});
  start_solver();
}

}  // namespace sprekk::model
