#include "model/scene_check.hpp"

#include "assembly/free_motion.hpp"
#include "base/check.hpp"
#include "base/text.hpp"
#include "mesh/msh_file.hpp"
#include "model/material_library.hpp"

#include <algorithm>
#include <set>

namespace sprekk::model {

namespace {

using Draft = base::Draft<Scene>;
using Names = std::vector<std::string>;

/// Whether a section was read without an error in it.
bool is_sound(const Draft& draft, const std::string& section) { return draft.report.is_sound("Sprekk > " + section); }

/// Whether the scene has no such section; else it may have one that could not be read, or with a misspelt name.
bool is_absent(const Draft& draft, const std::string& section) {
  return is_sound(draft, section) && !draft.report.with_unknown_names.count("Sprekk");
}

bool has(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

int index_of(const Names& names, const std::string& name) {
  return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
}

template <class T>
Names names_of(const std::map<std::string, T>& map) {
  Names names;
  for (const auto& [name, value] : map) names.push_back(name);
  return names;
}

/// The boundaries that "periodic" ties.
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

/// Compares the parts of a scene; what could not be read is passed over.
class Comparison {
 public:
  Comparison(const Draft& draft, const MeshNames& names) : draft_(draft), scene_(draft.value), names_(names) {}

  std::vector<std::string> misfits() {
    compare_bulk();
    compare_regions();
    compare_fractures();
    compare_boundary_conditions();
    compare_gravity();
    compare_lithostatic_stress();
    compare_flow();
    return std::move(errors_);
  }

 private:
  bool is_sound(const std::string& section) const { return model::is_sound(draft_, section); }

  void fail(const std::string& place, const std::string& what) {
    const auto line = fmt::format("{}: Sprekk > {}: {}", scene_.origin, place, what);
    if (!has(errors_, line)) errors_.push_back(line);  // of a joint that several fractures have
  }

  /// Whether a name in `section` may be one of those allowed.
  bool check_name(const std::string& section, const std::string& place, const std::string& name,
                  const std::optional<Names>& allowed) {
    if (!allowed || has(*allowed, name) || (name.empty() && !is_sound(section))) return true;
    fail(place, allowed->empty() ? fmt::format("is \"{}\", but the mesh has none with a name", base::shortened(name))
                                 : fmt::format("is \"{}\", must be one of {}{}", base::shortened(name),
                                               base::quoted_list(*allowed), base::did_you_mean(name, *allowed)));
    return false;
  }

  void check_material(const std::string& section, const std::string& name, const std::string& type) {
    const auto found = scene_.materials.find(name);
    const bool unreadable =
        found == scene_.materials.end()
            ? !is_sound("Materials > " + name) || (scene_.materials.empty() && !is_absent(draft_, "Materials"))
            : found->second.type.empty();
    if (unreadable || (name.empty() && !is_sound(section))) return;
    const std::string wrong = wrong_material(name, type, scene_.materials);
    if (!wrong.empty()) fail(section + " > \"material\"", wrong);
  }

  /// Nothing given has no length.
  void check_length(const std::string& place, std::size_t n, const std::optional<int>& wanted) {
    if (wanted && n != 0 && n != static_cast<std::size_t>(*wanted))
      fail(place, fmt::format("has {}, must have {}", base::counted(n, "value"), *wanted));
  }

  void check_stress(const std::string& section, const std::vector<base::Expression>& stress) {
    std::optional<int> wanted;
    if (names_.dim) wanted = *names_.dim == 2 ? 4 : 6;
    check_length(section + " > \"initial stress\"", stress.size(), wanted);
    if (!scene_.deforms() && !stress.empty())
      fail(section + " > \"initial stress\"", "is of rock that \"Flow > rigid rock\" says does not deform");
  }

  void compare_bulk() {
    check_material("Bulk", scene_.bulk.material, "elastic");
    check_length("Bulk > \"body force\"", scene_.bulk.body_force.size(), names_.dim);
    check_length("Bulk > \"gravity\"", scene_.bulk.gravity.size(), names_.dim);
    check_stress("Bulk", scene_.bulk.initial_stress);
  }

  void compare_regions() {
    for (const auto& [name, region] : scene_.regions)
      if (check_name("Regions", fmt::format("Regions > \"{}\"", name), name, names_.regions)) {
        if (region.material) check_material("Regions > " + name, *region.material, "elastic");
        check_stress("Regions > " + name, region.initial_stress);
        if (region.pressure && !scene_.flow && is_absent(draft_, "Flow"))
          fail("Regions > " + name + " > \"pressure\"", "needs the section \"Flow\"");
      }
  }

  void compare_fractures() {
    if (scene_.fractures.count("intersections"))
      fail("Fractures > \"intersections\"", "is how files of results call what fractures meet in; choose another name");
    for (const auto& [name, fracture] : scene_.fractures)
      if (check_name("Fractures", fmt::format("Fractures > \"{}\"", name), name, names_.fractures)) {
        check_material("Fractures > " + name, fracture.material, "joint");
        compare_joint(name, fracture);
        const std::string jump = fmt::format("Fractures > {} > \"plastic jump\"", name);
        check_length(jump, fracture.plastic_jump.size(), names_.dim ? std::optional(*names_.dim - 1) : std::nullopt);
        if (!scene_.deforms() && !fracture.plastic_jump.empty())
          fail(jump, "is of rock that \"Flow > rigid rock\" says does not deform");
        for (const auto& other : fracture.cuts) {
          const std::string place = fmt::format("Fractures > {} > \"cuts\"", name);
          if (check_name("Fractures > " + name, place, other, names_.fractures) && other == name)
            fail(place, fmt::format("is \"{}\", the fracture itself", other));
          if (scene_.flow && scene_.deforms()) fail(place, "needs \"Flow > rigid rock\"");
        }
      }
    if (!names_.fractures || (scene_.fractures.empty() && !is_absent(draft_, "Fractures"))) return;
    for (const auto& name : *names_.fractures)
      if (!scene_.fractures.count(name) && is_sound("Fractures > " + name))
        fail("Fractures", fmt::format("\"{}\" is in the mesh and has no section here", name));
  }

  /// What a joint must have depends on what the rock around it does.
  void compare_joint(const std::string& name, const Fracture& fracture) {
    const auto found = scene_.materials.find(fracture.material);
    const bool sound = is_sound("Materials > " + fracture.material) && is_sound("Flow");
    if (found == scene_.materials.end() || found->second.type != "joint" || !sound) return;
    const auto& joint = found->second;
    const std::string place = "Materials > " + fracture.material;
    if (scene_.deforms())
      for (const auto& [entry, what] : joint.missing())
        fail(entry.empty() ? place : fmt::format("{} > \"{}\"", place, entry), what);
    const auto zero = [](const base::Expression& value) { return value.is_constant() && value({}, 0) == 0; };
    if ((scene_.flow || scene_.host_fluid) && !zero(fracture.fluid_pressure))
      fail("Fractures > " + name + " > \"fluid pressure\"", "is not given but found, with \"Flow\"");
    if (!scene_.flow && is_absent(draft_, "Flow") && !zero(fracture.source))
      fail("Fractures > " + name + " > \"source\"", "needs the section \"Flow\"");
    if (!scene_.flow && is_absent(draft_, "Flow") && !fracture.cuts.empty())
      fail("Fractures > " + name + " > \"cuts\"", "needs the section \"Flow\"");
    if (scene_.flow && zero(joint.initial_aperture) && zero(joint.residual_aperture))
      fail(place + " > \"initial aperture\"",
           "is 0, and so is \"residual aperture\"; with \"Flow\" one must be above 0");
  }

  void compare_boundary_conditions() {
    const auto tied = tied_boundaries(scene_);
    for (const auto& [name, condition] : scene_.boundary_conditions) {
      const std::string section = "Boundary conditions > " + name;
      check_name(section, section + " > \"boundary\"", condition.boundary, names_.boundaries);
      if (has(tied, condition.boundary))
        fail(section + " > \"boundary\"",
             fmt::format("is \"{}\", which \"periodic\" ties to the opposite side; such a side is inside of the rock "
                         "and takes no conditions",
                         condition.boundary));
      if (condition.region) check_name(section, section + " > \"region\"", *condition.region, names_.regions);
      if (condition.fracture) check_name(section, section + " > \"fracture\"", *condition.fracture, names_.fractures);
      check_length(section + " > \"displacement\"", condition.displacement.size(), names_.dim);
      check_length(section + " > \"traction\"", condition.traction.size(), names_.dim);
    }
  }

  /// The material of a region, if it is rock.
  const Material* rock_of(const std::string& region) const {
    const auto own = scene_.regions.find(region);
    const auto found = scene_.materials.find(
        own == scene_.regions.end() ? scene_.bulk.material : own->second.material.value_or(scene_.bulk.material));
    return found == scene_.materials.end() || found->second.type != "elastic" ? nullptr : &found->second;
  }

  void compare_gravity() {
    if (scene_.bulk.gravity.empty() || !scene_.deforms() || !names_.regions || !is_sound("Regions")) return;
    std::set<const Material*> heavy;
    for (const auto& name : *names_.regions) heavy.insert(rock_of(name));
    if (scene_.bulk.lithostatic_stress) heavy.insert(rock_of("bulk"));  // whose density it takes
    for (const auto& [name, material] : scene_.materials)
      if (heavy.count(&material) && !material.density && is_sound("Materials > " + name))
        fail(fmt::format("Materials > {} > \"density\"", name), "missing; it is required with \"gravity\"");
  }

  void compare_lithostatic_stress() {
    const auto& gravity = scene_.bulk.gravity;
    if (!scene_.bulk.lithostatic_stress || gravity.empty()) return;
    const std::string place = "Bulk > lithostatic stress";
    if (const auto* rock = rock_of("bulk"); rock && rock->density && !rock->density->is_constant())
      fail(place, "needs a density that is a number; give an \"initial stress\" instead");
    if (std::any_of(gravity.begin(), gravity.end() - 1, [](Real g) { return g != 0; }))
      fail(place, "needs gravity along the last coordinate only");
  }

  void compare_flow() {
    if (scene_.flow && scene_.host_fluid) fail("Flow", "goes without a host_fluid, which brings its own flow");
    if (!scene_.flow && !scene_.host_fluid && is_absent(draft_, "Flow") && scene_.time.scheme != "implicit Euler")
      fail("Time > \"scheme\"", fmt::format("is \"{}\": needs the section \"Flow\"", scene_.time.scheme));
    for (const auto& [name, condition] : scene_.boundary_conditions) {
      const std::string place = "Boundary conditions > " + name;
      if (!scene_.flow && is_absent(draft_, "Flow") && (condition.pressure || condition.flux))
        fail(place + (condition.pressure ? " > \"pressure\"" : " > \"flux\""), "needs the section \"Flow\"");
      if (!scene_.deforms() && !(condition.displacement.empty() && condition.traction.empty()))
        fail(place, "moves or loads the rock, which \"Flow > rigid rock\" says does not deform");
    }
    if (!scene_.flow) return;
    const auto& bulk = scene_.bulk;
    if (!scene_.deforms() && (!bulk.body_force.empty() || bulk.lithostatic_stress))
      fail("Bulk", "has a force or stress of the rock, which \"Flow > rigid rock\" says does not deform");
    if (scene_.output.error_estimate)
      fail("Output > \"error estimate\"", "is of stress and jumps without a fluid; not available with \"Flow\"");
    compare_wells();
    compare_pressure();
    compare_fluid_conditions();
    for (const auto& name : names_.regions.value_or(Names()))
      if (const auto* rock = rock_of(name)) compare_rock(*rock);
  }

  void compare_wells() {
    for (const auto& [name, well] : scene_.flow->wells) {
      const std::string place = fmt::format("Flow > Wells > {} > \"points\"", name);
      const auto n = well.points.size();
      if (names_.dim == 2) check_length(place, n, 2);
      if (names_.dim == 3 && n > 0 && (n < 6 || n % 3 != 0))
        fail(place, fmt::format("has {}, must have three for each of two or more points", base::counted(n, "value")));
      for (std::size_t k = 3; names_.dim == 3 && k + 2 < n; k += 3)
        if (std::equal(&well.points[k], &well.points[k] + 3, &well.points[k - 3]))
          fail(place, fmt::format("has the point ({}, {}, {}) twice in a row", well.points[k], well.points[k + 1],
                                  well.points[k + 2]));
    }
  }

  /// Flow that no pressure and no storage ties to a level has none, or any.
  void compare_pressure() {
    const auto& conditions = scene_.boundary_conditions;
    const auto& wells = scene_.flow->wells;
    const bool given = std::any_of(wells.begin(), wells.end(), [](const auto& w) { return w.second.pressure; }) ||
                       std::any_of(conditions.begin(), conditions.end(),
                                   [](const auto& named) {
                                     const auto& c = named.second;
                                     const auto& k = c.conductance;
                                     return c.pressure && !(k && k->is_constant() && (*k)({}, 0) == 0);
                                   }) ||
                       std::any_of(scene_.regions.begin(), scene_.regions.end(),
                                   [](const auto& region) { return region.second.pressure; });
    if (!names_.regions || !names_.fractures) return;
    const bool in_fractures = !names_.fractures->empty() && (scene_.flow->compressibility > 0 || scene_.deforms());
    const Real fluid = scene_.flow->compressibility;
    const bool stored =
        in_fractures || std::any_of(names_.regions->begin(), names_.regions->end(), [&](const auto& name) {
          const auto* rock = rock_of(name);
          return !rock || rock->growth_of_pores(fluid) + rock->porosity * fluid > 0 ||
                 (scene_.deforms() && rock->biot > 0);
        });
    const bool known =
        is_sound("Boundary conditions") && (!conditions.empty() || is_absent(draft_, "Boundary conditions"));
    if (!given && !stored && known && is_sound("Materials") && is_sound("Flow"))
      fail("Flow",
           "nothing says how high the pressure is: give a \"pressure\" on a boundary, in a well or in a region, or "
           "storage "
           "(\"compressibility of pores\" or \"Biot modulus\" of the rock, or its \"porosity\" and "
           "\"compressibility\" of the fluid)");
  }

  /// What flows through a part of the boundary cannot be given where the pressure is.
  void compare_fluid_conditions() {
    const auto overlap = [](const BoundaryCondition& held, const BoundaryCondition& other) {
      if (held.boundary != other.boundary) return false;
      if (other.fracture) return held.fracture ? *held.fracture == *other.fracture : !held.region;
      return !held.fracture && (!held.region || !other.region || *held.region == *other.region);
    };
    for (const auto& [name, held] : scene_.boundary_conditions)
      for (const auto& [second, other] : scene_.boundary_conditions)
        if (held.pressure && !held.conductance && (other.flux || other.conductance) && overlap(held, other))
          fail("Boundary conditions > " + second,
               fmt::format("gives a {} where \"{}\" gives the pressure", other.flux ? "flux" : "conductance", name));
  }

  void compare_rock(const Material& rock) {
    const auto of = [&](const auto& entry) { return &entry.second == &rock; };
    const std::string name = std::find_if(scene_.materials.begin(), scene_.materials.end(), of)->first;
    if (scene_.deforms() && !(rock.E || rock.nu || rock.G || rock.lambda || rock.K) && is_sound("Materials > " + name))
      fail("Materials > " + name, "no elastic constants given, exactly two are needed where the rock deforms");
    const Real least = rock.porosity * scene_.flow->compressibility;  // storage that pores add to
    if (rock.biot_modulus && least * *rock.biot_modulus > 1 + 1e-12)
      fail(fmt::format("Materials > {} > \"Biot modulus\"", name),
           fmt::format(
               "is {:.6g} Pa, must not be above {:.6g} Pa, which \"porosity\" and \"compressibility\" of the fluid "
               "make without any growth of pores",
               *rock.biot_modulus, 1 / least));
    const std::string place = fmt::format("Materials > {} > \"permeability\"", name);
    if (rock.permeability.empty() && is_sound("Materials > " + name))
      fail(place, "missing; it is required with \"Flow\"");
    if (rock.permeability.empty() || !names_.dim) return;
    try {
      if (rock.flows_uniformly()) rock.mobility(*names_.dim, scene_.flow->viscosity, {});
    } catch (const Error& error) {
      fail(place, error.what());
    }
  }

  const Draft& draft_;
  const Scene& scene_;
  const MeshNames& names_;
  std::vector<std::string> errors_;
};

/// The conditions that could be read and fit to the mesh.
std::map<std::string, BoundaryCondition> fitting_conditions(const Draft& draft, const mesh::GlobalMesh& mesh) {
  std::map<std::string, BoundaryCondition> result;
  for (const auto& [name, condition] : draft.value.boundary_conditions) {
    const auto n = condition.displacement.size();
    if (is_sound(draft, "Boundary conditions > " + name) && has(mesh.boundary_names, condition.boundary) &&
        (!condition.region || has(mesh.region_names, *condition.region)) &&
        (!condition.fracture || has(mesh.fracture_names, *condition.fracture)) &&
        (n == 0 || n == static_cast<std::size_t>(mesh.dim())))
      result.emplace(name, condition);
  }
  return result;
}

/// Whether the values of a condition at the end of the first step are known.
bool can_be_evaluated(const Draft& draft, const BoundaryCondition& condition) {
  return (is_sound(draft, "Time") && is_sound(draft, "Tables")) ||
         std::all_of(condition.displacement.begin(), condition.displacement.end(),
                     [](const auto& value) { return value.text() == "free" || value.is_constant(); });
}

std::vector<std::string> conflicts(const Draft& draft, const mesh::GlobalMesh& mesh,
                                   std::map<std::string, BoundaryCondition> conditions) {
  for (auto it = conditions.begin(); it != conditions.end();)
    it = can_be_evaluated(draft, it->second) ? std::next(it) : conditions.erase(it);
  return assembly::find_conflicts(mesh, dirichlet_conditions(conditions, group_names(mesh)),
                                  is_sound(draft, "Time") ? draft.value.time.times().front() : 0);
}

/// What nothing holds, if all conditions are known.
std::string unheld_rock(const Draft& draft, const mesh::GlobalMesh& mesh,
                        const std::map<std::string, BoundaryCondition>& conditions) {
  if (!draft.value.deforms()) return "";
  const bool all = conditions.size() == draft.value.boundary_conditions.size() &&
                   (conditions.empty() ? is_absent : is_sound)(draft, "Boundary conditions");
  return all ? assembly::unheld(mesh, dirichlet_conditions(conditions, group_names(mesh))) : "";
}

}  // namespace

MeshNames names_in_scene(const Draft& draft) {
  const Scene& scene = draft.value;
  MeshNames names;
  if (scene.mesh_file) {
    if (is_sound(draft, "Mesh file")) names.fractures = names_of(scene.mesh_file->fractures);
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
    names.regions = names_of(box.regions);
    names.regions->push_back("bulk");
  }
  if (sound || (is_sound(draft, "Mesh > fractures") && !box.fractures.empty()))
    names.fractures = names_of(box.fractures);
  return names;
}

std::vector<std::string> misfits(const Draft& draft, const MeshNames& names) {
  return Comparison(draft, names).misfits();
}

std::vector<assembly::DirichletCondition> dirichlet_conditions(const std::map<std::string, BoundaryCondition>& given,
                                                               const GroupNames& names, const std::string& field) {
  std::vector<assembly::DirichletCondition> conditions;
  for (const auto& [name, one] : given) {
    const auto values = field == "displacement"            ? one.displacement
                        : one.pressure && !one.conductance ? std::vector{*one.pressure}
                                                           : std::vector<base::Expression>();
    if (values.empty()) continue;
    assembly::DirichletCondition condition{name, field, index_of(names.boundaries, one.boundary), {}};
    if (one.region) condition.region = index_of(names.regions, *one.region);
    if (one.fracture) condition.fracture = index_of(names.fractures, *one.fracture);
    for (const auto& value : values)
      condition.values.push_back(value.text() == "free" ? std::nullopt : std::make_optional(value));
    conditions.push_back(condition);
  }
  return conditions;
}

mesh::GlobalMesh checked_mesh(const Draft& draft, std::string* unheld) {
  const Scene& scene = draft.value;
  auto errors = draft.report.errors;
  const auto attempt = [&](const auto& work) {
    try {
      work();
    } catch (const Error& error) {
      errors.push_back(scene.origin + ": " + error.what());
    }
  };
  std::optional<mesh::GlobalMesh> mesh;
  if (is_sound(draft, scene.mesh_file ? "Mesh file" : "Mesh"))
    attempt([&] { mesh = scene.make_mesh(); });
  else if (scene.mesh_file && !scene.mesh_file->path.empty())
    attempt([&] { mesh::read_msh_file(scene.mesh_file->path); });
  for (const auto& misfit :
       misfits(draft, mesh ? MeshNames{mesh->dim(), mesh->region_names, mesh->boundary_names, mesh->fracture_names}
                           : names_in_scene(draft)))
    errors.push_back(misfit);
  if (mesh) {
    const auto conditions = fitting_conditions(draft, *mesh);
    try {
      for (const auto& conflict : conflicts(draft, *mesh, conditions)) errors.push_back(scene.origin + ": " + conflict);
    } catch (const Error& error) {  // an expression has no value there; alone, it is told by a step that goes there
      if (!errors.empty()) errors.push_back(scene.origin + ": " + error.what());
    }
    const std::string loose = unheld_rock(draft, *mesh, conditions);
    if (unheld)
      *unheld = loose;
    else if (!loose.empty())
      errors.push_back(scene.origin + ": " + loose);
  }
  base::throw_errors(errors);
  return std::move(*mesh);
}

}  // namespace sprekk::model
