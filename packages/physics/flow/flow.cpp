#include "physics/flow/flow.hpp"

#include "assembly/geometry.hpp"
#include "base/check.hpp"
#include "base/names.hpp"
#include "base/over_ranks.hpp"
#include "laws/joint_parameters.hpp"
#include "mesh/extents.hpp"
#include "mesh/facets.hpp"
#include "physics/comparison.hpp"
#include "physics/flow/fluid_flux.hpp"
#include "physics/flow/hydraulics.hpp"
#include "physics/flow/wells_and_channels.hpp"
#include "physics/mechanics/mechanics.hpp"
#include "physics/poroelasticity/poroelasticity.hpp"
#include "physics/scene.hpp"
#include "transport/advection.hpp"
#include "transport/balance_error.hpp"
#include "transport/fracture_flow.hpp"
#include "transport/hybrid_diffusion.hpp"
#include "transport/intersection_flow.hpp"
#include "transport/leak_off.hpp"
#include "transport/storage.hpp"
#include "transport/well_connections.hpp"

#include <algorithm>
#include <limits>

namespace sprekk::physics {

namespace {

std::vector<transport::FluxCondition> fluid_conditions(const Scene& scene, const mesh::Mesh& mesh, bool of_fractures) {
  return flux_conditions(scene, mesh,
                         {&BoundaryCondition::flux, &BoundaryCondition::pressure, &BoundaryCondition::conductance},
                         of_fractures);
}

/// Quantities that the fluid transports for all physics of a scene.
std::vector<CarriedQuantity> carried_in(const Scene& scene) {
  std::vector<CarriedQuantity> all;
  for_each_physics([&]<HasTransport P>(P) {
    for (auto& one : P::Transport::carried(scene)) all.push_back(one);
  });
  return all;
}

transport::HybridDiffusionParameters darcy_flow(const Scene& scene, const mesh::Mesh& mesh,
                                                const std::optional<transport::FluidChange>& change) {
  const auto& flow = *scene.flow;
  transport::HybridDiffusionParameters darcy{.name = "Darcy flow",
                                             .field = "pressure",
                                             .unit = "Pa",
                                             .flux = "Darcy velocity",
                                             .flux_unit = "m/s",
                                             .outflow = {"conductance", "inflows", mesh.dim() == 2 ? "m^2/s" : "m^3/s"},
                                             .fluid = {flow.compressibility, flow.reference_pressure},
                                             .change = change,
                                             .conditions = fluid_conditions(scene, mesh, false),
                                             .coupled_by = {"displacement"}};
  const fields::Properties<laws::Mobility> isotropic{
      std::vector<laws::Mobility>(mesh.region_names.size(), laws::Mobility::isotropic(1))};
  if (flows_in_rock(scene)) base::collectively(*mesh.comm, [&] { darcy.mobility = mobility(scene, mesh); });
  const auto chosen =
      transport::flux_scheme(scheme_entry(scene), mesh, flows_in_rock(scene) ? darcy.mobility : isotropic);
  darcy.scheme = chosen.scheme;
  darcy.reason = chosen.reason;
  darcy.in_regions =
      std::any_of(scene.regions.begin(), scene.regions.end(), [](const auto& r) { return r.second.pressure; });
  for (std::size_t i = 0; i < scene.bulk.gravity.size(); ++i) darcy.weight[i] = flow.density * scene.bulk.gravity[i];
  if (!is_zero(flow.source)) darcy.source = {flow.source};
  if (Flow::has_initial_state(scene)) darcy.initial = flow.initial_pressure;
  return darcy;
}

/// Scheme along fractures. By default it is mixed on all cells, since apertures vary over a few faces.
transport::FluxScheme scheme_in_fractures(const Scene& scene, transport::FluxScheme in_rock) {
  const bool is_chosen = scheme_entry(scene).name == "auto" && in_rock == transport::FluxScheme::tpfa;
  return is_chosen ? transport::FluxScheme::mimetic : in_rock;
}

transport::FractureFlowParameters fracture_flow(const Scene& scene, const mesh::Mesh& mesh,
                                                const transport::HybridDiffusionParameters& darcy) {
  transport::FractureFlowParameters fractures{.scheme = scheme_in_fractures(scene, darcy.scheme),
                                              .fluid = darcy.fluid,
                                              .change = darcy.change,
                                              .weight = darcy.weight,
                                              .outflow = darcy.outflow,
                                              .conditions = fluid_conditions(scene, mesh, true)};
  if (Mechanics::is_in(scene)) fractures.softness = mesh::largest_extent(mesh) / largest_modulus(scene, mesh);
  if (!flows_in_rock(scene)) {
    fractures.alone = {.initial = darcy.initial};
    if (Mechanics::is_in(scene)) fractures.alone->row = {{"displacement", mesh::typical_face_area(mesh), true}};
  }
  fractures.cut_by.resize(mesh.fracture_names.size());
  for (std::size_t k = 0; k < mesh.fracture_names.size(); ++k) {
    const auto& fracture = scene.fractures.at(mesh.fracture_names[k]);
    fractures.source.push_back(fracture.source);
    for (const auto& name : fracture.cuts)
      fractures.cut_by[base::index_of(mesh.fracture_names, name)].push_back(static_cast<int>(k));
  }
  return fractures;
}

transport::IntersectionFlowParameters intersection_flow(const Setting& setting,
                                                        const transport::HybridDiffusionParameters& darcy) {
  const auto& [scene, mesh, start] = setting;
  transport::IntersectionFlowParameters parameters{
      .channels = {},
      .constrained = dirichlet_conditions(scene.boundary_conditions, {}, names_of(mesh), "face pressure"),
      .fluid = darcy.fluid,
      .change = darcy.change,
      .weight = darcy.weight};
  for (const auto& [name, one] : scene.flow->intersections) parameters.channels.push_back(channel_of(one, scene, mesh));
  return parameters;
}

/// Adds flow and storage of the fluid in channels, and the transport by this flow. Collective.
void add_intersections(const Setting& setting, const transport::HybridDiffusionParameters& darcy,
                       const std::vector<CarriedQuantity>& all_carried, Modules& modules) {
  if (setting.scene.flow->intersections.empty()) return;
  const auto parameters = intersection_flow(setting, darcy);
  modules.push_back(transport::make_intersection_flow(setting.mesh, parameters));
  for (const auto& carried : all_carried)
    modules.push_back(transport::make_intersection_advection(setting.mesh, parameters, carried));
  if (darcy.fluid.compressibility > 0 || darcy.change)
    add_storage_in_channels(setting,
                            {.field = "pressure",
                             .amount = "m^3",
                             .fluid = darcy.fluid,
                             .initial = setting.scene.flow->initial_pressure,
                             .change = darcy.change},
                            {1, 0}, modules);
}

/// Storage capacities of the pores in local cells. Collective.
fields::Properties<transport::Capacity> capacities(const Setting& setting, Real of_fluid) {
  fields::Properties<transport::Capacity> result;
  base::collectively(*setting.mesh.comm, [&] {
    result = by_cell(
        setting.scene, setting.mesh, [](const Material& rock) { return rock.porosity.is_constant(); },
        [&](const Material& rock, const auto& x) { return rock.capacity(of_fluid, x); });
  });
  return result;
}

/// Parameters of the modules and of the error estimate.
struct Parts {
  transport::HybridDiffusionParameters darcy;
  transport::FractureFlowParameters fractures;
  transport::WellsParameters wells;
};

/// Collects the parameters. Collective.
Parts parts_of(const Setting& setting, const std::vector<CarriedQuantity>& all_carried) {
  const auto& [scene, mesh, start] = setting;
  std::optional<transport::FluidChange> change;
  for (const auto& carried : all_carried)
    if (carried.change) change = carried.change;
  Parts parts{darcy_flow(scene, mesh, change), {}, {}};
  auto& [darcy, fractures, wells] = parts;
  fractures = fracture_flow(scene, mesh, darcy);
  fractures.faces = hydraulics(setting);
  wells = {.wells = wells_in(scene, mesh.dim()),
           .mobility = darcy.mobility,
           .scheme = darcy.scheme,
           .in_fractures = fractures.scheme,
           .fluid = darcy.fluid,
           .weight = darcy.weight,
           .carried = {all_carried.begin(), all_carried.end()}};
  for (const auto& face : fractures.faces) {
    darcy.exchange.push_back(face.exchange);
    wells.faces.push_back(face.along);
  }
  return parts;
}

}  // namespace

bool Flow::is_in(const Scene& scene) { return scene.flow.has_value(); }

bool has_fluid(const Scene& scene) { return scene.flow || scene.host_fluid; }

bool has_unknown_pressure(const Scene& scene) { return scene.flow || (scene.host_fluid && scene.host_fluid->unknown); }

bool flows_in_rock(const Scene& scene) {
  const auto is_impermeable = [&](const std::string& name) {
    const auto rock = scene.materials.find(name);
    return rock != scene.materials.end() && rock->second.is_impermeable();
  };
  return !scene.flow || !(is_impermeable(scene.bulk.material) ||
                          std::any_of(scene.regions.begin(), scene.regions.end(), [&](const auto& region) {
                            return region.second.material && is_impermeable(*region.second.material);
                          }));
}

Facets Flow::needs_facets(const Scene& scene) {
  if (!has_unknown_pressure(scene)) return Facets::none;
  return flows_in_rock(scene) ? Facets::all : Facets::of_fractures;
}

bool Flow::Rates::exist(const Scene& scene) { return has_fluid(scene); }

bool Flow::has_initial_state(const Scene& scene) {
  if (!is_in(scene) || Mechanics::is_in(scene)) return true;
  const Real of_fluid = scene.flow->compressibility;
  return of_fluid > 0 || std::any_of(scene.materials.begin(), scene.materials.end(),
                                     [&](const auto& one) { return one.second.may_store(of_fluid); });
}

base::Expression initial_pressure(const Scene& scene) {
  return scene.flow ? scene.flow->initial_pressure
                    : base::Expression(scene.host_fluid ? scene.host_fluid->initial_pressure : 0);
}

fields::Properties<laws::Mobility> mobility(const Scene& scene, const mesh::Mesh& mesh) {
  return by_cell(
      scene, mesh, [](const Material& rock) { return rock.flows_uniformly(); },
      [&](const Material& rock, const auto& x) { return rock.mobility(mesh.dim(), scene.flow->viscosity, x); });
}

void add_storage_in_channels(const Setting& setting, const transport::StorageParameters& parameters,
                             const transport::Capacity& of_fluid, Modules& modules) {
  const auto& [scene, mesh, start] = setting;
  std::vector<transport::Channel> channels;
  if (scene.flow)
    for (const auto& [name, one] : scene.flow->intersections) channels.push_back(channel_of(one, scene, mesh));
  if (channels.empty()) return;
  modules.push_back(transport::make_edge_storage(parameters, transport::stored_in(channels, of_fluid, mesh)));
}

transport::SchemeEntry scheme_entry(const Scene& scene) {
  return {.section = "Flow", .name = scene.flow ? scene.flow->scheme : "auto", .property = "permeability"};
}

namespace {

/// Throws an Error for a held pressure without a facet in its box, with the nearest corner of the fracture. Collective.
void check_held_pressures(const Setting& setting) {
  const auto& [scene, mesh, start] = setting;
  using mesh::operator-, mesh::operator+, mesh::operator*;
  for (const auto& condition : dirichlet_conditions({}, {}, names_of(mesh), "face pressure", scene.fractures)) {
    bool any = false;
    assembly::for_each_facet_on_fracture(mesh, condition, [&](LocalIndex, const auto&) { any = true; });
    if (base::on_any_rank(*mesh.comm, any)) continue;
    const auto middle = 0.5 * (mesh::Vector((*condition.within)[0]) + mesh::Vector((*condition.within)[1]));
    mesh::Vector nearest{};
    Real distance = std::numeric_limits<Real>::max();
    for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f)
      for (int k = 0; k < mesh::n_face_corners(mesh.shape) && mesh.fracture_faces[f].fracture == condition.fracture;
           ++k)
        if (const auto x = mesh::face_corner(mesh, f, k); mesh::norm(x - middle) < distance) {
          distance = mesh::norm(x - middle);
          nearest = x;
        }
    const bool is_mine = distance == base::min_over_ranks(*mesh.comm, distance);
    const int rank = base::max_over_ranks(*mesh.comm, is_mine ? mesh.comm->getRank() : -1);
    for (Real& x : nearest) x = base::of_rank(*mesh.comm, rank, x);
    throw Error(fmt::format(
        "{}: Sprekk > {}: the box contains no {} of the fracture; the nearest corner is ({:.9g}, "
        "{:.9g}, {:.9g})",
        scene.origin, condition.name, mesh.dim() == 2 ? "node" : "edge", nearest[0], nearest[1], nearest[2]));
  }
}

/// Adds flow and storage in rock. Collective.
void add_rock(const Setting& setting, transport::HybridDiffusionParameters darcy, Modules& modules) {
  const auto& mesh = setting.mesh;
  transport::StorageParameters storage{.name = "fluid storage",
                                       .field = "pressure",
                                       .amount = "m^3",
                                       .capacity = capacities(setting, darcy.fluid.compressibility),
                                       .fluid = darcy.fluid,
                                       .initial = setting.scene.flow->initial_pressure,
                                       .change = darcy.change};
  const bool denser = darcy.fluid.compressibility > 0 || darcy.change;
  modules.push_back(transport::make_hybrid_diffusion(mesh.shape, std::move(darcy)));
  const bool stores = std::any_of(storage.capacity.values.begin(), storage.capacity.values.end(),
                                  [&](const auto& of) { return of.growth > 0 || (denser && of.room > 0); });
  if (base::on_any_rank(*mesh.comm, stores))  // values are those of local cells
    modules.push_back(transport::make_storage(std::move(storage)));
}

}  // namespace

void Flow::add_modules(const Setting& setting, Modules& modules) {
  const auto& scene = setting.scene;
  const auto& mesh = setting.mesh;
  if (!is_in(scene)) return;
  const auto& flow = *scene.flow;
  const bool deforms = Mechanics::is_in(scene);
  const auto all_carried = carried_in(scene);
  auto [darcy, fractures, wells] = parts_of(setting, all_carried);
  check_held_pressures(setting);
  const auto change = darcy.change;
  transport::FractureStorageParameters in_fractures{
      .fluid = darcy.fluid, .initial = flow.initial_pressure, .widens = deforms, .change = change};
  for (const auto& face : fractures.faces) {
    in_fractures.aperture.push_back(deforms ? face.along.initial_volume() : face.along.mechanical_aperture());
    in_fractures.minimum.push_back(face.along.least_volume());
  }
  if (deforms) base::collectively(*mesh.comm, [&] { in_fractures.share = filling_biot(scene, mesh); });
  const auto fluid = darcy.fluid;
  add_intersections(setting, darcy, all_carried, modules);
  for (const auto& carried : all_carried) {
    const auto stored = [&](const auto& find) { return find ? std::optional(find(setting)) : std::nullopt; };
    modules.push_back(transport::make_advection(mesh.shape, {darcy, stabilisation(scene, mesh)}, carried,
                                                stored(carried.stored_in_cells)));
    if (!mesh.fracture_names.empty())
      modules.push_back(transport::make_fracture_advection(mesh.shape, fractures, carried, deforms,
                                                           stored(carried.stored_in_fractures)));
  }
  if (!flow.wells.empty()) modules.push_back(transport::make_wells(std::move(wells)));
  if (flows_in_rock(scene)) add_rock(setting, std::move(darcy), modules);
  if (mesh.fracture_names.empty()) return;
  const bool denser = fluid.compressibility > 0 || change;
  if (std::any_of(scene.fractures.begin(), scene.fractures.end(),
                  [](auto& one) { return !is_zero(one.second.leak_off); }))
    modules.push_back(transport::make_leak_off(fractures.faces, deforms));
  modules.push_back(transport::make_fracture_flow(mesh.shape, std::move(fractures)));
  if (denser || deforms) modules.push_back(transport::make_fracture_storage(std::move(in_fractures)));
}

FluidFlux fluid_flux(const Setting& setting) {
  auto parts = parts_of(setting, {});
  SPREKK_CHECK(parts.darcy.scheme == transport::FluxScheme::rt0,
               "{}: the estimate of the error of flow is of triangles and tetrahedra, with the scheme rt0",
               setting.scene.origin);
  FluidFlux all{.flux = {.rock = std::move(parts.darcy)}, .conduits = {}, .wells = std::move(parts.wells)};
  for (const auto& face : parts.fractures.faces) {
    all.conduits.push_back(face.along);
    all.flux.transmissivity.push_back(face.along.transmissivity());
  }
  const auto names = names_of(setting.mesh);
  all.flux.constrained = dirichlet_conditions(setting.scene.boundary_conditions, {}, names, "face pressure");
  return all;
}

std::unique_ptr<estimate::MeshError> Flow::Estimate::mesh_error(const Setting& setting, assembly::System& system) {
  if (!is_in(setting.scene)) return nullptr;
  auto [flux, conduits, wells] = fluid_flux(setting);
  const Real of_fluid = flux.rock.fluid.compressibility;
  transport::BalanceErrorParameters parameters{.field = "pressure",
                                               .flux = "flux",
                                               .power = "W",
                                               .inflows = "inflows",
                                               .potential = {"pressure", "pressure"},
                                               .flow = {"flow", "rate"},
                                               .error = {.flow = std::move(flux)},
                                               .start = setting.start,
                                               .conduits = std::move(conduits),
                                               .wells = std::move(wells)};
  const auto capacity = capacities(setting, of_fluid);
  for (LocalIndex c = 0; system.has_rates() && c < setting.mesh.n_owned_cells; ++c) {
    const auto& of = capacity.of_cell(setting.mesh, c);
    parameters.error.storage.push_back(of.growth + of_fluid * of.room);
  }
  return transport::make_balance_error(system, std::move(parameters));
}

std::vector<LogColumn> Flow::Log::columns(const Setting& setting) {
  if (!is_in(setting.scene) || setting.scene.flow->wells.empty()) return {};
  return {{"well [Pa]", "wells", "pressure"}};
}

}  // namespace sprekk::physics
