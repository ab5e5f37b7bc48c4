// Checks of scenes with a tracer.
#include "base/entry_of_place.hpp"
#include "physics/comparison.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::physics {

namespace {

/// Reports entries for a tracer in a scene without one.
void compare_without_tracer(Comparison& c) {
  if (!c.is_absent("Tracer")) return;
  for (const auto& [name, condition] : c.scene().boundary_conditions)
    if (condition.concentration || condition.tracer_flux)
      c.fail(
          "Boundary conditions > " + name + (condition.concentration ? " > \"concentration\"" : " > \"tracer flux\""),
          "needs the section \"Tracer\"");
}

void compare_rock(Comparison& c, const Material& rock) {
  const std::string section = "Materials > " + c.name_of(rock);
  if (!c.is_sound(section)) return;
  if (is_zero(rock.porosity)) c.fail(section + " > \"porosity\"", "missing or 0; it is required with \"Tracer\"");
  const std::string place = section + " > \"effective diffusion coefficient\"";
  if (rock.effective_diffusion.empty()) c.fail(place, "missing; it is required with \"Tracer\"");
  if (rock.effective_diffusion.empty() || !c.names().dim) return;
  try {
    if (rock.diffuses_uniformly()) rock.diffusion(*c.names().dim, {});
  } catch (const Error& error) {
    c.fail(place, error.what());
  }
}

/// Reports the cases in which the velocity of dispersion is not that of Flow.
void compare_dispersivity(Comparison& c) {
  const auto& scene = c.scene();
  for (const auto& [name, material] : scene.materials) {
    if (!material.dispersivity.is_any() && !material.filling_dispersivity.is_any()) continue;
    const auto refuse = [&, &name = name](const std::string& what) {
      c.fail("Materials > " + name + " > \"longitudinal dispersivity\" and \"transverse dispersivity\"", what);
    };
    if (!scene.flow) refuse("need the section \"Flow\"");
    if (scene.flow && material.filling_dispersivity.is_any() && Mechanics::is_in(scene))
      refuse("of fractures need \"Flow > rigid rock\"");
    for_each_physics([&]<HasTransport P>(P) {
      for (const auto& one : P::Transport::carried(scene))
        if (one.change) refuse("are not available with a fluid that changes with the " + one.field);
    });
    for (const auto& [other, joint] : scene.materials) {
      const auto& across = joint.normal_permeability;
      if (!across.is_constant() || std::isfinite(across({}, 0)))
        refuse("are not available with the \"normal permeability\" of \"" + other + "\"");
    }
  }
}

void compare_conditions(Comparison& c) {
  const auto& conditions = c.scene().boundary_conditions;
  for (const auto& [name, condition] : conditions) {
    if (condition.fracture && (condition.tracer_flux || condition.tracer_transfer))
      c.fail("Boundary conditions > " + name,
             condition.tracer_flux
                 ? "gives a \"tracer flux\", which is one of rock, not of a \"fracture\""
                 : "gives a \"tracer transfer coefficient\", which is one of rock, not of a \"fracture\"");
    for (const auto& [second, other] : conditions)
      if (condition.concentration && !condition.tracer_transfer && (other.tracer_flux || other.tracer_transfer) &&
          condition.boundary == other.boundary && !condition.fracture &&
          (!condition.region || !other.region || *condition.region == *other.region))
        c.fail("Boundary conditions > " + second,
               fmt::format("gives a tracer flux where \"{}\" gives the concentration", name));
  }
}

}  // namespace

void Tracer::compare(Comparison& c) {
  const auto& scene = c.scene();
  if (!is_in(scene)) return compare_without_tracer(c);
  if (scene.host_fluid) c.fail("Tracer", "not available with a host_fluid, whose flow is not known");
  c.for_each_rock([&](const Material& rock) { compare_rock(c, rock); });
  compare_conditions(c);
  if (!c.is_sound("Tracer") || !c.is_sound("Flow")) return;
  compare_dispersivity(c);
  if (!scene.flow && scene.tracer->advection != "upwind")
    c.fail("Tracer > \"advection\"", "needs the section \"Flow\"");
  Names wells;
  if (scene.flow)
    for (const auto& [name, well] : scene.flow->wells) wells.push_back(name);
  for (const auto& [name, well] : scene.tracer->wells)
    if (!has(wells, name)) c.check_name("Tracer > Wells", "Tracer > Wells > " + name, name, wells);
}

std::string Tracer::Estimate::missing(const Scene& scene) {
  if (!is_in(scene)) return "";
  const auto& tracer = *scene.tracer;
  if (tracer.scheme != "auto" && tracer.scheme != "rt0")
    return fmt::format("is of the scheme rt0; not available with \"Tracer > scheme\" {}", tracer.scheme);
  if (tracer.advection != "upwind") return "is of upwind flow; not available with \"Tracer > advection\" second order";
  if (tracer.half_life) return "is of a tracer without decay; not available with \"Tracer > half life\"";
  if (has_dispersivity(scene)) return "is of diffusion; not available with a dispersivity";
  const auto& conditions = scene.boundary_conditions;
  if (std::any_of(conditions.begin(), conditions.end(), [](const auto& one) { return one.second.tracer_transfer; }))
    return "is of boundaries whose concentration or flux is given; not available with \"tracer transfer coefficient\"";
  return "";
}

std::vector<estimate::QuantityKind> Tracer::Estimate::quantities() {
  return {
      {"concentration", "kg/m^3", "kg/m^3", "concentration of the fluid of a well, or mean over fractures"},
      {"tracer flow", "kg/s", "kg/(m*s)", "tracer mass into the domain from a well or through a boundary, per time"}};
}

std::string Tracer::Estimate::refuses(const Scene& scene, const estimate::Functional& J) {
  const bool of_well = !J.well.empty(), is_flow = J.what == "tracer flow";
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
  const auto& conditions = scene.boundary_conditions;
  if (is_flow && !of_well && std::none_of(conditions.begin(), conditions.end(), [&](const auto& one) {
        return one.second.boundary == J.boundary && one.second.concentration;
      }))
    return fmt::format("\"boundary\": is \"{}\", where no concentration is prescribed; its flow is known", J.boundary);
  return "";
}

}  // namespace sprekk::physics
