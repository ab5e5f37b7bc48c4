// Checks of scenes with flow.
#include "base/entry_of_place.hpp"
#include "base/text.hpp"
#include "physics/comparison.hpp"

#include <algorithm>

namespace sprekk::physics {

namespace {

bool no_flow(const Comparison& c) { return !c.scene().flow && c.is_absent("Flow"); }

/// Reports entries for a fluid in a scene without one.
void compare_without_flow(Comparison& c) {
  if (!no_flow(c)) return;
  const auto needs_flow = [&](const std::string& place) { c.fail(place, "needs the section \"Flow\""); };
  for (const auto& [name, region] : c.scene().regions)
    if (region.pressure) needs_flow("Regions > " + name + " > \"pressure\"");
  for (const auto& [name, fracture] : c.scene().fractures) {
    if (!is_zero(fracture.source)) needs_flow("Fractures > " + name + " > \"source\"");
    if (!is_zero(fracture.leak_off)) needs_flow("Fractures > " + name + " > \"leak-off coefficient\"");
    if (!fracture.cuts.empty()) needs_flow("Fractures > " + name + " > \"cuts\"");
    if (!fracture.held_pressures.empty()) needs_flow("Fractures > " + name + " > Held pressures");
  }
  for (const auto& [name, condition] : c.scene().boundary_conditions)
    if (condition.pressure || condition.flux)
      needs_flow("Boundary conditions > " + name + (condition.pressure ? " > \"pressure\"" : " > \"flux\""));
}

void compare_fractures(Comparison& c) {
  const auto& scene = c.scene();
  for (const auto& [name, fracture] : scene.fractures) {
    for (const auto& other : fracture.cuts) {
      const std::string place = fmt::format("Fractures > {} > \"cuts\"", name);
      if (c.check_name("Fractures > " + name, place, other, c.names().fractures) && other == name)
        c.fail(place, fmt::format("is \"{}\", the fracture itself", other));
      if (scene.flow && Mechanics::is_in(scene)) c.fail(place, "needs \"Flow > rigid rock\"");
    }
    const auto* joint = c.joint_of(fracture);
    if (!joint || !c.is_sound("Flow")) continue;
    if (has_fluid(scene) && !is_zero(fracture.fluid_pressure))
      c.fail("Fractures > " + name + " > \"fluid pressure\"", "is computed, not given, with \"Flow\"");
    const bool leaks = !is_zero(fracture.leak_off) && Mechanics::is_in(scene),
               bonded = fracture.unbroken && Mechanics::is_in(scene);  // then also required by compare_unbroken()
    if (scene.flow && is_zero(joint->residual_aperture) && !bonded) {
      if (leaks)
        c.fail("Materials > " + fracture.material + " > \"residual aperture\"", "must be above 0 with leak-off");
      else if (is_zero(joint->initial_aperture))
        c.fail("Materials > " + fracture.material + " > \"initial aperture\"",
               "is 0, and so is \"residual aperture\"; with \"Flow\" one must be above 0");
    }
    if (!is_zero(fracture.leak_off) && scene.flow && flows_in_rock(scene))
      c.fail("Fractures > " + name + " > \"leak-off coefficient\"",
             "needs rock with the \"permeability\" 0; fluid leaks into other rock by flow");
    if (scene.flow && !Mechanics::is_in(scene))  // else mechanics reports all missing entries
      for (const auto& [entry, what] : joint->missing("hydraulic aperture"))
        c.fail(fmt::format("Materials > {} > \"{}\"", fracture.material, entry), what);
  }
}

void compare_wells(Comparison& c) {
  const auto& dim = c.names().dim;
  for (const auto& [name, well] : c.scene().flow->wells) {
    const std::string place = fmt::format("Flow > Wells > {} > \"points\"", name);
    const auto n = well.points.size();
    if (dim == 2) c.check_length(place, n, 2);
    if (dim == 3 && n > 0 && (n < 6 || n % 3 != 0))
      c.fail(place, fmt::format("has {}, must have three for each of two or more points", base::counted(n, "value")));
    for (std::size_t k = 3; dim == 3 && k + 2 < n; k += 3)
      if (std::equal(&well.points[k], &well.points[k] + 3, &well.points[k - 3]))
        c.fail(place, fmt::format("has the point ({}, {}, {}) twice in a row", well.points[k], well.points[k + 1],
                                  well.points[k + 2]));
  }
}

void compare_intersections(Comparison& c) {
  for (const auto& [name, one] : c.scene().flow->intersections) {
    const std::string section = "Flow > Intersections > " + name;
    if (c.names().dim == 2) c.fail(section, "needs a mesh in 3D; in 2D, intersections are points");
    for (const auto& fracture : one.fractures)
      c.check_name(section, section + " > \"fractures\"", fracture, c.names().fractures);
    for (std::size_t k = 1; k < one.fractures.size(); ++k)
      if (std::count(one.fractures.begin(), one.fractures.begin() + k, one.fractures[k]) > 0)
        c.fail(section + " > \"fractures\"", fmt::format("has \"{}\" twice", one.fractures[k]));
  }
}

/// Reports pressures of fractures with boxes of another dimension, and those with transport of a quantity.
void compare_held_pressures(Comparison& c) {
  for (const auto& [name, fracture] : c.scene().fractures)
    for (const auto& [held, one] : fracture.held_pressures) {
      const std::string section = fmt::format("Fractures > {} > Held pressures > {}", name, held);
      c.check_length(section + " > \"lower corner\"", one.lower_corner.size(), c.names().dim);
      c.check_length(section + " > \"upper corner\"", one.upper_corner.size(), c.names().dim);
      for_each_physics([&, &section = section]<HasTransport P>(P) {
        for (const auto& carried : P::Transport::carried(c.scene()))
          c.fail(section, fmt::format("not available with transport of the {}; use a well", carried.field));
      });
    }
}

bool gives_pressure(const BoundaryCondition& condition) {
  return condition.pressure && !(condition.conductance && is_zero(*condition.conductance));
}

/// Reports a flow problem whose pressure is determined neither by a prescribed pressure nor by storage.
void compare_level(Comparison& c) {
  const auto& scene = c.scene();
  const auto any = [](const auto& all, const auto& has) {
    return std::any_of(all.begin(), all.end(), [&](const auto& named) { return has(named.second); });
  };
  const bool given = any(scene.flow->wells, [](const auto& well) { return well.pressure.has_value(); }) ||
                     any(scene.boundary_conditions, gives_pressure) ||
                     any(scene.regions, [](const auto& region) { return region.pressure.has_value(); }) ||
                     any(scene.fractures, [](const auto& fracture) { return !fracture.held_pressures.empty(); });
  const auto& [dim, regions, boundaries, fractures] = c.names();
  if (!regions || !fractures) return;
  const bool deforms = Mechanics::is_in(scene);
  const Real fluid = scene.flow->compressibility;
  const bool in_fractures = !fractures->empty() && (fluid > 0 || deforms);
  const bool stored = in_fractures || std::any_of(regions->begin(), regions->end(), [&](const auto& name) {
                        const auto* rock = c.rock_of(name);
                        return !rock || rock->may_store(fluid) || (deforms && !is_zero(rock->biot));
                      });
  const bool known =
      c.is_sound("Boundary conditions") && (!scene.boundary_conditions.empty() || c.is_absent("Boundary conditions"));
  if (!given && !stored && known && c.is_sound("Materials") && c.is_sound("Flow"))
    c.fail(
        "Flow",
        "the level of the pressure is not determined: give a \"pressure\" on a boundary, in a well, in a region or on "
        "a fracture, or storage (\"compressibility of pores\" or \"Biot modulus\" of the rock, or its \"porosity\" and "
        "\"compressibility\" of the fluid)");
}

/// Reports fluxes or conductances where the pressure is prescribed.
void compare_conditions(Comparison& c) {
  const auto overlap = [](const BoundaryCondition& constrained, const BoundaryCondition& other) {
    if (constrained.boundary != other.boundary) return false;
    if (other.fracture) return constrained.fracture ? *constrained.fracture == *other.fracture : !constrained.region;
    return !constrained.fracture && (!constrained.region || !other.region || *constrained.region == *other.region);
  };
  for (const auto& [name, constrained] : c.scene().boundary_conditions)
    for (const auto& [second, other] : c.scene().boundary_conditions)
      if (constrained.pressure && !constrained.conductance && (other.flux || other.conductance) &&
          overlap(constrained, other))
        c.fail("Boundary conditions > " + second,
               fmt::format("gives a {} where \"{}\" gives the pressure", other.flux ? "flux" : "conductance", name));
}

void compare_probes(Comparison& c) {
  Names wells;
  if (c.scene().flow)
    for (const auto& [name, well] : c.scene().flow->wells) wells.push_back(name);
  for (const auto& [name, probe] : c.scene().probes)
    if (probe.well && c.is_sound("Flow"))
      c.check_name("Probes > " + name, fmt::format("Probes > {} > \"well\"", name), *probe.well, wells);
}

void compare_rock(Comparison& c, const Material& rock) {
  const std::string name = c.name_of(rock);
  const auto& flow = *c.scene().flow;
  const std::string place = fmt::format("Materials > {} > \"permeability\"", name);
  const auto try_to = [&](const std::string& where, const auto& find) {
    try {
      find();
    } catch (const Error& error) {
      c.fail(where, error.what());
    }
  };
  if (rock.porosity.is_constant()) try_to("Materials > " + name, [&] { rock.capacity(flow.compressibility, {}); });
  if (rock.permeability.empty() && c.is_sound("Materials > " + name))
    c.fail(place, "missing; it is required with \"Flow\"; 0: fluid flows in fractures only");
  if (rock.permeability.empty() || !c.names().dim) return;
  if (rock.is_impermeable()) return;
  if (!flows_in_rock(c.scene()))
    c.fail(place, "must be 0 like that of other rock, or above 0 in all rock: with 0, fluid flows in fractures only");
  if (rock.flows_uniformly()) try_to(place, [&] { rock.mobility(*c.names().dim, flow.viscosity, {}); });
}

/// Reports entries that need flow in the rock.
void compare_impermeable(Comparison& c) {
  const auto& scene = c.scene();
  if (flows_in_rock(scene)) return;
  const auto fail = [&](const std::string& place, const std::string& what = "") {
    c.fail(place, what + "needs rock with a \"permeability\" above 0; with 0, fluid flows in fractures only");
  };
  if (c.names().fractures && c.names().fractures->empty()) fail("Flow", "without fractures, ");
  if (!is_zero(scene.flow->source)) fail("Flow > \"source\"");
  for_each_physics([&]<HasTransport P>(P) {
    for (const auto& carried : P::Transport::carried(scene)) fail("Flow", "transport of the " + carried.field + " ");
  });
  for (const auto& [name, region] : scene.regions)
    if (region.pressure) fail("Regions > " + name + " > \"pressure\"");
  for (const auto& [name, one] : scene.boundary_conditions)
    if (!one.fracture && (one.flux || one.conductance))
      fail(fmt::format("Boundary conditions > {} > \"{}\"", name, one.flux ? "flux" : "conductance"),
           "without \"fracture\" ");
}

}  // namespace

std::string Flow::Estimate::missing(const Scene& scene) {
  if (has_unknown_pressure(scene) && !scene.flow) return "is not available where a host program computes the pressure";
  if (!scene.flow) return "";
  if (!flows_in_rock(scene)) return "is of rock with a permeability above 0";
  const auto& flow = *scene.flow;
  const auto any = [](const auto& all, const auto& has) {
    return std::any_of(all.begin(), all.end(), [&](const auto& named) { return has(named.second); });
  };
  if (flow.scheme != "auto" && flow.scheme != "rt0")
    return fmt::format("is of the scheme rt0; not available with \"Flow > scheme\" {}", flow.scheme);
  if (any(scene.boundary_conditions, [](const auto& condition) { return condition.conductance.has_value(); }))
    return "is of boundaries whose pressure or flux is given; not available with \"conductance\"";
  if (any(scene.regions, [](const auto& region) { return region.pressure.has_value(); }))
    return "is of pressures that are given on boundaries; not available with one of a region";
  if (any(scene.fractures, [](const auto& fracture) { return !fracture.held_pressures.empty(); }))
    return "is of pressures that are given on boundaries; not available with \"Held pressures\" of a fracture";
  if (any(scene.fractures, [](const auto& fracture) { return !fracture.cuts.empty(); }))
    return "is of fractures whose fillings are one; not available with \"cuts\"";
  if (!flow.intersections.empty())
    return "is of flow in rock and fractures; not available with \"Flow > Intersections\"";
  return "";
}

std::vector<estimate::QuantityKind> Flow::Estimate::quantities() {
  return {{"pressure", "Pa", "Pa", "pressure of a well with a given rate, or mean over fractures"},
          {"flow", "m^3/s", "m^2/s",
           "flow of fluid into the domain from a well with a given pressure, or through a boundary with a prescribed "
           "pressure"},
          {.name = "flux",
           .unit = "sqrt(W)",
           .unit_in_2d = "sqrt(W/m)",
           .text = "square root of the power dissipated by the flow of fluid",
           .is_norm = true}};
}

std::string Flow::Estimate::refuses(const Scene& scene, const estimate::Functional& J) {
  const bool of_well = !J.well.empty();
  const auto absent = [&](const char* entry, const char* of) {
    return fmt::format("\"{}\": must be absent: \"{}\" {}", entry, J.what, of);
  };
  if (J.what == "flux" && of_well) return absent("well", "is of all rock and fractures");
  if (J.what == "flux" && !J.boundary.empty()) return absent("boundary", "is of all rock and fractures");
  if (J.what != "pressure" && !J.fractures.empty()) return absent("fractures", "is not taken over them");
  if (J.what == "pressure" && !J.boundary.empty()) return absent("boundary", "is of a well or of fractures");
  if (J.what == "pressure" && of_well && !J.fractures.empty()) return absent("fractures", "is of the well");
  if (J.what == "flow" && of_well == !J.boundary.empty())
    return of_well ? "is of a \"boundary\" or a \"well\", not of both" : "needs \"boundary\" or \"well\"";
  const auto& wells = scene.flow->wells;
  if (std::any_of(wells.begin(), wells.end(), [](const auto& well) { return well.second.points.size() > 2; }))
    return "is not available with wells through rock; in 2D wells may be on fractures";
  if (J.what == "flux" && !wells.empty())
    return "is not available with wells, whose power does not follow from their radius";
  if (of_well) {
    const auto found = wells.find(J.well);
    if (found == wells.end()) return fmt::format("\"well\": is \"{}\", which is no section of Flow > Wells", J.well);
    if (J.what == "flow" && !found->second.pressure)
      return fmt::format("\"well\": the rate of \"{}\" is given; request its pressure", J.well);
    if (J.what == "pressure" && found->second.pressure)
      return fmt::format("\"well\": the pressure of \"{}\" is given; request its flow", J.well);
  }
  const auto& conditions = scene.boundary_conditions;
  if (J.what == "flow" && !of_well && std::none_of(conditions.begin(), conditions.end(), [&](const auto& one) {
        return one.second.boundary == J.boundary && one.second.pressure;
      }))
    return fmt::format("\"boundary\": is \"{}\", where no pressure is prescribed; its flow is known", J.boundary);
  return "";
}

void Flow::compare(Comparison& c) {
  if (c.scene().flow && c.scene().host_fluid) c.fail("Flow", "not available with a host_fluid, which has its own flow");
  compare_without_flow(c);
  compare_fractures(c);
  compare_probes(c);
  if (!c.scene().flow) return;
  compare_wells(c);
  compare_intersections(c);
  compare_held_pressures(c);
  compare_level(c);
  compare_conditions(c);
  compare_impermeable(c);
  c.for_each_rock([&](const Material& rock) { compare_rock(c, rock); });
}

}  // namespace sprekk::physics
