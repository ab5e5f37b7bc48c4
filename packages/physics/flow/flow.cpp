#include "physics/flow/flow.hpp"

#include "base/check.hpp"
#include "mesh/extents.hpp"
#include "mesh/facets.hpp"
#include "physics/flow/darcy_flow.hpp"
#include "physics/flow/fluid_storage.hpp"
#include "physics/flow/fracture_flow.hpp"
#include "physics/flow/wells.hpp"
#include "physics/mechanics/mechanics.hpp"
#include "physics/ranged_entry.hpp"
#include "physics/scene.hpp"

#include <algorithm>

namespace sprekk::physics {

namespace {

std::vector<FluidCondition> fluid_conditions(const Scene& scene, const mesh::Mesh& mesh, bool of_fractures) {
  std::vector<FluidCondition> conditions;
  for (const auto& [name, one] : scene.boundary_conditions)
    if (one.fracture.has_value() == of_fractures && (one.flux || one.conductance))
      conditions.push_back({index_of(mesh.boundary_names, one.boundary), one.flux ? *one.flux : *one.pressure,
                            one.conductance, one.region ? index_of(mesh.region_names, *one.region) : -1,
                            one.fracture ? index_of(mesh.fracture_names, *one.fracture) : -1});
  return conditions;
}

std::vector<Well> wells(const Scene& scene, int dim) {
  std::vector<Well> wells;
  for (const auto& [name, one] : scene.flow->wells) {
    wells.push_back({name, {}, one.radius, one.skin, one.rate, one.pressure});
    for (std::size_t k = 0; k < one.points.size(); k += dim) {
      std::copy_n(&one.points[k], dim, wells.back().points.emplace_back().begin());
    }
  }
  return wells;
}

/// Of the flow in and through a joint whose sides have moved apart by `opening`, m.
FractureFlowParameters::Face hydraulics(const Material& joint, Real viscosity, Real opening,
                                        const std::array<Real, 3>& x) {
  const auto at = [&](const char* name, const base::Expression& value, bool may_be_zero) {
    RangedEntry(name, value, 0, may_be_zero).check(x);
    return value(x, 0);
  };
  const Real aperture = at("initial aperture", joint.initial_aperture, true),
             residual = at("residual aperture", joint.residual_aperture, true), a = std::max(aperture, residual);
  SPREKK_CHECK(a > 0,
               "the hydraulic aperture is 0 at ({}, {}, {}), must be above 0: give an \"initial aperture\" "
               "or a \"residual aperture\"",
               x[0], x[1], x[2]);
  const auto& given = joint.tangential_permeability;
  const Real k = given ? at("tangential permeability", *given, false) : 0,
             across = at("normal permeability", joint.normal_permeability, false);
  const FractureFlowParameters::Face face{{aperture + opening, residual, k, viscosity}, 2 * across / (a * viscosity)};
  SPREKK_CHECK(face.along.hydraulic_aperture() > 0,
               "the hydraulic aperture is {:.3g} at ({:.6g}, {:.6g}, {:.6g}) under the initial stress, must be above "
               "0: give a \"residual aperture\", or an \"initial aperture\" above the closure",
               face.along.hydraulic_aperture(), x[0], x[1], x[2]);
  return face;
}

/// Of local fracture faces. Collective.
std::vector<FractureFlowParameters::Face> hydraulics(const Setting& setting) {
  const auto& scene = setting.scene;
  const auto& mesh = setting.mesh;
  std::vector<Real> openings(mesh.fracture_faces.size(), 0);
  if (Mechanics::is_in(scene) && !mesh.fracture_names.empty())
    openings = with_ghosts(mesh, fields::Entity::fracture_face, initial_openings(setting));
  std::vector<FractureFlowParameters::Face> faces;
  base::collectively(*mesh.comm, [&] {
    for (std::size_t f = 0; f < openings.size(); ++f) {
      const auto& face = mesh.fracture_faces[f];
      const auto& joint = scene.materials.at(scene.fractures.at(mesh.fracture_names[face.fracture]).material);
      faces.push_back(
          at_place(scene, joint, [&] { return hydraulics(joint, scene.flow->viscosity, openings[f], face.centre); }));
    }
  });
  return faces;
}

DarcyFlowParameters darcy_flow(const Scene& scene, const mesh::Mesh& mesh, const Properties<laws::Mobility>& rock) {
  const auto& flow = *scene.flow;
  DarcyFlowParameters darcy{rock.values, rock.number};
  const auto chosen = flux_scheme("Flow", flow.scheme, mesh, rock.values, rock.number);
  darcy.scheme = chosen.scheme;
  darcy.reason = chosen.reason;
  darcy.in_regions =
      std::any_of(scene.regions.begin(), scene.regions.end(), [](const auto& r) { return r.second.pressure; });
  for (std::size_t i = 0; i < scene.bulk.gravity.size(); ++i) darcy.weight[i] = flow.density * scene.bulk.gravity[i];
  darcy.fluid = {flow.compressibility, flow.reference_pressure};
  if (!is_zero(flow.source)) darcy.source = {flow.source};
  darcy.conditions = fluid_conditions(scene, mesh, false);
  return darcy;
}

FractureFlowParameters fracture_flow(const Scene& scene, const mesh::Mesh& mesh, const DarcyFlowParameters& darcy) {
  FractureFlowParameters fractures{
      {}, {}, {}, darcy.scheme, darcy.fluid, darcy.weight, fluid_conditions(scene, mesh, true)};
  if (Mechanics::is_in(scene)) fractures.softness = mesh::largest_extent(mesh) / largest_modulus(scene, mesh);
  fractures.cut_by.resize(mesh.fracture_names.size());
  for (std::size_t k = 0; k < mesh.fracture_names.size(); ++k) {
    const auto& fracture = scene.fractures.at(mesh.fracture_names[k]);
    fractures.source.push_back(fracture.source);
    for (const auto& name : fracture.cuts)
      fractures.cut_by[index_of(mesh.fracture_names, name)].push_back(static_cast<int>(k));
  }
  return fractures;
}

}  // namespace

bool Flow::is_in(const Scene& scene) { return scene.flow.has_value(); }

bool has_fluid(const Scene& scene) { return scene.flow || scene.host_fluid; }

bool has_unknown_pressure(const Scene& scene) { return scene.flow || (scene.host_fluid && scene.host_fluid->unknown); }

bool Flow::needs_facets(const Scene& scene) { return has_unknown_pressure(scene); }

bool Flow::has_rates(const Scene& scene) { return has_fluid(scene); }

base::Expression initial_pressure(const Scene& scene) {
  return scene.flow ? scene.flow->initial_pressure
                    : base::Expression(scene.host_fluid ? scene.host_fluid->initial_pressure : 0);
}

Properties<laws::Mobility> mobility(const Scene& scene, const mesh::Mesh& mesh) {
  const auto material = [&](int region) -> const Material& { return scene.material_of(mesh.region_names[region]); };
  return properties<laws::Mobility>(
      static_cast<int>(mesh.region_names.size()), mesh.cell_region,
      [&](int region) { return material(region).flows_uniformly(); },
      [&](int region, int cell) {
        const auto x = cell < 0 ? std::array<Real, 3>{} : mesh::cell_centre(mesh, cell);
        return at_place(scene, material(region),
                        [&] { return material(region).mobility(mesh.dim(), scene.flow->viscosity, x); });
      });
}

void Flow::add_modules(const Setting& setting, Modules& modules) {
  const auto& scene = setting.scene;
  const auto& mesh = setting.mesh;
  if (!is_in(scene)) return;
  const auto& flow = *scene.flow;
  const bool deforms = Mechanics::is_in(scene);
  Properties<laws::Mobility> rock;
  base::collectively(*mesh.comm, [&] { rock = mobility(scene, mesh); });
  auto darcy = darcy_flow(scene, mesh, rock);
  auto fractures = fracture_flow(scene, mesh, darcy);
  fractures.faces = hydraulics(setting);
  std::vector<Real> aperture;
  for (const auto& face : fractures.faces) {
    darcy.exchange.push_back(face.exchange);
    aperture.push_back(face.along.hydraulic_aperture());
  }
  const auto fluid = darcy.fluid;
  if (!flow.wells.empty()) {
    WellsParameters all{wells(scene, mesh.dim()), rock.values, rock.number, darcy.scheme, fluid, darcy.weight, {}};
    for (const auto& face : fractures.faces) all.faces.push_back(face.along);
    modules.push_back(make_wells(mesh.shape, std::move(all)));
  }
  modules.push_back(make_darcy_flow(mesh.shape, std::move(darcy)));
  const auto pores = by_region(scene, mesh, [&](const Material& m) {
    return Pores{m.porosity, m.growth_of_pores(flow.compressibility)};
  });
  if (std::any_of(pores.begin(), pores.end(),
                  [&](const auto& of) { return of.growth > 0 || of.porosity * fluid.compressibility > 0; }))
    modules.push_back(make_fluid_storage({pores, {}, fluid, flow.initial_pressure}));
  if (mesh.fracture_names.empty()) return;
  modules.push_back(make_fracture_flow(mesh.shape, std::move(fractures)));
  if (flow.compressibility > 0 || deforms)
    modules.push_back(make_fracture_storage({aperture, fluid, flow.initial_pressure, deforms}));
}

}  // namespace sprekk::physics
