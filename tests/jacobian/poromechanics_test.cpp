// Jacobians of poroelastic rock and fractures, compared with differences.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

#include "assembly/jacobian_check.hpp"
#include "jacobian/against_plastic_jump.hpp"
#include "model/model.hpp"
#include "unit/assembly/dense.hpp"
#include "unit/mesh/meshes.hpp"

namespace sprekk {
namespace {

/// Adds a well with a pressure and one with a rate. Both cross (2D: are on) the fracture "a", and in 3D pass through
/// rock.
void add_wells(model::Scene& scene, int dim) {
  for (const bool by_rate : {false, true}) {
    auto& well = scene.flow->wells[by_rate ? "by rate" : "by pressure"];
    well.points = dim == 2 ? std::vector<Real>{1.4, 2} : std::vector<Real>{1.4, 1.2, 0.6, 1.6, 2.7, 1.3};
    well.radius = 1e-3;
    (by_rate ? well.rate : well.pressure) = base::Expression(2);
  }
}

/// Returns fluid-filled rock with fractures that cross and end inside; apertures increase and decrease.
model::Scene make_scene(const std::string& cell, Real compressibility) {
  model::Scene scene;
  scene.mesh = mesh::testing::crossed(cell);
  const int dim = static_cast<int>(scene.mesh.lower_corner.size());
  auto& rock = scene.materials["rock"];
  rock.type = "elastic";
  rock.E = base::Expression(3);
  rock.nu = base::Expression(0.3);
  rock.permeability = {base::Expression(2)};
  rock.porosity = 0.2;
  rock.compressibility = 0.1;
  rock.biot = 0.8;
  auto& joint = scene.materials["joint"];
  joint.type = "joint";
  joint.friction_coefficient = base::Expression(0.6);
  joint.tangential_stiffness = base::Expression(2);
  joint.dilation_angle = base::Expression(5);
  joint.initial_aperture = base::Expression(1);
  joint.residual_aperture = base::Expression(0.8);
  if (compressibility > 0) {  // on both sides of the threshold of roughness, 1.12 m
    joint.hydraulic_aperture = "Barton";
    joint.entry("joint roughness coefficient") = base::Expression(263);
    joint.residual_aperture = base::Expression(0.5);
  }
  joint.normal_permeability = base::Expression(0.1);
  scene.bulk.material = "rock";
  scene.bulk.gravity.assign(dim, 0.5);
  rock.density = base::Expression(2);
  scene.flow.emplace();
  scene.flow->viscosity = 2;
  scene.flow->density = 3;
  scene.flow->compressibility = compressibility;
  scene.flow->initial_pressure = base::Expression("0.1*x + 0.2*y");
  add_wells(scene, dim);
  for (const auto& [name, fracture] : scene.mesh.fractures) scene.fractures[name].material = "joint";
  auto &floor = scene.boundary_conditions["floor"], &lid = scene.boundary_conditions["lid"];
  floor.boundary = "south";
  floor.displacement.assign(dim, base::Expression(0));
  lid.boundary = "north";
  lid.displacement.assign(dim, base::Expression(0));
  lid.pressure = base::Expression(1);
  return scene;
}

class PoromechanicsJacobian : public ::testing::TestWithParam<std::string> {};

TEST_P(PoromechanicsJacobian, OfEveryModuleIsItsDerivative) {
  for (const Real compressibility : {0.0, 0.4}) {
    model::Model model(make_scene(GetParam(), compressibility), Tpetra::getDefaultComm());
    auto& system = model.system();
    system.set_time(1, 0.5);
    auto x = system.initial();
    test::randomize(x, 0.3, 1);
    system.commit(x);
    auto before = fields::create_like(x);
    fields::copy(x, before);
    test::randomize(x, 0.3, 2);
    against_plastic_jump(system, before, *x[2]);
    const auto errors = assembly::check_jacobian(system, x, 1e-5);
    for (const auto& e : errors) EXPECT_LE(e.error, 1e-6) << e.module << ": " << e.row << ", " << e.column;
  }
}

TEST_P(PoromechanicsJacobian, IsThatOfTransmissivitiesThatLag) {
  model::Model model(make_scene(GetParam(), 0.4), Tpetra::getDefaultComm());
  auto& system = model.system();
  system.set_time(1, 0.5);
  auto x = system.initial();
  test::randomize(x, 0.3, 1);
  system.commit(x);
  auto before = fields::create_like(x), exact = fields::create_like(x), lagged = fields::create_like(x);
  fields::copy(x, before);
  system.residual(x, exact);
  EXPECT_EQ(system.lag(fields::BlockProblem::Lag::follow, x), 0);
  system.residual(x, lagged);  // for coefficients at the same x, the residual is equal up to round-off of a logarithm
  for (std::size_t b = 0; b < x.size(); ++b) {
    lagged[b]->update(1, *exact[b], -1);
    EXPECT_LE(lagged[b]->normInf(), 1e-12);
  }
  test::randomize(x, 0.3, 2);
  against_plastic_jump(system, before, *x[2]);
  for (const auto& e : assembly::check_jacobian(system, x, 1e-5))
    EXPECT_LE(e.error, 1e-6) << e.module << ": " << e.row << ", " << e.column;
  EXPECT_GT(system.lag(fields::BlockProblem::Lag::follow, x), 0);
  system.lag(fields::BlockProblem::Lag::none, x);
}

INSTANTIATE_TEST_SUITE_P(Cells, PoromechanicsJacobian, ::testing::ValuesIn(mesh::testing::all_cells),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace sprekk
