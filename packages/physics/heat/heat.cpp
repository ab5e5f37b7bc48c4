#include "physics/heat/heat.hpp"

#include "physics/comparison.hpp"
#include "physics/hybrid_diffusion.hpp"
#include "physics/entry_of_place.hpp"
#include "physics/storage.hpp"
#include "physics/tensor_entry.hpp"

#include <algorithm>

namespace sprekk::physics {

namespace {

constexpr const char* capacity_name = "volumetric heat capacity";

Properties<laws::Mobility> conductivity_of(const Scene& scene, const mesh::Mesh& mesh) {
  return by_cell(
      scene, mesh, [](const Material& rock) { return rock.conducts_uniformly(); },
      [&](const Material& rock, const auto& x) { return rock.conductivity(mesh.dim(), x); });
}

SchemeEntry scheme_entry(const HeatSection& heat) {
  return {.section = "Heat", .name = heat.scheme, .property = "thermal conductivity"};
}

bool no_heat(const Comparison& c) { return !c.scene().heat && c.is_absent("Heat"); }

/// What is of heat in a scene without it.
void compare_without_heat(Comparison& c) {
  if (!no_heat(c)) return;
  const auto needs_heat = [&](const std::string& place) { c.fail(place, "needs the section \"Heat\""); };
  for (const auto& [name, region] : c.scene().regions)
    if (region.temperature) needs_heat("Regions > " + name + " > \"temperature\"");
  for (const auto& [name, condition] : c.scene().boundary_conditions)
    if (condition.temperature || condition.heat_flux)
      needs_heat("Boundary conditions > " + name + (condition.temperature ? " > \"temperature\"" : " > \"heat flux\""));
}

void compare_rock(Comparison& c, const Material& rock) {
  const std::string section = "Materials > " + c.name_of(rock), place = section + " > \"thermal conductivity\"";
  if (!c.is_sound(section)) return;
  if (rock.thermal_conductivity.empty()) c.fail(place, "missing; it is required with \"Heat\"");
  if (rock.thermal_conductivity.empty() || !c.names().dim) return;
  try {
    if (rock.conducts_uniformly()) rock.conductivity(*c.names().dim, {});
  } catch (const Error& error) {
    c.fail(place, error.what());
  }
}

/// Heat that no temperature and no capacity ties to a level has none, or any.
void compare_level(Comparison& c) {
  const auto& conditions = c.scene().boundary_conditions;
  const auto& regions = c.scene().regions;
  bool known = conditions.empty() && !c.is_absent("Boundary conditions");
  known = known || std::any_of(conditions.begin(), conditions.end(), [](const auto& named) {
            const auto& h = named.second.heat_transfer_coefficient;
            return named.second.temperature && !(h && is_zero(*h));
          });
  known = known || std::any_of(regions.begin(), regions.end(), [](const auto& r) { return r.second.temperature; });
  c.for_each_rock([&](const Material& rock) { known = known || !is_zero(rock.heat_capacity); });
  if (known || !c.names().regions || !c.is_sound("Materials") || !c.is_sound("Boundary conditions")) return;
  c.fail("Heat",
         "nothing says how high the temperature is: give a \"temperature\" on a boundary or in a region, or "
         "rock a \"volumetric heat capacity\"");
}

}  // namespace

void HeatSection::describe(base::Section& s) {
  s.entry(source, "source", "W/m^3", base::any(), "power per volume of rock, an expression of x, y, z, t");
  entry_of_place(s, initial_temperature, "initial temperature", "K", base::any(),
                 "at the start, where heat is stored; of x, y, z");
  s.choice(
      scheme, "scheme", {"auto", "rt0", "tpfa", "mimetic"},
      "how flows follow from temperatures; auto: rt0 on simplices; on others tpfa where conductivity and cells are "
      "orthogonal, else mimetic");
}

void Heat::Sections::describe(base::Section& s) { s.section(heat, "Heat", "heat that the rock conducts and stores"); }

void Heat::Rock::describe(base::Section& s) {
  entry_of_place(s, thermal_conductivity, "thermal conductivity", "W/(m*K)", base::any(),
                 "of the rock, needed with \"Heat\": one value; XX, YY[, ZZ]; or XX, YY, XY in 2D, XX, YY, ZZ, XY, YZ, "
                 "XZ in 3D");
  entry_of_place(s, heat_capacity, capacity_name, "J/(m^3*K)", base::at_least(0),
                 "rho c, density times specific heat capacity; 0: no heat is stored");
}

bool Heat::Rock::conducts_uniformly() const { return is_uniform_tensor(thermal_conductivity); }

laws::Mobility Heat::Rock::conductivity(int dim, const std::array<Real, 3>& x) const {
  return tensor_at("thermal conductivity", thermal_conductivity, dim, x);
}

void Heat::Region::describe(base::Section& s) {
  s.entry(temperature, "temperature", "K", base::at_least(0),
          "of its cells, with \"Heat\": a value or an expression of x, y, z, t");
}

std::vector<Prescribed> Heat::Region::prescribed() const {
  if (!temperature) return {};
  return {{"temperature", {*temperature}}, {"face temperature", {*temperature}}};
}

void Heat::BoundaryCondition::describe(base::Section& s) {
  s.entry(temperature, "temperature", "K", base::at_least(0), "with \"Heat\": a value or an expression of x, y, z, t");
  s.entry(heat_flux, "heat flux", "W/m^2", base::any(), "heat that leaves per area and time, with \"Heat\"");
  entry_of_place(s, heat_transfer_coefficient, "heat transfer coefficient", "W/(m^2*K)", base::at_least(0),
                 "h: the flux is h (T - temperature), the temperature then being that beyond the boundary");
}

void Heat::BoundaryCondition::check(base::Section& s) const {
  if (heat_transfer_coefficient && !temperature)
    s.fail("heat transfer coefficient", "needs a \"temperature\" beyond the boundary");
  if (temperature && heat_flux) s.fail("give either \"temperature\" or \"heat flux\"");
}

std::vector<Prescribed> Heat::BoundaryCondition::prescribed() const {
  if (!temperature || heat_transfer_coefficient) return {};
  return {{"face temperature", {*temperature}}};
}

bool Heat::is_in(const Scene& scene) { return scene.heat.has_value(); }

bool Heat::has_initial_state(const Scene& scene) { return !is_in(scene) || scene.heat->initial_temperature; }

void Heat::compare(Comparison& c) {
  compare_without_heat(c);
  if (!c.scene().heat) return;
  if (c.names().fractures && !c.names().fractures->empty())
    c.fail("Heat", "goes without fractures so far, and the mesh has some");
  c.for_each_rock([&](const Material& rock) { compare_rock(c, rock); });
  compare_level(c);
  c.for_each_rock([&](const Material& rock) {
    if (!is_zero(rock.heat_capacity) && !c.scene().heat->initial_temperature && c.is_sound("Heat"))
      c.fail("Heat > \"initial temperature\"", "missing; it is required where rock has a \"volumetric heat capacity\"");
  });
  for (const auto& [name, condition] : c.scene().boundary_conditions)
    for (const auto& [second, other] : c.scene().boundary_conditions)
      if (condition.temperature && !condition.heat_transfer_coefficient &&
          (other.heat_flux || other.heat_transfer_coefficient) && condition.boundary == other.boundary &&
          (!condition.region || !other.region || *condition.region == *other.region))
        c.fail("Boundary conditions > " + second,
               fmt::format("gives a heat flux where \"{}\" gives the temperature", name));
}

void Heat::add_modules(const Setting& setting, Modules& modules) {
  const auto& scene = setting.scene;
  const auto& mesh = setting.mesh;
  if (!is_in(scene)) return;
  const auto& heat = *scene.heat;
  Properties<laws::Mobility> conductivity;
  Properties<Capacity> capacity;
  base::collectively(*mesh.comm, [&] {
    conductivity = conductivity_of(scene, mesh);
    capacity = by_cell(
        scene, mesh, [](const Material& rock) { return rock.heat_capacity.is_constant(); },
        [](const Material& rock, const auto& x) {
          return Capacity{.room = 0, .growth = value_at(capacity_name, rock.heat_capacity, base::at_least(0), x)};
        });
  });
  const auto chosen = flux_scheme(scheme_entry(heat), mesh, conductivity);
  HybridDiffusionParameters conduction{
      .name = "heat conduction",
      .field = "temperature",
      .unit = "K",
      .flux = "heat flux",
      .flux_unit = "W/m^2",
      .outflow = {"heat transfer coefficient", "heat_inflows", mesh.dim() == 2 ? "W/m" : "W"},
      .mobility = std::move(conductivity),
      .scheme = chosen.scheme,
      .reason = chosen.reason};
  if (!is_zero(heat.source)) conduction.source = {heat.source};
  conduction.initial = heat.initial_temperature;
  conduction.conditions = flux_conditions(
      scene, mesh,
      {&BoundaryCondition::heat_flux, &BoundaryCondition::temperature, &BoundaryCondition::heat_transfer_coefficient});
  conduction.in_regions =
      std::any_of(scene.regions.begin(), scene.regions.end(), [](const auto& r) { return r.second.temperature; });
  modules.push_back(make_hybrid_diffusion(mesh.shape, std::move(conduction)));
  modules.push_back(make_storage({.name = "heat storage",
                                  .field = "temperature",
                                  .capacity = std::move(capacity),
                                  .initial = heat.initial_temperature.value_or(0)}));
}

std::vector<std::string> Heat::warnings(const Setting& setting) {
  const auto& [scene, mesh, start] = setting;
  if (!is_in(scene)) return {};
  const auto skew = scheme_warning(scheme_entry(*scene.heat), mesh, conductivity_of(scene, mesh));
  return skew.empty() ? std::vector<std::string>() : std::vector{scene.origin + ": " + skew};
}

}  // namespace sprekk::physics
