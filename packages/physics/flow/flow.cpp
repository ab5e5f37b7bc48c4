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
#include "physics/mechanics/mechanics.hpp"
#include "physics/poroelasticity/poroelasticity.hpp"
#include "physics/scene.hpp"
#include "transport/advection.hpp"
#include "transport/balance_error.hpp"
#include "transport/fracture_flow.hpp"
#include "transport/hybrid_diffusion.hpp"
#include "transport/intersection_flow.hpp"
#include "transport/storage.hpp"
#include "transport/well_connections.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace sprekk::physics {

namespace {

std::vector<transport::FluxCondition> fluid_conditions(const Scene& scene, const mesh::Mesh& mesh, bool of_fractures) {
  return flux_conditions(scene, mesh,
                         {&BoundaryCondition::flux, &BoundaryCondition::pressure, &BoundaryCondition::conductance},
                         of_fractures);
}

std::vector<transport::Well> wells_in(const Scene& scene, int dim) {
  std::vector<transport::Well> wells;
  for (const auto& [name, one] : scene.flow->wells) {
    wells.push_back({.name = name,
                     .points = {},
                     .radius = one.radius,
                     .skin = one.skin,
                     .rate = one.rate,
                     .pressure = one.pressure});
    for (std::size_t k = 0; k < one.points.size(); k += dim)
      std::copy_n(&one.points[k], dim, wells.back().points.emplace_back().begin());
  }
  return wells;
}

transport::Channel channel_of(const IntersectionSection& section, const Scene& scene, const mesh::Mesh& mesh) {
  transport::Channel channel{.conductance = section.conductance(scene.flow->viscosity)};
  for (const auto& name : section.fractures) channel.fractures.push_back(base::index_of(mesh.fracture_names, name));
  std::sort(channel.fractures.begin(), channel.fractures.end());
  return channel;
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

/// Adds the flow in channels, and the transport by it. Collective.
void add_intersections(const Setting& setting, const transport::HybridDiffusionParameters& darcy,
                       const std::vector<CarriedQuantity>& all_carried, Modules& modules) {
  if (setting.scene.flow->intersections.empty()) return;
  const auto parameters = intersection_flow(setting, darcy);
  modules.push_back(transport::make_intersection_flow(setting.mesh, parameters));
  for (const auto& carried : all_carried)
    modules.push_back(transport::make_intersection_advection(setting.mesh, parameters, carried));
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

namespace {

/// Warns about joints that a compression of 1e-3 of Young's modulus closes by more than their initial aperture.
void add_closure_warnings(const Setting& setting, std::vector<std::string>& warnings) {
  const auto& [scene, mesh, start] = setting;
  if (!Mechanics::is_in(scene)) return;
  Real modulus = 0;
  for (const auto& rock : elasticity(scene, mesh).values) modulus = std::max(modulus, rock.youngs_modulus());
  const Real compression = 1e-3 * base::max_over_ranks(*mesh.comm, modulus), zero = 0;
  std::set<std::string> seen;
  for (std::size_t k = 0; k < mesh.single_fractures.size(); ++k) {
    const auto& joint = joint_of(scene, mesh, static_cast<int>(k));
    if (!joint.is_uniform() || joint.is_in_situ()) continue;
    const auto law = joint.joint({}).law;
    const Real aperture = joint.initial_aperture({}, 0),
               closure = -law.closure(laws::Contact<Real>{.lambda_n = -compression, .history = {&zero, 0}});
    if (aperture == 0 || !(closure > aperture) || !seen.insert(fmt::format("{} {}", closure, aperture)).second)
      continue;
    const bool residual = !is_zero(joint.residual_aperture);
    warnings.push_back(fmt::format(
        "{}: fracture \"{}\": a compression of {:.3g} Pa closes the joint by {:.3g} m, more than its \"initial "
        "aperture\" "
        "{:.3g} m; {}",
        scene.origin, mesh.single_fractures[k].name, compression, closure, aperture,
        residual ? "the fluid then has the \"residual aperture\"" : "the fluid in it then bears the compression"));
  }
}

/// Warns about wells near a fracture in 2D, where rounded coordinates may be the cause.
void add_well_warnings(const Setting& setting, std::vector<std::string>& warnings) {
  const auto& [scene, mesh, start] = setting;
  const auto wells = wells_in(scene, mesh.dim());
  for (const auto& [w, single, distance] : transport::wells_near_fractures(mesh, wells))
    warnings.push_back(implausible(
        fmt::format("{}: Sprekk > Flow > Wells > {} > \"points\"", scene.origin, wells[w].name),
        fmt::format("({:.10g}, {:.10g}) is {:.3g} m beside the fracture \"{}\", less than half of a face",
                    wells[w].points[0][0], wells[w].points[0][1], distance, mesh.single_fractures[single].name),
        "the well is connected to the rock only", "if it should be on the fracture, give a point of the fracture"));
}

/// Warns about channels without an intersection. Collective.
void add_channel_warnings(const Setting& setting, std::vector<std::string>& warnings) {
  const auto& [scene, mesh, start] = setting;
  for (const auto& [name, one] : scene.flow->intersections)
    if (transport::length_of(channel_of(one, scene, mesh), mesh) == 0)
      warnings.push_back(implausible(fmt::format("{}: Sprekk > Flow > Intersections > {}", scene.origin, name),
                                     one.fractures.empty() ? "no fractures meet" : "its \"fractures\" do not meet",
                                     "the channel has no effect", "remove it, or name fractures that intersect"));
}

}  // namespace

std::vector<std::string> Flow::warnings(const Setting& setting) {
  const auto& [scene, mesh, start] = setting;
  if (!is_in(scene)) return {};
  std::vector<std::string> all;
  if (flows_in_rock(scene))
    if (const auto skew = transport::scheme_warning(scheme_entry(scene), mesh, mobility(scene, mesh)); !skew.empty())
      all.push_back(scene.origin + ": " + skew);
  add_closure_warnings(setting, all);
  add_well_warnings(setting, all);
  add_channel_warnings(setting, all);
  return all;
}

/// Warns about wells that inject more than 1 % of the volume of the rock without an outlet.
std::vector<std::string> Flow::Warnings::of_input(const Setting& setting, const std::vector<Real>& times) {
  const auto& [scene, mesh, start] = setting;
  if (!is_in(scene) || !Mechanics::is_in(scene)) return {};
  const auto wells = wells_in(scene, mesh.dim());
  bool closed = std::all_of(wells.begin(), wells.end(), [](const auto& well) { return well.rate.has_value(); });
  for (const auto& [name, one] : scene.boundary_conditions) closed = closed && !one.pressure && !one.flux;
  for (const auto& [name, one] : scene.regions) closed = closed && !one.pressure;
  for (const auto& [name, one] : scene.fractures) closed = closed && one.held_pressures.empty();
  const auto volumes = assembly::cell_volumes(mesh);
  const Real rock =
      base::sum_over_ranks(*mesh.comm, std::accumulate(volumes.begin(), volumes.begin() + mesh.n_owned_cells, Real(0)));
  Real injected = 0, end = start;
  for (auto t = times.begin(); closed && t != times.end() && injected <= 0.01 * rock; end = *t++)
    for (const auto& well : wells) injected += (*t - end) * (*well.rate)(well.points[0], *t);
  if (injected <= 0.01 * rock) return {};
  return {implausible(
      scene.origin + ": Sprekk > Flow > Wells",
      fmt::format("{:.3g} {} of fluid enter until t = {:.4g} s, {:.3g} % of the volume of the rock, and none leave",
                  injected, mesh.dim() == 2 ? "m^2" : "m^3", end, 100 * injected / rock),
      "the fluid opens fractures or expands the rock by this volume, and an equilibrium need not exist",
      "check rates and units, or give a pressure at a boundary")};
}

std::vector<std::string> Flow::Warnings::of_state(const Setting& setting, const std::vector<Real>&,
                                                  const std::vector<assembly::OutputField>& outputs) {
  const auto& [scene, mesh, start] = setting;
  if (!is_in(scene)) return {};
  std::array<Real, 2> here{};  // largest value of -p, and of |p|
  for (const auto& output : outputs)
    for (const Real p : output.values)
      if (output.name == "pressure" || output.name == "fracture pressure") {
        here[0] = std::max(here[0], -p);
        here[1] = std::max(here[1], std::abs(p));
      }
  const auto all = base::max_over_ranks(*mesh.comm, here);
  if (all[0] <= 1e-9 * all[1]) return {};
  return {
      fmt::format("{}: the pressure of the fluid is below 0 in places; if it is an absolute pressure, a real fluid "
                  "boils or cavitates there; if it is relative to another pressure, ignore this warning",
                  scene.origin)};
}

}  // namespace sprekk::physics
