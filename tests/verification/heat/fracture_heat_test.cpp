// Heat in fractures and advected heat, compared with exact solutions.
#include "warm_boxes.hpp"

namespace sprekk::tests {
namespace {

/// Block of 10 m, k = 2.5 W/(m K), with a filled joint of 5 mm, 0.6 W/(m K), across the heat flow under 10 K: q =
/// 10/(L/k + a/k_f).
TEST(HeatInFractures, AFilledJointIsAResistanceInSeries) {
  constexpr Real q = 10 / (10 / 2.5 + 5e-3 / 0.6);
  for (const std::string cell : all_cells) {
    const bool flat = is_flat(cell);
    auto scene = closed_box(cell, false);
    for (auto& c : scene.mesh.upper_corner) c *= 10;
    for (auto* corner : {&scene.mesh.fractures["a"].lower_corner, &scene.mesh.fractures["a"].upper_corner})
      for (auto& c : *corner) c *= 10;
    scene.flow.reset();
    scene.bulk.rigid = true;
    warm(scene, 0, 2.5, 0, 0);
    auto& joint = scene.materials.at("joint");
    joint.initial_aperture = Expression(5e-3);
    joint.filling_conductivity = Expression(0.6);
    prescribe_temperature(scene, "south", "10");
    prescribe_temperature(scene, "north", "0");
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1).converged) << cell;
    EXPECT_LT(error(model, "heat flux", [&](const auto&, const auto&) { return Vector3{0, q, 0}; }), 1e-9) << cell;
    EXPECT_LT(error(model, "fracture temperature", [&](const auto&, const auto&) { return Vector3{5}; }), 1e-9)
        << cell << flat;
  }
}

/// At the intersection of two fractures, 2 parts of fluid at 20 K mix with 1 part at 80 K and leave with the mixing
/// temperature.
TEST(HeatInFractures, MixesWhereTheyMeet) {
  for (const std::string cell : all_cells)
    for (const auto& [out, other] : {std::pair("east", "north"), {"north", "east"}}) {
      auto scene = closed_box(cell);
      scene.materials.at("rock").permeability = {Expression(1e-30)};
      scene.materials.at("joint").filling_conductivity = Expression(1e-5);
      warm(scene, 0, 1e-8, 0, 3);
      inject(scene, "west", "a", 2);
      inject(scene, "south", "b", 1);
      inject(scene, out, out == std::string("east") ? "a" : "b", -1.2);
      constrain(scene, other, "0", other == std::string("east") ? "a" : "b");
      prescribe_temperature(scene, "west", "20", "a");
      prescribe_temperature(scene, "south", "80", "b");
      prescribe_temperature(scene, "west", "20");
      model::Model model(scene, Tpetra::getDefaultComm());
      const auto report = model.step_to(1e9);
      ASSERT_TRUE(report.converged) << cell << report.reason;
      const auto T = [&](const Vector3& x, const Vector3& n) {
        const bool in_a = std::abs(n[1]) > 0.5;
        return Vector3{x[in_a ? 0 : 1] > 0.5 ? 40.0 : in_a ? 20.0 : 80.0};
      };
      EXPECT_LT(error(model, "fracture temperature", T), 1e-5)
          << cell << " " << out;  // conduction is 1e-8 of advection
    }
}

/// Steady advection and conduction, T(0) = 0, T(1) = 1: T = (exp(Pe x) - 1)/(exp(Pe) - 1). Convergence with first
/// order at Pe = 10. At Pe = 1000, on cells with two-point fluxes, T is monotonic and between 0 and 1.
TEST(HeatInRock, IsCarriedWithTheFluid) {
  for (const std::string cell : {"quadrilateral", "hexahedron", "triangle"}) {
    std::vector<Real> errors;
    for (const auto& [n, Pe] : {std::pair(20, 10.0), {40, 10.0}, {50, 1000.0}}) {
      auto scene = closed_box(cell, false, 1);
      const bool flat = is_flat(cell);
      scene.mesh.fractures.clear();
      scene.fractures.clear();
      scene.mesh.cells[0] = n;
      scene.mesh.upper_corner = flat ? std::vector<Real>{1, 0.05} : std::vector<Real>{1, 0.05, 0.05};
      warm(scene, 0, 1, 0, 2);
      auto& west = scene.boundary_conditions["inflow"];
      west.boundary = "west";
      west.flux = Expression(-Pe / 2);
      constrain(scene, "east", "0");
      prescribe_temperature(scene, "west", "0");
      prescribe_temperature(scene, "east", "1");
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged) << cell;
      const auto exact = [Pe = Pe](const Vector3& x, const auto&) {
        return Vector3{std::exp(Pe * (x[0] - 1)) * (1 - std::exp(-Pe * x[0])) / (1 - std::exp(-Pe))};
      };
      if (Pe < 100) errors.push_back(error(model, "temperature", exact));
      if (Pe < 100 || cell == std::string("triangle")) continue;
      for (const Real T : model.output("temperature").values) {
        EXPECT_GE(T, -1e-12) << cell;
        EXPECT_LE(T, 1 + 1e-12) << cell;
      }
    }
    EXPECT_GT(std::log2(errors[0] / errors[1]), 0.8) << cell << ": " << errors[0] << ", " << errors[1];
    EXPECT_LT(errors[1], 0.1) << cell;
  }
}

/// Injection into a network of slipping and opening fractures, with water at the temperature of the rock: temperatures
/// stay constant, up to round-off.
TEST(HeatInFractures, NothingChangesWhereAllIsEquallyWarm) {
  auto scene = read_scene("poro/injection_2d.xml", {"Mesh.cells={20, 20}"});
  warm(scene, 350, 2.5, 2.2e6, 4.2e6);
  scene.heat->wells["injector"].temperature = Expression(350);
  for (const std::string side : {"west", "east"}) prescribe_temperature(scene, side, "350");
  model::Model model(scene, Tpetra::getDefaultComm());
  for (const Real t : {1800.0, 3600.0, 7200.0, 36000.0}) ASSERT_TRUE(model.step_to(t).converged) << t;
  const auto same = [](const auto&, const auto&) { return Vector3{350}; };
  EXPECT_LT(error(model, "temperature", same), 1e-9);
  EXPECT_LT(error(model, "fracture temperature", same), 1e-9);
}

/// Returns a joint between impermeable rocks, with the displacement `lid` (m) of the upper rock. Warmer fluid enters
/// through both ends and leaves again.
model::Scene pulled_joint(const std::string& cell, int n, Real rock_capacity, Real fluid_capacity,
                          const std::string& lid) {
  auto scene = closed_box(cell, false, n);
  scene.flow->rigid_rock = false;
  auto& rock = scene.materials.at("rock");
  rock.E = Expression(1e9);
  rock.nu = Expression(0.2);
  rock.biot = 0;
  rock.compressibility.reset();
  rock.porosity = 0;
  rock.permeability = {Expression(1e-18)};
  auto& joint = scene.materials.at("joint");
  joint.friction_coefficient = Expression(0.6);
  joint.tangential_stiffness = Expression(1e9);
  warm(scene, 10, 2.5, rock_capacity, fluid_capacity);
  auto &below = scene.boundary_conditions["floor"], &above = scene.boundary_conditions["lid"];
  below.boundary = "south";
  below.displacement.assign(is_flat(cell) ? 2 : 3, Expression(0));
  above.boundary = "north";
  above.displacement = below.displacement;
  above.displacement[1] = Expression(lid);
  for (const std::string side : {"west", "east"}) {
    constrain(scene, side, "0");
    scene.boundary_conditions[side].temperature = Expression("50 + t");
  }
  return scene;
}

/// Returns the heat in rock and fluid, relative to 0 K. Collective.
Real heat_content(model::Model& model, Real rock_capacity, Real fluid_capacity) {
  const auto& mesh = model.mesh();
  const auto T = model.output("temperature").values, T_f = model.output("fracture temperature").values,
             a = model.output("aperture").values;
  Real here = 0, all = 0;
  for (LocalIndex k = 0; k < mesh.n_owned_cells; ++k)
    here += rock_capacity * T[k] / static_cast<Real>(mesh.n_global_cells);
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f)
    here += fluid_capacity * a[f] * T_f[f] * mesh.fracture_faces[f].area;
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_SUM, 1, &here, &all);
  return all;
}

/// Returns the heat that enters through the ends in the step that ends at t: by conduction, by temperature difference,
/// and with the fluid.
Real heat_that_enters(model::Model& model, Real t, Real dt, Real fluid_capacity) {
  Real sum = 0;
  for (const auto& reaction : model.system().reactions(model.state())) {
    if (reaction.field == "face temperature") sum += dt * reaction.force.at(0);
    if (reaction.field == "face pressure") sum += dt * fluid_capacity * (50 + t) * reaction.force.at(0);
  }
  return sum;
}

/// The joint opens tenfold and closes to half. In each step, the inflow of heat equals the gain of rock and fluid, by
/// the rates of the time scheme. BDF2 counts 3/2 of the gain minus 1/2 of the previous gain, here from the third step.
TEST(HeatInFractures, IsInBalanceWhileAperturesChange) {
  constexpr Real c = 4.2e6, rc = 2.2e6;
  for (const auto& [cell, scheme] :
       {std::pair("quadrilateral", "implicit Euler"), {"tetrahedron", "implicit Euler"}, {"tetrahedron", "BDF2"}}) {
    auto scene = pulled_joint(cell, 4, rc, c, "t < 4 ? 9e-3*t/4 : 9e-3*(1 - (t - 4)/5)");
    scene.time.scheme = scheme;
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(0.5).converged) << cell;
    Real before = heat_content(model, rc, c), maximum = 0, gained = 0;
    for (int step = 2; step <= 14; ++step) {
      ASSERT_TRUE(model.step_to(0.5 * step).converged) << cell;
      const Real inflow = heat_that_enters(model, 0.5 * step, 0.5, c), after = heat_content(model, rc, c);
      maximum = std::max(maximum, std::abs(inflow));
      const Real gains = after - before;
      const bool counts_two = scene.time.scheme == "BDF2";
      if (!counts_two || step > 2)
        EXPECT_NEAR(counts_two ? 1.5 * gains - 0.5 * gained : gains, inflow, 1e-11 * after) << cell << " " << step;
      before = after;
      gained = gains;
    }
    EXPECT_GT(maximum, 1e4) << cell;
  }
}

/// The joint opens and closes a hundred times in a thousand steps without accumulation of errors. The final heat
/// equals initial heat plus inflow, to 1e-12 of the sum of absolute flows. Several ranks run only the last case.
TEST(HeatInFractures, IsInBalanceOverAThousandSteps) {
  constexpr Real c = 4.2e6, rc = 2.2e4, dt = 0.01;
  std::vector<std::pair<const char*, const char*>> cases = {
      {"quadrilateral", "upwind"}, {"quadrilateral", "second order"}, {"tetrahedron", "second order"}};
  if (Tpetra::getDefaultComm()->getSize() > 1) cases = {cases.back()};
  for (const auto& [cell, advection] : cases) {
    auto scene = pulled_joint(cell, 2, rc, c, "4e-3*sin(10*pi*t)^2");
    scene.solver.tolerance = 1e-13;  // the defect below is the sum of the residuals of all steps
    scene.heat->advection = advection;
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(dt).converged) << cell;
    const Real start = heat_content(model, rc, c);
    Real gained = 0, passed = 0;
    for (int step = 2; step <= 1001; ++step) {
      ASSERT_TRUE(model.step_to(dt * step).converged) << cell << " " << step;
      const Real inflow = heat_that_enters(model, dt * step, dt, c);
      gained += inflow;
      passed += std::abs(inflow);
    }
    EXPECT_NEAR(heat_content(model, rc, c) - start, gained, 1e-12 * passed) << cell << " " << advection;
    EXPECT_GT(passed, 20 * start) << cell << " " << advection;
  }
}

}  // namespace
}  // namespace sprekk::tests
