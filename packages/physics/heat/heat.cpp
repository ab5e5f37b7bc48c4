#include "physics/heat/heat.hpp"

#include "base/entry_of_place.hpp"
#include "base/names.hpp"
#include "base/over_ranks.hpp"
#include "mesh/extents.hpp"
#include "physics/comparison.hpp"
#include "physics/flow/fluid_flux.hpp"
#include "physics/heat/fracture_heat.hpp"
#include "physics/heat/overshoot.hpp"
#include "physics/heat/temperatures.hpp"
#include "physics/heat/thermal_expansion.hpp"
#include "transport/balance_error.hpp"
#include "transport/hybrid_diffusion.hpp"
#include "transport/storage.hpp"
#include "transport/tensor_entry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace sprekk::physics {

namespace {

constexpr const char *capacity_name = "volumetric heat capacity", *conductivity_name = "thermal conductivity",
                     *expansion_name = "thermal expansion";

fields::Properties<laws::Mobility> conductivity_of(const Scene& scene, const mesh::Mesh& mesh) {
  return by_cell(
      scene, mesh, [](const Material& rock) { return rock.conducts_uniformly(); },
      [&](const Material& rock, const auto& x) { return rock.conductivity(mesh.dim(), x); });
}

transport::SchemeEntry scheme_entry(const HeatSection& heat) {
  return {.section = "Heat", .name = heat.scheme, .property = "thermal conductivity"};
}

fields::Properties<Real> capacity_of_rock(const Scene& scene, const mesh::Mesh& mesh) {
  return by_cell(
      scene, mesh, [](const Material& rock) { return rock.heat_capacity.is_constant(); },
      [](const Material& rock, const auto& x) {
        return value_at(capacity_name, rock.heat_capacity, base::at_least(0), x);
      });
}

fields::Properties<Real> expansion_of_rock(const Scene& scene, const mesh::Mesh& mesh) {
  return by_cell(
      scene, mesh, [](const Material& rock) { return rock.thermal_expansion.is_constant(); },
      [](const Material& rock, const auto& x) {
        return value_at(expansion_name, rock.thermal_expansion, base::any(), x);
      });
}

/// Thermal expansion of fluid and grains minus that of the pores, by cell. The fluid contributes only if it is
/// constant; otherwise the storage term contains its expansion.
fields::Properties<Real> expansion_of_pores(const Scene& scene, const mesh::Mesh& mesh) {
  const Real of_fluid = scene.heat->fluid == "constant" ? scene.heat->fluid_expansion : 0;
  return by_cell(
      scene, mesh,
      [](const Material& rock) {
        return rock.thermal_expansion.is_constant() && rock.porosity.is_constant() && rock.biot.is_constant();
      },
      [&](const Material& rock, const auto& x) {
        const Real phi = rock.porosity(x, 0);
        return phi * of_fluid + (rock.biot(x, 0) - phi) * 3 * rock.thermal_expansion(x, 0);
      });
}

bool is_any(const mesh::Mesh& mesh, const fields::Properties<Real>& property) {
  const auto& values = property.values;
  return base::on_any_rank(*mesh.comm, std::any_of(values.begin(), values.end(), [](Real v) { return v != 0; }));
}

/// Thermal data of local fracture faces. Collective.
std::vector<FractureHeatParameters::Face> fillings(const Setting& setting) {
  const auto& [scene, mesh, start] = setting;
  const auto apertures = start_apertures(setting);
  const Real minimum = 1e-9 * mesh::largest_extent(mesh);  // ridges of closed fractures then conduct heat
  std::vector<FractureHeatParameters::Face> faces;
  base::collectively(*mesh.comm, [&, &scene = scene, &mesh = mesh] {
    for (std::size_t f = 0; f < apertures.size(); ++f) {
      const auto& x = mesh.fracture_faces[f].centre;
      const auto& joint = joint_of(scene, mesh, mesh.fracture_faces[f].single);
      faces.push_back(at_place(scene, joint, [&]() -> FractureHeatParameters::Face {
        const auto& own = joint.filling_heat_capacity;
        return {.aperture = apertures[f].value,
                .minimum = std::max(minimum, apertures[f].minimum),
                .conductivity = value_at(conductivity_name, joint.filling_conductivity, base::positive(), x),
                .capacity = own          ? value_at(capacity_name, *own, base::at_least(0), x)
                            : scene.flow ? scene.heat->fluid_capacity.value_or(0)
                                         : 0};
      }));
    }
  });
  return faces;
}

/// Temperatures of a scene, for the scale of stresses.
std::vector<GivenTemperature> given_temperatures(const Scene& scene, const mesh::Mesh& mesh) {
  std::vector<GivenTemperature> all;
  const auto number = [](const auto& names, const std::string& name) { return base::index_of(names, name); };
  for (const auto& [name, condition] : scene.boundary_conditions)
    if (condition.temperature)
      all.push_back({.value = *condition.temperature,
                     .boundary = number(mesh.boundary_names, condition.boundary),
                     .region = condition.region ? number(mesh.region_names, *condition.region) : -1});
  for (const auto& [name, region] : scene.regions)
    if (region.temperature) all.push_back({.value = *region.temperature, .region = number(mesh.region_names, name)});
  for (const auto& [name, well] : scene.heat->wells) all.push_back({.value = well.temperature});
  return all;
}

/// Heat sources and fluxes of a scene, each with the stationary temperature change over the domain per unit.
/// Collective.
std::vector<GivenTemperature> given_rates(const Scene& scene, const mesh::Mesh& mesh,
                                          const fields::Properties<laws::Mobility>& conductivity) {
  Real minimum = std::numeric_limits<Real>::infinity();
  for (const auto& each : conductivity.values)
    for (int i = 0; i < mesh.dim(); ++i) minimum = std::min(minimum, each.value[i][i]);
  const Real size = mesh::largest_extent(mesh), per_flux = size / -base::max_over_ranks(*mesh.comm, -minimum);
  std::vector<GivenTemperature> all;
  for (const auto& [name, condition] : scene.boundary_conditions)
    if (condition.heat_flux)
      all.push_back({.value = *condition.heat_flux,
                     .boundary = base::index_of(mesh.boundary_names, condition.boundary),
                     .region = condition.region ? base::index_of(mesh.region_names, *condition.region) : -1,
                     .per_rate = per_flux});
  if (!is_zero(scene.heat->source)) all.push_back({.value = scene.heat->source, .per_rate = size * per_flux});
  return all;
}

void add_fractures(const Setting& setting, const std::vector<FractureHeatParameters::Face>& faces,
                   transport::FluxScheme scheme, Modules& modules) {
  const auto& [scene, mesh, start] = setting;
  FractureHeatParameters fractures{.faces = faces,
                                   .scheme = scheme,
                                   .initial = scene.heat->initial_temperature.value_or(0),
                                   .expansion = scene.heat->fluid == "constant" ? scene.heat->fluid_expansion : 0,
                                   .change = scene.heat->fluid_change(),
                                   .widens = Mechanics::is_in(scene) && has_unknown_pressure(scene)};
  if (scene.flow) {
    fractures.fluid = {scene.flow->compressibility, scene.flow->reference_pressure};
    fractures.initial_pressure = scene.flow->initial_pressure;
  }
  modules.push_back(make_fracture_heat(mesh.shape, std::move(fractures)));
}

/// Adds thermal stress and thermal expansion of the fluid.
void add_expansion(const Setting& setting, std::vector<GivenTemperature> given, Modules& modules) {
  const auto& [scene, mesh, start] = setting;
  const auto initial = scene.heat->initial_temperature.value_or(0);
  fields::Properties<Real> of_rock, of_pores;
  base::collectively(*mesh.comm, [&, &scene = scene, &mesh = mesh] {
    of_rock = expansion_of_rock(scene, mesh);
    if (scene.flow) of_pores = expansion_of_pores(scene, mesh);
  });
  if (Mechanics::is_in(scene) && is_any(mesh, of_rock))
    modules.push_back(make_thermal_stress({.expansion = std::move(of_rock),
                                           .elasticity = elasticity(scene, mesh),
                                           .initial = initial,
                                           .given = std::move(given)}));
  if (is_any(mesh, of_pores))
    modules.push_back(make_pore_expansion({.expansion = std::move(of_pores), .initial = initial}));
}

}  // namespace

void WellTemperature::describe(base::Section& s) {
  s.required(temperature, "temperature", "K", base::at_least(0),
             "temperature of the injected fluid, a value or an expression of t");
}

void HeatSection::describe(base::Section& s) {
  s.entry(source, "source", "W/m^3", base::any(), "power per volume of rock, a value or an expression of x, y, z, t");
  entry_of_place(
      s, initial_temperature, "initial temperature", "K", base::any(),
      "initial temperature, required for heat storage, with zero thermal stress; a value or an expression of x, y, z");
  s.entry(fluid_capacity, "fluid heat capacity", "J/(m^3*K)", base::at_least(0),
          "volumetric heat capacity rho_0 c of the fluid at its reference pressure, required with \"Flow\"; about "
          "4.2e6 for water");
  s.entry(fluid_expansion, "fluid thermal expansion", "K^-1", base::at_least(0),
          "volumetric thermal expansion coefficient of the fluid in pores and fractures; about 2e-4 for water at 20 "
          "degrees C");
  s.choice(
      fluid, "fluid", {"constant", "exponential", "water"},
      "dependence of density and viscosity of the fluid of \"Flow\" on the temperature T; constant: none; exponential: "
      "rho = rho_0 exp(c (p - p_0) - \"fluid thermal expansion\" (T - T_0)), mu = mu_0 exp(-\"viscosity decay\" (T - "
      "T_0)); water: in the ratio of saturated liquid water (IAPWS) to the values at T_0, from 273.16 to 623.15 K");
  s.entry(viscosity_decay, "viscosity decay", "K^-1", base::at_least(0),
          "decay coefficient of the viscosity of an exponential fluid; about 0.02 for water");
  s.entry(reference_temperature, "reference temperature", "K", base::at_least(0),
          "temperature T_0 of the density and viscosity in \"Flow\", unless the fluid is constant");
  s.choice(scheme, "scheme", {"auto", "rt0", "tpfa", "mimetic"},
           "flux scheme of conduction; rt0: mixed elements (Raviart and Thomas 1977); tpfa: two-point flux "
           "approximation; mimetic: mimetic differences; auto: rt0 on simplices, on other cells tpfa if conductivity "
           "and cells are orthogonal, else mimetic");
  s.choice(advection, "advection", {"upwind", "second order"},
           "advection scheme between cells and along fractures; upwind: first order; second order: limited corrections "
           "once per step, with implicit Euler, for steps in which the fluid crosses at most about half a cell");
  s.entry(of_friction, "heat of friction", "-", "heating of fractures by the power that their friction dissipates");
  s.named_sections(
      wells, "Wells",
      "injection temperatures by the names of wells of \"Flow\"; other wells inject fluid at the local temperature");
}

std::optional<transport::FluidChange> HeatSection::fluid_change() const {
  if (fluid == "constant") return {};
  const auto response = fluid == "water" ? response_of_water(reference_temperature)
                                         : laws::FluidResponse{.reference = reference_temperature,
                                                               .expansion = fluid_expansion,
                                                               .thinning = viscosity_decay};
  return transport::FluidChange{"temperature", response, initial_temperature.value_or(0)};
}

void Heat::Sections::describe(base::Section& s) {
  s.section(heat, "Heat", "heat conduction and storage in rock and fractures, and advection by the fluid");
}

void Heat::Rock::describe(base::Section& s) {
  entry_of_place(s, thermal_conductivity, "thermal conductivity", "W/(m*K)", base::any(),
                 "thermal conductivity of the rock, required with \"Heat\": one value; XX, YY[, ZZ]; or XX, YY, XY in "
                 "2D, XX, YY, ZZ, XY, YZ, XZ in 3D; typical: 1.7 to 3.1 (material library)");
  entry_of_place(s, heat_capacity, capacity_name, "J/(m^3*K)", base::at_least(0),
                 "volumetric heat capacity rho c of the rock with its pore fluid, density times specific heat "
                 "capacity; 0: no heat storage; typical: 1.8e6 to 1.9e6 (material library)");
  entry_of_place(s, thermal_expansion, expansion_name, "K^-1", base::any(),
                 "linear thermal expansion coefficient alpha_T: the thermal stress is -3 K alpha_T (T - initial "
                 "temperature); typical: 5e-6 to 1e-5");
}

void Heat::Joint::describe(base::Section& s) {
  entry_of_place(s, filling_conductivity, conductivity_name, "W/(m*K)", base::positive(),
                 "thermal conductivity of the fracture filling, along and across the fracture, with \"Heat\"; the "
                 "default is the value of water");
  entry_of_place(
      s, filling_heat_capacity, capacity_name, "J/(m^3*K)", base::at_least(0),
      "volumetric heat capacity of the fracture filling, with \"Heat\"; absent: the value of the fluid of \"Flow\"");
}

bool Heat::Rock::conducts_uniformly() const { return transport::is_uniform_tensor(thermal_conductivity); }

laws::Mobility Heat::Rock::conductivity(int dim, const std::array<Real, 3>& x) const {
  return transport::tensor_at("thermal conductivity", thermal_conductivity, dim, x);
}

void Heat::Region::describe(base::Section& s) {
  s.entry(temperature, "temperature", "K", base::at_least(0),
          "prescribed temperature of the cells of the region, with \"Heat\": a value or an expression of x, y, z, t");
}

std::vector<Prescribed> Heat::Region::prescribed() const {
  if (!temperature) return {};
  return {{"temperature", {*temperature}}, {"face temperature", {*temperature}}};
}

void Heat::BoundaryCondition::describe(base::Section& s) {
  s.entry(temperature, "temperature", "K", base::at_least(0),
          "prescribed temperature, with \"Heat\": a value or an expression of x, y, z, t");
  s.entry(heat_flux, "heat flux", "W/m^2", base::any(), "outflow of heat per area and time, with \"Heat\"");
  entry_of_place(
      s, heat_transfer_coefficient, "heat transfer coefficient", "W/(m^2*K)", base::at_least(0),
      "heat transfer coefficient h: the flux is h (T - temperature), with the temperature beyond the boundary");
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

std::unique_ptr<estimate::MeshError> Heat::Estimate::mesh_error(const Setting& setting, assembly::System& system) {
  const auto& [scene, mesh, start] = setting;
  if (!is_in(scene)) return nullptr;
  transport::HybridDiffusionParameters rock;
  rock.initial = scene.heat->initial_temperature;
  fields::Properties<Real> capacity;
  base::collectively(*mesh.comm, [&, &scene = scene, &mesh = mesh] {
    rock.mobility = conductivity_of(scene, mesh);
    capacity = capacity_of_rock(scene, mesh);
  });
  rock.scheme = transport::flux_scheme(scheme_entry(*scene.heat), mesh, rock.mobility).scheme;
  SPREKK_CHECK(rock.scheme == transport::FluxScheme::rt0,
               "{}: the estimate of the error of heat is of triangles and tetrahedra, with the scheme rt0",
               scene.origin);
  if (!is_zero(scene.heat->source)) rock.source = {scene.heat->source};
  transport::BalanceErrorParameters parameters{.field = "temperature",
                                               .flux = "heat flux",
                                               .power = "W*K",
                                               .inflows = "heat_inflows",
                                               .potential = {"temperature", "temperature"},
                                               .flow = {"heat flow", "heat"},
                                               .error = {.flow = {.rock = std::move(rock)}},
                                               .start = start};
  auto& error = parameters.error;
  if (!mesh.fracture_names.empty())
    for (const auto& face : fillings(setting)) {
      error.flow.rock.exchange.push_back(2 * face.conductivity / face.aperture);
      error.flow.transmissivity.push_back(face.aperture * face.conductivity);
    }
  error.flow.constrained = dirichlet_conditions(scene.boundary_conditions, {}, names_of(mesh), "face temperature");
  for (LocalIndex c = 0; system.has_rates() && c < mesh.n_owned_cells; ++c)
    error.storage.push_back(capacity.of_cell(mesh, c));
  if (scene.flow && scene.heat->fluid_capacity.value_or(0) > 0) {
    auto fluid = fluid_flux(setting);
    parameters.carrier = {std::move(fluid.flux), std::move(fluid.conduits), *scene.heat->fluid_capacity};
  }
  return transport::make_balance_error(system, std::move(parameters));
}

std::vector<CarriedQuantity> Heat::Transport::carried(const Scene& scene) {
  if (!scene.heat || !scene.heat->fluid_capacity) return {};
  CarriedQuantity energy{{.field = "temperature",
                          .capacity = *scene.heat->fluid_capacity,
                          .total = "heat",
                          .unit = "W",
                          .in_wells = {},
                          .change = scene.heat->fluid_change()}};
  if (scene.heat->advection == "second order") {
    energy.stored_in_cells = [](const Setting& setting) {
      std::vector<Real> all;
      base::collectively(*setting.mesh.comm, [&] {
        const auto capacity = capacity_of_rock(setting.scene, setting.mesh);
        for (LocalIndex c = 0; c < setting.mesh.n_cells(); ++c) all.push_back(capacity.of_cell(setting.mesh, c));
      });
      return all;
    };
    energy.stored_in_fractures = [](const Setting& setting) {
      std::vector<Real> all;
      for (const auto& face : fillings(setting)) all.push_back(face.capacity);
      return all;
    };
  }
  for (const auto& [name, well] : scene.heat->wells) energy.in_wells.emplace(name, well.temperature);
  for (const auto& [name, condition] : scene.boundary_conditions)
    if (condition.temperature && !condition.fracture)
      energy.prescribed.push_back({condition.boundary, condition.region.value_or("")});
  return {energy};
}

std::string Heat::Transport::friction_power(const Scene& scene) {
  return scene.heat && scene.heat->of_friction ? "face temperature" : "";
}

std::string Heat::Rates::implicit_euler(const Scene& scene) {
  return scene.heat && scene.heat->advection == "second order" ? "Heat > \"advection\" = \"second order\"" : "";
}

void Heat::add_modules(const Setting& setting, Modules& modules) {
  const auto& scene = setting.scene;
  const auto& mesh = setting.mesh;
  if (!is_in(scene)) return;
  const auto& heat = *scene.heat;
  fields::Properties<laws::Mobility> conductivity;
  fields::Properties<transport::Capacity> capacity;
  base::collectively(*mesh.comm, [&] {
    conductivity = conductivity_of(scene, mesh);
    const auto values = capacity_of_rock(scene, mesh);
    capacity.number = values.number;
    for (const Real growth : values.values) capacity.values.push_back({.room = 0, .growth = growth});
  });
  auto given = given_temperatures(scene, mesh);
  for (auto& rate : given_rates(scene, mesh, conductivity)) given.push_back(std::move(rate));
  const auto chosen = transport::flux_scheme(scheme_entry(heat), mesh, conductivity);
  transport::HybridDiffusionParameters conduction{
      .name = "heat conduction",
      .field = "temperature",
      .unit = "K",
      .flux = "heat flux",
      .flux_unit = "W/m^2",
      .outflow = {"heat transfer coefficient", "heat_inflows", mesh.dim() == 2 ? "W/m" : "W"},
      .mobility = std::move(conductivity),
      .scheme = chosen.scheme,
      .reason = chosen.reason,
      .coupled_by = {"displacement", "pressure"}};
  if (!is_zero(heat.source)) conduction.source = {heat.source};
  conduction.initial = heat.initial_temperature;
  conduction.conditions = flux_conditions(
      scene, mesh,
      {&BoundaryCondition::heat_flux, &BoundaryCondition::temperature, &BoundaryCondition::heat_transfer_coefficient});
  conduction.in_regions =
      std::any_of(scene.regions.begin(), scene.regions.end(), [](const auto& r) { return r.second.temperature; });
  std::vector<FractureHeatParameters::Face> faces;
  if (!mesh.fracture_names.empty()) faces = fillings(setting);
  for (const auto& face : faces) conduction.exchange.push_back(2 * face.conductivity / face.aperture);
  modules.push_back(transport::make_hybrid_diffusion(mesh.shape, std::move(conduction)));
  modules.push_back(transport::make_storage({.name = "heat storage",
                                             .field = "temperature",
                                             .capacity = std::move(capacity),
                                             .initial = heat.initial_temperature.value_or(0)}));
  if (!mesh.fracture_names.empty()) add_fractures(setting, faces, chosen.scheme, modules);
  add_storage_in_channels(setting, {.field = "temperature", .initial = heat.initial_temperature.value_or(0)},
                          {0, heat.fluid_capacity.value_or(0)}, modules);
  add_expansion(setting, std::move(given), modules);
}

std::vector<std::string> Heat::warnings(const Setting& setting) {
  const auto& [scene, mesh, start] = setting;
  if (!is_in(scene)) return {};
  std::vector<std::string> all;
  const auto skew = transport::scheme_warning(scheme_entry(*scene.heat), mesh, conductivity_of(scene, mesh));
  if (!skew.empty()) all.push_back(scene.origin + ": " + skew);
  const auto change = scene.heat->fluid_change();
  if (scene.flow && change && change->initial.is_constant() && Mechanics::is_in(scene)) {
    const Real start_temperature = change->initial({}, 0), density = change->response.density(start_temperature).value;
    if (std::abs(density - 1) > 0.01)
      all.push_back(fmt::format(
          "{}: Sprekk > Heat > \"reference temperature\": is {:.6g} K, where the density of the fluid is "
          "{:.3g} times that at the \"initial temperature\", {:.6g} K; pores of rock that deforms press out "
          "fluid of the former: give both the same",
          scene.origin, scene.heat->reference_temperature, 1 / density, start_temperature));
  }
  if (!scene.flow || scene.heat->fluid != "water") return all;
  const Real T = scene.heat->reference_temperature;
  const auto see = [&, &scene = scene](const std::string& entry, Real given, Real of_water, const std::string& unit) {
    if (std::abs(given / of_water - 1) > 0.05)
      all.push_back(
          fmt::format("{}: Sprekk > Flow > \"{}\": is {:.6g} {}, but water has {:.6g} at the \"reference "
                      "temperature\" of Heat, {:.6g} K",
                      scene.origin, entry, given, unit, of_water, T));
  };
  see("density", scene.flow->density, water_density(T), "kg/m^3");
  see("viscosity", scene.flow->viscosity, water_viscosity(T), "Pa*s");
  return all;
}

/// Warns about temperatures below those of rock and water. The value 0 is accepted: it may denote a difference.
std::vector<std::string> Heat::Warnings::of_input(const Setting& setting, const std::vector<Real>&) {
  constexpr Real coldest = 230;
  const auto& scene = setting.scene;
  std::vector<std::string> all;
  const auto see = [&](const std::string& place, const base::Expression& T) {
    if (T.is_constant() && T({}, 0) != 0 && T({}, 0) < coldest)
      all.push_back(implausible(fmt::format("{}: Sprekk > {}", scene.origin, place), fmt::format("is {} K", T.text()),
                                "rock is rarely so cold",
                                "temperatures are in K: add 273.15 to those in degrees Celsius"));
  };
  if (is_in(scene)) for_each_temperature(scene, see);
  return all;
}

namespace {

/// Returns whether a temperature is outside of the water table. Collective.
bool leaves_water(const mesh::Mesh& mesh, const std::vector<assembly::OutputField>& outputs) {
  bool outside = false;
  for (const auto& output : outputs)
    if (output.name == "temperature" || output.name == "fracture temperature")
      outside = outside || !std::all_of(output.values.begin(), output.values.end(), is_water);
  return base::on_any_rank(*mesh.comm, outside);
}

}  // namespace

std::vector<std::string> Heat::Warnings::of_state(const Setting& setting, const std::vector<Real>& times,
                                                  const std::vector<assembly::OutputField>& outputs) {
  const auto& [scene, mesh, start] = setting;
  std::vector<std::string> all;
  if (!is_in(scene)) return all;
  auto given = given_temperatures(scene, mesh);
  if (scene.heat->initial_temperature) given.push_back({.value = *scene.heat->initial_temperature});
  if (const auto warning = overshoot_warning(setting, times, given, outputs); !warning.empty()) all.push_back(warning);
  if (scene.heat->fluid == "water" && leaves_water(mesh, outputs))
    all.push_back(
        fmt::format("{}: Sprekk > Heat > \"fluid\": temperatures leave the range of water, {} to {} K; beyond this "
                    "range density and viscosity are constant",
                    scene.origin, coldest_water, warmest_water));
  return all;
}

std::vector<std::string> Heat::Change::refuses_in(const mesh::Mesh& mesh, const Scene& before, const Scene& after) {
  std::vector<std::string> lines;
  if (!is_in(after) || !Mechanics::is_in(before) || !Mechanics::is_in(after)) return lines;
  for (const auto& [name, filled] : changed_rock(mesh, before, after))
    if (!filled && !is_zero(after.material_of(name).thermal_expansion))
      lines.push_back(fmt::format(
          "the rock of \"{}\" gets other elastic constants, and its thermal stress counts from the start", name));
  return lines;
}

}  // namespace sprekk::physics
