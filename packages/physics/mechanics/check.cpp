// Checks of scenes with mechanics.
#include "assembly/free_motion.hpp"
#include "mesh/extents.hpp"
#include "physics/comparison.hpp"
#include "physics/mechanics/unbroken.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <tuple>

namespace sprekk::physics {

namespace {

/// Name of the entry that makes the rock rigid.
std::string rigid_entry(const Scene& scene) { return scene.bulk.rigid ? "\"Bulk > rigid\"" : "\"Flow > rigid rock\""; }

void check_stress(Comparison& c, const std::string& section, const std::vector<base::Expression>& stress) {
  std::optional<int> wanted;
  if (c.names().dim) wanted = *c.names().dim == 2 ? 4 : 6;
  c.check_length(section + " > \"initial stress\"", stress.size(), wanted);
  if (!Mechanics::is_in(c.scene()) && !stress.empty())
    c.fail(section + " > \"initial stress\"", "is of rock that " + rigid_entry(c.scene()) + " says does not deform");
}

bool has_initial_stress(const Scene& scene) {
  const auto& bulk = scene.bulk;
  return !bulk.initial_stress.empty() || bulk.lithostatic_stress || bulk.in_situ_stress ||
         std::ranges::any_of(scene.regions, [](const auto& region) { return !region.second.initial_stress.empty(); });
}

void compare_rock(Comparison& c) {
  const auto& bulk = c.scene().bulk;
  c.check_length("Bulk > \"body force\"", bulk.body_force.size(), c.names().dim);
  check_stress(c, "Bulk", bulk.initial_stress);
  for (const auto& [name, region] : c.scene().regions) check_stress(c, "Regions > " + name, region.initial_stress);
  if (!Mechanics::is_in(c.scene())) {
    if (!bulk.body_force.empty() || bulk.lithostatic_stress || bulk.in_situ_stress)
      c.fail("Bulk",
             "prescribes a force or stress of the rock, which " + rigid_entry(c.scene()) + " says does not deform");
    return;
  }
  c.for_each_rock([&](const Material& rock) {
    const auto place = "Materials > " + c.name_of(rock);
    if (!rock.has_elasticity() && c.is_sound(place) && c.is_sound("Flow"))
      c.fail(place, "no elastic constants given, exactly two are needed where the rock deforms");
  });
}

void compare_stress_intensity(Comparison& c, const std::string& place) {
  const auto& scene = c.scene();
  if (!Mechanics::is_in(scene)) return c.fail(place, "is in rock that " + rigid_entry(scene) + " says does not deform");
  if (scene.host_fluid) c.fail(place, "is not available with the pressure of a host");
  if (has_solid_pressure(scene)) c.fail(place, "is not available in nearly incompressible rock");
}

void compare_prescribed_slip(Comparison& c, const std::string& name, const PrescribedSlip& slip) {
  const auto dim = c.names().dim;
  const auto section = fmt::format("Fractures > {} > prescribed slip", name);
  if (!Mechanics::is_in(c.scene()))
    return c.fail(section, "is in rock that " + rigid_entry(c.scene()) + " says does not deform");
  c.check_length(section + " > \"slip\"", slip.slip.size(),
                 !slip.direction.empty() ? std::optional(1)
                 : dim                   ? std::optional(*dim - 1)
                                         : std::nullopt);
  for (const auto& [entry, vector] :
       {std::pair("direction", slip.direction), std::pair("moving side", slip.moving_side),
        std::pair("lower corner", slip.lower_corner), std::pair("upper corner", slip.upper_corner)})
    c.check_length(fmt::format("{} > \"{}\"", section, entry), vector.size(), dim);
}

void compare_fractures(Comparison& c) {
  for (const auto& [name, fracture] : c.scene().fractures) {
    if (fracture.stress_intensity || fracture.toughness)
      compare_stress_intensity(c, fmt::format("Fractures > {} > \"stress intensity\"", name));
    for (const auto& [entry, given] : {std::pair("prescribed slip", fracture.prescribed_slip.has_value()),
                                       std::pair("plastic jump", !fracture.plastic_jump.empty()),
                                       std::pair("unbroken", fracture.unbroken.has_value())})
      if (given && fracture.toughness)
        c.fail(fmt::format("Fractures > {} > \"{}\"", name, entry), "not available with a \"toughness\"");
    if (fracture.toughness && c.names().dim == 3)
      c.fail(fmt::format("Fractures > {} > \"toughness\"", name), "requires a mesh in 2D");
    if (fracture.prescribed_slip) compare_prescribed_slip(c, name, *fracture.prescribed_slip);
    const std::string jump = fmt::format("Fractures > {} > \"plastic jump\"", name);
    c.check_length(jump, fracture.plastic_jump.size(),
                   c.names().dim ? std::optional(*c.names().dim - 1) : std::nullopt);
    const std::string traction = fmt::format("Fractures > {} > \"initial traction\"", name);
    c.check_length(traction, fracture.initial_traction.size(), c.names().dim);
    const auto* joint = c.joint_of(fracture);
    if (!Mechanics::is_in(c.scene())) {
      for (const auto& [place, given] :
           {std::pair(jump, &fracture.plastic_jump), std::pair(traction, &fracture.initial_traction)})
        if (!given->empty()) c.fail(place, "is of rock that " + rigid_entry(c.scene()) + " says does not deform");
    } else if (!fracture.initial_traction.empty() && !has_initial_stress(c.scene()) && c.is_sound("Bulk")) {
      c.fail(traction, "requires an \"initial stress\", a \"lithostatic stress\" or an \"in-situ stress\" of the rock");
    } else if (joint && c.is_sound("Flow")) {
      const std::string place = "Materials > " + fracture.material;
      for (const auto& [entry, what] : joint->missing())
        c.fail(entry.empty() ? place : fmt::format("{} > \"{}\"", place, entry), what);
      if (joint->is_in_situ() && !has_initial_stress(c.scene()))
        c.fail(place + " > \"reference state\"",
               fmt::format("is {}; it requires an \"initial stress\", a \"lithostatic stress\" or an \"in-situ "
                           "stress\"",
                           joint->reference_state));
      if (fracture.slip_path && !joint->is_in_situ())
        c.fail(fmt::format("Fractures > {} > \"slip path\"", name),
               "requires the \"reference state\" in situ of the joint");
      if (c.names().dim && *c.names().dim == 3)
        for (const auto& [entry, what] : joint->only_in_2d()) c.fail(fmt::format("{} > \"{}\"", place, entry), what);
    }
  }
}

void compare_conditions(Comparison& c) {
  for (const auto& [name, condition] : c.scene().boundary_conditions) {
    const std::string section = "Boundary conditions > " + name;
    c.check_length(section + " > \"displacement\"", condition.displacement.size(), c.names().dim);
    c.check_length(section + " > \"traction\"", condition.traction.size(), c.names().dim);
    const auto springs = section + " > \"foundation stiffness\"";
    if (const auto n = condition.foundation_stiffness.size(); n == 1 && c.scene().keeps_stress)
      c.fail(springs, "one value is not available if stages change stiffnesses");
    else if (const auto dim = c.names().dim; n > 1 && dim && n != static_cast<std::size_t>(*dim))
      c.fail(springs, fmt::format("has {} values, must have {}, or 1 along the normal", n, *dim));
    c.check_length(section + " > \"lower corner\"", condition.lower_corner.size(), c.names().dim);
    c.check_length(section + " > \"upper corner\"", condition.upper_corner.size(), c.names().dim);
    const bool given = condition.Mechanics::BoundaryCondition::is_given();
    if (given && condition.fracture)
      c.fail(section + " > \"fracture\"",
             "not available with \"displacement\", \"traction\", \"confining pressure\" and \"foundation stiffness\"");
    if (given && !Mechanics::is_in(c.scene()))
      c.fail(section, "moves or loads the rock, which " + rigid_entry(c.scene()) + " says does not deform");
  }
}

void compare_gravity(Comparison& c) {
  const auto& scene = c.scene();
  if (scene.bulk.gravity.empty() || !Mechanics::is_in(scene) || !c.names().regions || !c.is_sound("Regions")) return;
  std::set<const Material*> heavy;
  for (const auto& name : *c.names().regions) heavy.insert(c.rock_of(name));
  if (scene.bulk.lithostatic_stress) heavy.insert(c.rock_of("bulk"));  // lithostatic stress uses this density
  for (const auto& [name, material] : scene.materials)
    if (heavy.count(&material) && !material.density && c.is_sound("Materials > " + name))
      c.fail(fmt::format("Materials > {} > \"density\"", name), "missing; it is required with \"gravity\"");
}

void compare_lithostatic_stress(Comparison& c) {
  const auto& gravity = c.scene().bulk.gravity;
  if (!c.scene().bulk.lithostatic_stress || !c.is_sound("Bulk")) return;
  if (gravity.size() != 2 && gravity.size() != 3) {
    c.fail("Bulk > \"gravity\"", "must have 2 or 3 components for a \"lithostatic stress\"");
    return;
  }
  const std::string place = "Bulk > lithostatic stress";
  if (const auto* rock = c.rock_of("bulk"); rock && rock->density && !rock->density->is_constant())
    c.fail(place, "needs a density that is a number; give an \"initial stress\" instead");
  if (std::any_of(gravity.begin(), gravity.end() - 1, [](Real g) { return g != 0; }))
    c.fail(place, "needs gravity along the last coordinate only");
}

void compare_in_situ_stress(Comparison& c) {
  const auto& stress = c.scene().bulk.in_situ_stress;
  if (!stress || !c.names().dim || *c.names().dim == 3 || std::fmod(stress->azimuth, 90) == 0) return;
  c.fail("Bulk > in-situ stress > \"azimuth\"",
         fmt::format("is {} degrees; in 2D SHmax lies in the section, 90 or 270, or across it, 0 or 180",
                     stress->azimuth));
}

/// Conditions without errors that match the mesh.
std::map<std::string, BoundaryCondition> fitting_conditions(const Comparison& c) {
  std::map<std::string, BoundaryCondition> result;
  for (const auto& [name, condition] : c.scene().boundary_conditions) {
    const auto n = condition.displacement.size(), n_springs = condition.foundation_stiffness.size();
    const auto fits = [&](std::size_t size) { return size == 0 || size == static_cast<std::size_t>(*c.names().dim); };
    if (c.is_sound("Boundary conditions > " + name) && has(*c.names().boundaries, condition.boundary) &&
        (!condition.region || has(*c.names().regions, *condition.region)) &&
        (!condition.fracture || has(*c.names().fractures, *condition.fracture)) && fits(n) &&
        (n_springs == 1 || fits(n_springs)) && fits(condition.lower_corner.size()) &&
        fits(condition.upper_corner.size()))
      result.emplace(name, condition);
  }
  return result;
}

/// Conditions on displacements that constrain the unknowns of conditions and springs, also if planes are inclined.
std::vector<assembly::DirichletCondition> with_springs(const Comparison& c, const mesh::GlobalMesh& mesh,
                                                       std::map<std::string, BoundaryCondition> conditions) {
  for (auto& [name, condition] : conditions) {
    auto k = condition.foundation_stiffness;
    if (k.size() == 1 && k[0] > 0)
      k = mesh::parts_of_normals(mesh, base::index_of(*c.names().boundaries, condition.boundary));
    if (std::any_of(k.begin(), k.end(), [](Real k) { return k > 0; }))
      for (const Real k_i : k)
        condition.displacement.push_back(k_i > 0 ? base::Expression(0) : base::Expression("free"));
  }
  return dirichlet_conditions(conditions, {}, c.names(), "displacement");
}

/// Reports boxes of conditions without a boundary node, with the node nearest to the centre of the box.
void check_boxes(Comparison& c, const mesh::GlobalMesh& mesh,
                 const std::vector<assembly::DirichletCondition>& conditions) {
  using mesh::operator-, mesh::operator+, mesh::operator*;
  for (const auto& condition : conditions) {
    if (!condition.within) continue;
    const auto middle = 0.5 * (mesh::Vector((*condition.within)[0]) + mesh::Vector((*condition.within)[1]));
    bool any = false;
    mesh::Vector nearest{};
    Real distance = std::numeric_limits<Real>::infinity();
    for (const auto& face : mesh.boundary_faces) {
      if (face.boundary != condition.boundary ||
          (condition.region >= 0 && mesh.cell_region[face.cell] != condition.region))
        continue;
      const auto nodes = mesh::nodes_of_face(mesh, face.cell, face.local_face);
      for (int k = 0; k < mesh::n_face_nodes(mesh.shape); ++k) {
        const auto x = mesh::point(mesh, nodes[k]);
        any = any || condition.applies_at(x);
        if (const Real d = mesh::norm(x - middle); d < distance) std::tie(distance, nearest) = std::pair(d, x);
      }
    }
    if (!any)
      c.fail(fmt::format("Boundary conditions > {} > \"lower corner\"", condition.name),
             fmt::format("no node of boundary \"{}\" is in the box; the nearest to its middle is at ({:.9g}, {:.9g}, "
                         "{:.9g})",
                         (*c.names().boundaries)[condition.boundary], nearest[0], nearest[1], nearest[2]));
  }
}

/// Reports boxes of prescribed slip without a face, with the face nearest to the middle of the box.
void check_slip_boxes(Comparison& c, const mesh::GlobalMesh& mesh) {
  using mesh::operator-, mesh::operator+, mesh::operator*;
  for (const auto& [name, fracture] : c.scene().fractures) {
    const auto& slip = fracture.prescribed_slip;
    if (!slip || slip->slip.empty() || slip->lower_corner.size() != static_cast<std::size_t>(mesh.dim()) ||
        slip->upper_corner.size() != slip->lower_corner.size())
      continue;
    mesh::Vector middle{}, nearest{};
    for (int i = 0; i < mesh.dim(); ++i) middle[i] = (slip->lower_corner[i] + slip->upper_corner[i]) / 2;
    bool any = false;
    Real distance = std::numeric_limits<Real>::infinity();
    for (const auto& face : mesh.fracture_faces) {
      if (mesh.fracture_names[face.fracture] != name) continue;
      const auto centre = mesh::face_centre(mesh, face.cell[0], face.local_face[0]);
      any = any || slip->contains(centre);
      if (const Real d = mesh::norm(centre - middle); d < distance) std::tie(distance, nearest) = std::pair(d, centre);
    }
    if (!any)
      c.fail(
          fmt::format("Fractures > {} > prescribed slip > \"lower corner\"", name),
          fmt::format("no face of the fracture has its centre in the box; the nearest is at ({:.9g}, {:.9g}, {:.9g})",
                      nearest[0], nearest[1], nearest[2]));
  }
}

/// Returns whether a condition can be evaluated at the end of the first step.
bool can_be_evaluated(const Comparison& c, const BoundaryCondition& condition) {
  return (c.begin() && c.is_sound("Tables")) ||
         std::all_of(condition.displacement.begin(), condition.displacement.end(),
                     [](const auto& value) { return value.text() == "free" || value.is_constant(); });
}

}  // namespace

void Mechanics::compare(Comparison& c) {
  compare_rock(c);
  compare_fractures(c);
  compare_unbroken(c);
  compare_conditions(c);
  compare_gravity(c);
  compare_lithostatic_stress(c);
  compare_in_situ_stress(c);
}

void Mechanics::compare_mesh(Comparison& c, const mesh::GlobalMesh& mesh) {
  auto conditions = fitting_conditions(c);
  const auto constrained = [&] { return dirichlet_conditions(conditions, {}, c.names(), "displacement"); };
  const bool all = conditions.size() == c.scene().boundary_conditions.size() &&
                   (conditions.empty() ? c.is_absent("Boundary conditions") : c.is_sound("Boundary conditions"));
  check_boxes(c, mesh, constrained());
  check_slip_boxes(c, mesh);
  if (is_in(c.scene()) && all) c.fail_unconstrained(assembly::unconstrained(mesh, with_springs(c, mesh, conditions)));
  for (auto it = conditions.begin(); it != conditions.end();)
    it = can_be_evaluated(c, it->second) ? std::next(it) : conditions.erase(it);
  for (const auto& conflict : assembly::find_conflicts(mesh, constrained(), c.begin().value_or(0))) c.add(conflict);
}

}  // namespace sprekk::physics
