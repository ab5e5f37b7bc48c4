// Pressures prescribed in regions.
#include "boxes.hpp"

#include "base/check.hpp"

namespace sprekk::tests {
namespace {

/// Returns the closed unit square or cube with 4 cells along each edge, k/mu = 1, and a pressure in the slab x in [a,
/// b].
model::Scene with_slab(const std::string& cell, Real a, Real b, const std::string& pressure) {
  auto scene = closed_box(cell, false);
  scene.mesh.fractures.clear();
  scene.fractures.clear();
  scene.flow->viscosity = 1;
  const std::size_t dim = scene.mesh.cells.size();
  std::vector<Real> lower(dim, 0), upper(dim, 1);
  lower[0] = a;
  upper[0] = b;
  scene.mesh.regions["slab"] = {lower, upper};
  scene.regions["slab"].pressure = base::Expression(pressure);
  return scene;
}

/// Returns the inflow into the rock in regions, at cells and facets. Collective.
Real region_inflow(model::Model& model) {
  Real sum = 0;
  for (const auto& reaction : model.system().reactions(model.state()))
    if (reaction.region >= 0) sum += reaction.force.at(0);
  return sum;
}

/// Slab with p = (1 + 4 x) t between sides with pressures 0 and 1. The pressure is linear on both sides of the slab;
/// at t = 1 the outflow is 8 in the west and 4 in the east.
TEST(RegionPressure, IsBetweenLinearProfiles) {
  for (const std::string cell : all_cells)
    for (const std::string solver : {"direct", "iterative"}) {
      SCOPED_TRACE(cell + " " + solver);
      auto scene = with_slab(cell, 0.25, 0.5, "(1 + 4*x)*t");
      constrain(scene, "west", "0");
      constrain(scene, "east", "1");
      scene.solver.linear_solver.type = solver;
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged);
      const Real tolerance = solver == "direct" ? 1e-12 : 1e-8;
      EXPECT_LT(error(model, "pressure",
                      [](const Vector3& x, const auto&) {
                        return Vector3{x[0] < 0.25 ? 8 * x[0] : x[0] < 0.5 ? 1 + 4 * x[0] : 3 - 4 * (x[0] - 0.5)};
                      }),
                tolerance);
      EXPECT_LT(error(model, "Darcy velocity",
                      [](const Vector3& x, const auto&) {
                        return Vector3{x[0] < 0.25 ? -8.0 : x[0] < 0.5 ? -4.0 : 4.0};
                      }),
                10 * tolerance);
      EXPECT_NEAR(inflow(model, "west"), -8, 10 * tolerance);
      EXPECT_NEAR(inflow(model, "east"), -4, 10 * tolerance);
      EXPECT_NEAR(region_inflow(model), 12, 10 * tolerance);
    }
}

/// Storage does not change the prescribed pressure, also after a step that is short for the rest of the rock.
TEST(RegionPressure, HoldsAgainstStorage) {
  for (const std::string cell : all_cells) {
    SCOPED_TRACE(cell);
    auto scene = with_slab(cell, 0.25, 0.5, "2");
    scene.materials.at("rock").compressibility = 1e3;
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1).converged);
    const auto pressure = model.output("pressure").values;
    Real lowest = 2;
    for (LocalIndex c = 0; c < model.mesh().n_owned_cells; ++c) {
      if (model.mesh().region_names[model.mesh().cell_region[c]] == "slab") EXPECT_NEAR(pressure[c], 2, 1e-12);
      lowest = std::min(lowest, pressure[c]);
    }
    EXPECT_TRUE(anywhere(*Tpetra::getDefaultComm(), lowest < 0.1));
  }
}

/// In a closed box at rest, the pressure of a region is the pressure everywhere, including fractures inside and on its
/// boundary. All fluxes vanish.
TEST(RegionPressure, IsThatOfFractures) {
  for (const std::string cell : all_cells)
    for (const bool half : {false, true}) {
      SCOPED_TRACE(fmt::format("{} {}", cell, half));
      auto scene = closed_box(cell);
      if (half)
        scene.mesh.regions["part"] = {std::vector<Real>(scene.mesh.cells.size(), 0),
                                      std::vector<Real>(scene.mesh.cells.size(), 1)};
      if (half) scene.mesh.regions["part"].upper_corner[0] = 0.5;
      scene.regions[half ? "part" : "bulk"].pressure = base::Expression(3);
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged);
      const auto three = [](const auto&, const auto&) { return Vector3{3}; };
      EXPECT_LT(error(model, "pressure", three), 1e-12);
      EXPECT_LT(error(model, "fracture pressure", three), 1e-12);
      EXPECT_NEAR(region_inflow(model), 0, 1e-11);
    }
}

TEST(RegionPressure, OfTwoRegionsThatMeetMustAgree) {
  auto scene = with_slab("triangle", 0.25, 0.5, "1");
  scene.mesh.regions["other"] = {{0.5, 0}, {1, 1}};
  scene.regions["other"].pressure = base::Expression(2);
  try {
    model::Model model(scene, Tpetra::getDefaultComm());
    model.step_to(1);
    FAIL() << "no error";
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("conditions \"Regions > other\" and \"Regions > slab\" prescribe"), message.npos) << message;
  }
}

}  // namespace
}  // namespace sprekk::tests
