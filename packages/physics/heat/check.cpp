// Checks of scenes with heat.
#include "base/entry_of_place.hpp"
#include "physics/comparison.hpp"
#include "physics/heat/temperatures.hpp"

#include <algorithm>
#include <utility>

namespace sprekk::physics {

namespace {

bool no_heat(const Comparison& c) { return !c.scene().heat && c.is_absent("Heat"); }

/// Reports thermal entries in a scene without heat.
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

/// Reports a problem whose temperature is determined neither by a prescribed temperature nor by heat storage.
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
         "the level of the temperature is not determined: give a \"temperature\" on a boundary or in a region, or rock "
         "a \"volumetric heat capacity\"");
}

/// Returns whether the filling of a fracture stores heat.
bool stores_in_fractures(Comparison& c) {
  const auto& scene = c.scene();
  if (!c.names().fractures || c.names().fractures->empty()) return false;
  const bool fluid_does = scene.flow && scene.heat->fluid_capacity.value_or(0) > 0;
  return std::any_of(scene.fractures.begin(), scene.fractures.end(), [&](const auto& named) {
    const auto* joint = c.joint_of(named.second);
    if (!joint) return false;
    return joint->filling_heat_capacity ? !is_zero(*joint->filling_heat_capacity) : fluid_does;
  });
}

/// Reports a missing initial temperature where heat storage, expansion or the fluid depends on it.
void compare_start(Comparison& c) {
  const auto& scene = c.scene();
  if (scene.heat->initial_temperature || !c.is_sound("Heat")) return;
  bool said = false;
  const auto require = [&](const std::string& where) {
    if (!std::exchange(said, true)) c.fail("Heat > \"initial temperature\"", "missing; it is required where " + where);
  };
  c.for_each_rock([&](const Material& rock) {
    if (!is_zero(rock.heat_capacity))
      require("rock has a \"volumetric heat capacity\"");
    else if (!is_zero(rock.thermal_expansion))
      require("rock has a \"thermal expansion\"");
  });
  if (stores_in_fractures(c)) require("the filling of fractures has a heat capacity");
  if (scene.flow && scene.heat->fluid_expansion > 0) require("a fluid has a \"fluid thermal expansion\"");
  if (scene.flow && scene.heat->fluid != "constant") require("a fluid changes with the temperature");
}

/// Checks the entries for temperature-dependent density and viscosity.
void compare_change(Comparison& c) {
  const auto& heat = *c.scene().heat;
  const auto of = [&](const std::string& entry, const std::string& what) { c.fail("Heat > \"" + entry + "\"", what); };
  if (heat.fluid != "constant" && !c.scene().flow) of("fluid", "needs the section \"Flow\"");
  if (heat.fluid != "exponential" && heat.viscosity_decay > 0)
    of("viscosity decay", "requires \"fluid\" = \"exponential\"; here it is \"" + heat.fluid + "\"");
  if (heat.fluid != "water") return;
  if (heat.fluid_expansion > 0) of("fluid thermal expansion", "is part of \"fluid\" = \"water\": leave it out");
  const auto see = [&](const std::string& place, const base::Expression& T) {
    if (T.is_constant() && !is_water(T({}, 0)))
      c.fail(place, fmt::format("is {} K, must be between {} and {} K, where \"fluid\" = \"water\" is tabulated",
                                T.text(), coldest_water, warmest_water));
  };
  see("Heat > \"reference temperature\"", heat.reference_temperature);
  for_each_temperature(c.scene(), see);
}

void compare_fluid(Comparison& c) {
  const auto& heat = *c.scene().heat;
  if (c.scene().host_fluid) c.fail("Heat", "not available with a host_fluid, whose flow is not known");
  if (!c.is_sound("Heat") || !c.is_sound("Flow")) return;
  if (c.scene().flow && !heat.fluid_capacity)
    c.fail("Heat > \"fluid heat capacity\"", "missing; it is required with \"Flow\"");
  if (!c.scene().flow && heat.fluid_capacity)
    c.fail("Heat > \"fluid heat capacity\"", "needs the section \"Flow\"; a joint may have a capacity of its own");
  if (!c.scene().flow && heat.fluid_expansion > 0)
    c.fail("Heat > \"fluid thermal expansion\"", "needs the section \"Flow\"");
  if (!c.scene().flow && heat.advection != "upwind") c.fail("Heat > \"advection\"", "needs the section \"Flow\"");
  compare_change(c);
  Names wells;
  if (c.scene().flow)
    for (const auto& [name, well] : c.scene().flow->wells) wells.push_back(name);
  for (const auto& [name, well] : heat.wells)
    if (!has(wells, name)) c.check_name("Heat > Wells", "Heat > Wells > " + name, name, wells);
}

void compare_conditions(Comparison& c) {
  for (const auto& [name, condition] : c.scene().boundary_conditions)
    if (condition.fracture && (condition.heat_flux || condition.heat_transfer_coefficient))
      c.fail("Boundary conditions > " + name,
             condition.heat_flux
                 ? "gives a \"heat flux\", which is one of rock, not of a \"fracture\""
                 : "gives a \"heat transfer coefficient\", which is one of rock, not of a \"fracture\"");
  for (const auto& [name, condition] : c.scene().boundary_conditions)
    for (const auto& [second, other] : c.scene().boundary_conditions)
      if (condition.temperature && !condition.heat_transfer_coefficient &&
          (other.heat_flux || other.heat_transfer_coefficient) && condition.boundary == other.boundary &&
          !condition.fracture && (!condition.region || !other.region || *condition.region == *other.region))
        c.fail("Boundary conditions > " + second,
               fmt::format("gives a heat flux where \"{}\" gives the temperature", name));
}

}  // namespace

std::string Heat::Estimate::missing(const Scene& scene) {
  if (!scene.heat) return "";
  const auto& heat = *scene.heat;
  if (heat.scheme != "auto" && heat.scheme != "rt0")
    return fmt::format("is of the scheme rt0; not available with \"Heat > scheme\" {}", heat.scheme);
  if (heat.advection != "upwind") return "is of upwind flow; not available with \"Heat > advection\" second order";
  if (heat.fluid_change())
    return fmt::format("is of a fluid that heat does not change; not available with \"Heat > fluid\" {}", heat.fluid);
  if (heat.of_friction) return "is of joints that give off no heat; not available with \"Heat > heat of friction\"";
  const auto& conditions = scene.boundary_conditions;
  if (std::any_of(conditions.begin(), conditions.end(),
                  [](const auto& named) { return named.second.heat_transfer_coefficient.has_value(); }))
    return "is of boundaries whose temperature or heat flux is given; not available with \"heat transfer coefficient\"";
  const auto& regions = scene.regions;
  if (std::any_of(regions.begin(), regions.end(), [](const auto& named) { return named.second.temperature; }))
    return "is of temperatures that are given on boundaries; not available with one of a region";
  return "";
}

std::vector<estimate::QuantityKind> Heat::Estimate::quantities() {
  return {{"temperature", "K", "K", "temperature of the fluid of a well, or mean over fractures"},
          {"heat flow", "W", "W/m", "heat flow into the domain from a well or through a boundary"}};
}

std::string Heat::Estimate::refuses(const Scene& scene, const estimate::Functional& J) {
  const bool of_well = !J.well.empty(), is_flow = J.what == "heat flow";
  const auto absent = [&](const char* entry, const char* of) {
    return fmt::format("\"{}\": must be absent: \"{}\" {}", entry, J.what, of);
  };
  if (is_flow && !J.fractures.empty()) return absent("fractures", "is not taken over them");
  if (!is_flow && !J.boundary.empty()) return absent("boundary", "is of a well or of fractures");
  if (!is_flow && of_well && !J.fractures.empty()) return absent("fractures", "is of the well");
  if (is_flow && of_well == !J.boundary.empty())
    return of_well ? "is of a \"boundary\" or a \"well\", not of both" : "needs \"boundary\" or \"well\"";
  if (of_well && (!scene.flow || !scene.flow->wells.count(J.well)))
    return fmt::format("\"well\": is \"{}\", which is no section of Flow > Wells", J.well);
  if (!is_flow && of_well && scene.heat->wells.count(J.well)) {
    const auto& rate = scene.flow->wells.at(J.well).rate;
    if (rate && rate->is_constant() && (*rate)({}, 0) > 0)
      return fmt::format("\"well\": \"{}\" puts in fluid whose temperature is given", J.well);
  }
  const auto& conditions = scene.boundary_conditions;
  if (is_flow && !of_well && std::none_of(conditions.begin(), conditions.end(), [&](const auto& one) {
        return one.second.boundary == J.boundary && one.second.temperature;
      }))
    return fmt::format("\"boundary\": is \"{}\", where no temperature is prescribed; its heat flow is known",
                       J.boundary);
  return "";
}

void Heat::compare(Comparison& c) {
  compare_without_heat(c);
  if (!c.scene().heat) return;
  c.for_each_rock([&](const Material& rock) { compare_rock(c, rock); });
  compare_level(c);
  compare_start(c);
  compare_fluid(c);
  compare_conditions(c);
  if (!c.scene().heat->of_friction) return;
  const auto& fractures = c.names().fractures;
  if (!Mechanics::is_in(c.scene()) || (fractures && fractures->empty()))
    c.fail("Heat > \"heat of friction\"", "needs fractures, and rock that deforms");
  if (!c.scene().heat->initial_temperature)
    c.fail("Heat > \"initial temperature\"", "missing; it is required with \"heat of friction\"");
}

}  // namespace sprekk::physics
