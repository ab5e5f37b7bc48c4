#include "model/scene_check.hpp"

#include "base/check.hpp"
#include "base/text.hpp"
#include "mesh/msh_file.hpp"

#include <fmt/ranges.h>

namespace sprekk::model {

namespace {

using Draft = base::Draft<Scene>;
using physics::Comparison;
using physics::MeshNames;
using physics::Names;

bool is_sound(const Draft& draft, const std::string& section) { return draft.report.is_sound("Sprekk > " + section); }

template <class T>
Names keys_of(const std::map<std::string, T>& map) {
  Names names;
  for (const auto& [name, value] : map) names.push_back(name);
  return names;
}

/// Boundaries tied by "periodic".
Names tied_boundaries(const Scene& scene) {
  if (scene.mesh_file) return scene.mesh_file->periodic;
  const std::map<std::string, Names> sides = {
      {"x", {"west", "east"}}, {"y", {"south", "north"}}, {"z", {"bottom", "top"}}};
  Names names;
  for (const auto& direction : scene.mesh.periodic)
    if (const auto found = sides.find(direction); found != sides.end())
      names.insert(names.end(), found->second.begin(), found->second.end());
  return names;
}

std::optional<Real> end_of_first_step(const Draft& draft) {
  return is_sound(draft, "Time") ? std::make_optional(draft.value.time.times().front()) : std::nullopt;
}

/// Reports a scheme for storage rates in a scene without storage, or one not supported by a physics.
void compare_scheme(Comparison& comparison, const std::string& scheme) {
  bool rates = scheme == "implicit Euler" || !comparison.is_absent("Time");
  Names absent;
  physics::for_each_physics([&]<physics::HasRates P>(P) {
    rates = rates || P::Rates::exist(comparison.scene());
    for (const auto& section : P::Rates::sections()) absent.push_back(section);
  });
  for (const auto& section : absent) rates = rates || !comparison.is_absent(section);
  if (!rates)
    comparison.fail("Time > \"scheme\"",
                    fmt::format("is \"{}\": needs the section \"{}\"", scheme, fmt::join(absent, "\" or \"")));
  physics::for_each_physics([&]<physics::HasRates P>(P) {
    const auto entry = P::Rates::implicit_euler(comparison.scene());
    if (!entry.empty() && scheme != "implicit Euler")
      comparison.fail("Time > \"scheme\"", fmt::format("is \"{}\": {} requires implicit Euler", scheme, entry));
  });
}

void compare_error_estimate(Comparison& comparison, const std::string& place, const Scene& scene) {
  bool any_quantity = false, any_flux = false;
  physics::for_each_physics([&]<physics::HasEstimate P>(P) {
    if (const auto why = P::Estimate::missing(scene); !why.empty()) comparison.fail(place, why);
    if (!P::is_in(scene)) return;
    any_quantity = any_quantity || !P::Estimate::quantities().empty();
    any_flux = any_flux || P::needs_facets(scene) != physics::Facets::none;
  });
  if (!any_quantity) comparison.fail(place, "has nothing to estimate in this scene");
  const auto& cell = scene.mesh.cell;
  if (any_flux && !scene.accuracy && !scene.mesh_file && (cell == "quadrilateral" || cell == "hexahedron"))
    comparison.fail(place,
                    fmt::format("is of triangles and tetrahedra where something flows; the mesh is of {}s", cell));
}

/// Reports a catalogue of events in a scene without events.
void compare_events(Comparison& comparison, const Scene& scene) {
  bool any = false;
  physics::for_each_physics([&]<physics::HasEvents P>(P) { any = any || P::is_in(scene); });
  if (const auto& fractures = comparison.names().fractures; fractures && fractures->empty())
    comparison.fail("Output > \"events\"", "requires fractures, and the mesh has none");
  else if (!any)
    comparison.fail("Output > \"events\"", "requires deformable rock, and the rock of this scene is rigid");
}

void compare_accuracy(Comparison& comparison, const Scene& scene) {
  const auto& accuracy = *scene.accuracy;
  compare_error_estimate(comparison, "Accuracy", scene);
  for (const auto& [name, quantity] : accuracy.quantities) {
    const auto place = fmt::format("Accuracy > quantities > {}", name);
    for (const auto& fracture : quantity.fractures)
      comparison.check_name("Accuracy", place + " > \"fractures\"", fracture, comparison.names().fractures);
    const bool is_there =
        quantity.boundary.empty() ||
        comparison.check_name("Accuracy", place + " > \"boundary\"", quantity.boundary, comparison.names().boundaries);
    if (quantity.component == "z" && comparison.names().dim == 2)
      comparison.fail(place + " > \"component\"", "is z, must be x or y in 2D");
    std::vector<std::string> known;
    std::optional<std::string> refused;
    physics::for_each_physics([&]<physics::HasEstimate P>(P) {
      if (!P::is_in(comparison.scene())) return;
      std::vector<std::string> names;
      for (const auto& kind : P::Estimate::quantities()) names.push_back(kind.name);
      known.insert(known.end(), names.begin(), names.end());
      if (physics::has(names, quantity.what)) refused = P::Estimate::refuses(comparison.scene(), quantity);
    });
    const auto why =
        refused.value_or(fmt::format("\"quantity\": is \"{}\", which the scene does not contain; it contains {}",
                                     quantity.what, base::quoted_list(known)));
    const auto entry = why.find("\": ");  // the entry concerned
    if (is_there && !why.empty() && entry != std::string::npos)
      comparison.fail(place + " > " + why.substr(0, entry + 1), why.substr(entry + 3));
    else if (is_there && !why.empty())
      comparison.fail(place, why);
    const bool of_fractures = quantity.boundary.empty() && quantity.well.empty() && !quantity.is_norm();
    if (const auto& all = comparison.names().fractures; of_fractures && all && all->empty())
      comparison.fail(place, fmt::format("\"quantity\" is \"{}\", and the mesh has no fractures", quantity.what));
  }
}

}  // namespace

MeshNames names_in_scene(const Draft& draft) {
  const Scene& scene = draft.value;
  MeshNames names;
  if (scene.mesh_file) {
    if (is_sound(draft, "Mesh file")) names.fractures = keys_of(scene.mesh_file->fractures);
    return names;
  }
  const auto& box = scene.mesh;
  const bool sound = is_sound(draft, "Mesh");
  const auto n = box.cells.size();
  const bool was_read = sound || box.cells != mesh::BoxMesh{}.cells;
  if (was_read && (n == 2 || n == 3) && box.lower_corner.size() == n && box.upper_corner.size() == n) {
    names.dim = static_cast<int>(n);
    names.boundaries = {"west", "east", "south", "north"};
    if (n == 3) names.boundaries->insert(names.boundaries->end(), {"bottom", "top"});
  }
  if (sound || (is_sound(draft, "Mesh > regions") && !box.regions.empty())) {
    names.regions = keys_of(box.regions);
    names.regions->push_back("bulk");
  }
  if (sound || (is_sound(draft, "Mesh > fractures") && !box.fractures.empty()))
    names.fractures = keys_of(box.fractures);
  return names;
}

namespace {

/// Compares a draft with its mesh if it exists, otherwise with the names from the scene; walls of excavations are
/// boundaries.
Comparison compared(const Draft& draft, MeshNames names) {
  if (names.boundaries)
    for (const auto& wall : draft.value.excavated())
      if (!physics::has(*names.boundaries, wall)) names.boundaries->push_back(wall);
  Comparison comparison(draft.value, draft.report, names, tied_boundaries(draft.value), end_of_first_step(draft));
  comparison.compare();
  const auto& scheme = draft.value.time.scheme;
  compare_scheme(comparison, scheme);
  if (draft.value.output.energy && scheme != "implicit Euler")
    comparison.fail("Time > \"scheme\"", fmt::format("is \"{}\": Output > \"energy\" requires implicit Euler", scheme));
  if (draft.value.output.error_estimate) compare_error_estimate(comparison, "Output > \"error estimate\"", draft.value);
  if (draft.value.output.events) compare_events(comparison, draft.value);
  if (draft.value.accuracy && is_sound(draft, "Accuracy")) compare_accuracy(comparison, draft.value);
  return comparison;
}

}  // namespace

std::vector<std::string> misfits(const Draft& draft, const MeshNames& names) { return compared(draft, names).errors(); }

mesh::GlobalMesh checked_mesh(const Draft& draft, std::string* unconstrained) {
  const Scene& scene = draft.value;
  auto errors = draft.report.errors;
  const auto add = [&](const std::string& what) { errors.push_back(scene.origin + ": " + what); };
  const auto attempt = [&](const auto& work) {
    try {
      work();
    } catch (const Error& error) {
      add(error.what());
    }
  };
  std::optional<mesh::GlobalMesh> mesh;
  if (is_sound(draft, scene.mesh_file ? "Mesh file" : "Mesh"))
    attempt([&] { mesh = scene.make_mesh(); });
  else if (scene.mesh_file && !scene.mesh_file->path.empty())
    attempt([&] { mesh::read_msh_file(scene.mesh_file->path); });
  auto comparison = compared(draft, mesh ? physics::names_of(*mesh) : names_in_scene(draft));
  std::string no_value;  // of an expression; if it is the only mistake, the step at this time reports it
  try {
    if (mesh) comparison.compare(*mesh);
  } catch (const Error& error) {
    no_value = error.what();
  }
  errors.insert(errors.end(), comparison.errors().begin(), comparison.errors().end());
  if (!no_value.empty() && !errors.empty()) add(no_value);
  if (unconstrained)
    *unconstrained = comparison.unconstrained();
  else if (!comparison.unconstrained().empty())
    add(comparison.unconstrained());
  base::throw_errors(errors);
  return std::move(*mesh);
}

}  // namespace sprekk::model
