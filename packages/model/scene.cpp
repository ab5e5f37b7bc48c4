#include "model/scene.hpp"

#include "base/check.hpp"
#include "base/text.hpp"
#include "base/xml.hpp"

#include <cmath>

namespace sprekk::model {

namespace {

constexpr Real degree = 3.14159265358979323846 / 180;

template <class T>
std::vector<std::string> names_of(const std::map<std::string, T>& map) {
  std::vector<std::string> names;
  for (const auto& [name, value] : map) names.push_back(name);
  return names;
}

}  // namespace

void Material::describe(base::Section& s) {
  s.required_choice(type, "type", {"elastic", "joint"}, "elastic: rock; joint: the surface of a fracture");
  if (type != "joint") {
    s.entry(elastic.E, "Young's modulus", "Pa", base::positive(), "E; give exactly two elastic constants");
    s.entry(elastic.nu, "Poisson's ratio", "-", base::greater_than(-1).below(0.5), "nu");
    s.entry(elastic.G, "shear modulus", "Pa", base::positive(), "G");
    s.entry(elastic.lambda, "Lame's first parameter", "Pa", base::any(), "lambda");
    s.entry(elastic.K, "bulk modulus", "Pa", base::positive(), "K");
    if (type == "elastic" && s.complete()) {
      try {
        laws::lame_constants(elastic);
      } catch (const Error& error) {
        s.fail(error.what());
      }
    }
  }
  if (type != "elastic") {
    s.entry(tangential_stiffness, "tangential stiffness", "Pa/m", base::positive_or_infinite(),
            "K_t of the elastic part of the tangential jump (12); infinite: all tangential jump is plastic");
    s.entry(friction_coefficient, "friction coefficient", "-", base::at_least(0), "mu of the bound (13); or give the angle");
    s.entry(friction_angle, "friction angle", "degree", base::at_least(0).below(90), "atan(mu) (3)");
    s.entry(dilation_angle, "dilation angle", "degree", base::at_least(0).below(90), "theta: the gap grows by tan(theta)|u_t^p| (14)");
    s.entry(initial_gap, "initial gap", "m", base::any(), "g0 of (14)");
    s.entry(maximum_closure, "maximum closure", "m", base::at_least(0), "Du of the normal closure in (14); 0: none");
    s.entry(normal_stiffness, "normal stiffness", "Pa/m", base::positive(), "K_n at zero traction; needed with a maximum closure");
    s.entry(initial_aperture, "initial aperture", "m", base::at_least(0), "a0 of (15)");
    if (type == "joint" && s.complete()) {
      if (friction_coefficient.has_value() == friction_angle.has_value())
        s.fail("give either \"friction coefficient\" or \"friction angle\"");
      if (maximum_closure > 0 && !normal_stiffness)
        s.fail("normal stiffness", "missing; it is required with a \"maximum closure\" above 0");
    }
  }
}

physics::JointParameters Material::joint() const {
  physics::JointParameters joint;
  joint.law.elastic.compliance = 1 / tangential_stiffness;
  joint.law.friction.coefficient = friction_coefficient ? *friction_coefficient : std::tan(*friction_angle * degree);
  joint.law.gap.initial = initial_gap;
  joint.law.gap.dilation.tangent = std::tan(dilation_angle * degree);
  joint.law.gap.closure = {maximum_closure, normal_stiffness.value_or(1)};
  joint.initial_aperture = initial_aperture;
  return joint;
}

void Bulk::describe(base::Section& s) {
  s.required(material, "material", "-", "name of an elastic material");
  s.entry(body_force, "body force", "N/m^3", "force per volume, one value or expression of x, y, z, t per direction");
}

void Fracture::describe(base::Section& s) { s.required(material, "material", "-", "name of a joint material"); }

void BoundaryCondition::describe(base::Section& s) {
  s.required(boundary, "boundary", "-", "name of a boundary of the mesh: west, east, south, north, bottom, top");
  s.entry(displacement, "displacement", "m", "per direction a value, an expression of x, y, z, t, or free");
  s.entry(traction, "traction", "Pa", "force per area on the body, per direction a value or an expression of x, y, z, t");
  if (s.complete() && displacement.empty() == traction.empty()) s.fail("give either \"displacement\" or \"traction\"");
}

void Time::describe(base::Section& s) {
  s.entry(start, "start", "s", "time of the initial state");
  s.entry(end, "end", "s", "end of the last step");
  s.entry(steps, "steps", "-", base::at_least(1), "number of equal steps from start to end");
  s.entry(schedule, "schedule", "s", "ends of all steps, increasing; replaces end and steps");
  stepping.describe(s);
  if (!s.complete()) return;
  Real last = start;
  for (Real t : times()) {
    if (!(t > last)) {
      s.fail(schedule ? "schedule" : "end", fmt::format("is {} after {}; times must increase, from \"start\" on", t, last));
      break;
    }
    last = t;
  }
  if (schedule && schedule->empty()) s.fail("schedule", "is empty; give at least one time");
}

std::vector<Real> Time::times() const {
  if (schedule) return *schedule;
  std::vector<Real> times;
  for (int k = 1; k <= steps; ++k) times.push_back(k == steps ? end : start + (end - start) * k / steps);
  return times;
}

void Output::describe(base::Section& s) {
  s.entry(vtu, "vtu", "-", "write bulk.pvd and fractures.pvd for ParaView");
  s.entry(every, "every", "-", base::at_least(1), "write them after every so many steps, and after the last");
}

void Scene::describe(base::Section& s) {
  s.section(mesh, "Mesh", "a box with plane fractures");
  s.named_sections(materials, "Materials", "rock and joints, by names of your choice");
  s.section(bulk, "Bulk", "the rock");
  s.named_sections(fractures, "Fractures", "a section for each fracture of the mesh");
  s.named_sections(boundary_conditions, "Boundary conditions", "by names of your choice; boundaries without one are free of traction");
  s.named_sections(tables, "Tables", "piecewise linear functions that expressions call by name, e.g. ramp(t)");
  s.section(time, "Time", "steps");
  s.section(solver, "Solver", "Newton's method");
  s.section(output, "Output", "what is written beside results.json");
  if (s.complete()) check_names(s);
}

void Scene::check_names(base::Section& s) const {
  const auto known = [&](const std::string& place, const std::string& name, const std::vector<std::string>& allowed) {
    for (const auto& a : allowed)
      if (a == name) return true;
    s.fail(fmt::format("{}: is \"{}\", must be one of {}.{}", place, name, base::quoted_list(allowed),
                       base::did_you_mean(name, allowed)));
    return false;
  };
  const auto is_material = [&](const std::string& place, const std::string& name, const std::string& type) {
    std::vector<std::string> allowed;
    for (const auto& [key, material] : materials)
      if (material.type == type) allowed.push_back(key);
    known(place + " > \"material\"", name, allowed);
  };
  const auto has_length = [&](const std::string& place, std::size_t n) {
    if (n != 0 && n != static_cast<std::size_t>(dim()))
      s.fail(fmt::format("{}: has {} values, must have {}, one per direction", place, n, dim()));
  };
  is_material("Bulk", bulk.material, "elastic");
  has_length("Bulk > \"body force\"", bulk.body_force.size());
  for (const auto& [name, fracture] : fractures) {
    if (known(fmt::format("Fractures > \"{}\"", name), name, names_of(mesh.fractures)))
      is_material("Fractures > " + name, fracture.material, "joint");
  }
  for (const auto& [name, fracture] : mesh.fractures)
    if (!fractures.count(name)) s.fail(fmt::format("Fractures: \"{}\" is in the mesh and has no section here", name));
  std::vector<std::string> boundaries = {"west", "east", "south", "north"};
  if (dim() == 3) boundaries.insert(boundaries.end(), {"bottom", "top"});
  bool held = false;
  for (const auto& [name, condition] : boundary_conditions) {
    const std::string place = "Boundary conditions > " + name;
    known(place + " > \"boundary\"", condition.boundary, boundaries);
    has_length(place + " > \"displacement\"", condition.displacement.size());
    has_length(place + " > \"traction\"", condition.traction.size());
    for (const auto& value : condition.displacement) held = held || value.text() != "free";
  }
  if (!held) s.fail("Boundary conditions: none prescribes a displacement; nothing holds the rock in place");
}

Scene read_scene(const Comm& comm, const std::string& path, const std::vector<std::string>& overrides) {
  auto list = base::read_xml(comm, path, "Sprekk");
  for (const auto& text : overrides) base::apply_override(list, text);
  Scene scene = base::read<Scene>(list, path, "Sprekk");
  const auto tables = std::make_shared<const base::Tables>(scene.tables);
  const auto compile = [&](std::vector<base::Expression>& values) {
    for (auto& value : values)
      if (value.text() != "free") value.compile(tables);
  };
  compile(scene.bulk.body_force);
  for (auto& [name, condition] : scene.boundary_conditions) {
    compile(condition.displacement);
    compile(condition.traction);
  }
  return scene;
}

}  // namespace sprekk::model
