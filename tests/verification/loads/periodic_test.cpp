// Periodic sides: a uniform state.
#include "verification/scenes.hpp"

namespace sprekk::tests {
namespace {

/// Block in series with a slipping joint: N/k_n + V(N) + mu tan(theta) N/K_s = g0 + tan(theta)|d_t| - d_n with k_n =
/// 3, 1/K_s = 1 + 1/2 is a quadratic equation in N.
TEST(Periodic, BlockSlipsUniformly) {
  const Real N = 0.322985706114, l_t = 0.193791423668, u_p = 0.209312864497, opening = 0.007661902038;
  for (int order : {1, 2})
    for (const auto& cell : cells_of(2))
      for (int seed : {-1, 5}) {
        SCOPED_TRACE(fmt::format("{} order {} seed {}", cell, order, seed));
        auto scene =
            read_scene("verification/periodic_2d.xml", {"Mesh.cell=" + cell, fmt::format("Mesh.order={}", order)});
        if (seed >= 0) scene.mesh.renumbering_seed = seed;
        model::Model model(scene, Tpetra::getDefaultComm());
        const auto report = model.step_to(1);
        ASSERT_TRUE(report.converged) << report.reason;
        const Outputs out(model);
        for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
          EXPECT_NEAR(out.vector("traction local", f)[0], -N, 1e-10);
          EXPECT_NEAR(out.vector("traction local", f)[1], l_t, 1e-10);
          EXPECT_NEAR(out.scalar("slip", f), u_p, 1e-10);
          EXPECT_NEAR(out.scalar("opening", f), opening, 1e-10);
        }
      }
}

TEST(Periodic, UnknownDirectionIsRefused) {
  auto scene = read_scene("verification/periodic_2d.xml");
  scene.mesh.periodic = {"z"};
  try {
    model::Model model(scene, Tpetra::getDefaultComm());
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("x or y"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace sprekk::tests
