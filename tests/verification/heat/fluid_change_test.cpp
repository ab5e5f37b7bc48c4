// Fluid with temperature-dependent density and viscosity.
#include "assembly/jacobian_check.hpp"
#include "physics/heat/water.hpp"
#include "unit/assembly/dense.hpp"
#include "warm_boxes.hpp"

namespace sprekk::tests {
namespace {

/// Sets rho = rho_0 exp(-a T), mu = mu_0 exp(-b T).
void change(model::Scene& scene, Real a, Real b) {
  scene.heat->fluid = "exponential";
  scene.heat->reference_temperature = 0;
  scene.heat->fluid_expansion = a;
  scene.heat->viscosity_decay = b;
}

/// Compares with the verification table of IAPWS R12-08 (table 4), with densities of SR1-86 (table 1), and between the
/// knots of the table.
TEST(Water, IsThatOfItsTables) {
  struct Found {
    Real T, density, viscosity;
  };
  for (const auto& [T, density, viscosity] : {Found{298.15, 998, 889.735100},
                                              {298.15, 1200, 1437.649467},
                                              {373.15, 1000, 307.883622},
                                              {433.15, 1, 14.538324},
                                              {433.15, 1000, 217.685358},
                                              {873.15, 1, 32.619287},
                                              {873.15, 100, 35.802262},
                                              {873.15, 600, 77.430195},
                                              {1173.15, 1, 44.217245},
                                              {1173.15, 100, 47.640433},
                                              {1173.15, 400, 64.154608}})
    EXPECT_NEAR(physics::water_viscosity(T, density), 1e-6 * viscosity, 1e-12) << T << " " << density;
  EXPECT_NEAR(physics::water_density(273.16), 999.789, 5e-4);
  EXPECT_NEAR(physics::water_density(373.1243), 958.365, 5e-4);
  const auto response = physics::response_of_water(293.15);
  for (Real T = 273.5; T < 623; T += 7.3) {
    const auto d = response.density(T), m = response.mobility(T);
    EXPECT_NEAR(d.value, physics::water_density(T) / physics::water_density(293.15), 1e-8) << T;
    EXPECT_NEAR(m.value, physics::water_viscosity(293.15) / physics::water_viscosity(T), 1e-7) << T;
    EXPECT_NEAR(d.slope, (response.density(T + 1e-4).value - response.density(T - 1e-4).value) / 2e-4, 1e-10) << T;
    EXPECT_NEAR(m.slope, (response.mobility(T + 1e-4).value - response.mobility(T - 1e-4).value) / 2e-4, 1e-9) << T;
  }
  for (const Real T : {622.9, physics::warmest_water})
    EXPECT_NEAR(response.density(T).value, physics::water_density(T) / physics::water_density(293.15), 1e-7) << T;
  EXPECT_EQ(response.density(700).value, response.density(physics::warmest_water).value);
  EXPECT_EQ(response.density(700).slope, 0);
}

/// At uniform temperature, the fluid equals a fluid with the density and viscosity at this temperature: in rock, in
/// fractures and their intersections, through fillings, and in wells with a pressure. Volumes are at reference
/// conditions, hence larger by exp(a T).
TEST(FluidChange, EquallyWarmItIsAnotherFluid) {
  for (const std::string cell : all_cells) {
    std::array<std::unique_ptr<model::Model>, 2> models;
    for (const bool changes : {false, true}) {
      auto scene = closed_box(cell);
      const bool flat = is_flat(cell);
      scene.bulk.gravity.assign(flat ? 2 : 3, 0);
      scene.bulk.gravity.back() = -2;
      scene.materials.at("joint").normal_permeability = Expression(1e-3);
      scene.fractures.at("a").cuts = {"b"};
      warm(scene, 1, 1, 0, 3);
      scene.flow->density = changes ? 4 : 4 * std::exp(-0.3);
      scene.flow->viscosity = changes ? viscosity : viscosity * std::exp(-0.7);
      if (changes) change(scene, 0.3, 0.7);
      constrain(scene, "west", "1");
      constrain(scene, "north", "2");
      for (const std::string side : {"west", "north"}) prescribe_temperature(scene, side, "1");
      auto& well = scene.flow->wells["well"];
      well.points = flat ? std::vector<Real>{0.2, 0.3} : std::vector<Real>{0.2, 0.2, 0.2, 0.3, 0.8, 0.3};
      well.radius = 1e-3;
      well.pressure = Expression(5);
      scene.heat->wells["well"].temperature = Expression(1);
      models[changes] = std::make_unique<model::Model>(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(models[changes]->step_to(1).converged) << cell;
    }
    for (const char* name : {"pressure", "Darcy velocity", "fracture pressure", "fluid flux"}) {
      const auto one = models[0]->output(name).values, other = models[1]->output(name).values;
      ASSERT_EQ(one.size(), other.size());
      for (std::size_t k = 0; k < one.size(); ++k) EXPECT_NEAR(one[k], other[k], 1e-9) << cell << " " << name;
    }
    EXPECT_NEAR(inflow(*models[0], "west"), std::exp(0.3) * inflow(*models[1], "west"), 1e-9) << cell;
  }
}

/// Flow between a cold and a warm side. It equals flow through n cells in series with the viscosities at their
/// centres, and converges with second order.
TEST(FluidChange, FlowsByItsViscosity) {
  constexpr Real b = 2;
  for (const std::string cell : {"quadrilateral", "hexahedron", "triangle"}) {
    std::vector<Real> errors;
    for (const int n : {4, 8}) {
      auto scene = closed_box(cell, false, n);
      warm(scene, 0, 1, 0, 0);
      scene.materials.at("joint").filling_conductivity = Expression(1);
      change(scene, 0, b);
      constrain(scene, "west", "1");
      constrain(scene, "east", "0");
      prescribe_temperature(scene, "west", "0");
      prescribe_temperature(scene, "east", "1");
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged) << cell;
      const auto of = [](Real resistance) { return 1 / (viscosity * resistance); };
      const Real found = inflow(model, "west"), along = std::pow(aperture, 3) / 12,
                 exact = of((1 - std::exp(-b)) / b) * (1 + along);
      errors.push_back(std::abs(found - exact));
      if (cell == std::string("triangle")) continue;
      Real resistance = 0;
      for (int k = 0; k < n; ++k) resistance += std::exp(-b * (k + 0.5) / n) / n;
      EXPECT_NEAR(found, of(resistance) * (1 + along), 1e-11) << cell;
      const auto flux = [&](const auto&, const auto&) { return Vector3{along * of(resistance), 0, 0}; };
      EXPECT_LT(error(model, "fluid flux", flux), 1e-11 * along) << cell;
    }
    EXPECT_GT(std::log2(errors[0] / errors[1]), 1.9) << cell << ": " << errors[0] << ", " << errors[1];
  }
}

/// Column of fluid with temperature increasing upwards: the pressure is the weight of the fluid in the cells above.
TEST(FluidChange, WeighsByItsDensity) {
  constexpr Real a = 0.5, weight = 6;
  for (const std::string cell : all_cells) {
    constexpr int n = 6;
    auto scene = closed_box(cell, false, n);
    const bool flat = is_flat(cell);
    scene.mesh.fractures.clear();
    scene.fractures.clear();
    warm(scene, 0, 1, 0, 1);
    change(scene, a, 1);
    scene.flow->density = 3;
    scene.bulk.gravity.assign(flat ? 2 : 3, 0);
    scene.bulk.gravity.back() = -2;
    const std::string up = flat ? "north" : "top";
    constrain(scene, up, "0");
    prescribe_temperature(scene, up, "1");
    prescribe_temperature(scene, flat ? "south" : "bottom", "0");
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1).converged) << cell;
    const auto at_rest = [&](const Vector3& x, const auto&) {
      const Real z = x[flat ? 1 : 2];
      return Vector3{weight * (std::exp(-a * z) - std::exp(-a)) / a};
    };
    EXPECT_LT(error(model, "pressure", at_rest), 0.03) << cell;
    if (cell != std::string("quadrilateral") && cell != std::string("hexahedron")) continue;
    const auto of_cells = [&](const Vector3& x, const auto&) {
      Real p = 0;
      for (int k = 0; k < n; ++k) {
        const Real z = (k + 0.5) / n, away = z - x[flat ? 1 : 2];
        if (away > -1e-9) p += weight * std::exp(-a * z) / n * (away < 1e-9 ? 0.5 : 1);
      }
      return Vector3{p};
    };
    EXPECT_LT(error(model, "pressure", of_cells), 1e-11) << cell;
    EXPECT_LT(error(model, "Darcy velocity", [](const auto&, const auto&) { return Vector3{}; }), 1e-11) << cell;
  }
}

/// The mass in pores and a fracture is constant: (phi + c_phi p) exp(c p - a T) = phi in rigid rock.
TEST(FluidChange, KeepsItsMass) {
  constexpr Real phi = 0.2, c = 0.3, c_phi = 0.1, a = 0.5;
  for (const std::string cell : all_cells) {
    auto scene = closed_box(cell, false, 2);
    scene.mesh.fractures.clear();
    scene.fractures.clear();
    scene.flow->compressibility = c;
    auto& rock = scene.materials.at("rock");
    rock.porosity = phi;
    rock.compressibility = c_phi;
    warm(scene, 0, 1, 1, 1);
    change(scene, a, 0.7);
    scene.regions["bulk"].temperature = Expression("t");
    model::Model model(scene, Tpetra::getDefaultComm());
    for (const Real t : {0.5, 2.0}) {
      ASSERT_TRUE(model.step_to(t).converged) << cell;
      for (const Real p : model.output("pressure").values)
        EXPECT_NEAR((phi + c_phi * p) * std::exp(c * p - a * t), phi, 1e-11) << cell;
    }
  }
}

/// With gravity, fillings, rigid and deformable fractures, channels, and both kinds of wells.
TEST(FluidChange, JacobianIsItsDerivative) {
  for (const std::string cell : {"triangle", "hexahedron"})
    for (const bool deforms : {false, true}) {
      auto scene = closed_box(cell, true, 2);
      const int dim = is_flat(cell) ? 2 : 3;
      scene.flow->rigid_rock = !deforms;
      scene.flow->compressibility = 0.3;
      scene.flow->density = 1.5;
      scene.bulk.gravity.assign(dim, 0);
      scene.bulk.gravity.back() = -2;
      auto& rock = scene.materials.at("rock");
      if (deforms) {
        rock.G = Expression(3);
        rock.lambda = Expression(2);
        rock.biot = 0.7;
        rock.density = 1;
        scene.boundary_conditions["floor"].boundary = "south";
        scene.boundary_conditions["floor"].displacement.assign(dim, Expression(0));
      }
      rock.porosity = 0.2;
      rock.compressibility = 0.1;
      auto& joint = scene.materials.at("joint");
      joint.friction_coefficient = Expression(0.6);
      joint.tangential_stiffness = Expression(10);
      joint.initial_aperture = Expression(1);
      joint.residual_aperture = Expression(0.8);
      joint.normal_permeability = Expression(0.5);
      warm(scene, 0.5, 1.5, 0.8, 1.2);
      change(scene, 0.4, 0.7);
      if (dim == 3) scene.flow->intersections["channel"].permeability_area = 2;
      constrain(scene, "north", "1");
      prescribe_temperature(scene, "north", "1");
      for (const bool by_rate : {false, true}) {
        const std::string name = by_rate ? "by rate" : "by pressure";
        auto& well = scene.flow->wells[name];
        well.points = dim == 2 ? std::vector<Real>{0.2, 0.5} : std::vector<Real>{0.2, 0.2, 0.2, 0.3, 0.8, 0.3};
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

/// Horton and Rogers (1945), Lapwood (1948): fluid heated from below, in a square of height H with closed sides. The
/// perturbation cos(pi x) sin(pi z) of T = 1 - z grows with the rate Ra/2 - 2 pi^2 in kappa/H^2. Implicit Euler
/// amplifies a rate s by 1/(1 - s dt) per step. The measured rate has therefore only the mesh error, of second order.
void grows_at(const std::string& place, Real Ra) {
  constexpr Real small = 1e-3, a = 1e-4, dt = 0.001;
  const Real exact = Ra / 2 - 2 * M_PI * M_PI;
  const bool in_fracture = place == "fracture";
  std::vector<Real> errors;
  for (const int n : {8, 16}) {
    auto scene = closed_box(in_fracture ? "hexahedron" : place, false, n);
    const std::string z = in_fracture ? "z" : "y", below = in_fracture ? "bottom" : "south",
                      above = in_fracture ? "top" : "north";
    auto& rock = scene.materials.at("rock");
    rock.porosity = 0.1;
    warm(scene, 0, 1, 1, 1);
    if (in_fracture) {
      scene.mesh.cells = {n, 2, n};
      rock.permeability = {Expression(1e-20)};
      rock.thermal_conductivity = {Expression(1e-9)};
      rock.heat_capacity = 0;
      auto& joint = scene.materials.at("joint");
      joint.tangential_permeability = Expression(1);
      joint.filling_conductivity = Expression(1);
      prescribe_temperature(scene, below, "1", "a");
      prescribe_temperature(scene, above, "0", "a");
    } else {
      scene.mesh.fractures.clear();
      scene.fractures.clear();
      prescribe_temperature(scene, below, "1");
      prescribe_temperature(scene, above, "0");
    }
    scene.heat->initial_temperature = Expression(fmt::format("1 - {0} + {1}*cos(pi*x)*sin(pi*{0})", z, small));
    change(scene, a, 0);
    scene.flow->viscosity = 1;
    scene.flow->compressibility = 1e-9;
    scene.flow->density = Ra / a;
    scene.bulk.gravity.assign(in_fracture ? 3 : 2, 0);
    scene.bulk.gravity.back() = -1;
    model::Model model(scene, Tpetra::getDefaultComm());
    const auto amplitude = [&] {
      const auto T = model.output(in_fracture ? "fracture temperature" : "temperature").values;
      const auto& mesh = model.mesh();
      Real here = 0, all = 0;
      for (std::size_t k = 0; k < T.size(); ++k) {
        const auto e = static_cast<LocalIndex>(k);
        const auto x = in_fracture ? mesh.fracture_faces[e].centre : mesh::cell_centre(mesh, e);
        here += T[k] * std::cos(M_PI * x[0]) * std::sin(M_PI * x[in_fracture ? 2 : 1]);
      }
      Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_SUM, 1, &here, &all);
      return all;
    };
    auto report = model.step_to(dt);
    ASSERT_TRUE(report.converged) << place << report.reason;
    const Real before = amplitude();
    report = model.step_to(2 * dt);
    ASSERT_TRUE(report.converged) << place << report.reason;
    const Real rate = (1 - before / amplitude()) / dt;
    errors.push_back(std::abs(rate - exact));
  }
  EXPECT_LT(errors[1], 0.3) << place << " " << Ra << ": " << errors[0] << ", " << errors[1];
  EXPECT_GT(std::log2(errors[0] / errors[1]), 1.7) << place << " " << Ra << ": " << errors[0] << ", " << errors[1];
}

TEST(FluidChange, RisesWhereItIsWarm) {
  EXPECT_NEAR(60 / 2.0 - 2 * M_PI * M_PI, 10.260791, 1e-6);
  for (const Real Ra : {60.0, 30.0})
    for (const char* place : {"quadrilateral", "triangle", "fracture"}) grows_at(place, Ra);
}

}  // namespace
}  // namespace sprekk::tests
