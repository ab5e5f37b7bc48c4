#include "physics/tracer/tracer.hpp"

#include "base/entry_of_place.hpp"
#include "base/over_ranks.hpp"
#include "mesh/extents.hpp"
#include "physics/comparison.hpp"
#include "physics/flow/fluid_flux.hpp"
#include "physics/tracer/dispersion.hpp"
#include "physics/tracer/fracture_tracer.hpp"
#include "physics/tracer/rock_tracer.hpp"
#include "transport/balance_error.hpp"
#include "transport/hybrid_diffusion.hpp"
#include "transport/storage.hpp"
#include "transport/tensor_entry.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sprekk::physics {

namespace {

constexpr const char *retardation_name = "retardation factor", *rock_diffusion_name = "effective diffusion coefficient",
                     *filling_diffusion_name = "diffusion coefficient";

transport::SchemeEntry scheme_entry(const TracerSection& tracer) {
  return {.section = "Tracer", .name = tracer.scheme, .property = rock_diffusion_name};
}

fields::Properties<laws::Mobility> diffusion_of(const Scene& scene, const mesh::Mesh& mesh) {
  return by_cell(
      scene, mesh, [](const Material& rock) { return rock.diffuses_uniformly(); },
      [&](const Material& rock, const auto& x) { return rock.diffusion(mesh.dim(), x); });
}

/// R porosity: mass stored per volume of rock and unit of concentration.
fields::Properties<Real> capacity_of(const Scene& scene, const mesh::Mesh& mesh) {
  return by_cell(
      scene, mesh, [](const Material& rock) { return rock.porosity.is_constant() && rock.retardation.is_constant(); },
      [](const Material& rock, const auto& x) {
        return value_at("porosity", rock.porosity, base::positive(), x) *
               value_at(retardation_name, rock.retardation, base::at_least(1), x);
      });
}

std::vector<Real> capacity_of_cells(const Setting& setting, LocalIndex n) {
  std::vector<Real> all;
  base::collectively(*setting.mesh.comm, [&] {
    const auto capacity = capacity_of(setting.scene, setting.mesh);
    for (LocalIndex c = 0; c < n; ++c) all.push_back(capacity.of_cell(setting.mesh, c));
  });
  return all;
}

/// Data of local fracture faces. Collective.
std::vector<FractureTracerParameters::Face> tracer_fillings(const Setting& setting) {
  const auto& [scene, mesh, start] = setting;
  if (mesh.fracture_names.empty()) return {};
  const auto apertures = start_apertures(setting);
  const Real minimum = 1e-9 * mesh::largest_extent(mesh);  // ridges of closed fractures then have a balance
  std::vector<FractureTracerParameters::Face> faces;
  base::collectively(*mesh.comm, [&, &scene = scene, &mesh = mesh] {
    for (std::size_t f = 0; f < apertures.size(); ++f) {
      const auto& x = mesh.fracture_faces[f].centre;
      const auto& joint = joint_of(scene, mesh, mesh.fracture_faces[f].single);
      faces.push_back(at_place(scene, joint, [&]() -> FractureTracerParameters::Face {
        return {.aperture = apertures[f].value,
                .minimum = std::max(minimum, apertures[f].minimum),
                .diffusion = value_at(filling_diffusion_name, joint.filling_diffusion, base::positive(), x),
                .retardation = value_at(retardation_name, joint.filling_retardation, base::at_least(1), x)};
      }));
    }
  });
  return faces;
}

/// Appends the exchange between rock and fractures, D/(a/2) on each side, m/s.
void add_exchange(const std::vector<FractureTracerParameters::Face>& faces, std::vector<Real>& exchange) {
  for (const auto& face : faces) exchange.push_back(2 * face.diffusion / face.at_start());
}

void add_dispersion(const Setting& setting, Modules& modules) {
  const auto& [scene, mesh, start] = setting;
  if (!scene.flow || !has_dispersivity(scene)) return;
  DispersionParameters parameters;
  base::collectively(*mesh.comm, [&, &scene = scene, &mesh = mesh] {
    parameters.mobility = mobility(scene, mesh);
    parameters.of_rock = by_cell(
        scene, mesh, [](const Material&) { return true; },
        [](const Material& rock, const auto&) { return rock.dispersivity; });
  });
  for (std::size_t i = 0; i < scene.bulk.gravity.size(); ++i)
    parameters.weight[i] = scene.flow->density * scene.bulk.gravity[i];
  if (!mesh.fracture_names.empty()) {
    const auto apertures = start_apertures(setting);
    base::collectively(*mesh.comm, [&, &scene = scene, &mesh = mesh] {
      for (std::size_t f = 0; f < apertures.size(); ++f) {
        const auto& x = mesh.fracture_faces[f].centre;
        const auto& joint = joint_of(scene, mesh, mesh.fracture_faces[f].single);
        const auto& k = joint.tangential_permeability;
        const laws::Conduit conduit{apertures[f].value, apertures[f].minimum, k ? (*k)(x, 0) : 0, scene.flow->viscosity,
                                    joint.walls(x)};
        parameters.transmissivity.push_back(conduit.transmissivity());
        parameters.of_fractures.push_back(joint.filling_dispersivity);
      }
    });
  }
  modules.push_back(make_dispersion(mesh.shape, std::move(parameters)));
}

}  // namespace

void WellConcentration::describe(base::Section& s) {
  s.required(concentration, "concentration", "kg/m^3", base::at_least(0),
             "concentration of the injected fluid, a value or an expression of t");
}

void TracerSection::describe(base::Section& s) {
  s.entry(source, "source", "kg/(m^3*s)", base::any(),
          "tracer mass per volume of rock and time, a value or an expression of x, y, z, t");
  entry_of_place(s, initial_concentration, "initial concentration", "kg/m^3", base::at_least(0),
                 "initial concentration, mass per volume of fluid; a value or an expression of x, y, z");
  s.entry(half_life, "half life", "s", base::positive(), "half life of the tracer; absent: no decay");
  s.choice(scheme, "scheme", {"auto", "rt0", "tpfa", "mimetic"},
           "flux scheme of diffusion; rt0: mixed elements (Raviart and Thomas 1977); tpfa: two-point flux "
           "approximation; mimetic: mimetic differences; auto: rt0 on simplices, on other cells tpfa if diffusion and "
           "cells are orthogonal, else mimetic");
  s.choice(advection, "advection", {"upwind", "second order"},
           "advection scheme between cells and along fractures; upwind: first order; second order: limited corrections "
           "once per step, with implicit Euler, for steps in which the fluid crosses at most about half a cell");
  s.named_sections(
      wells, "Wells",
      "injected concentrations by the names of wells of \"Flow\"; other wells inject the local concentration");
}

Real TracerSection::decay() const { return half_life ? std::log(2.0) / *half_life : 0; }

void Dispersivity::describe(base::Section& s) {
  s.entry(along, "longitudinal dispersivity", "m", base::at_least(0),
          "dispersivity alpha_L along the flow: dispersion alpha_L |q| with the Darcy velocity q; needs \"Flow\"");
  s.entry(across, "transverse dispersivity", "m", base::at_least(0),
          "dispersivity alpha_T across the flow: dispersion alpha_T |q| with the Darcy velocity q; needs \"Flow\"");
}

void Tracer::Sections::describe(base::Section& s) {
  s.section(tracer, "Tracer",
            "a dissolved tracer in rock and fractures: diffusion, sorption, decay, and advection by the fluid");
}

void Tracer::Rock::describe(base::Section& s) {
  entry_of_place(
      s, effective_diffusion, rock_diffusion_name, "m^2/s", base::any(),
      "diffusion coefficient D_e of the rock, that of the pore fluid times porosity and tortuosity, required "
      "with \"Tracer\": one value; XX, YY[, ZZ]; or XX, YY, XY in 2D, XX, YY, ZZ, XY, YZ, XZ in 3D; typical: "
      "1e-14 (granite) to 1e-11 (clay)");
  entry_of_place(s, retardation, retardation_name, "-", base::at_least(1),
                 "retardation factor R of the rock with \"Tracer\": dissolved and sorbed mass divided by the dissolved "
                 "mass; 1: no sorption");
  dispersivity.describe(s);
}

void Tracer::Joint::describe(base::Section& s) {
  entry_of_place(s, filling_diffusion, filling_diffusion_name, "m^2/s", base::positive(),
                 "diffusion coefficient of the fracture filling with \"Tracer\", along and across the fracture; the "
                 "default is that of ions in water");
  entry_of_place(s, filling_retardation, retardation_name, "-", base::at_least(1),
                 "retardation factor R of the fracture with \"Tracer\": dissolved mass and mass sorbed on the sides, "
                 "divided by the dissolved mass, at the initial aperture");
  filling_dispersivity.describe(s);
}

bool Tracer::Rock::diffuses_uniformly() const { return transport::is_uniform_tensor(effective_diffusion); }

laws::Mobility Tracer::Rock::diffusion(int dim, const std::array<Real, 3>& x) const {
  return transport::tensor_at(rock_diffusion_name, effective_diffusion, dim, x);
}

void Tracer::BoundaryCondition::describe(base::Section& s) {
  s.entry(concentration, "concentration", "kg/m^3", base::at_least(0),
          "prescribed concentration, with \"Tracer\": a value or an expression of x, y, z, t");
  s.entry(tracer_flux, "tracer flux", "kg/(m^2*s)", base::any(),
          "outflow of tracer by diffusion per area and time, with \"Tracer\"");
  entry_of_place(s, tracer_transfer, "tracer transfer coefficient", "m/s", base::at_least(0),
                 "coefficient h: the diffusive flux is h (c - concentration), with the concentration beyond the "
                 "boundary; with h equal to the inflow of fluid per area, the total inflow is that of this "
                 "concentration");
}

void Tracer::BoundaryCondition::check(base::Section& s) const {
  if (tracer_transfer && !concentration)
    s.fail("tracer transfer coefficient", "needs a \"concentration\" beyond the boundary");
  if (concentration && tracer_flux) s.fail("give either \"concentration\" or \"tracer flux\"");
}

std::vector<Prescribed> Tracer::BoundaryCondition::prescribed() const {
  if (!concentration || tracer_transfer) return {};
  return {{"face concentration", {*concentration}}};
}

bool Tracer::is_in(const Scene& scene) { return scene.tracer.has_value(); }

bool has_dispersivity(const Scene& scene) {
  return std::any_of(scene.materials.begin(), scene.materials.end(), [](const auto& named) {
    return named.second.dispersivity.is_any() || named.second.filling_dispersivity.is_any();
  });
}

std::vector<CarriedQuantity> Tracer::Transport::carried(const Scene& scene) {
  if (!is_in(scene)) return {};
  CarriedQuantity mass{
      {.field = "concentration", .capacity = 1, .total = "tracer", .unit = "kg/s", .in_wells = {}, .change = {}}};
  if (scene.tracer->advection == "second order") {
    mass.stored_in_cells = [](const Setting& setting) { return capacity_of_cells(setting, setting.mesh.n_cells()); };
    mass.stored_in_fractures = [](const Setting& setting) {
      std::vector<Real> all;
      for (const auto& face : tracer_fillings(setting)) all.push_back(face.retardation);
      return all;
    };
  }
  for (const auto& [name, well] : scene.tracer->wells) mass.in_wells.emplace(name, well.concentration);
  for (const auto& [name, condition] : scene.boundary_conditions)
    if (condition.concentration && !condition.fracture)
      mass.prescribed.push_back({condition.boundary, condition.region.value_or("")});
  return {mass};
}

std::string Tracer::Rates::implicit_euler(const Scene& scene) {
  return is_in(scene) && scene.tracer->advection == "second order" ? "Tracer > \"advection\" = \"second order\"" : "";
}

void Tracer::add_modules(const Setting& setting, Modules& modules) {
  const auto& scene = setting.scene;
  const auto& mesh = setting.mesh;
  if (!is_in(scene)) return;
  const auto& tracer = *scene.tracer;
  fields::Properties<laws::Mobility> of_rock;
  fields::Properties<Real> capacity;
  base::collectively(*mesh.comm, [&] {
    of_rock = diffusion_of(scene, mesh);
    capacity = capacity_of(scene, mesh);
  });
  const auto chosen = transport::flux_scheme(scheme_entry(tracer), mesh, of_rock);
  transport::HybridDiffusionParameters diffusion{
      .name = "tracer diffusion",
      .field = "concentration",
      .unit = "kg/m^3",
      .flux = "tracer flux",
      .flux_unit = "kg/(m^2*s)",
      .outflow = {"tracer transfer coefficient", "tracer_inflows", mesh.dim() == 2 ? "kg/(m*s)" : "kg/s"},
      .mobility = std::move(of_rock),
      .scheme = chosen.scheme,
      .reason = chosen.reason,
      .initial = tracer.initial_concentration,
      .conditions = flux_conditions(
          scene, mesh,
          {&BoundaryCondition::tracer_flux, &BoundaryCondition::concentration, &BoundaryCondition::tracer_transfer}),
      .coupled_by = {"pressure"}};
  if (!is_zero(tracer.source)) diffusion.source = {tracer.source};
  const auto faces = tracer_fillings(setting);
  add_exchange(faces, diffusion.exchange);
  modules.push_back(transport::make_hybrid_diffusion(mesh.shape, std::move(diffusion)));
  fields::Properties<transport::Capacity> stored{.values = {}, .number = capacity.number};
  for (const Real growth : capacity.values) stored.values.push_back({.room = 0, .growth = growth});
  modules.push_back(transport::make_storage({.name = "tracer storage",
                                             .field = "concentration",
                                             .capacity = std::move(stored),
                                             .initial = tracer.initial_concentration}));
  modules.push_back(make_rock_tracer(capacity_of_cells(setting, mesh.n_cells()), tracer.decay()));
  add_dispersion(setting, modules);
  add_storage_in_channels(setting, {.field = "concentration", .initial = tracer.initial_concentration}, {0, 1},
                          modules);
  if (faces.empty() && mesh.fracture_names.empty()) return;
  FractureTracerParameters fractures{.faces = faces,
                                     .scheme = chosen.scheme,
                                     .initial = tracer.initial_concentration,
                                     .decay = tracer.decay(),
                                     .widens = Mechanics::is_in(scene) && has_unknown_pressure(scene)};
  if (scene.flow) {
    fractures.fluid = {scene.flow->compressibility, scene.flow->reference_pressure};
    fractures.initial_pressure = scene.flow->initial_pressure;
  }
  modules.push_back(make_fracture_tracer(mesh.shape, std::move(fractures)));
}

std::vector<std::string> Tracer::warnings(const Setting& setting) {
  const auto& [scene, mesh, start] = setting;
  if (!is_in(scene)) return {};
  const auto skew = transport::scheme_warning(scheme_entry(*scene.tracer), mesh, diffusion_of(scene, mesh));
  return skew.empty() ? std::vector<std::string>() : std::vector{scene.origin + ": " + skew};
}

std::unique_ptr<estimate::MeshError> Tracer::Estimate::mesh_error(const Setting& setting, assembly::System& system) {
  const auto& [scene, mesh, start] = setting;
  if (!is_in(scene)) return nullptr;
  transport::HybridDiffusionParameters rock;
  rock.initial = scene.tracer->initial_concentration;
  base::collectively(*mesh.comm, [&, &scene = scene, &mesh = mesh] { rock.mobility = diffusion_of(scene, mesh); });
  rock.scheme = transport::flux_scheme(scheme_entry(*scene.tracer), mesh, rock.mobility).scheme;
  SPREKK_CHECK(rock.scheme == transport::FluxScheme::rt0,
               "{}: the estimate of the error of a tracer is of triangles and tetrahedra, with the scheme rt0",
               scene.origin);
  if (!is_zero(scene.tracer->source)) rock.source = {scene.tracer->source};
  transport::BalanceErrorParameters parameters{.field = "concentration",
                                               .flux = "tracer flux",
                                               .power = "kg^2/(m^3*s)",
                                               .inflows = "tracer_inflows",
                                               .potential = {"concentration", "concentration"},
                                               .flow = {"tracer flow", "tracer"},
                                               .error = {.flow = {.rock = std::move(rock)}},
                                               .start = start};
  auto& error = parameters.error;
  const auto faces = tracer_fillings(setting);
  add_exchange(faces, error.flow.rock.exchange);
  for (const auto& face : faces) error.flow.transmissivity.push_back(face.at_start() * face.diffusion);
  error.flow.constrained = dirichlet_conditions(scene.boundary_conditions, {}, names_of(mesh), "face concentration");
  if (system.has_rates()) error.storage = capacity_of_cells(setting, mesh.n_owned_cells);
  if (scene.flow) {
    auto fluid = fluid_flux(setting);
    parameters.carrier = {std::move(fluid.flux), std::move(fluid.conduits), 1};
  }
  return transport::make_balance_error(system, std::move(parameters));
}

}  // namespace sprekk::physics
