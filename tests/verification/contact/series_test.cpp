// Joints in series, with slip not determined by equilibrium: it has the smallest sum of squares, independent of ranks
// and numbering.
#include "verification/scenes.hpp"

#include <Teuchos_DefaultMpiComm.hpp>

#include <numeric>

namespace sprekk::tests {
namespace {

/// All joints are at the friction limit, so the elastic part of the displacement is known: equal joints have equal
/// slip. With dilation, the free motion combines slip with uplift in one joint and reverse slip with settlement in
/// another. Both shear directions along an axis.
TEST(JointsInSeries, EqualOnesShareTheSlip) {
  constexpr Real shear = 0.5, G = 1, K_t = 2, mu = 0.5;
  for (const int dim : {2, 3})
    for (const auto& [angle, way] : {std::pair(0, 1), {5, 1}, {5, -1}}) {
      auto scene = read_scene(fmt::format("verification/stack_{}d.xml", dim),
                              {fmt::format("Materials.middle.dilation angle={}", angle),
                               fmt::format("Tables.shear.values={{0, 0, {}}}", way * shear)});
      for (auto& [name, fracture] : scene.fractures) fracture.material = "middle";
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged);
      const auto report = model.step_to(2);
      ASSERT_TRUE(report.converged) << report.reason;
      EXPECT_NE(report.floating, "");
      const Outputs out(model);
      for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
        const auto traction = out.vector("traction local", f);
        const Real tau = std::hypot(traction[1], traction[2]);
        EXPECT_NEAR(tau, -mu * traction[0], 1e-11);
        EXPECT_NEAR(out.scalar("slip", f), (shear - tau / G - 3 * tau / K_t) / 3, 1e-10)
            << dim << " " << angle << " " << way;
      }
    }
}

/// Constant normal load, then shear. Joints close without a change of traction, so this closure gives no information
/// on the stiffness of the rock. The weakest joint slips at mu N.
TEST(JointsInSeries, TheWeakestSlidesUnderAGivenLoad) {
  constexpr Real N = 0.1, tau = 0.5 * N, G = 1, compliance = 1 / G + 1.0 / 1 + 1.0 / 2 + 1.0 / 4;
  for (const int dim : {2, 3})
    for (const auto& cell : cells_of(dim)) {
      const std::string across = dim == 2 ? "" : ", 0", top = dim == 2 ? "north" : "top";
      const auto scene =
          read_scene(fmt::format("verification/stack_{}d.xml", dim),
                     {"Mesh.cell=" + cell, dim == 2 ? "Mesh.cells={5, 8}" : "Mesh.cells={3, 2, 4}", "Time.steps=4",
                      "Tables.shear.values={0, 0, 0.5}", "Boundary conditions.load.boundary=" + top,
                      fmt::format("Boundary conditions.load.traction={{0{}, {}}}", across, -N),
                      fmt::format("Boundary conditions.moved.displacement={{shear(t){}, free}}", across)});
      model::Model model(scene, Tpetra::getDefaultComm());
      for (const Real t : scene.time.times()) {
        const auto report = model.step_to(t);
        ASSERT_TRUE(report.converged) << cell << " " << report.reason;
        const Real slip = t > 1 ? 0.5 * (t - 1) - tau * compliance : 0;
        const Outputs out(model);
        for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
          const auto& name = model.mesh().fracture_names[model.mesh().fracture_faces[f].fracture];
          const auto traction = out.vector("traction local", f);
          EXPECT_NEAR(traction[0], -N, 1e-11);
          EXPECT_NEAR(std::hypot(traction[1], traction[2]), t > 1 ? tau : 0, 1e-11);
          EXPECT_NEAR(out.scalar("slip", f), name == "middle" ? slip : 0, 1e-10) << cell << " " << t << " " << name;
        }
      }
    }
}

/// Returns the scene of five layers of thickness h.
model::Scene layers(Real h) {
  std::vector<std::string> entries = {fmt::format("Mesh.upper corner={{1, {:.17g}}}", 5 * h),
                                      fmt::format("Tables.shear.values={{0, 0, {0}, -{0}}}", 0.05 * h),
                                      fmt::format("Tables.press.values={{0, {0}, {0}}}", 5e-4 * h)};
  for (int k = 1; k < 5; ++k)
    for (const auto& [corner, x] : {std::pair{"lower", 0}, {"upper", 1}})
      entries.push_back(fmt::format("Mesh.fractures.joint {}.{} corner={{{}, {:.17g}}}", k, corner, x, k * h));
  return read_scene("contact/layers_2d.xml", entries);
}

/// Returns the jumps of all faces, upper side minus lower side: joint by joint, from west to east.
std::vector<Vector3> jumps_in_order(model::Model& model) {
  const auto faces = gathered_faces(model, identity(), {0, 1, 0});
  std::vector<std::size_t> order(faces.centre.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const auto &x = faces.centre[a], &y = faces.centre[b];
    return std::abs(x[1] - y[1]) > 1e-9 ? x[1] < y[1] : x[0] < y[0];
  });
  std::vector<Vector3> jumps;
  for (const auto f : order) jumps.push_back(faces.jump[f]);
  return jumps;
}

/// Each joint between equal layers has the same mean slip. Each face has the same jump on one rank as on all ranks
/// with another numbering, relative to the displacement of the top.
TEST(JointsInSeries, LayersSlideAlike) {
  for (const Real h : {0.1, 0.01, 0.001}) {
    const auto scene = layers(h);
    auto renumbered = scene;
    renumbered.mesh.renumbering_seed = 7;
    model::Model together(renumbered, Tpetra::getDefaultComm()),
        single(scene, rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF)));
    std::vector<Vector3> before(40, Vector3{});
    for (const Real t : scene.time.times()) {
      for (auto* model : {&together, &single}) ASSERT_TRUE(model->step_to(t).converged) << h << " " << t;
      const Real tolerance = 1e-8 * single.system().scales().at("displacement");
      const auto jumps = jumps_in_order(single), others = jumps_in_order(together);
      ASSERT_EQ(jumps.size(), before.size());
      std::array<Real, 4> slid{};
      for (std::size_t f = 0; f < jumps.size(); ++f) {
        slid[f / 10] += (jumps[f][0] - before[f][0]) / 10;
        for (int i = 0; i < 2; ++i)
          EXPECT_NEAR(others[f][i], jumps[f][i], tolerance) << h << " " << t << " " << f << " " << i;
      }
      for (const Real mean : slid) EXPECT_NEAR(mean, slid[0], tolerance) << h << " " << t;
      before = jumps;
    }
  }
}

}  // namespace
}  // namespace sprekk::tests
