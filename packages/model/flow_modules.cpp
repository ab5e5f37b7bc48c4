#include "model/flow_modules.hpp"

#include "base/text.hpp"
#include "mesh/extents.hpp"
#include "mesh/facets.hpp"
#include "model/properties.hpp"
#include "physics/flow/darcy_flow.hpp"
#include "physics/flow/fluid_storage.hpp"
#include "physics/flow/fracture_flow.hpp"
#include "physics/poroelasticity/given_pressure.hpp"
#include "physics/poroelasticity/poroelastic_coupling.hpp"
#include "physics/flow/wells.hpp"

#include <Teuchos_CommHelpers.hpp>

namespace sprekk::model {

namespace {

/// Materials of the mesh's regions, by their numbers.
template <class Of>
auto by_region(const Scene& scene, const mesh::Mesh& mesh, const Of& of) {
  std::vector<decltype(of(scene.material_of("")))> values;
  for (const auto& name : mesh.region_names) values.push_back(of(scene.material_of(name)));
  return values;
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

std::vector<physics::FluidCondition> fluid_conditions(const Scene& scene, const mesh::Mesh& mesh, bool of_fractures) {
  std::vector<physics::FluidCondition> conditions;
  for (const auto& [name, one] : scene.boundary_conditions)
    if (one.fracture.has_value() == of_fractures && (one.flux || one.conductance))
      conditions.push_back({index_of(mesh.boundary_names, one.boundary), one.flux ? *one.flux : *one.pressure,
                            one.conductance, one.region ? index_of(mesh.region_names, *one.region) : -1,
                            one.fracture ? index_of(mesh.fracture_names, *one.fracture) : -1});
  return conditions;
}

std::vector<physics::Well> wells(const Scene& scene, int dim) {
  std::vector<physics::Well> wells;
  for (const auto& [name, one] : scene.flow->wells) {
    wells.push_back({name, {}, one.radius, one.skin, one.rate, one.pressure});
    for (std::size_t k = 0; k < one.points.size(); k += dim) {
      std::copy_n(&one.points[k], dim, wells.back().points.emplace_back().begin());
    }
  }
  return wells;
}

/// Of local fracture faces; the apertures at the start are those of the joints and `initial_jumps` along the normal.
std::vector<physics::FractureFlowParameters::Face> hydraulics(const Scene& scene, const mesh::Mesh& mesh,
                                                              const std::vector<Real>& initial_jumps) {
  std::vector<physics::FractureFlowParameters::Face> faces;
  for (std::size_t f = 0; f < mesh.fracture_faces.size(); ++f) {
    const auto& face = mesh.fracture_faces[f];
    const auto& joint = scene.materials.at(scene.fractures.at(mesh.fracture_names[face.fracture]).material);
    at_place(scene, joint, [&] {
      faces.push_back(joint.hydraulics(scene.flow->viscosity, face.centre));
      auto& along = faces.back().along;
      if (!initial_jumps.empty()) along.aperture += initial_jumps[f];
      SPREKK_CHECK(
          along.hydraulic_aperture() > 0,
          "the hydraulic aperture is {:.3g} at ({:.6g}, {:.6g}, {:.6g}) under the initial stress, must be above "
          "0: give a \"residual aperture\", or an \"initial aperture\" above the closure",
          along.hydraulic_aperture(), face.centre[0], face.centre[1], face.centre[2]);
      return 0;
    });
  }
  return faces;
}

}  // namespace

std::vector<std::unique_ptr<assembly::Module>> make_flow(const Scene& scene, const mesh::Mesh& mesh,
                                                         const std::vector<Real>& initial_jumps) {
  const auto& flow = *scene.flow;
  Properties<laws::Mobility> rock;
  base::collectively(*mesh.comm, [&] { rock = mobility(scene, mesh); });
  physics::DarcyFlowParameters darcy{rock.values, rock.number};
  const auto chosen = physics::flux_scheme(flow.scheme, mesh, rock.values, rock.number);
  darcy.scheme = chosen.scheme;
  darcy.reason = chosen.reason;
  darcy.deforms = scene.deforms() || std::any_of(scene.regions.begin(), scene.regions.end(), [](const auto& region) {
                    return region.second.pressure;  // pressures of cells are prescribed: they stay in linear solves
                  });
  for (std::size_t i = 0; i < scene.bulk.gravity.size(); ++i) darcy.weight[i] = flow.density * scene.bulk.gravity[i];
  darcy.fluid = {flow.compressibility, flow.reference_pressure};
  if (!flow.source.is_constant() || flow.source({}, 0) != 0) darcy.source = {flow.source};
  darcy.conditions = fluid_conditions(scene, mesh, false);
  const auto pores = by_region(scene, mesh, [&](const Material& m) {
    return physics::Pores{m.porosity, m.growth_of_pores(flow.compressibility)};
  });
  physics::FractureFlowParameters fractures{
      {}, {}, {}, darcy.scheme, darcy.fluid, darcy.weight, fluid_conditions(scene, mesh, true), scene.deforms()};
  if (scene.deforms()) fractures.softness = mesh::largest_extent(mesh) / largest_modulus(scene, mesh);
  const auto jumps =
      scene.deforms() ? with_ghosts(mesh, fields::Entity::fracture_face, initial_jumps) : std::vector<Real>();
  base::collectively(*mesh.comm, [&] { fractures.faces = hydraulics(scene, mesh, jumps); });
  std::vector<Real> aperture;
  for (const auto& face : fractures.faces) {
    darcy.exchange.push_back(face.exchange);
    aperture.push_back(face.along.hydraulic_aperture());
  }
  fractures.cut_by.resize(mesh.fracture_names.size());
  for (std::size_t k = 0; k < mesh.fracture_names.size(); ++k) {
    const auto& fracture = scene.fractures.at(mesh.fracture_names[k]);
    fractures.source.push_back(fracture.source);
    for (const auto& name : fracture.cuts)
      fractures.cut_by[index_of(mesh.fracture_names, name)].push_back(static_cast<int>(k));
  }
  std::vector<std::unique_ptr<assembly::Module>> modules;
  const auto fluid = darcy.fluid;
  if (!flow.wells.empty()) {
    physics::WellsParameters all{
        wells(scene, mesh.dim()), rock.values, rock.number, darcy.scheme, fluid, darcy.weight, {}};
    for (const auto& face : fractures.faces) all.faces.push_back(face.along);
    all.widens = fractures.widens && !mesh.fracture_names.empty();
    all.softness = fractures.softness;
    modules.push_back(physics::make_wells(mesh.shape, std::move(all)));
  }
  modules.push_back(physics::make_darcy_flow(mesh.shape, std::move(darcy)));
  if (std::any_of(pores.begin(), pores.end(),
                  [&](const auto& of) { return of.growth > 0 || of.porosity * fluid.compressibility > 0; }))
    modules.push_back(physics::make_fluid_storage({pores, {}, fluid, flow.initial_pressure}));
  if (mesh.fracture_names.empty()) return modules;
  modules.push_back(physics::make_fracture_flow(mesh.shape, std::move(fractures)));
  if (flow.compressibility > 0 || scene.deforms())
    modules.push_back(physics::make_fracture_storage({aperture, fluid, flow.initial_pressure, scene.deforms()}));
  return modules;
}

std::unique_ptr<assembly::Module> make_coupling(const Scene& scene, const mesh::Mesh& mesh) {
  const auto rock = elasticity(scene, mesh);
  const auto biot = by_region(scene, mesh, [](const Material& m) { return m.biot; });
  physics::PoroelasticCouplingParameters coupling;
  for (LocalIndex cell = 0; cell < mesh.n_cells(); ++cell) {
    const int region = mesh.cell_region[cell];
    coupling.rock.push_back({biot[region], rock.values[rock.number.empty() ? region : rock.number[cell]]});
    coupling.rock_of_cell.push_back(cell);
  }
  const Properties<laws::Mobility> any{
      std::vector<laws::Mobility>(mesh.region_names.size(), laws::Mobility::isotropic(1)), {}};
  const auto flow = scene.flow ? mobility(scene, mesh) : any;
  coupling.initial = scene.initial_pressure();
  coupling.scheme =
      physics::flux_scheme(scene.flow ? scene.flow->scheme : "auto", mesh, flow.values, flow.number).scheme;
  coupling.fractures = !mesh.fracture_names.empty();
  coupling.tips = mesh.n_global_enriched > 0;
  return physics::make_poroelastic_coupling(mesh.shape, std::move(coupling));
}

std::unique_ptr<assembly::Module> make_given(const Scene& scene, const mesh::Mesh& mesh) {
  const auto biot = by_region(scene, mesh, [](const Material& m) { return m.biot; });
  physics::GivenPressureParameters given{{}, !mesh.fracture_names.empty(), mesh.n_global_enriched > 0};
  for (LocalIndex cell = 0; cell < mesh.n_cells(); ++cell) given.biot.push_back(biot[mesh.cell_region[cell]]);
  return physics::make_given_pressure(mesh.shape, std::move(given));
}

Real largest_mobility(const Scene& scene, const mesh::Mesh& mesh) {
  Real here = 0, largest = 0;
  for (const auto& one : mobility(scene, mesh).values)
    for (int i = 0; i < mesh.dim(); ++i) here = std::max(here, one.value[i][i]);
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_MAX, 1, &here, &largest);
  return largest;
}

}  // namespace sprekk::model
