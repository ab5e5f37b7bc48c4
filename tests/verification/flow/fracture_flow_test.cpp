// Flow along and across fractures, compared with exact solutions.
#include "boxes.hpp"

namespace sprekk::tests {
namespace {

/// Linear pressure in a network of fractures that all end on the boundary, under gravity, with any transmissivity. In
/// rock q = -k/mu (G - rho g); in fractures its tangential part times the aperture.
TEST(FractureFlow, LinearPressureThroughANetworkIsExact) {
  for (const std::string cell : all_cells)
    for (const Real k : {1e-3, 1e4}) {
      auto scene = closed_box(cell);
      const bool flat = is_flat(cell);
      scene.flow->density = 3;
      scene.bulk.gravity = flat ? std::vector<Real>{0, -10} : std::vector<Real>{0, 0, -10};
      scene.materials.at("joint").tangential_permeability = k;
      for (const std::string side : {"west", "east", "south", "north", "bottom", "top"})
        if (!flat || (side != "bottom" && side != "top")) constrain(scene, side, flat ? "1+2*x-3*y" : "1+2*x-3*y+4*z");
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged) << cell;
      const Vector3 drive = flat ? Vector3{2, -3 + 30, 0} : Vector3{2, -3, 4 + 30};
      const auto p = [&](const auto& x, const auto&) {
        return Vector3{1 + 2 * x[0] - 3 * x[1] + (flat ? 0 : 4 * x[2])};
      };
      EXPECT_LT(error(model, "pressure", p), 1e-11) << cell;
      EXPECT_LT(error(model, "fracture pressure", p), 1e-11) << cell;
      const auto velocity = [&](const auto&, const auto&) {
        return Vector3{-drive[0] / viscosity, -drive[1] / viscosity, -drive[2] / viscosity};
      };
      EXPECT_LT(error(model, "Darcy velocity", velocity), 1e-10) << cell;
      const auto flux = [&](const auto&, const auto& normal) {
        Vector3 along{};
        for (int i = 0; i < 3; ++i)
          along[i] = -aperture * k / viscosity *
                     (drive[i] - normal[i] * (drive[0] * normal[0] + drive[1] * normal[1] + drive[2] * normal[2]));
        return along;
      };
      EXPECT_LT(error(model, "fluid flux", flux), 1e-12 * k) << cell;
    }
}

/// Rock, fracture, rock in series: q = (p_west - p_east)/(mu (1/k + a/k_n)).
TEST(FractureFlow, AFractureAcrossTheFlowResists) {
  for (const std::string cell : all_cells)
    for (const Real k : {1e-10, 1e-3, 1.0, 1e10}) {
      auto scene = closed_box(cell);
      scene.materials.at("joint").normal_permeability = k;
      scene.materials.at("joint").tangential_permeability = k;
      constrain(scene, "west", "1");
      constrain(scene, "east", "0");
      scene.mesh.fractures.erase("a");
      scene.fractures.erase("a");
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged) << cell;
      const Real q = 1 / (viscosity * (1 + aperture / k));
      const Real rounding = 1e-15 * (1 + k * aperture);  // round-off of pressures near 1, times the largest
                                                         // conductance
      EXPECT_NEAR(inflow(model, "west"), q, 1e-9 * q + 10 * rounding) << cell << ' ' << k;
      EXPECT_NEAR(inflow(model, "east"), -q, 1e-9 * q + 10 * rounding) << cell << ' ' << k;
      const auto half = [](const auto&, const auto&) { return Vector3{0.5}; };
      EXPECT_LT(error(model, "fracture pressure", half), 1e-9 + 10 * rounding) << cell << ' ' << k;
    }
}

/// In parallel: Q = (k + a k_t)/mu dp/L, by default with k_t = a^2/12 (cubic law).
TEST(FractureFlow, AFractureAlongTheFlowCarriesItsShare) {
  for (const std::string cell : all_cells)
    for (const Real k : {0.0, 1e-7, 1e13}) {
      auto scene = closed_box(cell, false);
      auto& joint = scene.materials.at("joint");
      joint.initial_aperture = 0.1;
      joint.residual_aperture = 0.5;
      if (k > 0) joint.tangential_permeability = k;
      constrain(scene, "west", "1");
      constrain(scene, "east", "0");
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged) << cell;
      const Real Q = (1 + 0.5 * (k > 0 ? k : 0.25 / 12)) / viscosity;
      EXPECT_NEAR(inflow(model, "west") / Q, 1, 1e-11) << cell << ' ' << k;
      EXPECT_NEAR(inflow(model, "east") / Q, -1, 1e-11) << cell << ' ' << k;
    }
}

/// Rough walls: hydraulic aperture e = min(a, a^2/JRC^2.5) in micrometres. With JRC 300, 1 m conducts like 0.6415 m,
/// and 2 m like a smooth fracture.
TEST(FractureFlow, ARoughFractureCarriesLess) {
  for (const std::string cell : all_cells)
    for (const Real a : {1.0, 2.0}) {
      auto scene = closed_box(cell, false);
      auto& joint = scene.materials.at("joint");
      joint.initial_aperture = a;
      joint.hydraulic_aperture = "Barton";
      joint.entry("joint roughness coefficient") = base::Expression(300);
      constrain(scene, "west", "1");
      constrain(scene, "east", "0");
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged) << cell;
      const Real e = a == 1 ? 1e6 / (9e4 * std::sqrt(300.0)) : 2, Q = (1 + e * e * e / 12) / viscosity;
      EXPECT_NEAR(inflow(model, "west") / Q, 1, 1e-11) << cell << ' ' << a;
      EXPECT_LT(error(model, "hydraulic aperture", [&](const auto&, const auto&) { return Vector3{e}; }), 1e-14);
    }
}

/// Fractures in almost impermeable rock, with prescribed pressures at their ends. Of four branches of length 1/2, one
/// has the pressure 1 and the others 0, so the intersection has 1/4.
TEST(FractureFlow, WhatFlowsIntoAnIntersectionFlowsOut) {
  for (const std::string cell : all_cells) {
    auto scene = closed_box(cell);
    auto& joint = scene.materials.at("joint");
    joint.normal_permeability = 1e-16;
    joint.tangential_permeability = 10;
    constrain(scene, "west", "1", "a");
    constrain(scene, "east", "0", "a");
    constrain(scene, "south", "0", "b");
    constrain(scene, "north", "0", "b");
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1).converged) << cell;
    const Real T = aperture * 10 / viscosity;
    EXPECT_NEAR(inflow(model, "west"), 1.5 * T, 1e-9 * T) << cell;
    for (const char* side : {"east", "south", "north"}) EXPECT_NEAR(inflow(model, side), -0.5 * T, 1e-9 * T) << cell;
    const auto p = [](const auto& x, const auto&) {
      return Vector3{0.25 + (x[0] < 0.5 ? 0.75 : -0.25) * std::abs(1 - 2 * x[0]) - 0.25 * std::abs(1 - 2 * x[1])};
    };
    EXPECT_LT(error(model, "fracture pressure", p), 1e-9) << cell;
  }
}

/// A sealed fracture cuts the open fracture "a": its halves and the filling are in series, Q = dp/(1/T + a_b mu/(k_n
/// a)).
TEST(FractureFlow, ASealedFractureCutsAnOpenOne) {
  for (const std::string cell : all_cells)
    for (const Real k : {1e-8, 1e-3, 10.0}) {
      auto scene = closed_box(cell);
      auto& open = scene.materials.at("joint");
      open.normal_permeability = 1e-18;
      open.tangential_permeability = 10;
      auto& sealed = scene.materials["seal"] = open;
      sealed.initial_aperture = 0.01;
      sealed.tangential_permeability = 1e-18;
      sealed.normal_permeability = k;
      scene.materials.at("rock").permeability = {base::Expression(1e-18)};
      scene.fractures.at("b").material = "seal";
      scene.fractures.at("b").cuts = {"a"};
      constrain(scene, "west", "1", "a");
      constrain(scene, "east", "0", "a");
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged) << cell;
      const Real Q = aperture / viscosity / (1 / 10.0 + 0.01 / k);
      EXPECT_NEAR(inflow(model, "west") / Q, 1, 1e-6) << cell << ' ' << k;
      EXPECT_NEAR(inflow(model, "east") / Q, -1, 1e-6) << cell << ' ' << k;
    }
}

/// Fracture in almost impermeable rock: the inflow at its west end equals the outflow through a conductance at its
/// east end. The same for rock.
TEST(FractureFlow, FluxesAndConductancesAtEnds) {
  for (const std::string cell : all_cells)
    for (const bool in_fracture : {true, false}) {
      auto scene = closed_box(cell, false);
      auto& joint = scene.materials.at("joint");
      joint.normal_permeability = 1e-16;
      joint.tangential_permeability = 10;
      constrain(scene, "east", "7", in_fracture ? "a" : "");
      scene.boundary_conditions.at("east").conductance = base::Expression(0.25);
      auto& west = scene.boundary_conditions["west"];
      west.boundary = "west";
      west.flux = base::Expression(-3.0);
      if (in_fracture) west.fracture = "a";
      scene.flow->compressibility = 1e-30;  // otherwise the pressure of the part without inflow is undetermined
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged) << cell;
      const Real slope = 3 * viscosity / (in_fracture ? 10 : 1);
      const auto p = [&](const auto& x, const auto&) { return Vector3{7 + 3 / 0.25 + slope * (1 - x[0])}; };
      EXPECT_LT(error(model, in_fracture ? "fracture pressure" : "pressure", p), 1e-7) << cell << in_fracture;
      const Real put_in = 3 * (in_fracture ? aperture : 1);
      for (const auto& total : model.system().totals(model.state()))
        if (total.names[0] == "inflows")
          EXPECT_NEAR(total.value / put_in, total.names[1] == "west" ? 1 : -1, 1e-9) << cell << in_fracture;
    }
}

/// Two fractures in almost impermeable rock that meet at a point of the boundary. The inflow at the end of one
/// fracture equals the outflow at the end of the other; the reported inflows include both.
TEST(FractureFlow, TwoFracturesMeetOnTheBoundary) {
  auto scene = read_scene("flow/source_2d.xml");
  scene.mesh_file.emplace();
  scene.mesh_file->path = source_dir() + "/tests/data/meshes/meeting_on_boundary.msh";
  scene.materials.at("rock").permeability = {base::Expression(1e-12)};
  auto& joint = scene.materials["joint"];
  joint.type = "joint";
  joint.initial_aperture = aperture;
  for (const char* name : {"a", "b"}) {
    scene.mesh_file->fractures[name];
    scene.fractures[name].material = "joint";
  }
  scene.flow->source = 0;
  scene.boundary_conditions.clear();
  auto& in = scene.boundary_conditions["in"];
  in.boundary = "south";
  in.fracture = "a";
  in.flux = base::Expression(-3.0);
  auto& out = scene.boundary_conditions["out"];
  out.boundary = "south";
  out.fracture = "b";
  out.conductance = base::Expression(0.25);
  out.pressure = base::Expression(7.0);
  model::Model model(scene, Tpetra::getDefaultComm());
  ASSERT_TRUE(model.step_to(1).converged);
  const auto p = [](const auto&, const auto&) { return Vector3{7 + 3 / 0.25}; };
  EXPECT_LT(error(model, "fracture pressure", p), 1e-9);
  const auto totals = model.system().totals(model.state());
  ASSERT_EQ(totals.size(), 2u);
  for (const auto& total : totals) EXPECT_EQ(total.names, (std::vector<std::string>{"inflows", "south"}));
  EXPECT_NEAR(totals[0].value, 3 * aperture, 1e-12 * aperture);
  EXPECT_NEAR(totals[1].value, -3 * aperture, 1e-9 * aperture);
}

}  // namespace
}  // namespace sprekk::tests
