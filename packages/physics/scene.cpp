#include "physics/scene.hpp"

#include "base/text.hpp"
#include "base/value.hpp"
#include "base/xml.hpp"
#include "physics/material_library.hpp"

#include <fmt/ranges.h>

#include <set>

namespace sprekk::physics {

void Material::describe(base::Section& s) {
  s.required_choice(type, "type", {"elastic", "joint"},
                    "type of the material; elastic: rock; joint: the surface of a fracture");
  s.entry(source, "source", "-", "origin of the values, such as a publication");
  if (type != "joint") describe_rock(s);
  if (type != "elastic") describe_joint(s);
  if (!s.complete()) return;
  if (type == "elastic") check_rock(s);
  if (type == "joint") check_joint(s);
}

void Bulk::describe(base::Section& s) {
  s.required(material, "material", "-", "name of an elastic material of this scene or of the library");
  s.entry(gravity, "gravity", "m/s^2", base::any(),
          "acceleration of gravity per direction, e.g. {0, 0, -9.81}; density times gravity adds to the body force");
  describe_parts(s);
  if (!s.complete()) return;
  check_parts(s);
}

void Region::describe(base::Section& s) {
  s.entry(material, "material", "-",
          "name of an elastic material of this scene or of the library; absent: the material of \"Bulk\"");
  s.entry(excavated, "excavated", "-",
          "excavation of the region: its walls form a boundary of the same name, and fractures end there");
  describe_parts(s);
  if (!s.complete()) return;
  check_parts(s);
  if (!material && !excavated && !is_any_given()) s.fail("has no entry; give a \"material\" or another one");
}

void Fracture::describe(base::Section& s) {
  const std::string meaning = "name of a joint material of this scene or of the library";
  if (material.empty() && !s.documents())
    s.required(material, "material", "-", meaning);
  else
    s.entry(material, "material", "-", meaning + "; without it, the \"material\" of \"Fractures\" must be given");
  describe_parts(s);
  if (s.complete()) check_parts(s);
}

void Probe::describe(base::Section& s) {
  s.entry(outputs, "outputs", "-",
          "names of arrays of bulk.pvd or fractures.pvd, of results of fractures in results.json, or of sums over a "
          "boundary such as \"reactions\"");
  s.entry(point, "point", "m", base::any(), "coordinates of a point, for values at this point");
  s.entry(line, "line", "m", base::any(),
          "coordinates of the first and the last point of a line, for values along this line");
  s.entry(points, "points", "-", base::between(2, 100000),
          "number of points of the line, at equal distances, including its ends");
  s.entry(boundary, "boundary", "-", "name of a boundary, for the \"value\" over its faces");
  s.entry(region, "region", "-", "name of a region, for the \"value\" over its cells");
  s.entry(fracture, "fracture", "-", "name of a fracture or of a set of fractures, for the \"value\" over its faces");
  s.choice(value, "value", {"mean", "maximum", "minimum", "integral"},
           "kind of value over a boundary, a region or a fracture");
  describe_parts(s);
  if (!s.complete()) return;
  const int n = !point.empty() + !line.empty() + boundary.has_value() + region.has_value() + fracture.has_value();
  const bool of_physics = is_any_given();
  std::string others;
  for (const auto& kind : kinds())
    if (!kind.empty()) others += std::string(", ") + kind;
  if (n + of_physics != 1)
    s.fail(fmt::format("give one of \"point\", \"line\", \"boundary\", \"region\", \"fracture\"{}", others));
  if (outputs.empty() && !of_physics && n == 1) s.fail("outputs", "missing; name at least one output");
  if (!outputs.empty() && of_physics)
    s.fail("outputs", "requires a place; " + others.substr(2) + " prints all its outputs");
  check_parts(s);
}

void BoundaryCondition::describe(base::Section& s) {
  s.required(boundary, "boundary", "-",
             "name of a boundary of the mesh; of a box: west, east, south, north, bottom, top");
  s.entry(region, "region", "-", "name of a region, which restricts the condition to faces of its cells");
  s.entry(fracture, "fracture", "-",
          "name of a fracture, which restricts the condition to its end on the boundary, per aperture and length; not "
          "for displacements and tractions");
  describe_parts(s);
  if (!s.complete()) return;
  if (fracture && region) s.fail("give either \"fracture\" or \"region\"");
  check_parts(s);
  if (is_any_given()) return;
  std::string all;
  for (const auto& some : kinds())
    if (!some.empty()) all += (all.empty() ? "" : "; ") + some;
  s.fail("give " + all);
}

void Scene::describe_expressions(base::Section& s) {
  s.named_sections(tables, "Tables", "piecewise linear functions for use in expressions by name, e.g. ramp(t)");
  s.named_expressions(expressions, "Expressions",
                      "named expressions for use in all other expressions, e.g. depth = 0.5 - y");
  s.expressions_call(tables, expressions);
}

void Scene::describe_physics(base::Section& s) {
  s.named_sections(materials, "Materials",
                   "materials of rock and joints, by names of your choice; materials of the library need no section");
  s.section(bulk, "Bulk", "properties of the rock");
  describe_parts(s);
  s.named_sections(regions, "Regions", "properties of regions of the mesh, by their names");
  s.named_sections(
      fractures, "Fractures", "properties of fractures of the mesh, by their names",
      [&](base::Section& all, Fracture& first) {
        all.entry(default_joint, "material", "-",
                  "name of the default joint material, for fractures without a section or without a \"material\"");
        first.material = default_joint.value_or("");
      });
  s.named_sections(boundary_conditions, "Boundary conditions",
                   "boundary conditions by names of your choice; boundaries without a condition are traction-free");
  s.named_sections(probes, "Probes", "time series by names of your choice, each in its own table");
  std::vector<std::string> used = {bulk.material};
  for (const auto& [name, region] : regions)
    if (region.material) used.push_back(*region.material);
  for (const auto& [name, fracture] : fractures) used.push_back(fracture.material);
  if (default_joint) used.push_back(*default_joint);
  add_library_materials(materials, used);
}

const Material& Scene::material_of(const std::string& region) const {
  const auto found = regions.find(region);
  return materials.at(found == regions.end() ? bulk.material : found->second.material.value_or(bulk.material));
}

std::vector<std::string> Scene::excavated() const {
  std::vector<std::string> names;
  for (const auto& [name, region] : regions)
    if (region.excavated) names.push_back(name);
  return names;
}

namespace {

/// Section with the joints of single fractures. Their entries are read like those of Materials.
struct OwnJoints {
  base::Tables tables;
  base::Expression::Named expressions;
  std::map<std::string, Material> joints;
  void describe(base::Section& s) {
    s.named_sections(tables, "Tables", "");
    s.named_expressions(expressions, "Expressions", "");
    s.expressions_call(tables, expressions);
    s.named_sections(joints, "single fractures", "");
  }
};

/// Names of all entries of joints.
std::vector<std::string> names_of_entries() {
  std::vector<std::string> names = {"material"};
  for (const auto& entry : base::specification<Material>("").entries) names.push_back(entry.name);
  return names;
}

bool is_entry(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Name of the base joint of a single fracture with individual properties.
const std::string& joint_name(const Scene& scene, const mesh::Mesh& mesh, const mesh::SingleFracture& single) {
  const auto own = single.properties.find("material");
  return own == single.properties.end() ? scene.fractures.at(mesh.fracture_names[single.set]).material : own->second;
}

}  // namespace

std::map<int, Material> own_joints(const Scene& scene, const mesh::Mesh& mesh) {
  const auto names = names_of_entries();
  OwnJoints own{scene.tables, scene.expressions, {}};
  auto list = base::effective(own, "Sprekk");
  std::vector<std::string> errors;
  for (const auto& single : mesh.single_fractures) {
    const auto& [name, set, properties] = single;
    if (properties.empty()) continue;
    const auto& joint = joint_name(scene, mesh, single);
    const auto report = [&](const std::string& entry, const std::string& what) {
      errors.push_back(fmt::format("{}: fracture \"{}\": {}: {}", scene.origin, name, entry, what));
    };
    if (const auto wrong = wrong_material(joint, "joint", scene.materials); !wrong.empty()) {
      report("\"material\"", wrong);
      continue;
    }
    auto copy = scene.materials.at(joint);
    auto& entries = list.sublist("single fractures").sublist(name);
    entries = base::effective(copy, name);
    for (const auto& [entry, value] : properties)
      if (is_entry(names, entry) && entry != "material")
        base::apply_override(entries, entry + "=" + value);
      else if (const auto meant = base::did_you_mean(entry, names); !is_entry(names, entry) && !meant.empty())
        report(fmt::format("\"{}\"", entry), "is no entry of a joint" + meant);
  }
  const auto draft = base::draft<OwnJoints>(list, scene.origin, "Sprekk", errors);
  base::throw_errors(draft.report.errors);
  std::map<int, Material> result;
  for (std::size_t k = 0; k < mesh.single_fractures.size(); ++k)
    if (const auto found = draft.value.joints.find(mesh.single_fractures[k].name); found != draft.value.joints.end())
      result.emplace(static_cast<int>(k), found->second);
  return result;
}

std::map<std::string, std::string> own_entries(const Scene& scene, const mesh::Mesh& mesh, int single) {
  const auto own = scene.own_joints.find(single);
  if (own == scene.own_joints.end()) return {};
  const auto& name = joint_name(scene, mesh, mesh.single_fractures[single]);
  auto joint = own->second, material = scene.materials.at(name);
  const auto entries = base::effective(joint, name), before = base::effective(material, name);
  std::map<std::string, std::string> different = {{"material", name}};
  for (const auto& entry : entries)
    if (const auto text = base::value_text(entry.second);
        !before.isParameter(entry.first) || base::value_text(before.getEntry(entry.first)) != text)
      different.emplace(entry.first, text);
  return different;
}

std::vector<std::string> properties_passed_over(const Scene& scene, const mesh::Mesh& mesh) {
  std::set<std::string> titles;
  for (const auto& single : mesh.single_fractures)
    for (const auto& property : single.properties) titles.insert(property.first);
  for (const auto& name : names_of_entries()) titles.erase(name);
  if (titles.empty()) return {};
  return {fmt::format("{}: ignored columns of fractures, which are no entries of a joint: \"{}\"", scene.origin,
                      fmt::join(titles, "\", \""))};
}

const Material& joint_of(const Scene& scene, const mesh::Mesh& mesh, int single) {
  if (const auto own = scene.own_joints.find(single); own != scene.own_joints.end()) return own->second;
  return scene.materials.at(scene.fractures.at(mesh.fracture_names[mesh.single_fractures[single].set]).material);
}

std::string place_of(const Scene& scene, const Material& material) {
  const auto is_it = [&](const auto& one) { return &one.second == &material; };
  const auto found = std::find_if(scene.materials.begin(), scene.materials.end(), is_it);
  return fmt::format("{}: Sprekk > Materials > {}", scene.origin,
                     found == scene.materials.end() ? "a fracture's own" : found->first);
}

}  // namespace sprekk::physics
