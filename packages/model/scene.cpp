#include "model/scene.hpp"

#include "base/check.hpp"
#include "base/text.hpp"
#include "base/xml.hpp"
#include "model/material_library.hpp"
#include "model/scene_check.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <tuple>

namespace sprekk::model {

namespace {

void check_constant_in_time(base::Section& s, const std::string& entry, const base::Expression& value) {
  if (!value.constant_in_time())
    s.fail(entry, fmt::format("is \"{}\"; it may depend on x, y, z, not on t", value.text()));
}

void describe_initial_stress(base::Section& s, std::vector<base::Expression>& stress, const std::string& whose) {
  s.entry(stress, "initial stress", "Pa",
          "stress at zero displacement" + whose +
              ", tension positive: XX, YY, ZZ, XY in 2D; XX, YY, ZZ, XY, YZ, XZ in 3D; values or expressions of x, y, "
              "z");
  for (const auto& component : stress) check_constant_in_time(s, "initial stress", component);
}

}  // namespace

template <class Visit>
void Material::for_each(const Visit& visit) const {
  const Real none = -std::numeric_limits<Real>::infinity(), infinite = -none;
  const auto optional = [&](const char* name, const std::optional<Value>& value, Real least, bool itself, Real limit) {
    if (value) visit(name, *value, least, itself, limit);
  };
  if (type == "elastic") {
    optional("Young's modulus", E, 0, false, infinite);
    optional("Poisson's ratio", nu, -1, false, 0.5);
    optional("shear modulus", G, 0, false, infinite);
    optional("Lame's first parameter", lambda, none, false, infinite);
    optional("bulk modulus", K, 0, false, infinite);
    optional("density", density, 0, true, infinite);
  } else {
    visit("residual aperture", residual_aperture, 0, true, infinite);
    optional("tangential permeability", tangential_permeability, 0, false, infinite);
    visit("normal permeability", normal_permeability, 0, false, infinite);
  }
}

void Material::describe(base::Section& s) {
  s.required_choice(type, "type", {"elastic", "joint"}, "elastic: rock; joint: the surface of a fracture");
  s.entry(source, "source", "-", "where the values come from");
  if (type != "joint") {
    s.entry(E, "Young's modulus", "Pa", base::positive(), "E; give exactly two elastic constants");
    s.entry(nu, "Poisson's ratio", "-", base::greater_than(-1).below(0.5), "nu");
    s.entry(G, "shear modulus", "Pa", base::positive(), "G");
    s.entry(lambda, "Lame's first parameter", "Pa", base::any(), "lambda");
    s.entry(K, "bulk modulus", "Pa", base::positive(), "K");
    s.entry(density, "density", "kg/m^3", base::at_least(0), "of the rock; needed with gravity");
    s.entry(permeability, "permeability", "m^2", base::any(),
            "k of the rock, needed with \"Flow\": one value; XX, YY[, ZZ]; or XX, YY, XY in 2D, XX, YY, ZZ, XY, YZ, XZ "
            "in 3D");
    s.entry(porosity, "porosity", "-", base::between(0, 1), "share of the volume that is fluid");
    s.entry(
        compressibility, "compressibility of pores", "Pa^-1", base::at_least(0),
        "growth of the porosity with the fluid's pressure; of rock that deforms: at constant strain, (Biot coefficient "
        "- porosity)/bulk modulus of the grains");
    s.entry(biot_modulus, "Biot modulus", "Pa", base::positive_or_infinite(),
            "M, instead of the compressibility of pores: 1/M is that plus the porosity times the compressibility of "
            "the fluid, the storage at constant strain");
    s.entry(
        biot, "Biot coefficient", "-", base::between(0, 1),
        "alpha: with \"Flow\" total stress is that of the displacement less alpha (p - initial pressure), and pores "
        "grow by alpha div u");
    s.hint({"E", "young"}, "Did you mean \"Young's modulus\"?");
    s.hint({"nu", "poisson"}, "Did you mean \"Poisson's ratio\"?");
    s.hint({"G"}, "Did you mean \"shear modulus\"?");
    s.hint({"K"}, "Did you mean \"bulk modulus\"?");
    s.hint({"lambda"}, "Did you mean \"Lame's first parameter\"?");
    s.hint({"rho"}, "Did you mean \"density\"?");
    const int n = E.has_value() + nu.has_value() + G.has_value() + lambda.has_value() + K.has_value();
    if (type == "elastic" && s.complete() && n != 2 && (n != 0 || permeability.empty()))
      s.fail(fmt::format("{} elastic constants given, exactly two are needed", n));
    if (s.complete() && compressibility && biot_modulus)
      s.fail("give either \"compressibility of pores\" or \"Biot modulus\"");
  }
  if (type != "elastic") {
    JointMaterial::describe(s, type.empty());
    s.entry(residual_aperture, "residual aperture", "m", base::at_least(0),
            "the hydraulic aperture, with \"Flow\", is the aperture, but not less than this");
    s.entry(
        tangential_permeability, "tangential permeability", "m^2", base::positive(),
        "k_t of the flow along the fracture, with \"Flow\"; without it the cubic law holds, (hydraulic aperture)^2/12");
    s.entry(normal_permeability, "normal permeability", "m^2", base::positive_or_infinite(),
            "k_n of the flow across, with \"Flow\"; infinite: the fluid in the fracture has the pressure of that "
            "beside it");
    if (type == "joint" && s.complete()) compare_entries(s);
  }
  for_each([&](const char* name, const Value& value, Real, bool, Real) { check_constant_in_time(s, name, value); });
  for (const auto& value : permeability) check_constant_in_time(s, "permeability", value);
}

bool Material::is_uniform() const {
  bool uniform = type == "elastic" || JointMaterial::is_uniform();
  for_each([&](const char*, const Value& value, Real, bool, Real) { uniform = uniform && value.is_constant(); });
  return uniform;
}

void Material::check(const Point& x) const {
  if (type != "elastic") JointMaterial::check(x);
  for_each([&](const char* name, const Value& value, Real least, bool itself, Real limit) {
    if (value.is_constant()) return;  // checked when it was read
    const Real v = value(x, 0);
    SPREKK_CHECK((itself ? v >= least : v > least) && v < limit, "\"{}\" = {} is {} at ({}, {}, {}), must be {} {}{}",
                 name, base::shortened(value.text()), v, x[0], x[1], x[2], itself ? "at least" : "above", least,
                 std::isfinite(limit) ? fmt::format(" and below {}", limit) : "");
  });
}

laws::Elasticity Material::elasticity(const Point& x) const {
  check(x);
  const auto at = [&](const std::optional<Value>& value) {
    return value ? std::make_optional((*value)(x, 0)) : std::nullopt;
  };
  return laws::lame_constants({at(E), at(nu), at(G), at(lambda), at(K)});
}

bool Material::flows_uniformly() const {
  return std::all_of(permeability.begin(), permeability.end(), [](const Value& k) { return k.is_constant(); });
}

Real Material::growth_of_pores(Real of_fluid) const {
  return biot_modulus ? std::max(Real(0), 1 / *biot_modulus - porosity * of_fluid) : compressibility.value_or(0);
}

laws::Mobility Material::mobility(int dim, Real viscosity, const Point& x) const {
  std::vector<Real> k;
  for (const Value& value : permeability) k.push_back(value(x, 0));
  const auto n = static_cast<int>(k.size()), n_all = dim * (dim + 1) / 2;
  SPREKK_CHECK(n == 1 || n == dim || n == n_all, "\"permeability\" has {}, must have 1, {} or {} in {}D",
               base::counted(k.size(), "value"), dim, n_all, dim);
  laws::Mobility m;
  for (int i = 0; i < dim; ++i) m.value[i][i] = k[n == 1 ? 0 : i] / viscosity;
  for (int i = dim; i < n; ++i) {
    const int row = i == 4 ? 1 : 0, column = i == 3 || dim == 2 ? 1 : 2;
    m.value[row][column] = m.value[column][row] = k[i] / viscosity;
  }
  std::vector<std::string> texts;
  for (const Value& value : permeability) texts.push_back(value.text());
  SPREKK_CHECK(m.is_positive(dim), "\"permeability\" = {{{}}} is not positive definite{}", fmt::join(texts, ", "),
               flows_uniformly() ? "" : fmt::format(" at x = ({}, {}, {})", x[0], x[1], x[2]));
  return m;
}

physics::FractureFlowParameters::Face Material::hydraulics(Real viscosity, const Point& x) const {
  check(x);
  const Real a = std::max(initial_aperture(x, 0), residual_aperture(x, 0));
  SPREKK_CHECK(a > 0,
               "the hydraulic aperture is 0 at ({}, {}, {}), must be above 0: give an \"initial aperture\" "
               "or a \"residual aperture\"",
               x[0], x[1], x[2]);
  const Real k = tangential_permeability ? (*tangential_permeability)(x, 0) : 0;
  return {{initial_aperture(x, 0), residual_aperture(x, 0), k, viscosity},
          2 * normal_permeability(x, 0) / (a * viscosity)};
}

void Bulk::describe(base::Section& s) {
  s.required(material, "material", "-", "name of an elastic material, of this scene or of the library");
  s.entry(body_force, "body force", "N/m^3", "force per volume, one value or expression of x, y, z, t per direction");
  s.entry(gravity, "gravity", "m/s^2", base::any(),
          "acceleration per direction, e.g. {0, 0, -9.81}; adds the density times it to the body force");
  describe_initial_stress(s, initial_stress, "");
  s.section(lithostatic_stress, "lithostatic stress",
            "initial stress of rock at rest under gravity along the last coordinate");
  if (s.complete() && lithostatic_stress && !initial_stress.empty())
    s.fail("give either \"initial stress\" or \"lithostatic stress\"");
  if (s.complete() && lithostatic_stress && gravity.size() != 2 && gravity.size() != 3)
    s.fail("gravity", "must have 2 or 3 components for a \"lithostatic stress\"");
}

void Lithostatic::describe(base::Section& s) {
  s.required(surface, "surface", "m", "coordinate where the vertical stress is zero");
  s.entry(horizontal_ratio, "horizontal ratio", "-", base::at_least(0), "horizontal over vertical stress");
}

void Flow::describe(base::Section& s) {
  s.entry(rigid_rock, "rigid rock", "-", "the rock does not deform: flow alone, without displacements");
  s.entry(viscosity, "viscosity", "Pa*s", base::positive(), "mu of the fluid");
  s.entry(density, "density", "kg/m^3", base::at_least(0),
          "rho_0 of the fluid, at the reference pressure; its weight counts where \"Bulk\" has gravity");
  s.entry(compressibility, "compressibility", "Pa^-1", base::at_least(0),
          "c of the fluid: its density is rho_0 exp(c (p - reference pressure))");
  s.entry(reference_pressure, "reference pressure", "Pa", base::any(),
          "with a compressibility: where the density is as given; volumes of fluid are at this pressure");
  s.entry(source, "source", "s^-1", base::any(),
          "volume of fluid per volume of rock and time, an expression of x, y, z, t");
  s.entry(initial_pressure, "initial pressure", "Pa", base::any(), "at the start, where fluid is stored; of x, y, z");
  s.choice(scheme, "scheme", {"auto", "rt0", "tpfa", "mimetic"},
           "how flows follow from pressures; auto: rt0 on simplices; on others tpfa where permeability and cells are "
           "orthogonal, else mimetic");
  s.named_sections(wells, "Wells", "by names of your choice");
  check_constant_in_time(s, "initial pressure", initial_pressure);
}

void Well::describe(base::Section& s) {
  s.required(points, "points", "m", base::any(),
             "2D: x, y of a line of length 1 across the plane; 3D: of a polyline, x0, y0, z0, x1, y1, z1, ...");
  s.required(radius, "radius", "m", base::positive(), "r_w of the hole");
  s.entry(skin, "skin", "-", base::any(),
          "S: the pressure falls by S like flow by a further factor exp(S) of distance");
  s.entry(rate, "rate", "m^3/s", base::any(),
          "volume of fluid per time that is put in (2D: m^2/s), negative: taken out; an expression of t");
  s.entry(pressure, "pressure", "Pa", base::any(), "in the well at its first point, an expression of t");
  if (s.complete() && rate.has_value() == pressure.has_value()) s.fail("give either \"rate\" or \"pressure\"");
}

void Region::describe(base::Section& s) {
  s.entry(material, "material", "-",
          "name of an elastic material, of this scene or of the library; absent: that of \"Bulk\"");
  describe_initial_stress(s, initial_stress, ", in place of that of \"Bulk\"");
  s.entry(
      pressure, "pressure", "Pa", base::any(),
      "of the fluid in its cells and in fractures inside of it, with \"Flow\": a value or an expression of x, y, z, t");
  if (s.complete() && !material && initial_stress.empty() && !pressure)
    s.fail("give a \"material\", an \"initial stress\" or a \"pressure\"");
}

void Fracture::describe(base::Section& s) {
  s.required(material, "material", "-", "name of a joint material, of this scene or of the library");
  s.entry(
      fluid_pressure, "fluid pressure", "Pa", base::any(),
      "p, a value or an expression of x, y, z, t: it pushes the sides apart; the traction on the rock is lambda - p n");
  s.entry(
      source, "source", "m/s", base::any(),
      "volume of fluid per area and time that is put into the fracture, with \"Flow\", an expression of x, y, z, t");
  s.entry(
      cuts, "cuts", "-",
      "names of fractures that it divides where they meet: what flows from one part to the other crosses it, by its "
      "normal permeability, with \"Flow\"");
  s.entry(
      plastic_jump, "plastic jump", "m", base::any(),
      "tangential plastic jump at the start, in the frame of the face: t in 2D, t1, t2 in 3D; values or expressions "
      "of x, y, z");
  for (const auto& component : plastic_jump) check_constant_in_time(s, "plastic jump", component);
}

void BoundaryCondition::describe(base::Section& s) {
  s.required(boundary, "boundary", "-", "name of a boundary of the mesh: west, east, south, north, bottom, top");
  s.entry(region, "region", "-", "name of a region: the condition holds only on faces of its cells");
  s.entry(displacement, "displacement", "m", base::any().or_word("free"),
          "per direction a value, an expression of x, y, z, t, or free");
  s.entry(traction, "traction", "Pa",
          "force per area on the body, per direction a value or an expression of x, y, z, t");
  s.entry(pressure, "pressure", "Pa", base::any(),
          "of the fluid, with \"Flow\": a value or an expression of x, y, z, t");
  s.entry(flux, "flux", "m/s", base::any(), "volume of fluid that leaves per area and time, with \"Flow\"");
  s.entry(conductance, "conductance", "m/(Pa*s)", base::at_least(0),
          "c: the flux is c (p - pressure), the pressure then being that beyond the boundary");
  s.entry(fracture, "fracture", "-",
          "name of a fracture: the condition on the fluid holds only where it ends on the boundary, per aperture and "
          "length; without it a pressure without conductance holds for rock and fractures, all else for rock");
  if (conductance) check_constant_in_time(s, "conductance", *conductance);
  if (!s.complete()) return;
  if (conductance && !pressure) s.fail("conductance", "needs a \"pressure\" beyond the boundary");
  if (fracture && region) s.fail("give either \"fracture\" or \"region\"");
  if (fracture && !(displacement.empty() && traction.empty()))
    s.fail("fracture", "goes with \"pressure\" or \"flux\" only");
  if (!displacement.empty() && !traction.empty()) s.fail("give either \"displacement\" or \"traction\"");
  if (pressure && flux) s.fail("give either \"pressure\" or \"flux\"");
  if (displacement.empty() && traction.empty() && !pressure && !flux)
    s.fail("give either \"displacement\" or \"traction\"; with \"Flow\" also \"pressure\" or \"flux\"");
}

void Time::describe(base::Section& s) {
  s.entry(start, "start", "s", "time of the initial state");
  s.entry(end, "end", "s", "end of the last step");
  s.entry(steps, "steps", "-", base::between(1, 10000000), "number of equal steps from start to end");
  s.entry(schedule, "schedule", "s", "ends of all steps, increasing; replaces end and steps");
  s.choice(scheme, "scheme", {"implicit Euler", "BDF2"},
           "of what fluid is stored, with \"Flow\": of first or second order in time");
  stepping.describe(s);
  if (!s.complete()) return;
  Real last = start;
  for (Real t : times()) {
    if (!(t > last)) {
      s.fail(schedule ? "schedule" : "end",
             fmt::format("is {} after {}; times must increase, from \"start\" on", t, last));
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

void CheckpointTimes::describe(base::Section& s) {
  s.entry(steps, "steps", "-", base::at_least(1), "after every so many steps");
  s.entry(minutes, "minutes", "min", base::positive(), "when so much time has passed since the last one");
  if (s.complete() && !steps && !minutes) s.fail("needs \"steps\", \"minutes\", or both");
}

void Output::describe(base::Section& s) {
  s.entry(vtu, "vtu", "-", "write bulk.pvd and fractures.pvd for ParaView");
  s.entry(every, "every", "-", base::at_least(1), "write them after every so many steps, and after the last");
  s.entry(
      error_estimate, "error estimate", "-",
      "estimate after every step how far stress and jumps are off on this mesh: error_estimate in results.json, and "
      "fields; costs a pass over all cells and a linear solve per step");
  s.section(checkpoints, "checkpoints", "what --restart goes on from; one is also written after the last step");
}

void MeshFile::Fracture::describe(base::Section& s) {
  s.entry(reference_normal, "reference normal", "-",
          "the normal, from side - to side +, has a positive product with this vector");
  s.entry(swap_sides, "swap sides", "-", "exchange side - and side +");
}

void MeshFile::describe(base::Section& s) {
  s.section(network, "network", "fractures of which `./sprekk mesh` makes the mesh, and `./sprekk run` before it runs");
  s.entry(path, "path", "-",
          "file of gmsh, version 2.2 or 4.1; relative to the scene's file; required but for a network under `./sprekk "
          "run` and `check`, which make one");
  if (s.complete() && path.empty() && !network) s.fail("path", "missing; it is required: a file of gmsh");
  s.entry(
      order, "order", "-", base::between(1, 2),
      "of the displacement in each cell: 2 adds nodes in the middle of edges to a file of order 1; absent: as in the "
      "file");
  mesh::describe_tips(s, tips);
  mesh::describe_periodic(
      s, periodic,
      "boundaries in pairs, {a, b, c, d}: displacements on b equal those on a, of which b is the translate, and so on");
  if (periodic.size() % 2 == 1)
    s.fail("periodic", fmt::format("has {}, must have an even number", base::counted(periodic.size(), "name")));
  mesh::describe_refinements(s, refinements, periodic);
  s.named_sections(fractures, "fractures",
                   "the physical groups that are fractures, by their names; those of a network need not be listed");
  if (network)
    for (const auto& [name, set] : network->fractures) fractures[name];
}

void Scene::describe(base::Section& s) {
  s.named_sections(tables, "Tables", "piecewise linear functions that expressions call by name, e.g. ramp(t)");
  s.named_expressions(expressions, "Expressions", "what all other expressions may call by name, e.g. depth = 0.5 - y");
  s.expressions_call(tables, expressions);
  s.section(mesh_file, "Mesh file", "a mesh of gmsh, instead of the section Mesh");
  if (!mesh_file) s.section(mesh, "Mesh", "a box with plane fractures");
  s.named_sections(materials, "Materials",
                   "rock and joints, by names of your choice; those of the material library need no section");
  s.section(bulk, "Bulk", "the rock");
  s.section(flow, "Flow", "a fluid that flows through the rock");
  s.named_sections(regions, "Regions", "what regions of the mesh have of their own, by their names");
  s.named_sections(fractures, "Fractures", "a section for each fracture of the mesh");
  s.named_sections(boundary_conditions, "Boundary conditions",
                   "by names of your choice; boundaries without one are free of traction");
  s.section(time, "Time", "steps");
  s.section(solver, "Solver", "Newton's method");
  s.section(output, "Output", "what is written beside results.json");
  if (auto& reproducible = solver.linear_solver.reproducible; output.checkpoints && !reproducible) reproducible = true;
  std::vector<std::string> used = {bulk.material};
  for (const auto& [name, region] : regions)
    if (region.material) used.push_back(*region.material);
  for (const auto& [name, fracture] : fractures) used.push_back(fracture.material);
  add_library_materials(materials, used);
}

namespace {

std::vector<base::Expression> lithostatic_stress(const Scene& scene) {
  const auto& [surface, horizontal_ratio] = *scene.bulk.lithostatic_stress;
  const auto& gravity = scene.bulk.gravity;
  const int dim = static_cast<int>(gravity.size()), up = dim - 1;
  const Real weight = -(*scene.material_of("bulk").density)({0, 0, 0}, 0) * gravity[up];  // positive: it points down
  std::vector<base::Expression> stress(dim == 2 ? 4 : 6, base::Expression(0));
  for (int i = 0; i < 3; ++i) {
    const Real factor = weight * (i == up ? 1 : horizontal_ratio);
    stress[i] = base::Expression(fmt::format("{:.17g}*({}-({:.17g}))", factor, "xyz"[up], surface));
  }
  for (auto& component : stress) component.compile();
  return stress;
}

}  // namespace

physics::InitialStress Scene::initial_stress(const std::vector<std::string>& region_names) const {
  const auto common = bulk.lithostatic_stress ? lithostatic_stress(*this) : bulk.initial_stress;
  physics::InitialStress stress;
  std::size_t n_components = 0;
  for (const auto& name : region_names) {
    const auto region = regions.find(name);
    const bool own = region != regions.end() && !region->second.initial_stress.empty();
    n_components =
        std::max(n_components, stress.value.emplace_back(own ? region->second.initial_stress : common).size());
  }
  if (n_components == 0) return {};
  for (auto& components : stress.value) components.resize(n_components, base::Expression(0));
  return stress;
}

base::Expression Scene::initial_pressure() const {
  return flow ? flow->initial_pressure : base::Expression(host_fluid ? host_fluid->initial_pressure : 0);
}

physics::FluidPressure Scene::fluid_pressure(const std::vector<std::string>& fracture_names) const {
  physics::FluidPressure fluid;
  if (host_fluid) {
    if (!host_fluid->unknown && host_fluid->initial_pressure != 0)
      fluid.value.assign(fracture_names.size(), initial_pressure());
    return fluid;
  }
  bool any = false;
  for (const auto& name : fracture_names) {
    const auto& p = fluid.value.emplace_back(fractures.at(name).fluid_pressure);
    any = any || !p.is_constant() || p({}, 0) != 0;
  }
  return any ? fluid : physics::FluidPressure();
}

const Material& Scene::material_of(const std::string& region) const {
  const auto found = regions.find(region);
  return materials.at(found == regions.end() ? bulk.material : found->second.material.value_or(bulk.material));
}

namespace {

base::Draft<Scene> from_list(const Teuchos::ParameterList& list, const std::string& origin,
                             const std::vector<std::string>& errors = {}) {
  auto draft = base::draft<Scene>(list, origin, "Sprekk", errors);
  draft.value.origin = origin;
  return draft;
}

/// Adds to a material's list its entries of the other type, which effective() leaves out: so that they are refused.
void add_stray_entries(Teuchos::ParameterList& list, const Material& material) {
  Material other = material, none;
  other.type = none.type = material.type == "joint" ? "elastic" : "joint";
  const auto defaults = base::effective(none, "");
  for (const auto& named_entry : base::effective(other, "")) {
    const auto& [name, entry] = std::tie(named_entry.first, named_entry.second);
    if (!defaults.isParameter(name) || base::value_text(defaults.getEntry(name)) != base::value_text(entry))
      list.setEntry(name, entry);
  }
}

}  // namespace

base::Draft<Scene> prepared(const Scene& scene) {
  Scene copy = scene;  // which describe() could change
  auto list = base::effective(copy, "Sprekk");
  for (const auto& [name, material] : scene.materials)
    add_stray_entries(list.sublist("Materials").sublist(name), material);
  auto draft = from_list(list, scene.origin);
  draft.value.augmentation = scene.augmentation;
  draft.value.host_fluid = scene.host_fluid;
  draft.value.solver.should_stop = scene.solver.should_stop;
  return draft;
}

Scene read_scene(const Comm& comm, const std::string& path, const std::vector<std::string>& overrides) {
  auto list = base::read_xml(comm, path, "Sprekk", base::Defects::keep);
  const bool has_body = list.isParameter("Mesh") || list.isParameter("Mesh file") || list.isParameter("Bulk");
  SPREKK_CHECK(has_body || !list.isParameter("Point"),
               "{}: is a scene for `sprekk point`: it has the section \"Point\" and neither mesh nor \"Bulk\"", path);
  const auto errors = base::apply_overrides(list, path, overrides);
  auto draft = from_list(list, path, errors);
  auto& file = draft.value.mesh_file;
  if (file && !file->path.empty())
    file->path = std::filesystem::absolute(std::filesystem::path(path).parent_path() / file->path).string();
  if (file && file->network) file->network->resolve_files(std::filesystem::path(path).parent_path().string());
  base::collectively(comm, [&] {
    const bool is_wrong = !draft.report.errors.empty() || !misfits(draft, names_in_scene(draft)).empty();
    if (is_wrong && comm.getRank() == 0) checked_mesh(draft);
  });
  return std::move(draft.value);
}

}  // namespace sprekk::model
