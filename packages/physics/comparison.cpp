#include "physics/comparison.hpp"

#include "base/check.hpp"
#include "base/names.hpp"
#include "base/over_ranks.hpp"
#include "physics/material_library.hpp"

namespace sprekk::physics {

void Comparison::fail(const std::string& place, const std::string& what) {
  const auto line = fmt::format("{}: Sprekk > {}: {}", scene_.origin, place, what);
  if (!has(errors_, line)) errors_.push_back(line);  // several fractures may share a joint
}

bool Comparison::check_name(const std::string& section, const std::string& place, const std::string& name,
                            const std::optional<Names>& allowed) {
  if (!allowed || has(*allowed, name) || (name.empty() && !is_sound(section))) return true;
  fail(place, allowed->empty() ? fmt::format("is \"{}\", but the mesh has none with a name", base::shortened(name))
                               : fmt::format("is \"{}\", must be one of {}{}", base::shortened(name),
                                             base::quoted_list(*allowed), base::did_you_mean(name, *allowed)));
  return false;
}

void Comparison::check_length(const std::string& place, std::size_t n, const std::optional<int>& wanted) {
  if (wanted && n != 0 && n != static_cast<std::size_t>(*wanted))
    fail(place, fmt::format("has {}, must have {}", base::counted(n, "value"), *wanted));
}

void Comparison::check_material(const std::string& section, const std::string& name, const std::string& type) {
  const auto found = scene_.materials.find(name);
  const bool unreadable = found == scene_.materials.end() ? !is_sound("Materials > " + name) ||
                                                                (scene_.materials.empty() && !is_absent("Materials"))
                                                          : found->second.type.empty();
  if (unreadable || (name.empty() && !is_sound(section))) return;
  const std::string wrong = wrong_material(name, type, scene_.materials);
  if (!wrong.empty()) fail(section + " > \"material\"", wrong);
}

const Material* Comparison::rock_of(const std::string& region) const {
  const auto own = scene_.regions.find(region);
  const auto found = scene_.materials.find(
      own == scene_.regions.end() ? scene_.bulk.material : own->second.material.value_or(scene_.bulk.material));
  return found == scene_.materials.end() || found->second.type != "elastic" ? nullptr : &found->second;
}

const Material* Comparison::joint_of(const Fracture& fracture) const {
  const auto found = scene_.materials.find(fracture.material);
  const bool known = found != scene_.materials.end() && found->second.type == "joint";
  return known && is_sound("Materials > " + fracture.material) ? &found->second : nullptr;
}

std::string Comparison::name_of(const Material& material) const {
  const auto is_it = [&](const auto& one) { return &one.second == &material; };
  return std::find_if(scene_.materials.begin(), scene_.materials.end(), is_it)->first;
}

void Comparison::compare_regions() {
  for (const auto& [name, region] : scene_.regions)
    if (check_name("Regions", fmt::format("Regions > \"{}\"", name), name, names_.regions) && region.material)
      check_material("Regions > " + name, *region.material, "elastic");
}

void Comparison::compare_fractures() {
  if (scene_.fractures.count("intersections"))
    fail("Fractures > \"intersections\"", "is the name of intersections in result files; choose another name");
  if (scene_.fractures.count("channels") && scene_.flow && !scene_.flow->intersections.empty())
    fail("Fractures > \"channels\"", "is the name of channels in result files; choose another name");
  for (const auto& [name, fracture] : scene_.fractures)
    if (check_name("Fractures", fmt::format("Fractures > \"{}\"", name), name, names_.fractures))
      check_material("Fractures > " + name, fracture.material, "joint");
  if (!names_.fractures || (scene_.fractures.empty() && !is_absent("Fractures"))) return;
  const auto is_misspelt = [&](const std::string& name) {  // reported elsewhere
    return std::any_of(scene_.fractures.begin(), scene_.fractures.end(), [&](const auto& one) {
      return !has(*names_.fractures, one.first) && !base::did_you_mean(one.first, {name}).empty();
    });
  };
  for (const auto& name : *names_.fractures)
    if (!scene_.fractures.count(name) && is_sound("Fractures > " + name) && !is_misspelt(name))
      fail("Fractures", fmt::format("\"{}\" is in the mesh and has no section here", name));
}

void Comparison::compare_boundary_conditions() {
  for (const auto& [name, condition] : scene_.boundary_conditions) {
    const std::string section = "Boundary conditions > " + name;
    check_name(section, section + " > \"boundary\"", condition.boundary, names_.boundaries);
    if (has(tied_, condition.boundary))
      fail(section + " > \"boundary\"",
           fmt::format(
               "is \"{}\", which \"periodic\" connects to the opposite side; a periodic side allows no conditions",
               condition.boundary));
    if (condition.region) check_name(section, section + " > \"region\"", *condition.region, names_.regions);
    if (condition.fracture) check_name(section, section + " > \"fracture\"", *condition.fracture, names_.fractures);
  }
}

void Comparison::compare_probes() {
  for (const auto& [name, probe] : scene_.probes) {
    const std::string section = "Probes > " + name;
    const bool plain = !name.empty() && name.find_first_of("/\\\"\n") == name.npos && name[0] != '.';
    if (!plain) fail(section, "its name becomes a file name; leave out slashes, quotation marks and a first dot");
    check_length(section + " > \"point\"", probe.point.size(), names_.dim);
    check_length(section + " > \"line\"", probe.line.size(),
                 names_.dim ? std::optional(2 * *names_.dim) : std::nullopt);
    if (probe.boundary) check_name(section, section + " > \"boundary\"", *probe.boundary, names_.boundaries);
    if (probe.region) check_name(section, section + " > \"region\"", *probe.region, names_.regions);
  }
}

void Comparison::compare() {
  check_material("Bulk", scene_.bulk.material, "elastic");
  check_length("Bulk > \"gravity\"", scene_.bulk.gravity.size(), names_.dim);
  compare_regions();
  compare_fractures();
  compare_boundary_conditions();
  compare_probes();
  bool any = false;
  for_each_physics([&](auto physics) {
    physics.compare(*this);
    any = any || physics.is_in(scene_);
  });
  if (!any && is_sound("Bulk")) fail("Bulk > \"rigid\"", "leaves nothing to solve for; the scene has no other physics");
}

void Comparison::compare(const mesh::GlobalMesh& mesh) {
  for_each_physics([&](auto physics) { physics.compare_mesh(*this, mesh); });
}

std::vector<assembly::DirichletCondition> dirichlet_conditions(
    const std::map<std::string, BoundaryCondition>& conditions, const std::map<std::string, Region>& regions,
    const MeshNames& names, const std::string& field, const std::map<std::string, Fracture>& fractures) {
  std::vector<assembly::DirichletCondition> all;
  const auto add = [&](assembly::DirichletCondition condition, const std::vector<Prescribed>& prescribed) {
    for (const auto& one : prescribed) {
      if (!field.empty() && one.field != field) continue;
      condition.field = one.field;
      condition.values.clear();
      condition.within.reset();
      if (!one.lower_corner.empty()) {
        auto& [lower, upper] = condition.within.emplace();
        lower = upper = {};
        std::copy(one.lower_corner.begin(), one.lower_corner.end(), lower.begin());
        std::copy(one.upper_corner.begin(), one.upper_corner.end(), upper.begin());
      }
      for (const auto& value : one.values)
        condition.values.push_back(value.text() == "free" ? std::nullopt : std::make_optional(value));
      all.push_back(condition);
    }
  };
  for (const auto& [name, one] : conditions)
    add({.name = name,
         .field = "",
         .boundary = base::index_of(*names.boundaries, one.boundary),
         .values = {},
         .region = one.region ? base::index_of(*names.regions, *one.region) : -1,
         .fracture = one.fracture ? base::index_of(*names.fractures, *one.fracture) : -1},
        one.prescribed());
  for (const auto& [name, one] : regions)
    add({.name = "Regions > " + name,
         .field = "",
         .boundary = -1,
         .values = {},
         .region = base::index_of(*names.regions, name)},
        one.prescribed());
  for (const auto& [name, one] : fractures)
    for (const auto& prescribed : one.prescribed())
      add({.name = fmt::format("Fractures > {} > {}", name, prescribed.section),
           .field = "",
           .boundary = -1,
           .values = {},
           .fracture = base::index_of(*names.fractures, name)},
          {prescribed});
  return all;
}

std::vector<transport::FluxCondition> flux_conditions(const Scene& scene, const mesh::Mesh& mesh,
                                                      const FluxEntries& entries, bool of_fractures) {
  std::vector<transport::FluxCondition> conditions;
  for (const auto& [name, one] : scene.boundary_conditions) {
    const auto& flux = one.*entries.flux;
    const auto& coefficient = one.*entries.coefficient;
    if (one.fracture.has_value() != of_fractures || !(flux || coefficient)) continue;
    conditions.push_back({.boundary = base::index_of(mesh.boundary_names, one.boundary),
                          .value = flux ? *flux : *(one.*entries.beyond),
                          .coefficient = coefficient,
                          .region = one.region ? base::index_of(mesh.region_names, *one.region) : -1,
                          .fracture = one.fracture ? base::index_of(mesh.fracture_names, *one.fracture) : -1,
                          .location = fmt::format("{}: Sprekk > Boundary conditions > {}", scene.origin, name)});
  }
  return conditions;
}

std::vector<std::string> conditions_without_effect(const Scene& scene, const mesh::Mesh& mesh) {
  const auto n = mesh.region_names.size();
  std::vector<int> here(mesh.boundary_names.size() * n, 0);
  for (const auto& face : mesh.boundary_faces) here[face.boundary * n + mesh.cell_region[face.cell]] = 1;
  const auto touches = base::max_over_ranks(*mesh.comm, here);
  std::vector<std::string> all;
  for (const auto& [name, one] : scene.boundary_conditions)
    if (one.region && !touches[base::index_of(mesh.boundary_names, one.boundary) * n +
                               base::index_of(mesh.region_names, *one.region)])
      all.push_back(
          fmt::format("{}: Sprekk > Boundary conditions > {} > \"region\": \"{}\" does not touch the boundary \"{}\": "
                      "the condition applies nowhere",
                      scene.origin, name, *one.region, one.boundary));
  return all;
}

}  // namespace sprekk::physics
