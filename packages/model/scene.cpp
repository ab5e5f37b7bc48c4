#include "model/scene.hpp"

#include "base/check.hpp"
#include "base/text.hpp"
#include "base/xml.hpp"
#include "model/scene_check.hpp"

#include <fmt/ranges.h>

#include <filesystem>
#include <tuple>

namespace sprekk::model {

void CheckpointTimes::describe(base::Section& s) {
  s.entry(steps, "steps", "-", base::at_least(1), "interval of checkpoints in steps");
  s.entry(minutes, "minutes", "min", base::positive(), "interval of checkpoints in wall-clock time");
  if (s.complete() && !steps && !minutes) s.fail("needs \"steps\", \"minutes\", or both");
}

void EventThreshold::describe(base::Section& s) {
  s.entry(rate, "rate", "m/s", base::positive(),
          "threshold of the rate of a face; a fracture with a faster face in a step is part of an event");
}

void Output::describe(base::Section& s) {
  s.entry(vtu, "vtu", "-", "switch for bulk.pvd and fractures.pvd, for ParaView");
  s.entry(every, "every", "-", base::at_least(1),
          "interval of bulk.pvd and fractures.pvd, in steps; the last step is always written");
  s.entry(error_estimate, "error estimate", "-",
          "estimate of the error due to the mesh after every step: error_estimate in results.json, and fields; costs a "
          "pass over all cells and, with fractures, a linear solve per step");
  s.entry(energy, "energy", "-",
          "energy balance: elastic energy and work since the start, by cause, `energy` in "
          "results.json; costs a few residuals per step");
  s.choice(time_unit, "time unit", {"s", "min", "h", "d", "year"}, "unit of times in tables of probes and in pictures");
  s.section(checkpoints, "checkpoints", "checkpoints for --restart; another checkpoint follows the last step");
  s.section(events, "events", "catalogue of fast events in events.csv, in place of events by the mean rate");
}

void MeshFile::Fracture::describe(base::Section& s) {
  s.entry(reference_normal, "reference normal", "-",
          "reference vector of the orientation: its product with the normal, from side - to side +, is positive");
  s.entry(swap_sides, "swap sides", "-", "exchange of side - and side +");
}

void MeshFile::describe(base::Section& s) {
  s.section(network, "network",
            "fracture network in place of a mesh file; `./sprekk mesh` and `./sprekk run` generate its mesh");
  s.entry(path, "path", "-",
          "mesh file of gmsh, format 2.2 or 4.1, relative to the folder of the scene; required, except with a network "
          "under `./sprekk run` and `check`");
  if (s.complete() && path.empty() && !network) s.fail("path", "missing; it is required: a file of gmsh");
  s.entry(order, "order", "-", base::between(1, 2),
          "polynomial order of the node fields in each cell: 1 (linear) or 2 (quadratic); 2 adds mid-edge nodes to a "
          "file of order 1; absent: as in the file");
  mesh::describe_tips(s, tips);
  mesh::describe_periodic(
      s, periodic,
      "pairs of periodic boundaries {a, b, c, d}: equal node fields on a and on its translate b, and on c and d");
  if (periodic.size() % 2 == 1)
    s.fail("periodic", fmt::format("has {}, must have an even number", base::counted(periodic.size(), "name")));
  mesh::describe_refinements(s, refinements, periodic);
  s.named_sections(fractures, "fractures",
                   "physical groups of the fractures, by their names; the sets of a network need no section");
  if (network)
    for (const auto& [name, set] : network->fractures) fractures[name];
}

void Scene::add_default_joints() {
  const auto add = [&](const auto& of_mesh) {
    for (const auto& [name, fracture] : of_mesh)
      if (auto& added = fractures[name]; added.material.empty()) added.material = *default_joint;
  };
  mesh_file ? add(mesh_file->fractures) : add(mesh.fractures);
}

void Scene::describe(base::Section& s) {
  describe_expressions(s);
  s.section(mesh_file, "Mesh file", "mesh file of gmsh or fracture network, in place of the section Mesh");
  if (!mesh_file) s.section(mesh, "Mesh", "a box with plane fractures");
  describe_physics(s);
  if (default_joint) add_default_joints();
  s.section(time, "Time", "time steps of the run");
  s.section(solver, "Solver", "parameters of Newton's method");
  s.section(output, "Output", "output in addition to results.json");
  s.named_sections(stages, "Stages",
                   "changes of the scene during the run, by names of your choice; see docs/use/stages.md");
  if (s.is_sound() && !s.documents()) check_stages(s, stages, time.start);
  s.section(accuracy, "Accuracy", "quantities of interest with tolerances, on meshes that the run refines");
  if (accuracy && s.is_sound() && !s.documents()) check_accuracy(s);
  s.section(growth, "Growth", "growth of fractures with a \"toughness\" along free paths through triangles");
  if (growth && s.is_sound() && !s.documents()) check_growth(s);
  if (auto& reproducible = solver.linear_solver.reproducible; output.checkpoints && !reproducible) reproducible = true;
}

/// Reports entries incompatible with bisected meshes.
void Scene::check_accuracy(base::Section& s) const {
  const std::string section = mesh_file ? "Mesh file" : "Mesh";
  const auto fail = [&](const std::string& entry, const std::string& what) {
    s.fail_inside(fmt::format("{}: {} with \"Accuracy\"", entry, what));
  };
  if (refinements() > 0) fail(section + " > \"refinements\"", fmt::format("is {}, must be 0", refinements()));
  if (const auto& periodic = mesh_file ? mesh_file->periodic : mesh.periodic; !periodic.empty())
    fail(section + " > \"periodic\"", fmt::format("is {{{}}}, must be absent", fmt::join(periodic, ", ")));
  if (accuracy->refines_during_run()) {
    if (output.events) fail("Output > \"events\"", "must be absent");
    for (const auto& [name, stage] : stages)
      if (!stage.backfill.empty()) fail(fmt::format("Stages > {} > \"backfill\"", name), "must be absent");
    return;
  }
  if (output.checkpoints) fail("Output > \"checkpoints\"", "must be absent");
  if (!stages.empty()) fail("Stages", "must be absent");
  if (time.chooses_steps())
    fail(time.tolerance ? "Time > \"tolerance\"" : "Time > \"target Newton iterations\"", "must be absent");
}

/// Reports entries incompatible with growing fractures.
void Scene::check_growth(base::Section& s) const {
  const auto fail_if = [&](bool fails, const std::string& entry, const std::string& what) {
    if (fails) s.fail_inside(fmt::format("{}, {} with \"Growth\"", entry, what));
  };
  const std::string section = mesh_file ? "Mesh file" : "Mesh";
  fail_if(!mesh_file && mesh.cell != "triangle", fmt::format("Mesh > \"cell\": is {}", mesh.cell), "must be triangle");
  fail_if(refinements() > 0, fmt::format("{} > \"refinements\": is {}", section, refinements()), "must be 0");
  fail_if(!(mesh_file ? mesh_file->periodic : mesh.periodic).empty(), section + " > \"periodic\": is given",
          "must be absent");
  fail_if(accuracy.has_value(), "Accuracy: is given", "must be absent");
  fail_if(output.events.has_value(), "Output > \"events\": is given", "must be absent");
  for (const auto& [name, stage] : stages)
    fail_if(!stage.excavate.empty() || !stage.backfill.empty(), fmt::format("Stages > {}: changes the regions", name),
            "which is not available");
  fail_if(std::none_of(fractures.begin(), fractures.end(), [](const auto& one) { return one.second.toughness; }),
          "Fractures: none has a \"toughness\"", "one is required");
  auto facets = physics::Facets::none;
  physics::for_each_physics([&](auto physics) { facets = std::max(facets, physics.needs_facets(*this)); });
  int n_stored = 0;
  physics::for_each_physics([&]<physics::HasRates P>(P) { n_stored += P::Rates::exist(*this); });
  fail_if(facets == physics::Facets::all && n_stored > 1, "Bulk: the rock stores several transported quantities",
          "which is not available");
}

namespace {

base::Draft<Scene> from_list(const Teuchos::ParameterList& list, const std::string& origin,
                             const std::vector<std::string>& errors = {}) {
  auto draft = base::draft<Scene>(list, origin, "Sprekk", errors);
  draft.value.origin = origin;
  return draft;
}

/// Returns an error for each entry that is of the other type only. describe() declares the entries of its own type.
std::vector<std::string> stray_entries(const std::string& place, Material material) {
  Material other = material, none;
  other.type = none.type = material.type == "joint" ? "elastic" : "joint";
  const auto own = base::effective(material, ""), defaults = base::effective(none, "");
  std::vector<std::string> errors;
  for (const auto& named_entry : base::effective(other, "")) {
    const auto& [name, entry] = std::tie(named_entry.first, named_entry.second);
    const bool is_default =
        defaults.isParameter(name) && base::value_text(defaults.getEntry(name)) == base::value_text(entry);
    if (!own.isParameter(name) && !is_default)
      errors.push_back(fmt::format("{} > \"{}\": unknown in a material of type \"{}\"", place, name, material.type));
  }
  return errors;
}

}  // namespace

base::Draft<Scene> prepared(const Scene& scene) {
  auto draft = base::checked(scene, scene.origin, "Sprekk");
  auto& errors = draft.report.errors;
  for (const auto& [name, material] : scene.materials)
    for (auto& error : stray_entries(fmt::format("{}: Sprekk > Materials > {}", scene.origin, name), material))
      errors.push_back(std::move(error));
  return draft;
}

Scene read_scene(const Comm& comm, const std::string& path, const std::vector<std::string>& overrides) {
  return scene_of(comm, base::read_xml(comm, path, "Sprekk", base::Defects::keep), path,
                  std::filesystem::path(path).parent_path().string(), overrides);
}

Scene scene_of(const Comm& comm, Teuchos::ParameterList entries, const std::string& origin, const std::string& folder,
               const std::vector<std::string>& overrides) {
  const bool has_body = entries.isParameter("Mesh") || entries.isParameter("Mesh file") || entries.isParameter("Bulk");
  SPREKK_CHECK(has_body || !entries.isParameter("Point"),
               "{}: is a scene for `sprekk point`: it has the section \"Point\" and neither mesh nor \"Bulk\"", origin);
  const auto errors = base::apply_overrides(entries, origin, overrides);
  auto draft = from_list(entries, origin, errors);
  auto& file = draft.value.mesh_file;
  if (file && !file->path.empty())
    file->path = std::filesystem::absolute(std::filesystem::path(folder) / file->path).string();
  if (file && file->network) file->network->resolve_files(folder);
  base::collectively(comm, [&] {
    const bool is_wrong = !draft.report.errors.empty() || !misfits(draft, names_in_scene(draft)).empty();
    if (is_wrong && comm.getRank() == 0) checked_mesh(draft);
    if (is_wrong) return;
    std::vector<std::string> wrong;
    for (const auto& staged : staged_scenes(draft.value))
      for (const auto& errors : {staged.draft.report.errors, misfits(staged.draft, names_in_scene(staged.draft))})
        wrong.insert(wrong.end(), errors.begin(), errors.end());
    base::throw_errors(wrong);
  });
  return std::move(draft.value);
}

}  // namespace sprekk::model
