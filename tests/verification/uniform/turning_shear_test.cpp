// Shear with rotating direction, at constant normal force: mu N = 0.18, K_s = 2/3 of rock and joint in series. The
// elastic displacement during slip is S = 0.27.
#include "verification/uniform/states.hpp"

namespace sprekk::tests {
namespace {

constexpr Real bound = 0.18, S = 0.27, D = 0.5;

model::Scene turning(const Discretisation& d, const std::vector<std::string>& overrides = {}) {
  return read_scene("verification/turning_shear_3d.xml", d.with(overrides));
}

/// Shears from (0, 0) to (D, 0) in one step, then to (D, 0.4) in n equal steps.
void go_round_the_corner(model::Model& model, int n) {
  ASSERT_TRUE(model.step_to(1).converged);
  for (int k = 1; k <= n; ++k) {
    const auto report = model.step_to(1 + static_cast<Real>(k) / n);
    ASSERT_TRUE(report.converged) << report.reason;
  }
}

/// Returns the state after n steps of implicit Euler (radial return): u^p += (1 - S/|e|) e if e = d_t - u^p is longer
/// than S, and lambda_t = K_s (d_t - u^p).
Expected after_corner(int n, Real tolerance) {
  std::array<Real, 2> p = {D - S, 0}, e;
  for (int k = 1; k <= n; ++k) {
    e = {D - p[0], 0.4 * k / n - p[1]};
    const Real shrink = std::max<Real>(0, 1 - S / std::hypot(e[0], e[1]));
    for (int i = 0; i < 2; ++i) p[i] += shrink * e[i];
  }
  const Vector3 l = {2.0 / 3 * (D - p[0]), 2.0 / 3 * (0.4 - p[1]), -0.3};
  return {{0, 0, 1}, {l[0] / 2, l[1] / 2, 0}, {p[0], p[1], 0}, l, tolerance, tolerance};
}

/// Compares after_corner() with an independent computation.
TEST(TurningShear, ReferenceOfTheCorner) {
  for (const auto& [n, x, y] : {std::tuple{1, 0.100705113900191, 0.149192761333617},
                                {4, 0.086703396577055, 0.157741944396543},
                                {64, 0.078480004325677, 0.161990397619864}}) {
    const auto e = after_corner(n, 0);
    EXPECT_NEAR(e.traction[0], x, 1e-14);
    EXPECT_NEAR(e.traction[1], y, 1e-14);
  }
}

TEST(TurningShear, Corner) {
  for (const auto& d : discretisations(3))
    for (const int n : {1, 4}) {
      SCOPED_TRACE(fmt::format("{}, {} steps", d.name(), n));
      model::Model model(turning(d), Tpetra::getDefaultComm());
      go_round_the_corner(model, n);
      expect_joint(model, after_corner(n, tolerance));
    }
}

/// Along the second part, of length v, the angle psi between d_t - u^p and the velocity is tan(psi/2) = tan(psi_0/2)
/// exp(-v/S), psi_0 = 90 degrees (Krieg and Krieg 1977). The error is first order in the time step.
TEST(TurningShear, FirstOrderInTime) {
  const Real psi = 2 * std::atan(std::exp(-0.4 / S));
  const Vector3 exact = {bound * std::sin(psi), bound * std::cos(psi), 0};
  std::vector<Real> errors;
  for (const int n : {8, 16, 32}) {
    model::Model model(turning({"hexahedron", 1}), Tpetra::getDefaultComm());
    go_round_the_corner(model, n);
    const auto traction = Outputs(model)["traction"];
    errors.push_back(std::hypot(mean(model, traction, 0) - exact[0], mean(model, traction, 1) - exact[1]));
    if (errors.size() > 1) {
      const Real order = std::log2(errors[errors.size() - 2] / errors.back());
      EXPECT_NEAR(order, 1, 0.1) << n;
    }
  }
  EXPECT_LT(errors.back(), 2e-3);
}

/// Rotates with |d_t| = D until the state is periodic in the rotating frame. Then u^p is on a circle of radius -S
/// sin(a/2) + sqrt(D^2 - S^2 cos^2(a/2)), with the angle a per step. The traction leads it by 90 degrees - a/2.
void expect_circle(const Discretisation& d, const std::string& cells, int n, Real radius) {
  SCOPED_TRACE(fmt::format("{}, {} steps per turn", d.name(), n));
  model::Model model(turning(d, {"Boundary conditions.moved.displacement={0.5*min(t, 1)*cos(2*pi*max(t - 1, 0)), "
                                 "0.5*sin(2*pi*max(t - 1, 0)), -0.1}",
                                 "Mesh.cells=" + cells}),
                     Tpetra::getDefaultComm());
  ASSERT_TRUE(model.step_to(1).converged);
  Real before = 0, now = -1;
  int k = 0;
  for (; std::abs(now - before) > 1e-14; ++k) {
    ASSERT_LT(k, 12 * n);
    ASSERT_TRUE(model.step_to(1 + static_cast<Real>(k + 1) / n).converged);
    const Outputs out(model);
    before = now;
    now = std::hypot(mean(model, out["plastic jump"], 0), mean(model, out["plastic jump"], 1));
  }
  const Real turned = 2 * M_PI * k / n, half = M_PI / n;
  EXPECT_NEAR(radius, -S * std::sin(half) + std::sqrt(D * D - S * S * std::cos(half) * std::cos(half)), 1e-14);
  const Outputs out(model);
  const Vector3 jump = {mean(model, out["plastic jump"], 0), mean(model, out["plastic jump"], 1), 0};
  const Vector3 traction = {mean(model, out["traction"], 0), mean(model, out["traction"], 1), 0};
  const Real lead = std::atan2(jump[0] * traction[1] - jump[1] * traction[0], dot(jump, traction));
  EXPECT_NEAR(norm(jump), radius, 1e-10);
  EXPECT_NEAR(norm(traction), bound, 1e-10);
  EXPECT_NEAR(lead, M_PI / 2 - half, 1e-10);
  EXPECT_NEAR(dot(traction, {std::cos(turned), std::sin(turned), 0}),
              2.0 / 3 * (D - dot(jump, {std::cos(turned), std::sin(turned), 0})), 1e-10);
}

TEST(TurningShear, Circle) {
  for (const auto& d : discretisations(3)) expect_circle(d, "{2, 2, 2}", 8, 0.330006706645024);
  expect_circle({"hexahedron", 1}, "{1, 1, 2}", 64, 0.407792719656629);
}

/// Compares frame-independent means over the fracture: normal and tangential jump and traction.
void expect_invariants(model::Model& model, const Expected& e) {
  const Outputs out(model);
  const auto expect_same = [&](const char* name, Real normal, const Vector3& tangential) {
    const auto& local = out[name];
    EXPECT_NEAR(mean(model, local, 0), normal, 1e-9) << name;
    EXPECT_NEAR(std::hypot(mean(model, local, 1), mean(model, local, 2)), norm(tangential), 1e-9) << name;
  };
  expect_same("jump local", e.elastic[2] + e.plastic[2], {e.elastic[0] + e.plastic[0], e.elastic[1] + e.plastic[1], 0});
  expect_same("traction local", e.traction[2], {e.traction[0], e.traction[1], 0});
}

/// The result does not depend on rotation, translation by 1000 km, order of sides, and numbering. Far away, the
/// coordinates of a block of 1 m are rounded to 4e-10 of a cell, with a corresponding error of the strains.
TEST(TurningShear, DoesNotSeeTheFrame) {
  const Vector3 far = {0.6e6, 0, 0.8e6};
  for (const auto& d : discretisations(3))
    for (const Real degrees : {0.0, -118.0})
      for (const Vector3& shift : {Vector3{0, 0, 0}, far})
        for (const bool other : {false, true}) {
          SCOPED_TRACE(fmt::format("{}, {} degrees, moved by ({}), swapped and renumbered: {}", d.name(), degrees,
                                   fmt::join(shift, ", "), other));
          auto scene = turning(d);
          translate(scene, shift);
          scene.mesh.fractures.at("fracture").swap_sides = other;
          if (other) scene.mesh.renumbering_seed = 7;
          const auto Q = turn(scene, degrees, {1, 2, 3});
          model::Model model(scene, Tpetra::getDefaultComm());
          go_round_the_corner(model, 4);
          const bool moved = norm(shift) > 0;
          expect_joint(model, after_corner(4, moved ? (degrees == 0 ? 1e-9 : 4e-9) : tolerance), Q);
          expect_invariants(model, after_corner(4, 0));
        }
}

}  // namespace
}  // namespace sprekk::tests
