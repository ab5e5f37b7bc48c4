// Jacobians of the modules of flow, compared with differences.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

#include "assembly/jacobian_check.hpp"
#include "model/model.hpp"
#include "unit/assembly/dense.hpp"
#include "unit/mesh/meshes.hpp"

namespace sprekk {
namespace {

/// Returns rock with an immersed fracture with normal resistance, one that crosses it and one from it to the boundary.
/// The fluid is compressible and under gravity.
model::Scene make_scene(const std::string& cell) {
  model::Scene scene;
  scene.mesh = mesh::testing::crossed(cell);
  const int dim = static_cast<int>(scene.mesh.lower_corner.size());
  auto& rock = scene.materials["rock"];
  rock.type = "elastic";
  rock.permeability = std::vector<base::Expression>(dim, base::Expression(2));
  rock.permeability.back() = base::Expression(1);
  rock.porosity = 0.2;
  rock.compressibility = 0.1;
  auto& joint = scene.materials["joint"];
  joint.type = "joint";
  joint.initial_aperture = 0.1;
  joint.tangential_permeability = base::Expression(5);
  joint.normal_permeability = base::Expression(0.01);
  scene.bulk.material = "rock";
  scene.bulk.gravity.assign(dim, 0.5);
  scene.flow.emplace();
  scene.flow->rigid_rock = true;
  scene.flow->viscosity = 2;
  scene.flow->density = 3;
  scene.flow->compressibility = 0.4;
  scene.flow->reference_pressure = 0.3;
  for (const auto& [name, fracture] : scene.mesh.fractures) scene.fractures[name].material = "joint";
  auto& well = scene.flow->wells["well"];
  const auto &low = scene.mesh.lower_corner, &high = scene.mesh.upper_corner;
  const auto at = [&](Real share) {
    for (int i = 0; i < dim; ++i) well.points.push_back(low[i] + (i == dim - 1 ? share : 0.37) * (high[i] - low[i]));
  };
  at(0.1);
  if (dim == 3) at(0.9);
  well.radius = 1e-4;
  well.pressure = base::Expression(2);
  if (dim == 3) scene.flow->intersections["channel"].permeability_area = 3;
  auto &floor = scene.boundary_conditions["floor"], &lid = scene.boundary_conditions["lid"];
  floor.boundary = "south";
  floor.pressure = base::Expression(1);
  lid.boundary = "north";
  lid.pressure = base::Expression(0);
  lid.conductance = base::Expression(0.7);
  return scene;
}

class FlowJacobian : public ::testing::TestWithParam<std::string> {};

TEST_P(FlowJacobian, OfEveryModuleIsItsDerivative) {
  model::Model model(make_scene(GetParam()), Tpetra::getDefaultComm());
  auto& system = model.system();
  const std::size_t n_modules = model.mesh().dim() == 3 ? 7 : 5;
  ASSERT_EQ(system.modules().size(), n_modules);
  system.set_time(1, 0.5);
  auto x = system.initial();
  test::randomize(x, 1, 1);
  system.commit(x);
  test::randomize(x, 1, 2);
  const auto errors = assembly::check_jacobian(system, x, 1e-5);
  EXPECT_EQ(errors.size(), n_modules * 2 * 2);  // modules, rows, columns
  for (const auto& e : errors) EXPECT_LE(e.error, 1e-8) << e.module << ": " << e.row << ", " << e.column;
}

INSTANTIATE_TEST_SUITE_P(Cells, FlowJacobian, ::testing::ValuesIn(mesh::testing::all_cells),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace sprekk
