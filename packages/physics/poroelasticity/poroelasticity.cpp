#include "physics/poroelasticity/poroelasticity.hpp"

#include "base/entry_of_place.hpp"
#include "base/over_ranks.hpp"
#include "mesh/facets.hpp"
#include "physics/comparison.hpp"
#include "physics/poroelasticity/fracture_opening.hpp"
#include "physics/poroelasticity/hydraulic_opening.hpp"
#include "physics/poroelasticity/poroelastic_coupling.hpp"
#include "physics/scene.hpp"

#include <functional>

namespace sprekk::physics {

namespace {

constexpr const char* biot_name = "Biot coefficient";

bool is_one(const base::Expression& value) { return value.is_constant() && value({}, 0) == 1; }

/// Biot's coefficients of cells. Throws an Error on all ranks. Collective.
fields::Properties<Real> biot(const Scene& scene, const mesh::Mesh& mesh) {
  fields::Properties<Real> values;
  base::collectively(*mesh.comm, [&] {
    values = by_cell(
        scene, mesh, [](const Material& rock) { return rock.biot.is_constant(); },
        [](const Material& rock, const auto& x) { return value_at(biot_name, rock.biot, base::between(0, 1), x); });
  });
  return values;
}

/// Returns find() and throws its errors on all ranks. Collective.
std::vector<Real> collected(const mesh::Mesh& mesh, const std::function<std::vector<Real>()>& find) {
  std::vector<Real> values;
  base::collectively(*mesh.comm, [&] { values = find(); });
  return values;
}

/// Creates the module of a pressure prescribed by the host.
std::unique_ptr<assembly::Module> make_given(const Scene& scene, const mesh::Mesh& mesh) {
  return make_given_pressure(mesh, {.biot = biot(scene, mesh),
                                    .of_fillings = collected(mesh, [&] { return filling_biot(scene, mesh); }),
                                    .initial = scene.host_fluid->initial_pressure});
}

}  // namespace

void Poroelasticity::Rock::describe(base::Section& s) {
  entry_of_place(
      s, biot, biot_name, "-", base::between(0, 1),
      "Biot coefficient alpha: with \"Flow\" total stress is the stress of the displacement minus alpha (p - initial "
      "pressure), and the pore volume grows by alpha div u (Biot 1941); typical: 0.35 to 0.8 (material library)");
}

void Poroelasticity::Joint::describe(base::Section& s) {
  entry_of_place(s, filling_biot, biot_name, "-", base::between(0, 1),
                 "Biot coefficient alpha of the filling: a fluid pressure p in the fracture adds -alpha p n to the "
                 "traction on the rock, and with \"Flow\" a widening b takes up the fluid volume alpha b; 1: open");
}

/// Reports fillings with a fluid that transports a quantity.
void Poroelasticity::compare(Comparison& c) {
  if (!is_in(c.scene())) return;
  for_each_physics([&]<HasTransport P>(P) {
    for (const auto& carried : P::Transport::carried(c.scene()))
      for (const auto& [name, fracture] : c.scene().fractures)
        if (const auto* joint = c.joint_of(fracture); joint && !is_one(joint->filling_biot))
          c.fail(fmt::format("Materials > {} > \"{}\"", fracture.material, biot_name),
                 fmt::format("is {}; must be 1 with transport of the {}", joint->filling_biot.text(), carried.field));
  });
}

std::vector<Real> filling_biot(const Scene& scene, const mesh::Mesh& mesh) {
  std::vector<Real> all;
  for (const auto& face : mesh.fracture_faces) {
    const auto& joint = joint_of(scene, mesh, face.single);
    all.push_back(at_place(scene, joint,
                           [&] { return value_at(biot_name, joint.filling_biot, base::between(0, 1), face.centre); }));
  }
  return all;
}

transport::Stabilisation stabilisation(const Scene& scene, const mesh::Mesh& mesh) {
  if (!Poroelasticity::is_in(scene)) return {};
  const auto alpha = biot(scene, mesh);
  const auto laws = elasticity(scene, mesh);
  std::vector<Real> softness;
  for (LocalIndex c = 0; c < mesh.n_cells(); ++c) {
    const auto& law = laws.of_cell(mesh, c);
    softness.push_back(alpha.of_cell(mesh, c) * alpha.of_cell(mesh, c) / (law.lambda + 2 * law.G));
  }
  const fields::Properties<laws::Mobility> any{
      std::vector<laws::Mobility>(mesh.region_names.size(), laws::Mobility::isotropic(1))};
  const auto scheme =
      transport::flux_scheme(scheme_entry(scene), mesh, scene.flow ? mobility(scene, mesh) : any).scheme;
  return {std::move(softness), initial_pressure(scene), scheme};
}

bool Poroelasticity::is_in(const Scene& scene) { return Mechanics::is_in(scene) && has_fluid(scene); }

void Poroelasticity::add_modules(const Setting& setting, Modules& modules) {
  const auto& [scene, mesh, start] = setting;
  if (!is_in(scene)) return;
  if (!has_unknown_pressure(scene)) return modules.push_back(make_given(scene, mesh));
  if (flows_in_rock(scene))
    modules.push_back(
        make_poroelastic_coupling({.biot = biot(scene, mesh), .stabilisation = stabilisation(scene, mesh)}));
  if (!mesh.fracture_names.empty())
    modules.push_back(make_fracture_opening(
        mesh, collected(mesh, [&, &scene = scene, &mesh = mesh] { return filling_biot(scene, mesh); })));
}

std::vector<std::string> Poroelasticity::warnings(const Setting& setting) {
  const auto& [scene, mesh, start] = setting;
  std::vector<std::string> all;
  if (!is_in(scene) || scene.host_fluid || !flows_in_rock(scene)) return all;
  for (const auto& [name, material] : scene.materials) {
    const auto is_low = [&, &rock = material](LocalIndex cell) {
      const auto x = mesh::cell_centre(mesh, cell);
      return &scene.material_of(mesh.region_names[mesh.cell_region[cell]]) == &rock &&
             rock.biot(x, 0) < rock.porosity(x, 0);
    };
    const auto any_low = [&] {
      for (LocalIndex cell = 0; cell < mesh.n_owned_cells; ++cell)
        if (is_low(cell)) return true;
      return false;
    };
    if (base::any_rank(*mesh.comm, any_low))
      all.push_back(
          fmt::format("{}: Sprekk > Materials > {} > \"Biot coefficient\": is {}, below the porosity {}; rock with "
                      "grains stiffer than its skeleton has a larger coefficient",
                      scene.origin, name, material.biot.text(), material.porosity.text()));
  }
  return all;
}

std::vector<std::string> Poroelasticity::Warnings::of_input(const Setting& setting, const std::vector<Real>& times) {
  if (!Mechanics::is_in(setting.scene)) return {};  // a "fluid pressure" of fractures needs no Flow
  return hydraulic_opening_doubts(setting, times);
}

}  // namespace sprekk::physics
