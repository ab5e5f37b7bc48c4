// Change of the mechanical part of a scene in a live model.
#include "assembly/tip_cell.hpp"
#include "base/names.hpp"
#include "base/over_ranks.hpp"
#include "laws/joint_parameters.hpp"
#include "physics/mechanics/mechanics.hpp"
#include "physics/scene.hpp"

#include <fmt/ranges.h>

#include <cmath>
#include <map>
#include <string>
#include <tuple>
#include <vector>

namespace sprekk::physics {

namespace {

/// Names of the joint laws with history variables, in the order of these variables.
std::vector<std::string> laws_with_memory(const Material& material) {
  std::vector<std::string> names;
  material.joint({}).law.for_each_part([&](const auto& law, int) {
    if (laws::n_history(law) == 0) return;
    names.emplace_back(law.visit([](const auto& kind) { return std::decay_t<decltype(kind)>::name; }));
  });
  return names;
}

bool is_excavated(const Scene& scene, const std::string& region) {
  const auto found = scene.regions.find(region);
  return found != scene.regions.end() && found->second.excavated;
}

/// Stiffness, boundary and region of springs, by condition.
auto springs_of(const Scene& scene) {
  std::map<std::string, std::tuple<std::string, std::string, std::vector<Real>>> springs;
  for (const auto& [name, condition] : scene.boundary_conditions)
    if (!condition.foundation_stiffness.empty())
      springs[name] = {condition.boundary, condition.region.value_or(""), condition.foundation_stiffness};
  return springs;
}

}  // namespace

std::map<std::string, bool> changed_rock(const mesh::Mesh& mesh, const Scene& before, const Scene& after) {
  constexpr Real rounding = 1e-12;
  std::vector<int> others(mesh.region_names.size());
  base::collectively(*mesh.comm, [&] {
    const auto old = elasticity(before, mesh), now = elasticity(after, mesh);
    const auto differ = [](Real a, Real b) { return !(std::abs(a - b) <= rounding * std::abs(a)); };
    for (LocalIndex c = 0; c < mesh.n_owned_cells; ++c) {
      const auto &a = old.of_cell(mesh, c), &b = now.of_cell(mesh, c);
      if (differ(a.G, b.G) || differ(a.youngs_modulus(), b.youngs_modulus())) others[mesh.cell_region[c]] = 1;
    }
  });
  others = base::max_over_ranks(*mesh.comm, others);
  std::map<std::string, bool> changed;
  for (std::size_t k = 0; k < others.size(); ++k)
    if (const auto& name = mesh.region_names[k]; !is_excavated(after, name))
      if (const bool filled = is_excavated(before, name); filled || others[k]) changed[name] = filled;
  return changed;
}

/// Strains and jumps are measured from the initial state, which has the initial stress.
std::vector<std::string> Mechanics::fixed_entries() {
  return {"initial stress", "lithostatic stress", "in-situ stress", "plastic jump",
          "slip path",      "initial traction",   "unbroken"};
}

void Mechanics::Change::prepare(const mesh::Mesh& mesh, const Scene& before, Scene& after) {
  after.keeps_stress =
      before.keeps_stress || (is_in(before) && is_in(after) &&
                              (!changed_rock(mesh, before, after).empty() || springs_of(before) != springs_of(after)));
}

/// Only the stress of nodes can be transferred, not that of face bubbles and tip functions.
std::vector<std::string> Mechanics::Change::refuses_in(const mesh::Mesh& mesh, const Scene& before,
                                                       const Scene& after) {
  if (!is_in(before) || !is_in(after)) return {};
  const auto changed = changed_rock(mesh, before, after);
  if (changed.empty()) return {};
  const std::size_t n_regions = mesh.region_names.size();
  std::vector<int> meets(n_regions * mesh.fracture_names.size()), has_tips(n_regions);  // [fracture, region]
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f)
    for (const LocalIndex cell : mesh.fracture_faces[f].cell)
      meets[mesh.fracture_faces[f].fracture * n_regions + mesh.cell_region[cell]] = 1;
  for (LocalIndex c = 0; c < mesh.n_owned_cells; ++c)
    if (assembly::has_tip(mesh, c)) has_tips[mesh.cell_region[c]] = 1;
  meets = base::max_over_ranks(*mesh.comm, meets);
  has_tips = base::max_over_ranks(*mesh.comm, has_tips);
  std::vector<std::string> lines;
  if (has_solid_pressure(before) || has_solid_pressure(after))
    lines.push_back(
        fmt::format("the rock of \"{}\" changes, and some rock is nearly incompressible, with a pressure that "
                    "counts from the start",
                    changed.begin()->first));
  for (const auto& [name, filled] : changed) {
    const char* what = filled ? "is filled" : "gets other elastic constants";
    const auto region = base::index_of(mesh.region_names, name);
    for (std::size_t k = 0; k < mesh.fracture_names.size(); ++k)
      if (meets[k * n_regions + region])
        lines.push_back(
            fmt::format("the rock of \"{}\" {}, and the fracture \"{}\" meets it; that can only happen in "
                        "rock without adjacent fractures",
                        name, what, mesh.fracture_names[k]));
    if (has_tips[region])
      lines.push_back(fmt::format("the rock of \"{}\" {}, and there are crack tips in it", name, what));
  }
  return lines;
}

namespace {

/// Entry of friction that depends on the slip rate whose change would change the initial slip rate or state; or empty.
/// Without an "initial state", the state follows from other entries.
std::string changed_start(const Material& now, const Material& then) {
  if (!now.depends_on_rate() || !then.depends_on_rate()) return "";
  std::vector<std::string> entries = {"initial slip rate", "initial state"};
  if (!now.entry("initial state"))
    entries.insert(entries.end(),
                   {"initial friction coefficient", "direct effect", "evolution effect", "state evolution distance",
                    "reference slip rate", "reference friction coefficient"});
  const auto text = [](const auto& value) { return value ? value->text() : std::string(); };
  for (const auto& entry : entries)
    if (text(now.entry(entry)) != text(then.entry(entry))) return entry;
  return "";
}

}  // namespace

std::vector<std::string> Mechanics::Change::refuses(const Scene& before, const Scene& after) {
  std::vector<std::string> lines;
  for (const auto& [name, fracture] : after.fractures) {
    const auto old = before.fractures.find(name);
    if (old == before.fractures.end() || !is_in(after)) continue;
    const auto &now = after.materials.at(fracture.material), &then = before.materials.at(old->second.material);
    if (now.reference_state != then.reference_state)
      lines.push_back(fmt::format("Fractures > {}: \"reference state\": is {}, was {}", name, now.reference_state,
                                  then.reference_state));
    const auto laws = laws_with_memory(now), old_laws = laws_with_memory(then);
    if (!old_laws.empty() && laws != old_laws)
      lines.push_back(
          fmt::format("Fractures > {}: its laws with history variables become \"{}\", they were \"{}\"; other laws "
                      "cannot use these history variables",
                      name, fmt::join(laws, "\", \""), fmt::join(old_laws, "\", \"")));
  }
  for (const auto& [name, fracture] : after.fractures) {
    const auto old = before.fractures.find(name);
    if (old == before.fractures.end() || !is_in(after)) continue;
    const auto &now = after.materials.at(fracture.material), &then = before.materials.at(old->second.material);
    if (const auto entry = changed_start(now, then); !entry.empty())
      lines.push_back(
          fmt::format("Fractures > {}: \"{}\" of \"{}\" must not change: history variables are relative to the initial "
                      "slip rate and state",
                      name, entry, fracture.material));
  }
  if (!after.bulk.lithostatic_stress) return lines;
  const auto density = [](const Scene& scene) { return scene.material_of("bulk").density.value_or(0).text(); };
  if (before.bulk.gravity != after.bulk.gravity || density(before) != density(after))
    lines.push_back("Bulk > \"lithostatic stress\": follows from gravity and density and cannot be changed alone");
  return lines;
}

}  // namespace sprekk::physics
