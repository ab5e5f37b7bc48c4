#include "model/model.hpp"

#include "assembly/geometry.hpp"
#include "base/text.hpp"
#include "mesh/distribute.hpp"
#include "mesh/extents.hpp"
#include "mesh/number_facets.hpp"
#include "model/fingerprint.hpp"
#include "model/scene_check.hpp"
#include "model/uniqueness.hpp"
#include "physics/darcy_flow.hpp"
#include "physics/fluid_storage.hpp"
#include "physics/fracture_flow.hpp"
#include "physics/mechanics.hpp"
#include "physics/poroelastic_coupling.hpp"
#include "physics/wells.hpp"

#include <Teuchos_CommHelpers.hpp>

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

/// The law of a face is that at its centre, with the mean of its gap: jumps are means, too.
Properties<physics::JointParameters> joints(const Scene& scene, const mesh::Mesh& mesh) {
  const auto material = [&](int fracture) -> const Material& {
    return scene.materials.at(scene.fractures.at(mesh.fracture_names[fracture]).material);
  };
  std::vector<int> fracture_of;
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) fracture_of.push_back(mesh.fracture_faces[f].fracture);
  return properties<physics::JointParameters>(
      static_cast<int>(mesh.fracture_names.size()), fracture_of,
      [&](int fracture) { return material(fracture).is_uniform(); },
      [&](int fracture, int f) {
        if (f < 0) return material(fracture).joint({});
        const auto& face = mesh.fracture_faces[f];
        auto joint = material(fracture).joint(face.centre);
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
        (*scene.material_of(mesh.region_names[mesh.cell_region[cell]]).density)(centre(mesh, cell), 0));
  return force;
}

/// Materials of the mesh's regions, by their numbers.
template <class Of>
auto by_region(const Scene& scene, const mesh::Mesh& mesh, const Of& of) {
  std::vector<decltype(of(scene.material_of("")))> values;
  for (const auto& name : mesh.region_names) values.push_back(of(scene.material_of(name)));
  return values;
}

/// What `find` finds of a material; its errors get the place of the material in the scene.
template <class Find>
auto at_place(const Scene& scene, const Material& material, const Find& find) {
  try {
    return find();
  } catch (const Error& error) {
    const auto found = std::find_if(scene.materials.begin(), scene.materials.end(),
                                    [&](const auto& one) { return &one.second == &material; });
    throw Error(fmt::format("{}: Sprekk > Materials > {}: {}", scene.origin, found->first, error.what()));
  }
}

Properties<laws::Mobility> mobility(const Scene& scene, const mesh::Mesh& mesh) {
  const auto material = [&](int region) -> const Material& { return scene.material_of(mesh.region_names[region]); };
  return properties<laws::Mobility>(
      static_cast<int>(mesh.region_names.size()), mesh.cell_region,
      [&](int region) { return material(region).flows_uniformly(); },
      [&](int region, int cell) {
        const auto x = cell < 0 ? std::array<Real, 3>{} : centre(mesh, cell);
        return at_place(scene, material(region),
                        [&] { return material(region).mobility(mesh.dim(), scene.flow->viscosity, x); });
      });
}

assembly::Reference reference_of_flow(const Scene& scene, const mesh::Mesh& mesh) {
  Real here = 0, largest = 0;
  for (const auto& one : mobility(scene, mesh).values)
    for (int i = 0; i < mesh.dim(); ++i) here = std::max(here, one.value[i][i]);
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_MAX, 1, &here, &largest);
  return {1, mesh::largest_extent(mesh), largest};
}

/// Young's, Pa. Collective.
Real largest_modulus(const Scene& scene, const mesh::Mesh& mesh) {
  Real here = 0, modulus = 0;
  for (LocalIndex cell = 0; cell < mesh.n_owned_cells; ++cell) {
    const auto& material = scene.material_of(mesh.region_names[mesh.cell_region[cell]]);
    if (cell > 0 && material.is_uniform() && mesh.cell_region[cell] == mesh.cell_region[cell - 1]) continue;
    here = std::max(here, material.elasticity(centre(mesh, cell)).youngs_modulus());
  }
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_MAX, 1, &here, &modulus);
  return modulus;
}

assembly::Reference reference(const Scene& scene, const mesh::Mesh& mesh) {
  if (!scene.deforms()) return reference_of_flow(scene, mesh);
  const Real mobility = scene.flow ? reference_of_flow(scene, mesh).mobility : 0;
  return {largest_modulus(scene, mesh), mesh::largest_extent(mesh), mobility};
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

}  // namespace

namespace {

std::vector<physics::FluidCondition> fluid_conditions(const Scene& scene, const mesh::Mesh& mesh, bool of_fractures) {
  std::vector<physics::FluidCondition> conditions;
  for (const auto& [name, one] : scene.boundary_conditions)
    if (one.fracture.has_value() == of_fractures && (one.flux || one.conductance))
      conditions.push_back({index_of(mesh.boundary_names, one.boundary), one.flux ? *one.flux : *one.pressure,
                            one.conductance, one.region ? index_of(mesh.region_names, *one.region) : -1,
                            one.fracture ? index_of(mesh.fracture_names, *one.fracture) : -1});
  return conditions;
}

std::vector<physics::Well> wells(const Scene& scene, int dim) {
  std::vector<physics::Well> wells;
  for (const auto& [name, one] : scene.flow->wells) {
    wells.push_back({name, {}, one.radius, one.skin, one.rate, one.pressure});
    for (std::size_t k = 0; k < one.points.size(); k += dim) {
      std::copy_n(&one.points[k], dim, wells.back().points.emplace_back().begin());
    }
  }
  return wells;
}

/// The values of owned fracture faces and of ghosts. Collective.
std::vector<Real> with_ghosts(const mesh::Mesh& mesh, const std::vector<Real>& owned) {
  const fields::Layout layout({"value", fields::Entity::fracture_face, 1, ""}, mesh);
  fields::Vector from(layout.owned()), to(layout.ghosted());
  {
    const auto put = from.getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (std::size_t f = 0; f < owned.size(); ++f) put(f, 0) = owned[f];
  }
  to.doImport(from, *layout.import(), Tpetra::REPLACE);
  const auto all = to.getLocalViewHost(Tpetra::Access::ReadOnly);
  std::vector<Real> values;
  for (std::size_t f = 0; f < all.extent(0); ++f) values.push_back(all(f, 0));
  return values;
}

/// Of local fracture faces; the apertures at the start are those of the joints and `initial_jumps` along the normal.
std::vector<physics::FractureFlowParameters::Face> hydraulics(const Scene& scene, const mesh::Mesh& mesh,
                                                              const std::vector<Real>& initial_jumps) {
  std::vector<physics::FractureFlowParameters::Face> faces;
  for (std::size_t f = 0; f < mesh.fracture_faces.size(); ++f) {
    const auto& face = mesh.fracture_faces[f];
    const auto& joint = scene.materials.at(scene.fractures.at(mesh.fracture_names[face.fracture]).material);
    at_place(scene, joint, [&] {
      faces.push_back(joint.hydraulics(scene.flow->viscosity, face.centre));
      auto& along = faces.back().along;
      if (!initial_jumps.empty()) along.aperture += initial_jumps[f];
      SPREKK_CHECK(
          along.hydraulic_aperture() > 0,
          "the hydraulic aperture is {:.3g} at ({:.6g}, {:.6g}, {:.6g}) under the initial stress, must be above "
          "0: give a \"residual aperture\", or an \"initial aperture\" above the closure",
          along.hydraulic_aperture(), face.centre[0], face.centre[1], face.centre[2]);
      return 0;
    });
  }
  return faces;
}

/// `initial_jumps` [local fracture face], along the normal; empty: zero.
std::vector<std::unique_ptr<assembly::Module>> make_flow(const Scene& scene, const mesh::Mesh& mesh,
                                                         const std::vector<Real>& initial_jumps = {}) {
  const auto& flow = *scene.flow;
  Properties<laws::Mobility> rock;
  base::collectively(*mesh.comm, [&] { rock = mobility(scene, mesh); });
  physics::DarcyFlowParameters darcy{rock.values, rock.number};
  const auto chosen = physics::flux_scheme(flow.scheme, mesh, rock.values, rock.number);
  darcy.scheme = chosen.scheme;
  darcy.reason = chosen.reason;
  darcy.deforms = scene.deforms();
  for (std::size_t i = 0; i < scene.bulk.gravity.size(); ++i) darcy.weight[i] = flow.density * scene.bulk.gravity[i];
  darcy.fluid = {flow.compressibility, flow.reference_pressure};
  if (!flow.source.is_constant() || flow.source({}, 0) != 0) darcy.source = {flow.source};
  darcy.conditions = fluid_conditions(scene, mesh, false);
  const auto pores = by_region(scene, mesh, [](const Material& m) {
    return physics::Pores{m.porosity, m.compressibility};
  });
  physics::FractureFlowParameters fractures{
      {}, {}, {}, darcy.scheme, darcy.fluid, darcy.weight, fluid_conditions(scene, mesh, true), scene.deforms()};
  if (scene.deforms()) fractures.softness = mesh::largest_extent(mesh) / largest_modulus(scene, mesh);
  base::collectively(*mesh.comm, [&] { fractures.faces = hydraulics(scene, mesh, initial_jumps); });
  std::vector<Real> aperture;
  for (const auto& face : fractures.faces) {
    darcy.exchange.push_back(face.exchange);
    aperture.push_back(face.along.hydraulic_aperture());
  }
  fractures.cut_by.resize(mesh.fracture_names.size());
  for (std::size_t k = 0; k < mesh.fracture_names.size(); ++k) {
    const auto& fracture = scene.fractures.at(mesh.fracture_names[k]);
    fractures.source.push_back(fracture.source);
    for (const auto& name : fracture.cuts)
      fractures.cut_by[index_of(mesh.fracture_names, name)].push_back(static_cast<int>(k));
  }
  std::vector<std::unique_ptr<assembly::Module>> modules;
  const auto fluid = darcy.fluid;
  if (!flow.wells.empty()) {
    physics::WellsParameters all{
        wells(scene, mesh.dim()), rock.values, rock.number, darcy.scheme, fluid, darcy.weight, {}};
    for (const auto& face : fractures.faces) all.transmissivity.push_back(face.along.transmissivity());
    modules.push_back(physics::make_wells(mesh.shape, std::move(all)));
  }
  modules.push_back(physics::make_darcy_flow(mesh.shape, std::move(darcy)));
  if (std::any_of(pores.begin(), pores.end(),
                  [&](const auto& of) { return of.growth > 0 || of.porosity * fluid.compressibility > 0; }))
    modules.push_back(physics::make_fluid_storage({pores, {}, fluid, flow.initial_pressure}));
  if (mesh.fracture_names.empty()) return modules;
  modules.push_back(physics::make_fracture_flow(mesh.shape, std::move(fractures)));
  if (flow.compressibility > 0 || scene.deforms())
    modules.push_back(physics::make_fracture_storage({aperture, fluid, flow.initial_pressure, scene.deforms()}));
  return modules;
}

/// What mechanics and flow are to each other.
std::unique_ptr<assembly::Module> make_coupling(const Scene& scene, const mesh::Mesh& mesh) {
  const auto rock = elasticity(scene, mesh);
  const auto biot = by_region(scene, mesh, [](const Material& m) { return m.biot; });
  physics::PoroelasticCouplingParameters coupling;
  for (LocalIndex cell = 0; cell < mesh.n_cells(); ++cell) {
    const int region = mesh.cell_region[cell];
    coupling.rock.push_back({biot[region], rock.values[rock.number.empty() ? region : rock.number[cell]]});
    coupling.rock_of_cell.push_back(cell);
  }
  const auto flow = mobility(scene, mesh);
  coupling.initial = scene.flow->initial_pressure;
  coupling.scheme = physics::flux_scheme(scene.flow->scheme, mesh, flow.values, flow.number).scheme;
  coupling.fractures = !mesh.fracture_names.empty();
  coupling.tips = mesh.n_global_enriched > 0;
  return physics::make_poroelastic_coupling(mesh.shape, std::move(coupling));
}

physics::MechanicsParameters mechanics(const Scene& scene, const mesh::Mesh& mesh) {
  const auto rock = elasticity(scene, mesh);
  physics::BulkMomentumParameters bulk{rock.values, body_force(scene, mesh), {}, scene.initial_stress(), rock.number};
  for (const auto& [name, condition] : scene.boundary_conditions)
    if (!condition.traction.empty())
      bulk.tractions.push_back({index_of(mesh.boundary_names, condition.boundary), condition.traction,
                                condition.region ? index_of(mesh.region_names, *condition.region) : -1});
  if (mesh.fracture_names.empty()) return {bulk};
  const auto joint = joints(scene, mesh);
  physics::FluidPressure initial;
  if (scene.flow) initial.value.assign(mesh.fracture_names.size(), scene.flow->initial_pressure);
  return {bulk,    joint.values,           joint.number,     scene.fluid_pressure(mesh.fracture_names),
          initial, scene.flow.has_value(), scene.time.start, scene.augmentation};
}

}  // namespace

std::vector<std::unique_ptr<assembly::Module>> make_modules(const Scene& scene, const mesh::Mesh& mesh) {
  if (!scene.deforms()) return make_flow(scene, mesh);
  physics::MechanicsParameters parameters;
  base::collectively(*mesh.comm, [&] { parameters = mechanics(scene, mesh); });
  auto modules = physics::make_mechanics(mesh, parameters);
  if (!scene.flow) return modules;
  std::vector<Real> widths;
  base::collectively(*mesh.comm, [&] {
    for (const auto& jump : physics::initial_jumps(mesh, physics::jump_parameters(mesh, parameters)))
      widths.push_back(jump[0]);
  });
  for (auto& module : make_flow(scene, mesh, with_ghosts(mesh, widths))) modules.push_back(std::move(module));
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
    if (draft.value.flow) mesh = mesh::with_facets(mesh);
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
  system_ = std::make_unique<assembly::System>(mesh, std::move(modules), conditions, reference(scene_, *mesh), timers_);
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
  auto report = stepper_->advance(x_, time_, t);
  if (report.converged) return report;
  for (const auto& doubt : {friction_doubt(scene_), dilation_doubt(scene_, mesh())})
    if (!doubt.empty()) report.reason += "; " + doubt;
  return report;
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
  checkpoint.content = {
      {"time", time_},
      {"dt", memory.dt},
      {"scales",
       {{"stress", memory.scales.stress}, {"length", memory.scales.length}, {"pressure", memory.scales.pressure}}},
      {"calibration", memory.calibration},
      {"scene", fingerprint(scene_, *system_)}};
  start_solver();
  return checkpoint;
}

void Model::restore(const io::Checkpoint& checkpoint) {
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
  const auto& scales = content.at("scales");
  system_->resume(x_, {time_,
                       content.at("dt"),
                       {scales.at("stress"), scales.at("length"), scales.value("pressure", Real(0))},
                       content.value("calibration", std::vector<Real>())});
  start_solver();
}

}  // namespace sprekk::model
