// Cyclic shear at constant normal force: hysteresis loop. N = 0.3, so the joint slips at 0.18. Rock and joint in
// series have K_s = 2/3; slip begins at the elastic displacement S = 0.18/K_s = 0.27.
#include "verification/uniform/states.hpp"

namespace sprekk::tests {
namespace {

const std::vector<Real> loop_l_t = {0.2 / 3, 0.18, 0.18, 0.14 / 3, -0.18, 0.02, 0.18, 0.18};
const std::vector<Real> loop_u_p = {0, 0.23, 0.23, 0.23, -0.23, -0.23, 0.23, 0.23};

Expected expected(int dim, const Vector3& m, Real l_t, Real u_p) {
  return UniformJoint{l_t, -0.3, u_p, 0, 0, 2}.along(m, dim);
}

void expect_loop(const model::Scene& scene, const Vector3& m, const Matrix3& Q) {
  model::Model model(scene, Tpetra::getDefaultComm());
  for (int k = 1; k <= 8; ++k) {
    SCOPED_TRACE(k);
    const auto report = model.step_to(k);
    ASSERT_TRUE(report.converged) << report.reason;
    EXPECT_EQ(report.cuts, 0);
    expect_joint(model, expected(model.mesh().dim(), m, loop_l_t[k - 1], loop_u_p[k - 1]), Q);
  }
}

model::Scene cyclic(int dim, const std::vector<std::string>& overrides = {}) {
  return read_scene(fmt::format("verification/cyclic_{}d.xml", dim), overrides);
}

TEST(CyclicShear, HysteresisOnEveryMesh) {
  for (const int dim : {2, 3})
    for (const auto& d : discretisations(dim))
      for (const int n : dim == 2 ? std::vector<int>{2, 6} : std::vector<int>{2, 4})
        for (const auto sides : {Sides::loaded, Sides::tied}) {
          if (d.order == 2 && n > 2) continue;
          SCOPED_TRACE(fmt::format("{}, {} cells, sides {}", d.name(), n, sides == Sides::tied ? "tied" : "loaded"));
          auto scene = cyclic(dim, d.with());
          scene.mesh.cells.assign(dim, n);
          if (sides == Sides::tied) tie_sides(scene);
          expect_loop(scene, {1, 0, 0}, identity());
        }
}

TEST(CyclicShear, Turned) {
  for (const int dim : {2, 3})
    for (const auto& d : discretisations(dim))
      for (const Real degrees : {27.0, 90.0}) {
        SCOPED_TRACE(fmt::format("{} {} degrees", d.name(), degrees));
        auto scene = cyclic(dim, d.with());
        scene.mesh.fractures.at("fracture").swap_sides = degrees == 90;
        scene.mesh.renumbering_seed = 3;
        const auto Q = turn(scene, degrees, dim == 2 ? Vector3{0, 0, 1} : Vector3{-1, 2, 0.5});
        expect_loop(scene, {1, 0, 0}, Q);
      }
}

/// Shear in a general direction of the joint frame.
TEST(CyclicShear, Oblique) {
  for (const auto& d : discretisations(3)) {
    SCOPED_TRACE(d.name());
    const Real c = std::cos(0.7), s = std::sin(0.7);
    const auto set = [](const std::string& entry, const std::array<std::string, 3>& text) {
      return fmt::format("Boundary conditions.{}={{{}}}", entry, fmt::join(text, ", "));
    };
    const auto shear = [&](Real factor) { return fmt::format("({:.17g})*shear(t)", factor); };
    const auto scene = cyclic(3, d.with({set("moved.displacement", {fmt::format("{:.17g}*tangential(t)", c),
                                                                    fmt::format("{:.17g}*tangential(t)", s), "-0.1"}),
                                         set("left.traction", {"-lateral(t)", "0", shear(-c)}),
                                         set("right.traction", {"lateral(t)", "0", shear(c)}),
                                         set("front.traction", {"0", "-lateral(t)", shear(-s)}),
                                         set("back.traction", {"0", "lateral(t)", shear(s)})}));
    expect_loop(scene, {c, s, 0}, identity());
  }
}

/// Steps exactly at the friction limit (0) are not compared.
TEST(CyclicShear, StateTellsStickFromSlip) {
  for (const int dim : {2, 3}) {
    model::Model model(cyclic(dim), Tpetra::getDefaultComm());
    const std::vector<int> states = {1, 2, 0, 1, 2, 1, 2, 0};
    for (int k = 1; k <= 8; ++k) {
      ASSERT_TRUE(model.step_to(k).converged);
      const Outputs out(model);
      for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f)
        if (states[k - 1] != 0) {
          EXPECT_EQ(out.scalar("state", f), states[k - 1]) << "step " << k;
        }
    }
  }
}

/// Returns a block with tied sides under cyclic displacement: D = 0.5 at even times, -D at odd times.
model::Scene swinging() {
  auto scene = cyclic(2, {"Boundary conditions.moved.displacement={0.5*cos(pi*t), -0.1}", "Mesh.cells={1, 2}"});
  tie_sides(scene);
  return scene;
}

/// 1000 cycles; 20 in parallel to save time.
TEST(CyclicShear, DoesNotDrift) {
  model::Model model(swinging(), Tpetra::getDefaultComm());
  const int steps = model.mesh().comm->getSize() == 1 ? 2000 : 40;
  for (int k = 1; k <= steps; ++k) ASSERT_TRUE(model.step_to(k).converged) << k;
  expect_joint(model, expected(2, {1, 0, 0}, 0.18, 0.23));
}

/// The work per cycle is 4 mu N (D - S) = 0.1656, for any number of steps that include the beginning and end of slip.
TEST(CyclicShear, DissipatedWork) {
  const Real begin = std::acos((0.5 - 2 * 0.27) / 0.5) / M_PI;  // beginning of slip in every half cycle
  for (const int substeps : {1, 7}) {
    model::Model model(swinging(), Tpetra::getDefaultComm());
    Real work = 0, d = 0, l_t = 0, t = 0;
    const auto go_to = [&](Real end) {
      const Real start = t;
      for (int k = 1; k <= substeps; ++k) {
        t = start + k * (end - start) / substeps;
        ASSERT_TRUE(model.step_to(t).converged);
        const Real d_new = 0.5 * std::cos(M_PI * t), l_new = mean(model, Outputs(model)["traction"], 0);
        work += 0.5 * (l_t + l_new) * (d_new - d);
        d = d_new;
        l_t = l_new;
      }
    };
    go_to(1);
    work = 0;
    for (const Real half : {1, 2})
      for (const Real end : {half + begin, half + 1}) go_to(end);
    EXPECT_NEAR(work, 0.1656, tolerance);
    expect_joint(model, expected(2, {1, 0, 0}, -0.18, -0.23));
  }
}

}  // namespace
}  // namespace sprekk::tests
