// Thermal stresses and pressures, compared with exact solutions.
#include "../uniform/states.hpp"
#include "assembly/jacobian_check.hpp"
#include "unit/assembly/dense.hpp"
#include "warm_boxes.hpp"

namespace sprekk::tests {
namespace {

/// Returns the tangential part of a vector in the frame of a face.
Vector3 tangential(const assembly::OutputField& field, LocalIndex f) {
  Vector3 v{};
  for (int k = 1; k < field.n_components; ++k) v[k - 1] = field.values[f * field.n_components + k];
  return v;
}

/// Column of 10 m with a horizontal joint and the displacement (2, -2) mm of its top, then uniform cooling. The joint
/// slips at -6.48 K and opens at -13.3 K. N/k_n + V(N) = g_0 - d_n + beta_T dT/k_n, beta_T = (3 lambda + 2G) alpha_T.
TEST(ThermalStress, CoolingMakesAJointSlipAndOpen) {
  struct State {
    Real dT, N, shear, u_p, opening;
  };
  const State states[] = {{-5, 4.71906420e6, 2.30769231e6, 0, -0.07023395013606e-3},
                          {-10, 1.80997512e6, 1.08598507e6, 1.058812935403e-3, -0.04750621894396e-3},
                          {-20, 0, 0, 2e-3, 1e-3}};
  for (const int dim : {2, 3})
    for (const auto& d : discretisations(dim)) {
      SCOPED_TRACE(d.name());
      auto scene = read_scene(fmt::format("verification/regimes_{}d.xml", dim), d.with({}));
      tie_sides(scene);
      for (int k = 0; k < dim - 1; ++k) scene.mesh.cells[k] = 3;
      for (auto* c : {&scene.mesh.lower_corner, &scene.mesh.upper_corner})
        for (auto& x : *c) x *= 10;
      for (auto& [name, fracture] : scene.mesh.fractures)
        for (auto* c : {&fracture.lower_corner, &fracture.upper_corner})
          for (auto& x : *c) x *= 10;
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
      warm(scene, 300, 2.5, 0, 0);
      scene.boundary_conditions.at("moved").displacement.assign(dim, Expression(0));
      scene.boundary_conditions.at("moved").displacement[0] = Expression(2e-3);
      scene.boundary_conditions.at("moved").displacement[dim - 1] = Expression(-2e-3);
      scene.regions["bulk"].temperature = Expression("300 + (t < 2 ? 0 : t < 3 ? -5 : t < 4 ? -10 : -20)");
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged);
      for (int k = 0; k < 3; ++k) {
        const auto& s = states[k];
        ASSERT_TRUE(model.step_to(k + 2).converged);
        const auto traction = model.output("traction local"), jump = model.output("plastic jump local");
        const auto total = model.output("jump local");
        for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
          const auto along = [&](const auto& field) { return norm(tangential(field, f)); };
          EXPECT_NEAR(traction.values[dim * f], -s.N, 1e-8 * 7e6) << s.dT;
          EXPECT_NEAR(along(traction), s.shear, 1e-8 * 7e6) << s.dT;
          EXPECT_NEAR(along(jump), s.u_p, 1e-11) << s.dT;
          EXPECT_NEAR(total.values[dim * f], s.opening, 1e-11) << s.dT;
        }
      }
    }
}

/// Half-space of xml/heat/cooling_2d.xml, without strain along its surface.
/// Stress along the surface: E alpha_T/(1 - nu) 50 K erfc(x/sqrt(4 kappa t)). Displacement of the surface:
/// (1 + nu)/(1 - nu) alpha_T 50 K sqrt(4 kappa t/pi).
TEST(ThermalStress, OfAHalfSpaceThatCools) {
  for (const int dim : {2, 3}) {
    auto scene = read_scene(fmt::format("heat/cooling_{}d.xml", dim));
    scene.bulk.rigid = false;
    auto& rock = scene.materials.at("rock");
    rock.E = Expression(50e9);
    rock.nu = Expression(0.25);
    rock.thermal_expansion = Expression(1e-5);
    const std::vector<std::string> sides = {"south", "north", "bottom", "top"};
    for (int k = 0; k < 2 * dim - 1; ++k) {
      const std::string side = k < 2 * dim - 2 ? sides[k] : "east";
      auto& condition = scene.boundary_conditions[side + " held"];
      condition.boundary = side;
      condition.displacement.assign(dim, Expression("free"));
      condition.displacement[side == "east" ? 0 : 1 + k / 2] = Expression(0);
    }
    model::Model model(scene, Tpetra::getDefaultComm());
    for (const Real t : scene.time.times()) ASSERT_TRUE(model.step_to(t).converged);
    const Real width = std::sqrt(4e-6 * scene.time.end), stretch = 5.0 / 3 * 1e-5 * 50;
    const auto along = [&](const Vector3& x) { return 50e9 * 1e-5 * 50 / 0.75 * std::erfc(x[0] / width); };
    const auto stress = model.output("stress").values, thermal = model.output("thermal stress").values;
    for (LocalIndex k = 0; k < model.mesh().n_owned_cells; ++k) {
      const Real at = along(mesh::cell_centre(model.mesh(), k));
      EXPECT_NEAR(stress[6 * k] + thermal[k], 0, 1e-3 * 33e6);
      EXPECT_NEAR(stress[6 * k + 1] + thermal[k], at, 5e-3 * 33e6);
      EXPECT_NEAR(stress[6 * k + 2] + thermal[k], at, 5e-3 * 33e6);
    }
    const auto u = model.output("displacement").values;
    for (LocalIndex node = 0; node < model.mesh().n_nodes(); ++node)
      if (model.mesh().coordinates[node * dim] < 1e-9) {
        EXPECT_NEAR(u[node * dim], stretch * width / std::sqrt(M_PI), 5e-3 * stretch * width);
      }
  }
}

/// Pressure increase per kelvin in a closed box. Rigid: beta_m/S; with free strain along one axis: (beta_m - alpha K
/// beta_s/M)/(S + alpha^2/M); with free strain: (beta_m - alpha beta_s)/(S + alpha^2/K). Here beta_m = phi beta_f +
/// (alpha - phi) beta_s, M = K + 4G/3; plane strain constrains the third axis.
TEST(ThermalExpansion, OfAFluidThatCannotLeave) {
  constexpr Real alpha = 0.8, phi = 0.1, K = 20e9, G = 12e9, beta_s = 3e-5, beta_f = 3e-4;
  constexpr Real S = (alpha - phi) / 100e9 + phi / 2.2e9, beta_m = phi * beta_f + (alpha - phi) * beta_s,
                 M = K + 4 * G / 3;
  constexpr Real plane = K + G / 3, dT = 0.01;  // stiffness of plane strain for equal strains; temperature increase
  struct Case {
    int free;
    Real rise;
  };
  for (const std::string cell : all_cells) {
    const bool flat = is_flat(cell);
    const int dim = flat ? 2 : 3;
    const std::vector<Case> cases = {{-1, beta_m / S},
                                     {1, (beta_m - alpha * K * beta_s / M) / (S + alpha * alpha / M)},
                                     {dim, flat ? (beta_m - alpha * K * beta_s / plane) / (S + alpha * alpha / plane)
                                                : (beta_m - alpha * beta_s) / (S + alpha * alpha / K)}};
    for (const auto& one : cases) {
      auto scene = closed_box(cell, false, 2);
      scene.mesh.fractures.clear();
      scene.fractures.clear();
      scene.flow->rigid_rock = one.free < 0;
      scene.flow->compressibility = 1 / 2.2e9;
      auto& rock = scene.materials.at("rock");
      rock.porosity = phi;
      rock.compressibility = (alpha - phi) / 100e9;
      rock.biot = alpha;
      rock.permeability = {Expression(1e-12)};
      rock.thermal_expansion = Expression(beta_s / 3);
      if (one.free >= 0) {
        rock.K = Expression(K);
        rock.G = Expression(G);
      }
      warm(scene, 300, 2.5, 2e6, 4e6);
      scene.heat->fluid_expansion = beta_f;
      scene.regions["bulk"].temperature = Expression("300 + 0.01*min(t, 1)");
      const std::vector<std::string> sides = {"west", "south", "bottom", "east", "north", "top"};
      for (std::size_t k = 0; k < sides.size() && one.free >= 0; ++k) {
        const int axis = static_cast<int>(k) % 3;
        if (axis >= dim || (k >= 3 && axis < one.free)) continue;
        auto& condition = scene.boundary_conditions[sides[k]];
        condition.boundary = sides[k];
        condition.displacement.assign(dim, Expression("free"));
        condition.displacement[axis] = Expression(0);
      }
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged) << cell << " " << one.free;
      const auto p = [&](const auto&, const auto&) { return Vector3{one.rise * dT}; };
      EXPECT_LT(error(model, "pressure", p), 1e-5 * one.rise * dT) << cell << " " << one.free;
    }
  }
}

/// Thermal consolidation of a column (Bai 2005; 7 m, drained and heated by 50 K at its top, load 1 Pa). The reference
/// is the series for pressures at the bottom and settlements at three times. Without thermal expansion of the pore
/// walls, the pressure at 1000 s would be 44 % lower.
TEST(ThermalExpansion, OfAColumnThatConsolidates) {
  for (const std::string cell : {"quadrilateral", "hexahedron"}) {
    auto scene = read_scene(is_flat(cell) ? "verification/terzaghi_2d.xml" : "verification/terzaghi_3d.xml");
    const bool flat = is_flat(cell);
    scene.mesh.cell = cell;
    scene.mesh.cells.assign(flat ? 2 : 3, 1);
    const int up = flat ? 1 : 2;
    scene.mesh.upper_corner[up] = 7;
    scene.mesh.cells[up] = 70;
    auto& rock = scene.materials.at("rock");
    rock.lambda.reset();
    rock.G.reset();
    rock.E = Expression(6000);
    rock.nu = Expression(0.4);
    rock.porosity = 0.2;
    rock.permeability = {Expression(4e-9)};
    rock.thermal_expansion = Expression(3e-7);
    scene.flow->viscosity = 1e-3;
    warm(scene, 0, 836, 1.672e5, 0);
    auto& top = scene.boundary_conditions.at("top");
    top.traction[up] = Expression(-1);
    top.temperature = Expression(50);
    scene.time.scheme = "BDF2";
    model::Model model(scene, Tpetra::getDefaultComm());
    struct Found {
      Real t, p, settlement;
    };
    Real t = 0, dt = 0.5;
    for (const auto& want :
         {Found{300, 0.58565265, 0}, {1000, 0.09672584, 4.225817e-4}, {10000, 1.4216e-4, 3.154095e-4}}) {
      while (t < want.t) {
        t = std::min(want.t, t + dt);
        ASSERT_TRUE(model.step_to(t).converged) << cell << " " << t;
        dt = std::min(dt * 1.2, 0.02 * t + 1);
      }
      EXPECT_NEAR(value_at(model, "pressure", flat ? Vector3{0.1, 0.05, 0} : Vector3{0.1, 0.1, 0.05}), want.p, 5e-3)
          << cell << " " << want.t;
      Real lowest = 0, all = 0;
      const auto u = model.output("displacement").values;
      const int dim = flat ? 2 : 3;
      for (LocalIndex n = 0; n < model.mesh().n_nodes(); ++n) lowest = std::min(lowest, u[n * dim + up]);
      Teuchos::reduceAll(*model.mesh().comm, Teuchos::REDUCE_MIN, 1, &lowest, &all);
      if (want.settlement > 0) {
        EXPECT_NEAR(-all, want.settlement, 5e-3 * want.settlement) << cell << " " << want.t;
      }
    }
  }
}

/// The scene of injection, with cold water and all couplings, after two steps.
TEST(ThermoPoroelasticity, JacobianIsItsDerivative) {
  for (const std::string cell : {"triangle", "hexahedron"})
    for (const bool tips : {false, true}) {
      auto scene = closed_box(cell, !tips, 2);
      if (tips) scene.mesh.fractures["a"].upper_corner[0] = 0.5;
      scene.flow->rigid_rock = false;
      scene.flow->compressibility = 0.3;
      auto& rock = scene.materials.at("rock");
      rock.G = Expression(3);
      rock.lambda = Expression(2);
      rock.biot = 0.7;
      rock.porosity = 0.2;
      rock.compressibility = 0.1;
      rock.thermal_expansion = Expression(0.2);
      auto& joint = scene.materials.at("joint");
      joint.friction_coefficient = Expression(0.6);
      joint.tangential_stiffness = Expression(10);
      joint.initial_aperture = Expression(1);
      joint.residual_aperture = Expression(0.8);
      joint.normal_permeability = Expression(0.5);
      warm(scene, 2, 1.5, 0.8, 1.2);
      scene.heat->fluid_expansion = 0.4;
      scene.boundary_conditions["floor"].boundary = "south";
      scene.boundary_conditions["floor"].displacement.assign(is_flat(cell) ? 2 : 3, Expression(0));
      constrain(scene, "north", "1");
      prescribe_temperature(scene, "north", "3");
      for (const bool by_rate : {false, true}) {
        const std::string name = by_rate ? "by rate" : "by pressure";
        auto& well = scene.flow->wells[name];
        well.points = is_flat(cell) ? std::vector<Real>{0.2, 0.5} : std::vector<Real>{0.2, 0.2, 0.2, 0.3, 0.8, 0.3};
        well.radius = 1e-3;
        (by_rate ? well.rate : well.pressure) = Expression(2);
        scene.heat->wells[name].temperature = Expression(1);
      }
      model::Model model(scene, Tpetra::getDefaultComm());
      auto& system = model.system();
      system.set_time(1, 0.5);
      auto x = system.initial();
      test::randomize(x, 0.3, 1);
      system.commit(x);
      test::randomize(x, 0.3, 2);
      int checked = 0;
      for (const auto& e : assembly::check_jacobian(system, x, 1e-6)) {
        if (e.module.find("jump") != std::string::npos) continue;  // not differentiable everywhere; tested elsewhere
        ++checked;
        EXPECT_LE(e.error, 1e-5) << cell << ": " << e.module << ": " << e.row << ", " << e.column;
      }
      EXPECT_GT(checked, 20);
    }
}

/// Scenes of xml/thm: a fault next to a cooled wall sticks for a year and then slips. A producer delivers water that
/// cools from year to year, between the temperatures of injected water and rock. A gallery heats its rock.
TEST(ThermoPoroelasticity, ScenesTellWhatTheySay) {
  const auto largest = [](model::Model& model, const std::string& output) {
    Real here = 0, all = 0;
    for (const Real value : model.output(output).values) here = std::max(here, value);
    Teuchos::reduceAll(*model.mesh().comm, Teuchos::REDUCE_MAX, 1, &here, &all);
    return all;
  };
  const auto fault = read_scene("thm/cooling_2d.xml", {"Mesh.cells={16, 16}", "Time.steps=10"});
  model::Model slides(fault, Tpetra::getDefaultComm());
  for (const Real t : fault.time.times()) {
    ASSERT_TRUE(slides.step_to(t).converged) << t;
    if (t == fault.time.times().front()) {
      EXPECT_LT(largest(slides, "slip"), 2e-3);
    }
  }
  EXPECT_GT(largest(slides, "slip"), 6e-3);

  const auto gallery = read_scene("thm/gallery_2d.xml", {"Time.steps=5"});
  model::Model warms(gallery, Tpetra::getDefaultComm());
  for (const Real t : gallery.time.times()) ASSERT_TRUE(warms.step_to(t).converged) << t;
  EXPECT_GT(largest(warms, "temperature"), 330);
  EXPECT_LT(largest(warms, "temperature"), 420);

  const auto doublet = read_scene("thm/doublet_2d.xml", {"Mesh.cells={20, 20}", "Time.steps=10"});
  model::Model cools(doublet, Tpetra::getDefaultComm());
  Real before = 420;
  for (const Real t : doublet.time.times()) {
    const auto report = cools.step_to(t);
    ASSERT_TRUE(report.converged) << t << report.reason;
    Real T = 0;
    for (const auto& total : cools.system().totals(cools.state()))
      if (total.names == std::vector<std::string>{"wells", "producer", "temperature"}) T += total.value;
    EXPECT_LT(T, before) << t;
    EXPECT_GT(T, 320) << t;
    before = T;
  }
}

}  // namespace
}  // namespace sprekk::tests
