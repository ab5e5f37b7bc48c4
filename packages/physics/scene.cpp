#include "physics/scene.hpp"

#include "physics/material_library.hpp"

namespace sprekk::physics {

void Material::describe(base::Section& s) {
  s.required_choice(type, "type", {"elastic", "joint"}, "elastic: rock; joint: the surface of a fracture");
  s.entry(source, "source", "-", "where the values come from");
  if (type != "joint") describe_rock(s);
  if (type != "elastic") describe_joint(s);
  if (!s.complete()) return;
  if (type == "elastic") check_rock(s);
  if (type == "joint") check_joint(s);
}

void Bulk::describe(base::Section& s) {
  s.required(material, "material", "-", "name of an elastic material, of this scene or of the library");
  s.entry(gravity, "gravity", "m/s^2", base::any(),
          "acceleration per direction, e.g. {0, 0, -9.81}; adds the density times it to the body force");
  describe_parts(s);
  if (!s.complete()) return;
  check_parts(s);
}

void Region::describe(base::Section& s) {
  s.entry(material, "material", "-",
          "name of an elastic material, of this scene or of the library; absent: that of \"Bulk\"");
  describe_parts(s);
  if (!s.complete()) return;
  check_parts(s);
  if (!material && !is_any_given()) s.fail("has no entry; give a \"material\" or another one");
}

void Fracture::describe(base::Section& s) {
  s.required(material, "material", "-", "name of a joint material, of this scene or of the library");
  describe_parts(s);
  if (s.complete()) check_parts(s);
}

void BoundaryCondition::describe(base::Section& s) {
  s.required(boundary, "boundary", "-", "name of a boundary of the mesh: west, east, south, north, bottom, top");
  s.entry(region, "region", "-", "name of a region: the condition holds only on faces of its cells");
  s.entry(fracture, "fracture", "-",
          "name of a fracture: the condition holds only where it ends on the boundary, per aperture and length; not of "
          "displacements and tractions");
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
  s.named_sections(tables, "Tables", "piecewise linear functions that expressions call by name, e.g. ramp(t)");
  s.named_expressions(expressions, "Expressions", "what all other expressions may call by name, e.g. depth = 0.5 - y");
  s.expressions_call(tables, expressions);
}

void Scene::describe_physics(base::Section& s) {
  s.named_sections(materials, "Materials",
                   "rock and joints, by names of your choice; those of the material library need no section");
  s.section(bulk, "Bulk", "the rock");
  describe_parts(s);
  s.named_sections(regions, "Regions", "what regions of the mesh have of their own, by their names");
  s.named_sections(fractures, "Fractures", "a section for each fracture of the mesh");
  s.named_sections(boundary_conditions, "Boundary conditions",
                   "by names of your choice; boundaries without one are free of traction");
  std::vector<std::string> used = {bulk.material};
  for (const auto& [name, region] : regions)
    if (region.material) used.push_back(*region.material);
  for (const auto& [name, fracture] : fractures) used.push_back(fracture.material);
  add_library_materials(materials, used);
}

const Material& Scene::material_of(const std::string& region) const {
  const auto found = regions.find(region);
  return materials.at(found == regions.end() ? bulk.material : found->second.material.value_or(bulk.material));
}

}  // namespace sprekk::physics
