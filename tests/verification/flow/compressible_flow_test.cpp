// Flow of a fluid with a density exponential in the pressure, compared with exact solutions: at rest, and in flow
// without gravity. Without gravity, the density satisfies the equation of the pressure of an incompressible fluid.
#include "boxes.hpp"

namespace sprekk::tests {
namespace {

constexpr Real c = 2, reference = 0.5;
constexpr Real steady = 1e15;  // a step so long that the fractures fill to their steady state

/// Returns the pressure for a density of e times the reference density.
Real pressure_at(Real e) { return reference + std::log(e) / c; }
std::string text_of(Real number) { return fmt::format("{:.17g}", number); }

model::Scene compressible_box(const std::string& cell, int n = 4) {
  auto scene = closed_box(cell, true, n);
  scene.flow->compressibility = c;
  scene.flow->reference_pressure = reference;
  scene.flow->initial_pressure = reference;
  return scene;
}

/// The density decreases linearly from west to east in rock, and in fractures along and across the flow.
TEST(CompressibleFlow, DensityIsLinearInSteadyFlow) {
  for (const std::string cell : all_cells)
    for (const Real k : {1e-3, 1e4}) {
      auto scene = compressible_box(cell);
      scene.materials.at("joint").tangential_permeability = k;
      constrain(scene, "west", text_of(pressure_at(5)));
      constrain(scene, "east", text_of(pressure_at(1)));
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(steady).converged) << cell;
      const auto p = [](const auto& x, const auto&) { return Vector3{pressure_at(5 - 4 * x[0])}; };
      EXPECT_LT(error(model, "pressure", p), 1e-10) << cell;
      EXPECT_LT(error(model, "fracture pressure", p), 1e-10) << cell;
      const auto velocity = [](const auto& x, const auto&) { return Vector3{4 / (c * viscosity * (5 - 4 * x[0]))}; };
      EXPECT_LT(error(model, "Darcy velocity", velocity), 1e-9) << cell;
      const auto flux = [&](const auto& x, const auto& normal) {
        return Vector3{aperture * k * 4 / (c * viscosity * (5 - 4 * x[0])) * (1 - normal[0] * normal[0])};
      };
      EXPECT_LT(error(model, "fluid flux", flux), 1e-9 * k) << cell;
      const Real Q = (1 + aperture * k) * 4 / (c * viscosity);
      EXPECT_NEAR(inflow(model, "west") / Q, 1, 1e-10) << cell;
      EXPECT_NEAR(inflow(model, "east") / Q, -1, 1e-10) << cell;
    }
}

/// At rest, 1/e is linear in the height, independent of permeabilities.
TEST(CompressibleFlow, AColumnAtRestIsExact) {
  for (const std::string cell : all_cells)
    for (const Real k_n : {1e-6, std::numeric_limits<Real>::infinity()}) {
      auto scene = compressible_box(cell);
      const bool flat = is_flat(cell);
      const int up = flat ? 1 : 2;
      scene.flow->density = 0.5;
      scene.bulk.gravity.assign(up + 1, 0);
      scene.bulk.gravity[up] = -0.5;  // then d(1/e)/dy = 1/2
      scene.materials.at("joint").tangential_permeability = 100;
      scene.materials.at("joint").normal_permeability = k_n;
      scene.materials.at("rock").permeability = {base::Expression(flat ? "1 + y" : "1 + z")};
      constrain(scene, flat ? "north" : "top", text_of(pressure_at(1)));
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(steady).converged) << cell;
      const auto p = [&](const auto& x, const auto&) { return Vector3{pressure_at(1 / (1 - 0.5 * (1 - x[up])))}; };
      EXPECT_LT(error(model, "pressure", p), 1e-10) << cell;
      EXPECT_LT(error(model, "fracture pressure", p), 1e-10) << cell;
      const auto nothing = [](const auto&, const auto&) { return Vector3{}; };
      EXPECT_LT(error(model, "Darcy velocity", nothing), 1e-10) << cell;
      EXPECT_LT(error(model, "fluid flux", nothing), 1e-10) << cell;
    }
}

/// Box of rock with doubled density on the west side: porosity de/dt = k/(mu c) div grad e.
struct Doubled {
  static constexpr Real porosity = 0.3, diffusivity = 1 / (viscosity * porosity * c);

  static model::Scene scene(const std::string& cell, int n, bool linear) {
    auto scene = closed_box(cell, false, n);
    scene.mesh.fractures.clear();
    scene.fractures.clear();
    auto& rock = scene.materials.at("rock");
    if (linear) {
      rock.compressibility = porosity * c;
    } else {
      rock.porosity = porosity;
      scene.flow->compressibility = c;
      scene.flow->reference_pressure = reference;
      scene.flow->initial_pressure = reference;
    }
    constrain(scene, "west", linear ? "1" : text_of(pressure_at(2)));
    return scene;
  }

  /// Returns e at x and t, by separation of variables.
  static Real density(Real x, Real t) {
    Real e = 2;
    for (int m = 0; m < 50; ++m) {
      const Real root = (m + 0.5) * M_PI;
      e -= 2 / root * std::sin(root * x) * std::exp(-root * root * diffusivity * t);
    }
    return e;
  }
};

/// In each step, the density minus 1 equals the pressure of a linear problem with compressible pores.
TEST(CompressibleFlow, DensityFollowsThePressureOfALinearProblem) {
  for (const std::string cell : all_cells) {
    model::Model model(Doubled::scene(cell, 4, false), Tpetra::getDefaultComm());
    model::Model linear(Doubled::scene(cell, 4, true), Tpetra::getDefaultComm());
    for (const Real t : {0.01, 0.05, 0.3}) {
      ASSERT_TRUE(model.step_to(t).converged) << cell;
      ASSERT_TRUE(linear.step_to(t).converged) << cell;
      const auto p = model.output("pressure").values, less_one = linear.output("pressure").values;
      for (std::size_t i = 0; i < p.size(); ++i) EXPECT_NEAR(p[i], pressure_at(1 + less_one[i]), 1e-9) << cell;
    }
  }
}

TEST(CompressibleFlow, DensityDiffuses) {
  for (const std::string cell : {"triangle", "quadrilateral"}) {
    std::vector<Real> errors;
    for (const int n : {1, 2}) {
      model::Model model(Doubled::scene(cell, 16 * n, false), Tpetra::getDefaultComm());
      const Real end = 0.3;
      const int steps = 10 * n * n;
      for (int k = 1; k <= steps; ++k) ASSERT_TRUE(model.step_to(end * k / steps).converged) << cell;
      errors.push_back(error(model, "pressure", [&](const auto& x, const auto&) {
        return Vector3{pressure_at(Doubled::density(x[0], end))};
      }));
    }
    EXPECT_LT(errors[1], 3e-3) << cell;
    EXPECT_GT(errors[0] / errors[1], 3) << cell;  // second order in the cells, first order in the steps
  }
}

/// Checks that the volume injected into rock and a fracture in a closed box equals the change of storage, up to
/// round-off. `growth` is the change of porosity with pressure, 1/Pa; `set` sets it in the rock.
void expect_stored(const std::string& cell, const std::string& porosity, Real growth,
                   const std::function<void(physics::Material&)>& set) {
  auto scene = compressible_box(cell);
  auto& rock = scene.materials.at("rock");
  rock.porosity = base::Expression(porosity);
  set(rock);
  auto& joint = scene.materials.at("joint");
  joint.initial_aperture = 0.2;
  joint.normal_permeability = 0.01;
  scene.flow->initial_pressure = base::Expression("0.1*x");
  scene.flow->source = base::Expression("0.1*t");
  scene.fractures.at("a").source = base::Expression("0.2*t");
  scene.solver.tolerance = 1e-14;
  model::Model model(scene, Tpetra::getDefaultComm());
  const auto& mesh = model.mesh();
  const Real volume = 1.0 / static_cast<Real>(mesh.n_global_cells);  // all cells have equal volumes
  base::Expression room(porosity);
  room.compile();
  const auto density = [](Real p) { return std::exp(c * (p - reference)); };
  Real put_in = 0;
  for (const Real t : {0.5, 0.75, 1.5}) {
    put_in += (0.1 + 0.2) * t * (t - model.time());
    ASSERT_TRUE(model.step_to(t).converged) << cell;
    const auto p = model.output("pressure").values, in_fracture = model.output("fracture pressure").values;
    Real here = 0, all = 0;
    for (LocalIndex k = 0; k < mesh.n_owned_cells; ++k) {
      const auto x = mesh::cell_centre(mesh, k);
      const Real start = 0.1 * x[0], part = room(x, 0);
      here += volume * ((part + growth * (p[k] - start)) * density(p[k]) - part * density(start));
    }
    for (std::size_t f = 0; f < in_fracture.size(); ++f) {
      const auto& face = mesh.fracture_faces[f];
      here += 0.2 * face.area * (density(in_fracture[f]) - density(0.1 * face.centre[0]));
    }
    Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_SUM, 1, &here, &all);
    EXPECT_NEAR(all, put_in, 1e-12) << cell << ", porosity " << porosity;
  }
}

TEST(CompressibleFlow, StoresWhatIsPutIn) {
  for (const std::string cell : all_cells)
    expect_stored(cell, "0.2", 0.3, [](auto& rock) { rock.compressibility = 0.3; });
}

/// Storage only in cells of one corner; other ranks have no storage.
TEST(CompressibleFlow, StoresInPartsOfTheRock) {
  for (const std::string cell : all_cells) expect_stored(cell, "x < 0.25 ? (y < 0.25 ? 0.2 : 0) : 0", 0, [](auto&) {});
}

TEST(CompressibleFlow, AnInfiniteBiotModulusStoresNothing) {
  const auto infinite = [](auto& rock) { rock.biot_modulus = std::numeric_limits<Real>::infinity(); };
  expect_stored("triangle", "0", 0, infinite);
}

/// CG is for symmetric matrices only. With GMRES and multigrid the density is linear, too.
TEST(CompressibleFlow, IterativeSolvesFindIt) {
  for (const auto& [cell, n] : std::vector<std::pair<std::string, int>>{{"triangle", 32}, {"hexahedron", 12}}) {
    auto scene = compressible_box(cell, n);
    scene.solver.linear_solver.type = "iterative";
    constrain(scene, "west", text_of(pressure_at(5)));
    constrain(scene, "east", text_of(pressure_at(1)));
    model::Model model(scene, Tpetra::getDefaultComm());
    const auto report = model.step_to(steady);
    ASSERT_TRUE(report.converged) << cell;
    EXPECT_LE(report.newton_iterations, 8) << cell;
    for (const auto& linear : report.linear_solves) EXPECT_LE(linear.iterations, 30) << cell;
    const auto p = [](const auto& x, const auto&) { return Vector3{pressure_at(5 - 4 * x[0])}; };
    EXPECT_LT(error(model, "pressure", p), 1e-8) << cell;
  }
}

}  // namespace
}  // namespace sprekk::tests
