#include "model/model.hpp"

#include "assembly/geometry.hpp"
#include "base/names.hpp"
#include "base/over_ranks.hpp"
#include "base/text.hpp"
#include "mesh/distribute.hpp"
#include "mesh/facets.hpp"
#include "mesh/number_facets.hpp"
#include "mesh/without_regions.hpp"
#include "model/change.hpp"
#include "model/fingerprint.hpp"
#include "model/scene_check.hpp"
#include "model/transfer.hpp"

#include <algorithm>

namespace sprekk::model {

namespace {

/// Returns the element with the given name. Throws an Error that lists the available names.
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

/// Changes of a mesh in a checkpoint: the cells, or the cells followed by the numbers of extensions and turns.
nlohmann::json to_json(const std::vector<mesh::MeshChange>& changes) {
  auto all = nlohmann::json::array();
  for (const auto& one : changes) {
    auto extensions = nlohmann::json::array(), turns = nlohmann::json::array();
    for (const auto& e : one.extensions) extensions.push_back({e.tip, e.direction, e.length, e.size, e.beyond});
    for (const auto& t : one.turns) turns.push_back({t.begin, t.tip, t.angle});
    all.push_back(extensions.empty() && turns.empty() ? nlohmann::json(one.cells)
                                                      : nlohmann::json{one.cells, extensions, turns});
  }
  return all;
}

mesh::MeshChange mesh_change(const nlohmann::json& saved) {
  if (saved.empty() || !saved[0].is_array()) return {saved.get<std::vector<GlobalIndex>>()};
  mesh::MeshChange change{saved[0].get<std::vector<GlobalIndex>>()};
  for (const auto& e : saved[1])
    change.extensions.push_back({e[0], e[1], e[2], e[3], e.size() > 4 ? e[4].get<Real>() : 0});
  for (const auto& t : saved[2]) change.turns.push_back({t[0], t[1], t[2]});
  return change;
}

/// Key of the unknowns of a block in a checkpoint.
std::string key_of(const fields::Block& block) { return "unknowns: " + block.name; }

void redistribute(const fields::Vector& from, fields::Vector& to) {
  to.doImport(from, fields::Import(from.getMap(), to.getMap()), Tpetra::REPLACE);
}

}  // namespace

physics::Modules make_modules(const Scene& scene, const mesh::Mesh& mesh) {
  physics::Modules modules;
  physics::for_each_physics([&](auto physics) { physics.add_modules({scene, mesh, scene.time.start}, modules); });
  return modules;
}

namespace {

/// Throws an Error for conditions on ends of fractures not on the given boundary, which would have no effect.
/// Collective.
void check_ends(const Scene& scene, const mesh::Mesh& mesh) {
  const auto n = mesh.boundary_names.size();
  std::vector<int> here(n * mesh.fracture_names.size(), 0);
  if (mesh.facets.is_null() || here.empty()) return;
  for (const auto& rim : mesh.facets->rims) here[mesh.fracture_faces[rim.face].fracture * n + rim.boundary] = 1;
  const auto anywhere = base::max_over_ranks(*mesh.comm, here);
  for (const auto& [name, condition] : scene.boundary_conditions) {
    if (!condition.fracture) continue;
    const auto first = anywhere.begin() + base::index_of(mesh.fracture_names, *condition.fracture) * n;
    std::vector<std::string> ends;
    for (std::size_t b = 0; b < n; ++b)
      if (first[b]) ends.push_back(mesh.boundary_names[b]);
    SPREKK_CHECK(first[base::index_of(mesh.boundary_names, condition.boundary)],
                 "{}: Sprekk > Boundary conditions > {} > \"fracture\": \"{}\" does not end on \"{}\"; it ends on {}",
                 scene.origin, name, *condition.fracture, condition.boundary,
                 ends.empty() ? "no boundary" : base::quoted_list(ends));
  }
}

/// Throws an Error if the scene refines the mesh during the run and a module cannot follow.
void check_transfer(const Scene& scene, const std::vector<std::unique_ptr<assembly::Module>>& modules,
                    const mesh::Mesh& mesh) {
  const bool refines = scene.accuracy && scene.accuracy->refines_during_run();
  if (!refines && !scene.growth) return;
  const std::string place = refines ? "Accuracy > \"refinement\": is \"during the run\"," : "Growth: is";
  for (const auto& module : modules)
    for (const auto& history : module->declare(mesh).history)
      SPREKK_CHECK(history.is_transferred,
                   "{}: Sprekk > {} not available with {}: \"{}\" has no values on a refined mesh", scene.origin, place,
                   module->name(), history.name);
}

}  // namespace

Model::Model(const Scene& scene, RCP<const Comm> comm, const ModuleFactory& more_modules)
    : more_modules_(more_modules), timers_(rcp(new base::Timers)), time_(scene.time.start) {
  auto draft = prepared(scene);
  if (auto& value = draft.value; value.growth && !value.bisection)
    value.bisection = std::make_shared<std::optional<mesh::Bisection>>();
  std::string unconstrained;  // rock unsupported by the scene, perhaps supported by host modules; on rank 0
  whole_mesh_ = make_whole_mesh(draft, comm, unconstrained);
  auto made = drafted(std::move(draft.value), unconstrained);
  scene_ = made.scene;
  system_ = make_system(std::move(made));
  x_ = system_->initial();
  scene_.is_continued = true;  // from here on the scene only changes
  check_stages();
  start_solver();
}

/// Makes the mesh with all regions. `unconstrained`: see checked_mesh(); set if there are host modules.
RCP<const mesh::Mesh> Model::make_whole_mesh(const base::Draft<Scene>& draft, RCP<const Comm> comm,
                                             std::string& unconstrained) const {
  const auto scope = timers_->scope("mesh");
  auto mesh =
      mesh::make_distributed([&] { return checked_mesh(draft, more_modules_ ? &unconstrained : nullptr); }, comm);
  mesh = draft.value.refined(mesh);
  auto facets = physics::Facets::none;
  physics::for_each_physics([&](auto physics) { facets = std::max(facets, physics.needs_facets(draft.value)); });
  return facets == physics::Facets::none ? mesh : mesh::with_facets(mesh, facets == physics::Facets::all);
}

/// Makes the mesh and the modules. `unconstrained`: message on rock that host modules must support; empty if all is
/// supported.
Model::Draft Model::drafted(Scene scene, const std::string& unconstrained) const {
  const auto& comm = *whole_mesh_->comm;
  Draft draft{std::move(scene), mesh::without_regions(whole_mesh_, draft.scene.excavated()), {}};
  const auto& mesh = *draft.mesh;
  check_ends(draft.scene, mesh);
  check_growth(draft.scene, mesh);
  base::collectively(comm, [&] { draft.scene.own_joints = physics::own_joints(draft.scene, mesh); });
  base::collectively(comm, [&] {
    draft.modules = make_modules(draft.scene, mesh);
    if (more_modules_)
      for (auto& module : more_modules_(mesh)) draft.modules.push_back(std::move(module));
    check_transfer(draft.scene, draft.modules, mesh);
    const bool constrained = std::any_of(draft.modules.begin(), draft.modules.end(), [](const auto& module) {
      const auto* forces = dynamic_cast<const assembly::Supporting*>(module.get());
      return forces && forces->constrains_bodies();
    });
    SPREKK_CHECK(unconstrained.empty() || constrained, "{}: {}", draft.scene.origin, unconstrained);
  });
  return draft;
}

std::unique_ptr<assembly::System> Model::make_system(Draft draft) const {
  const auto& scene = draft.scene;
  const auto mesh = draft.mesh;
  const auto conditions = physics::dirichlet_conditions(scene.boundary_conditions, scene.regions,
                                                        physics::names_of(*mesh), "", scene.fractures);
  auto system = std::make_unique<assembly::System>(
      mesh, std::move(draft.modules), conditions, timers_,
      scene.time.scheme == "BDF2" ? assembly::Rates::Scheme::bdf2 : assembly::Rates::Scheme::implicit_euler);
  if (scene.time.chooses_steps()) system->watch_errors(scene.time.times().back() - scene.time.start);
  if (scene.output.energy) system->watch_energy();
  return system;
}

/// Makes the mesh and the modules of a change. Throws an Error with the reasons if the change is invalid.
Model::Draft Model::drafted_change(const Scene& before, const Scene& changed) const {
  auto prepared = model::prepared(changed);
  const auto refuse = [&](const std::vector<std::string>& reasons) {
    std::vector<std::string> lines;
    for (const auto& reason : reasons)
      lines.push_back(fmt::format("{}: {}; a live model cannot follow this", changed.origin, reason));
    base::throw_errors(lines);
  };
  auto errors = prepared.report.errors;
  for (const auto& line : misfits(prepared, physics::names_of(*whole_mesh_))) errors.push_back(line);
  base::throw_errors(errors);
  refuse(refused_changes(before, prepared.value));
  prepared.value.is_continued = true;
  prepared.value.bisection = scene_.bisection;
  physics::for_each_physics([&]<physics::HasChange P>(P) { P::Change::prepare(*whole_mesh_, before, prepared.value); });
  auto draft = drafted(std::move(prepared.value));
  std::vector<std::string> lines;
  physics::for_each_physics([&]<physics::HasEstimate P>(P) {
    if (const auto why = P::Estimate::missing(draft.scene); !why.empty() && draft.scene.accuracy)
      lines.push_back("Accuracy: " + why);
    else if (!why.empty() && draft.scene.output.error_estimate)
      lines.push_back("Output > \"error estimate\": " + why);
  });
  physics::for_each_physics([&]<physics::HasChange P>(P) {
    for (auto& line : P::Change::refuses_in(*draft.mesh, before, draft.scene)) lines.push_back(std::move(line));
  });
  refuse(lines);
  auto now = drafted(before);  // storage of modules must be read before they are bound
  refuse(misfits(storage_of(now.modules, *now.mesh), storage_of(draft.modules, *draft.mesh)));
  return draft;
}

/// Throws an Error for contradictory conditions, or for invalid expressions, at the begin of a stage.
void Model::check_start(Draft draft, const StagedScene& stage) const {
  try {
    make_system(std::move(draft))->set_time(stage.time, 0);
  } catch (const Error& error) {
    const std::string text = error.what();
    throw Error(text.rfind(stage.draft.value.origin, 0) == 0 ? text
                                                             : fmt::format("stage \"{}\": {}", stage.name, text));
  }
}

/// Checks all stages in advance, so that no stage fails when its time comes.
void Model::check_stages() const {
  const Scene* before = &scene_;
  const auto stages = staged_scenes(scene_);
  for (const auto& stage : stages) {
    base::throw_errors(stage.draft.report.errors);
    auto draft = drafted_change(*before, stage.draft.value);
    if (stage.time < scene_.time.times().back()) check_start(std::move(draft), stage);
    before = &stage.draft.value;
  }
}

void Model::change(const Scene& changed) {
  const auto scope = timers_->scope("changes of the scene");
  auto draft = drafted_change(scene_, changed);
  if (same_entries(scene_, draft.scene)) return;
  auto scene = draft.scene;
  auto system = make_system(std::move(draft));
  auto x = system->initial();
  system->prescribe(time_, x);  // for entities that did not exist before
  carry_over(*whole_mesh_, *system_, x_, *system, x);
  system->pass_unbalanced(x);
  scene_ = std::move(scene);
  replace(std::move(system), std::move(x));
}

std::vector<mesh::Extended> Model::change_mesh(const mesh::MeshChange& change) {
  SPREKK_CHECK(scene_.bisection, "{}: the mesh of a model without Scene::bisection cannot be refined", scene_.origin);
  const auto scope = timers_->scope("refinement");
  const auto comm = whole_mesh_->comm;
  std::vector<GlobalIndex> parent;  // on rank 0
  std::vector<mesh::Overlap> overlaps;
  std::vector<std::array<Real, 8>> made(change.extensions.size() + change.turns.size());
  base::collectively(*comm, [&] {
    auto& bisection = *scene_.bisection;
    if (!bisection) return;
    const auto before = made.empty() ? std::nullopt : std::optional(*bisection);
    parent = bisection->refine(change.cells, mesh().dim());
    std::size_t k = 0;
    for (const auto& one : change.extensions) {
      const auto e = bisection->extend(one, parent);
      made[k++] = {Real(e.how), e.begin[0],  e.begin[1],       e.end[0],
                   e.end[1],    Real(e.met), Real(e.is_ahead), Real(e.obstacle)};
    }
    for (const auto& one : change.turns) made[k++][0] = bisection->turn(one);
    if (before) overlaps = bisection->overlaps(*before, parent);
  });
  if (!made.empty()) made = base::sum_over_ranks(*comm, made);
  std::vector<mesh::Extended> results;
  for (const auto& m : made)
    results.push_back({static_cast<mesh::Extended::How>(m[0]),
                       {m[1], m[2]},
                       {m[3], m[4]},
                       static_cast<int>(m[5]),
                       m[6] != 0,
                       static_cast<mesh::Extended::Obstacle>(m[7])});
  for (std::size_t k = 0; k < change.extensions.size(); ++k)
    if (results[k] == mesh::Extended::none) without_room_.push_back(change.extensions[k].tip);
  auto prepared = model::prepared(scene_);
  std::string unconstrained;
  whole_mesh_ = make_whole_mesh(prepared, comm, unconstrained);
  auto system = make_system(drafted(std::move(prepared.value), unconstrained));
  auto x = system->initial();
  transfer({mesh(), system->mesh(), parent, overlaps}, *system_, x_, *system, x);
  mesh_changes_.push_back(change);
  replace(std::move(system), std::move(x));
  return results;
}

void Model::replace(std::unique_ptr<assembly::System> system, fields::BlockVector x) {
  stepper_.reset();
  newton_.reset();
  beginning_.reset();
  system_ = std::move(system);
  x_ = std::move(x);
  ++n_changes_;
  start_solver();
}

void Model::start_solver() {
  const auto scope = timers_->scope("set-up of the solver");
  stepper_.reset();
  newton_.reset();
  newton_ = std::make_unique<solve::Newton>(*system_, scene_.solver, timers_);
  auto stepping = scene_.time.stepping;
  stepping.predicts = system_->evolves();
  stepper_ = std::make_unique<solve::TimeStepper>(*system_, *newton_, stepping);
}

solve::StepReport Model::step_to(Real t) {
  SPREKK_CHECK(t > time_, "a step to t = {} is no step forward: the model is at t = {}", t, time_);
  return advance(t);
}

solve::StepReport Model::find_equilibrium() {
  SPREKK_CHECK(!system_->has_rates(), "a change of stored quantities requires a time step: take a step");
  return advance(time_);
}

solve::StepReport Model::advance(Real t) {
  const auto scope = timers_->scope("time steps");
  beginning_ = beginning();
  system_->take_exchanges();
  auto report = stepper_->advance(x_, time_, t);
  report.exchanges = system_->take_exchanges();
  if (report.converged || report.stopped) return report;
  const bool oscillates = base::any_rank(*mesh().comm, [&] {
    return std::find(report.oscillating.begin(), report.oscillating.end(), 1) != report.oscillating.end();
  });
  physics::for_each_physics([&]<physics::HasSolvability P>(P) {
    for (const auto& doubt : P::Solvability::doubts(setting(), oscillates)) report.reason += "; " + doubt;
  });
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

FieldView Model::field(const std::string& name) {
  std::vector<FieldView> all;
  for (std::size_t b = 0; b < x_.size(); ++b) {
    const auto& field = system_->layouts()[b].field();
    all.push_back({field, fields::by_entity(*x_[b], field.n_components)});
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
    Kokkos::deep_copy(fields::by_entity(*vector, field.n_components), values);
    checkpoint.vectors[field.name] = vector;
  }
  const auto memory = system_->memory();
  checkpoint.content = {{"time", time_},
                        {"dt", memory.dt},
                        {"scales", memory.scales},
                        {"calibration", memory.calibration},
                        {"errors", memory.errors},
                        {"energy", memory.energy},
                        {"scene", fingerprint(scene_, *system_)},
                        {"refinements", to_json(mesh_changes_)}};
  start_solver();
  return checkpoint;
}

void Model::restore(const io::Checkpoint& checkpoint) {
  beginning_.reset();
  const auto& content = checkpoint.content;
  const auto changes = content.value("refinements", nlohmann::json::array());
  for (std::size_t k = mesh_changes_.size(); k < changes.size(); ++k) change_mesh(mesh_change(changes[k]));
  check_fingerprint(content.at("scene"), fingerprint(scene_, *system_));
  for (std::size_t b = 0; b < x_.size(); ++b)
    redistribute(*checkpoint.vectors.at(key_of(system_->blocks()[b])), *x_[b]);
  for (const auto& [field, values] : system_->histories()) {
    fields::Vector vector(fields::owned_map(field, mesh()));
    const auto saved = checkpoint.vectors.find(field.name);
    if (saved == checkpoint.vectors.end()) continue;  // rates, absent after steps of prescribed length
    redistribute(*saved->second, vector);
    Kokkos::deep_copy(values, fields::by_entity(vector, field.n_components));
  }
  time_ = content.at("time");
  system_->resume(x_,
                  {time_, content.at("dt"), content.at("scales"), content.at("calibration"),
                   content.value("errors", std::vector<Real>()), content.value("energy", assembly::Energy::Sums())});
  start_solver();
}

}  // namespace sprekk::model
