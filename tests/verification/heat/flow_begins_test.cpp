// Heat and tracer when a flow begins: counts of iterations, and equal results of all solvers.
#include "warm_boxes.hpp"

namespace sprekk::tests {
namespace {

/// Cold water enters a fracture at a well. In the first step, the flow is balanced first, and heat follows by one solve
/// of its own; no step is bisected. Later steps start from a balanced flow. All solvers agree.
TEST(HeatInAFlow, BeginsWithTheFlow) {
  for (const std::string fluid : {"constant", "water"}) {
    std::vector<Real> expected;
    for (const std::string type : {"direct", "iterative"}) {
      const auto scene = read_scene("new/doublet.xml", {"Heat.fluid=" + fluid, "Solver.Linear solver.type=" + type});
      model::Model model(scene, Tpetra::getDefaultComm());
      for (const Real year : {2.5, 5.0}) {
        const bool first = year == 2.5;
        const auto report = model.step_to(year * 365.25 * 86400);
        ASSERT_TRUE(report.converged) << fluid << type << report.reason;
        EXPECT_EQ(report.cuts, 0) << fluid << type;
        EXPECT_EQ(report.advected_solves.size(), first ? 1u : 0u) << fluid << type;
        EXPECT_LE(report.newton_iterations, fluid == "constant" ? 3 : 4) << fluid << type << year;
        for (const auto& solve : report.linear_solves) EXPECT_LE(solve.iterations, 40) << fluid << type;
      }
      for (const char* name : {"temperature", "fracture temperature"}) {
        const auto found = model.output(name).values;
        if (type == "direct") expected.insert(expected.end(), found.begin(), found.end());
        const std::size_t start = name == std::string("temperature") ? 0 : expected.size() - found.size();
        for (std::size_t k = 0; k < found.size(); ++k)
          EXPECT_NEAR(found[k], expected[start + k], 1e-5) << fluid << name;
      }
    }
  }
}

/// The same in a network of fractures in 3D, from a state at which water of different temperatures is out of balance.
TEST(HeatInAFlow, BeginsInANetwork) {
  std::vector<Real> expected;
  for (const std::string method : {"auto", "ILU", "direct"}) {
    auto scene = read_scene("tracer/doublet_3d.xml",
                            {"Solver.Linear solver.type=iterative", "Solver.Blocks.face temperature.type=" + method});
    scene.tracer.reset();
    warm(scene, 0, 3, 2.2e6, 4.1e6);
    scene.heat->initial_temperature = Expression("400 - 0.3*z");
    scene.heat->fluid = "water";
    for (auto& [name, well] : scene.flow->wells)
      if (well.rate) scene.heat->wells[name].temperature = Expression(330);
    scene.bulk.gravity = {0, 0, -9.81};
    model::Model model(scene, Tpetra::getDefaultComm());
    const auto report = model.step_to(30 * 86400);
    ASSERT_TRUE(report.converged) << method << report.reason;
    EXPECT_EQ(report.cuts, 0) << method;
    EXPECT_EQ(report.advected_solves.size(), 1u) << method;
    EXPECT_LE(report.newton_iterations, 8) << method;
    for (const auto& solve : report.linear_solves) EXPECT_LE(solve.iterations, 40) << method;
    const auto found = model.output("fracture temperature").values;
    if (expected.empty()) expected = found;
    for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], expected[k], 1e-5) << method;
  }
}

}  // namespace
}  // namespace sprekk::tests
