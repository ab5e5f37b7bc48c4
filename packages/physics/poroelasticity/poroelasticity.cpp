#include "physics/poroelasticity/poroelasticity.hpp"

#include "physics/poroelasticity/poroelastic_coupling.hpp"
#include "physics/scene.hpp"

namespace sprekk::physics {

namespace {

std::unique_ptr<assembly::Module> make_coupling(const Scene& scene, const mesh::Mesh& mesh) {
  const auto rock = elasticity(scene, mesh);
  const auto biot = by_region(scene, mesh, [](const Material& m) { return m.biot; });
  PoroelasticCouplingParameters coupling;
  for (LocalIndex cell = 0; cell < mesh.n_cells(); ++cell) {
    const int region = mesh.cell_region[cell];
    coupling.rock.push_back({biot[region], rock.values[rock.number.empty() ? region : rock.number[cell]]});
    coupling.rock_of_cell.push_back(cell);
  }
  const Properties<laws::Mobility> any{
      std::vector<laws::Mobility>(mesh.region_names.size(), laws::Mobility::isotropic(1)), {}};
  const auto flow = scene.flow ? mobility(scene, mesh) : any;
  coupling.initial = initial_pressure(scene);
  coupling.scheme =
      flux_scheme("Flow", scene.flow ? scene.flow->scheme : "auto", mesh, flow.values, flow.number).scheme;
  return make_poroelastic_coupling(mesh, std::move(coupling));
}

/// The pressure that a host gives.
std::unique_ptr<assembly::Module> make_given(const Scene& scene, const mesh::Mesh& mesh) {
  const auto biot = by_region(scene, mesh, [](const Material& m) { return m.biot; });
  GivenPressureParameters given{{}, scene.host_fluid->initial_pressure};
  for (LocalIndex cell = 0; cell < mesh.n_cells(); ++cell) given.biot.push_back(biot[mesh.cell_region[cell]]);
  return make_given_pressure(mesh, std::move(given));
}

}  // namespace

void Poroelasticity::Rock::describe(base::Section& s) {
  s.entry(biot, "Biot coefficient", "-", base::between(0, 1),
          "alpha: with \"Flow\" total stress is that of the displacement less alpha (p - initial pressure), and pores "
          "grow by alpha div u");
}

bool Poroelasticity::is_in(const Scene& scene) { return Mechanics::is_in(scene) && has_fluid(scene); }

void Poroelasticity::add_modules(const Setting& setting, Modules& modules) {
  const auto& [scene, mesh, start] = setting;
  if (is_in(scene))
    modules.push_back(has_unknown_pressure(scene) ? make_coupling(scene, mesh) : make_given(scene, mesh));
}

std::vector<std::string> Poroelasticity::warnings(const Setting& setting) {
  const auto& scene = setting.scene;
  std::vector<std::string> all;
  if (!is_in(scene) || scene.host_fluid) return all;
  for (const auto& [name, material] : scene.materials)
    if (material.type == "elastic" && material.biot < material.porosity)
      all.push_back(fmt::format(
          "{}: Sprekk > Materials > {} > \"Biot coefficient\": is {}, below the porosity {}; rock whose grains are "
          "stiffer than its skeleton has more",
          scene.origin, name, material.biot, material.porosity));
  return all;
}

}  // namespace sprekk::physics
