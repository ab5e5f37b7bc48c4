// Prescribed slip compared with exact tractions of dislocations and cracks, with convergence orders.
#include "verification/tips/crack.hpp"

#include "base/over_ranks.hpp"

namespace sprekk::tests {
namespace {

using Exact = std::function<Vector3(const Vector3&)>;

/// Solves one step. Returns the relative L2 error of the tractions of the faces at a distance below 0.5 from the
/// centre, for the normal +y or +z. Compares jumps that are linear in a face. Collective.
Real traction_error(const model::Scene& scene, const Exact& traction, const std::optional<Vector3>& jump = {}) {
  model::Model model(scene, Tpetra::getDefaultComm());
  const auto report = model.step_to(1);
  EXPECT_TRUE(report.converged) << report.reason;
  EXPECT_LE(report.newton_iterations, 2);
  const Outputs out(model);
  std::array<Real, 2> sums{};
  for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
    const auto& face = model.mesh().fracture_faces[f];
    const Real sign = face.frame[0][1] + face.frame[0][2] > 0 ? 1 : -1;
    auto w = out.vector("jump", f);
    for (Real& component : w) component *= sign;
    if (jump) {
      EXPECT_NEAR(norm(difference(w, *jump)), 0, 1e-10 * norm(*jump));
    }
    if (std::hypot(face.centre[0], face.centre[1]) >= 0.5) continue;
    auto t = out.vector("traction", f);
    for (Real& component : t) component *= sign;
    const auto exact = traction(face.centre), error = difference(t, exact);
    sums[0] += face.area * dot(error, error);
    sums[1] += face.area * dot(exact, exact);
  }
  sums = base::sum_over_ranks(*model.mesh().comm, sums);
  return std::sqrt(sums[0] / sums[1]);
}

/// Expects that the error decreases with at least this mean order from the first to the last number of cells, which
/// differ by powers of two.
void expect_order(const std::string& name, const std::vector<int>& cells, const std::function<Real(int)>& error,
                  Real order) {
  const Real first = error(cells.front()), last = error(cells.back());
  const Real found = std::log(first / last) / std::log(Real(cells.back()) / cells.front());
  EXPECT_GE(found, order) << name << ": " << first << ", then " << last;
}

/// Uniform slip of 1 mm in plane strain: tau = b G/(pi (1 - nu) (x^2 - 1)).
TEST(PrescribedSlip, PairOfEdgeDislocations) {
  const Real b = 1e-3, D = 30e9 * b / (M_PI * 0.75);
  for (const std::string cell : {"quadrilateral", "triangle"})
    expect_order(
        "edge dislocations, " + cell, {16, 64},
        [&](int n) {
          const auto scene = read_scene("verification/dislocation_2d.xml",
                                        {"Mesh.cell=" + cell, fmt::format("Mesh.cells={{{}, {}}}", n, n)});
          return traction_error(
              scene,
              [&](const Vector3& x) {
                return Vector3{D / (x[0] * x[0] - 1), 0, 0};
              },
              Vector3{b, 0, 0});
        },
        1);
}

/// Returns the slab of crack_in_box() with a crack in antiplane strain along z, without initial stress, stress drop
/// 1e-3:
///   u_z = 1e-3 Im(sqrt(zeta^2 - 1) - zeta),  zeta = x + i y;  slip 2e-3 sqrt(1 - x^2).
model::Scene tearing_crack(const std::string& cell, int n, const physics::PrescribedSlip& slip) {
  auto scene = crack_in_box("sliding", cell, 1, n, "enriched");
  scene.bulk.initial_stress.clear();
  for (auto& [name, condition] : scene.boundary_conditions) {
    const bool ends = name == "bottom" || name == "top";
    const std::string along = ends ? "free"
                                   : "1e-3*((y < 0 ? -1 : 1)*sqrt(max(sqrt(((x - 1)^2 + y^2)*((x + 1)^2 + y^2)) - (x^2 "
                                     "- y^2 - 1), 0)/2) - y)";
    condition.displacement = {base::Expression(0), base::Expression(0), base::Expression(along)};
  }
  scene.fractures["crack"].prescribed_slip = slip;
  return scene;
}

/// Cubes alternate the errors of adjacent faces near tips; the error decreases from 16 cells on, four faces in |x| <
/// 0.5. On the vertical fault the side towards +y moves up the dip. The same motion by the other side and a vector.
TEST(PrescribedSlip, CrackInAntiplaneStrain) {
  const base::Expression zero(0), profile("2e-3*sqrt(max(1 - x^2, 0))");
  const Exact traction = [](const Vector3&) { return Vector3{0, 0, -1e-3}; };
  for (const std::string cell : {"hexahedron", "tetrahedron"})
    expect_order(
        "antiplane strain, " + cell, cell == "hexahedron" ? std::vector{16, 64} : std::vector{8, 32},
        [&](int n) {
          physics::PrescribedSlip slip;
          slip.slip = {zero, profile};
          slip.opening = zero;
          const Real by_dip = traction_error(tearing_crack(cell, n, slip), traction);
          slip.slip = {profile};
          slip.direction = {0, 1, -2};
          slip.moving_side = {0.3, -1, 0};
          EXPECT_NEAR(traction_error(tearing_crack(cell, n, slip), traction), by_dip, 1e-8);
          return by_dip;
        },
        1);
}

/// Slip of a crack with the stress drop 1e-3, under compression: the shear traction is 5e-4. In 3D along the strike.
TEST(PrescribedSlip, UniformStressDrop) {
  for (const std::string cell : {"quadrilateral", "triangle", "hexahedron", "tetrahedron"})
    for (const int order : {1, 2}) {
      const bool flat = cell == "quadrilateral" || cell == "triangle";
      if (!flat && order == 2) continue;
      expect_order(
          fmt::format("uniform stress drop, {} of order {}", cell, order), {8, 32},
          [&](int n) {
            auto scene = crack_in_box("sliding", cell, order, n, "enriched");
            auto& slip = scene.fractures["crack"].prescribed_slip.emplace();
            slip.slip = {base::Expression("-1.5e-3*sqrt(max(1 - x^2, 0))")};
            if (!flat) slip.slip.emplace_back(0);
            return traction_error(scene, [](const Vector3&) { return Vector3{5e-4, -1e-3, 0}; });
          },
          1);
    }
}

/// The state of the ageing law follows the prescribed slip, also under a shear traction far from the friction bound:
/// rest, theta = theta_0 + t, then slip at the rate V, theta = L/V + (theta_0 - L/V) exp(-V t/L).
TEST(PrescribedSlip, StateOfFrictionByRate) {
  constexpr Real L = 1e-5, V = 1e-8;
  auto scene = read_scene("earthquakes/spring_slider_2d.xml");
  auto& slip = scene.fractures["fault"].prescribed_slip.emplace();
  slip.slip = {base::Expression("t < 1500 ? 0 : 1e-8*(t - 1500)")};
  model::Model model(scene, Tpetra::getDefaultComm());
  Real theta = 1e4;
  for (const Real t : {500, 1500, 2000, 3000}) {
    const Real dt = t - model.time();
    ASSERT_TRUE(model.step_to(t).converged) << t;
    theta = t <= 1500 ? theta + dt : L / V + (theta - L / V) * std::exp(-V * dt / L);
    for (const Real found : model.output("friction state").values) EXPECT_NEAR(found, theta, 1e-9 * theta) << t;
  }
}

/// Prescribed opening of a circular crack under the pressure 1e-3 (Sneddon 1946).
TEST(PrescribedSlip, OpeningOfACircularCrack) {
  const auto error = [](int order, int n) {
    const auto scene = read_scene(
        "verification/penny.xml",
        {fmt::format("Mesh file.order={}", order), fmt::format("Mesh file.refinements={}", n - 1),
         "Fractures.crack.fluid pressure=0", "Fractures.crack.prescribed slip.slip={0}",
         "Fractures.crack.prescribed slip.direction={1, 0, 0}", "Fractures.crack.prescribed slip.moving side={0, 0, 1}",
         "Fractures.crack.prescribed slip.opening=3e-3/pi*sqrt(max(1 - x^2 - y^2, 0))"});
    return traction_error(scene, [](const Vector3&) { return Vector3{0, 0, -1e-3}; });
  };
  expect_order(
      "circular crack", {1, 2}, [&](int n) { return error(1, n); }, 1);
  EXPECT_LE(error(2, 1), 0.03);
}

}  // namespace
}  // namespace sprekk::tests
