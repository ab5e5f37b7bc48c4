// Heat fronts along fractures and away from them, compared with exact solutions.
#include "../uniform/states.hpp"
#include "base/over_ranks.hpp"
#include "warm_boxes.hpp"

namespace sprekk::tests {
namespace {

constexpr Real conductivity = 2.5, rock_capacity = 2.2e6, fluid_capacity = 4.2e6;

/// Returns rock at 0 K around a fracture in the plane y = 0 (3D: z = 0), with conduction only normal to the fracture.
model::Scene rock_around_fracture(const std::string& cell, const std::vector<Real>& lower,
                                  const std::vector<Real>& upper, const std::vector<int>& cells, int across) {
  auto scene = closed_box(cell, false);
  scene.mesh.cells = cells;
  scene.mesh.lower_corner = lower;
  scene.mesh.upper_corner = upper;
  auto& fracture = scene.mesh.fractures["a"];
  fracture = {lower, upper};
  fracture.lower_corner[across] = fracture.upper_corner[across] = 0;
  auto& rock = scene.materials.at("rock");
  rock.permeability = {Expression(1e-30)};
  warm(scene, 0, 1, rock_capacity, fluid_capacity);
  rock.thermal_conductivity.assign(lower.size(), Expression(1e-9));
  rock.thermal_conductivity[across] = Expression(conductivity);
  scene.materials.at("joint").filling_conductivity = Expression(100);
  return scene;
}

/// Returns the largest error of the fracture temperature at the given distances along x, after n equal steps to t.
template <class Exact>
Real error_of_front(const model::Scene& scene, Real t, int n, const std::vector<Real>& places, const Exact& exact) {
  model::Model model(scene, Tpetra::getDefaultComm());
  for (int step = 1; step <= n; ++step) EXPECT_TRUE(model.step_to(step * t / n).converged);
  Real worst = 0;
  for (const Real x : places) {
    const Real at = value_at(model, "fracture temperature", {x, 0, is_flat(scene.mesh.cell) ? 0 : 0.5});
    worst = std::max(worst, std::abs(at - exact(x)));
  }
  return worst;
}

/// Fluid at 1 K enters a fracture with v = 1e-2 m/s (Lauwerier 1955):
/// T_f = erfc(A x/sqrt(t - x/v)), A = sqrt(k rho c)/(rho_f c_f b v). First order with upwind flow.
TEST(HeatInFractures, AFractureWarmsTheRock) {
  constexpr Real v = 1e-2, t = 1e6;
  const auto exact = [&](Real x) {
    return std::erfc(std::sqrt(conductivity * rock_capacity) / (fluid_capacity * aperture * v) * x /
                     std::sqrt(t - x / v));
  };
  EXPECT_NEAR(exact(10), 0.429488231027, 1e-10);
  for (const std::string cell : {"quadrilateral", "hexahedron"}) {
    std::vector<Real> errors;
    for (const int n : {6, 12}) {
      auto scene = is_flat(cell) ? rock_around_fracture(cell, {0, -8}, {20, 8}, {2 * n, 4 * n}, 1)
                                 : rock_around_fracture(cell, {0, -8, 0}, {20, 8, 1}, {2 * n, 4 * n, 1}, 1);
      inject(scene, "west", "a", aperture * v);
      constrain(scene, "east", "0", "a");
      prescribe_temperature(scene, "west", "1", "a");
      errors.push_back(error_of_front(scene, t, 2 * n, {20.0 * 5 / 24, 20.0 * 11 / 24, 20.0 * 17 / 24}, exact));
    }
    EXPECT_LT(errors[1], 0.05) << cell;
    EXPECT_GT(std::log2(errors[0] / errors[1]), 0.7) << cell << ": " << errors[0] << ", " << errors[1];
  }
}

/// Fractures at a spacing of 10 m, so that the fronts between them interact (Gringarten, Witherspoon and Ohnishi
/// 1975). At 3e7 s and 50 m: 0.659390165260, by inversion of exp(-(x/v) (s + 2k/(rho_f c_f b) q tanh(q D)))/s, q =
/// sqrt(s rho c/k), D = 5 m. A single fracture has 0.47.
TEST(HeatInFractures, ParallelFracturesWarmTheRockBetweenThem) {
  const auto exact = [](Real) { return 0.659390165260; };
  for (const std::string cell : {"quadrilateral", "hexahedron"}) {
    std::vector<Real> errors;
    for (const int n : {6, 12}) {
      auto scene = is_flat(cell) ? rock_around_fracture(cell, {0, -5}, {60, 5}, {6 * n, 2 * n}, 1)
                                 : rock_around_fracture(cell, {0, -5, 0}, {60, 5, 1}, {6 * n, 2 * n, 1}, 1);
      inject(scene, "west", "a", aperture * 1e-2);
      constrain(scene, "east", "0", "a");
      prescribe_temperature(scene, "west", "1", "a");
      // Mean of the two faces adjacent to x = 50 m.
      const Real h = 60.0 / (6 * n);
      model::Model model(scene, Tpetra::getDefaultComm());
      for (int step = 1; step <= 3 * n; ++step) ASSERT_TRUE(model.step_to(step * 3e7 / (3 * n)).converged);
      const Real z = is_flat(cell) ? 0 : 0.5;
      const Real at = 0.5 * (value_at(model, "fracture temperature", {50 - h / 2, 0, z}) +
                             value_at(model, "fracture temperature", {50 + h / 2, 0, z}));
      errors.push_back(std::abs(at - exact(50)));
    }
    EXPECT_LT(errors[1], 0.015) << cell;
    EXPECT_GT(std::log2(errors[0] / errors[1]), 0.7) << cell << ": " << errors[0] << ", " << errors[1];
  }
}

/// Fluid at 1 K flows radially from a well into a horizontal fracture, 1e-3 m^3/s (Lauwerier's problem, radial). At
/// 1e7 s: T_f = erfc(pi r^2 sqrt(k rho c)/(rho_f c_f Q sqrt(t - pi r^2 b/Q))), 0.753655784467 at 20 m. A quarter of
/// the plane.
TEST(HeatInFractures, AWellWarmsTheRock) {
  constexpr Real Q = 1e-3, t = 1e7;
  const auto exact = [&](Real r) {
    return std::erfc(M_PI * r * r * std::sqrt(conductivity * rock_capacity) /
                     (fluid_capacity * Q * std::sqrt(t - M_PI * r * r * aperture / Q)));
  };
  EXPECT_NEAR(exact(20), 0.753655784467, 1e-10);
  EXPECT_NEAR(exact(40), 0.209287483075, 1e-10);
  std::vector<Real> errors;
  for (const int n : {10, 20}) {
    auto scene = rock_around_fracture("hexahedron", {0, 0, -12}, {80, 80, 12}, {n, n, n}, 2);
    auto& well = scene.flow->wells["injector"];
    const Real h = 80.0 / n;
    well.points = {h / 2, h / 2, -6, h / 2, h / 2, 6};
    well.radius = 0.1;
    well.rate = Expression(Q / 4);
    scene.heat->wells["injector"].temperature = Expression(1);
    for (const std::string side : {"east", "north"}) constrain(scene, side, "0", "a");
    model::Model model(scene, Tpetra::getDefaultComm());
    for (int step = 1; step <= n; ++step) ASSERT_TRUE(model.step_to(step * t / n).converged);
    const auto T = model.output("fracture temperature").values;
    std::vector<Real> sum(2, 0);  // of errors, and their number, between 15 and 45 m from the well
    for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
      const auto& x = model.mesh().fracture_faces[f].centre;
      const Real r = std::hypot(x[0], x[1]);
      if (r < 15 || r > 45) continue;
      sum[0] += std::abs(T[f] - exact(r));
      sum[1] += 1;
    }
    sum = base::sum_over_ranks(*model.mesh().comm, sum);
    errors.push_back(sum[0] / sum[1]);
  }
  EXPECT_LT(errors[1], 0.05);
  EXPECT_GT(std::log2(errors[0] / errors[1]), 0.6) << errors[0] << ", " << errors[1];
}

/// Column of 40 m with a joint at mid-height and sides on rollers; displacement (2, -2) mm of its top. Then the joint
/// is cooled by 50 K. The cold fronts, with the integral 4 dT sqrt(kappa t/pi) over the height, reduce its
/// compression: it slips at 2.24e5 s and opens at 1.396e6 s. In 2D the exact temperature is prescribed.
TEST(ThermalStress, AColdFrontMakesAJointSlipAndOpen) {
  struct State {
    Real t, N, u_p;
  };
  const State states[] = {{1e5, 1.423187838e6, 0},
                          {3e5, 1.038758272e6, 2.133357715e-4},
                          {1e6, 0.294592688e6, 1.493300576e-3},
                          {1.3e6, 0.066936276e6, 1.884869606e-3}};
  for (const int dim : {2, 3}) {
    std::vector<Real> errors;
    for (const int n : {40, 80}) {
      auto scene = read_scene(fmt::format("verification/regimes_{}d.xml", dim));
      tie_sides(scene);
      scene.mesh.periodic = {"x"};
      for (int k = 0; k < dim; ++k) scene.mesh.cells[k] = k == 0 ? 3 : k < dim - 1 ? 1 : 2 * n;
      const auto stretched = [&](std::vector<Real>& corner) { corner[dim - 1] *= 40; };
      stretched(scene.mesh.lower_corner);
      stretched(scene.mesh.upper_corner);
      for (auto& [name, fracture] : scene.mesh.fractures) {
        stretched(fracture.lower_corner);
        stretched(fracture.upper_corner);
      }
      auto& rock = scene.materials.at("rock");
      rock.G = Expression(15e9);
      rock.lambda = Expression(10e9);
      rock.thermal_expansion = Expression(1e-5);
      auto& joint = scene.materials.at("joint");
      joint.dilation_angle = Expression(0);
      joint.initial_gap = Expression(0);
      joint.maximum_closure = Expression(1e-4);
      joint.normal_stiffness = Expression(2e10);
      joint.tangential_stiffness = Expression(5e9);
      joint.initial_aperture = Expression(1e-3);
      joint.filling_conductivity = Expression(1e12);  // both sides have equal temperatures
      warm(scene, 300, 2.2, 2.2e6, 0);
      auto& moved = scene.boundary_conditions.at("moved").displacement;
      moved.assign(dim, Expression(0));
      moved[0] = Expression(2e-3);
      moved[dim - 1] = Expression(-2e-3);
      if (dim == 2)
        scene.regions["bulk"].temperature = Expression("t > 0 ? 300 - 50*erfc(abs(y - 20)/sqrt(4e-6*t)) : 300");
      for (const std::string side : {"south", "north"})
        if (dim == 3) {
          prescribe_temperature(scene, side, "250", scene.mesh.fractures.begin()->first);
          auto& rolls = scene.boundary_conditions[side + " rolls"];
          rolls.boundary = side;
          rolls.displacement = {Expression("free"), Expression(0), Expression("free")};
        }
      model::Model model(scene, Tpetra::getDefaultComm());
      Real before = 0, worst = 0;
      for (const auto& s : states) {
        const int steps = n / 4;
        for (int k = 1; k <= steps; ++k) {  // equal advances of the front
          const Real root = std::sqrt(before) + (std::sqrt(s.t) - std::sqrt(before)) * k / steps;
          ASSERT_TRUE(model.step_to(k == steps ? s.t : root * root).converged) << dim << " " << s.t;
        }
        before = s.t;
        const auto traction = model.output("traction local"), jump = model.output("plastic jump local");
        for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
          Real slip = 0;
          for (int k = 1; k < dim; ++k) slip = std::hypot(slip, jump.values[dim * f + k]);
          worst =
              std::max({worst, std::abs(traction.values[dim * f] + s.N) / 1.95062490e6, std::abs(slip - s.u_p) / 2e-3});
        }
      }
      errors.push_back(base::max_over_ranks(*model.mesh().comm, worst));
    }
    EXPECT_LT(errors[1], 0.02) << dim;
    EXPECT_GT(std::log2(errors[0] / errors[1]), 0.8) << dim << ": " << errors[0] << ", " << errors[1];
  }
}

}  // namespace
}  // namespace sprekk::tests
