// Flow through rock, compared with exact solutions of the equations and of the discretisation.
#include "boxes.hpp"

namespace sprekk::tests {
namespace {

/// Returns xml/flow/source_2d.xml or source_3d.xml with n cells along each edge.
model::Scene scene_of(const std::string& cell, int n, const std::string& scheme = "auto") {
  auto scene = read_scene(is_flat(cell) ? "flow/source_2d.xml" : "flow/source_3d.xml");
  scene.mesh.cell = cell;
  for (int& count : scene.mesh.cells) count = n;
  scene.flow->scheme = scheme;
  return scene;
}

Vector3 centre(const mesh::Mesh& mesh, LocalIndex cell) {
  Vector3 x{};
  const int n = mesh::n_corners(mesh.shape);
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < mesh.dim(); ++i) x[i] += mesh.coordinates[mesh.cells[cell * n + k] * mesh.dim() + i] / n;
  return x;
}

/// Returns the root mean squares, over cells, of the errors of pressure and Darcy velocity. Collective.
template <class Pressure, class Velocity>
std::array<Real, 2> errors(model::Model& model, const Pressure& p, const Velocity& v) {
  const auto pressure = model.output("pressure").values, velocity = model.output("Darcy velocity").values;
  const auto& mesh = model.mesh();
  std::array<Real, 2> here{}, all{};
  for (LocalIndex c = 0; c < mesh.n_owned_cells; ++c) {
    const auto x = centre(mesh, c);
    const Vector3 exact = v(x);
    here[0] += std::pow(pressure[c] - p(x), 2);
    for (int i = 0; i < mesh.dim(); ++i) here[1] += std::pow(velocity[3 * c + i] - exact[i], 2);
  }
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_SUM, 2, here.data(), all.data());
  for (auto& sum : all) sum = std::sqrt(sum / static_cast<Real>(mesh.n_global_cells));
  return all;
}

/// Constant gradient under gravity in anisotropic rock, with prescribed pressures on all sides except a prescribed
/// flux in the east.
TEST(Flow, ConstantGradientIsExact) {
  const Vector3 gradient = {0.7, -0.3, 0.45};
  const Real weight = 3 * -10;  // rho g in the last direction
  for (const std::string cell : all_cells) {
    auto scene = scene_of(cell, 3);
    const int dim = is_flat(cell) ? 2 : 3;
    scene.flow->source = 0;
    scene.flow->density = 3;
    scene.flow->viscosity = 2;
    scene.bulk.gravity = dim == 2 ? std::vector<Real>{0, -10} : std::vector<Real>{0, 0, -10};
    auto& k = scene.materials.at("rock").permeability;
    using Tensor = std::vector<base::Expression>;
    k = dim == 2 ? Tensor{4, 2, 1} : Tensor{4, 2, 3, 1, 0.4, 0.6};
    Matrix3 M = {{{2, 0.5, 0.3}, {0.5, 1, 0.2}, {0.3, 0.2, 1.5}}};
    Vector3 velocity{};
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) velocity[i] -= M[i][j] * (gradient[j] - (j == dim - 1 ? weight : 0));
    for (auto& [name, condition] : scene.boundary_conditions)
      condition.pressure = base::Expression(dim == 2 ? "0.7*x - 0.3*y" : "0.7*x - 0.3*y + 0.45*z");
    auto& east = scene.boundary_conditions.at("east");
    east.pressure.reset();
    east.flux = base::Expression(velocity[0]);
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1).converged) << cell;
    const auto p = [&](const Vector3& x) {
      return gradient[0] * x[0] + gradient[1] * x[1] + (dim == 3 ? gradient[2] * x[2] : 0);
    };
    const auto error = errors(model, p, [&](const auto&) { return velocity; });
    EXPECT_LT(error[0], 1e-11) << cell;
    EXPECT_LT(error[1], 1e-11) << cell;
  }
}

TEST(Flow, ErrorsShrinkWithTheCells) {
  const auto shrinks = [](const std::string& cell, const std::string& scheme) {
    const int dim = is_flat(cell) ? 2 : 3;
    const auto bump = [&](const Vector3& x, int along) {  // product of sines, or its derivative
      Real value = 1;
      for (int i = 0; i < dim; ++i) value *= i == along ? M_PI * std::cos(M_PI * x[i]) : std::sin(M_PI * x[i]);
      return value;
    };
    std::vector<std::array<Real, 2>> error;
    for (int n : {4, 8}) {
      model::Model model(scene_of(cell, dim == 2 ? 4 * n : n, scheme), Tpetra::getDefaultComm());
      EXPECT_TRUE(model.step_to(1).converged) << cell;
      error.push_back(errors(
          model, [&](const Vector3& x) { return 1 - x[0] + bump(x, -1); },
          [&](const Vector3& x) {
            return Vector3{1 - bump(x, 0), -bump(x, 1), dim == 3 ? -bump(x, 2) : 0};
          }));
    }
    EXPECT_GT(std::log2(error[0][0] / error[1][0]), 1.8) << cell << ' ' << scheme;
    EXPECT_GT(std::log2(error[0][1] / error[1][1]), 0.9) << cell << ' ' << scheme;
  };
  shrinks("triangle", "rt0");
  shrinks("tetrahedron", "rt0");
  shrinks("quadrilateral", "mimetic");
  shrinks("hexahedron", "mimetic");
  shrinks("hexahedron", "tpfa");
}

/// The inflow at the sides and the source inside balance.
TEST(Flow, IsInBalance) {
  for (const std::string cell : all_cells) {
    auto scene = scene_of(cell, 4);
    scene.flow->source = 3;
    model::Model model(scene, Tpetra::getDefaultComm());
    const auto report = model.step_to(1);
    ASSERT_TRUE(report.converged) << cell;
    Real sum = 3;
    for (const auto& reaction : model.system().reactions(model.state())) sum += reaction.force.at(0);
    EXPECT_NEAR(sum, 0, 1e-12 * 4) << cell;
    for (const auto& measure : report.measures) EXPECT_LT(measure.value, 1e-12) << cell << ' ' << measure.name;
  }
}

/// The number of iterations is almost independent of the mesh, for all schemes.
TEST(Flow, MultigridSolvesPressures) {
  for (const auto& [cell, scheme] : std::vector<std::array<std::string, 2>>{
           {"triangle", "rt0"}, {"tetrahedron", "rt0"}, {"quadrilateral", "tpfa"}, {"hexahedron", "mimetic"}}) {
    std::vector<int> counts;
    for (int n : {1, 2}) {
      auto scene = scene_of(cell, n * (is_flat(cell) ? 32 : 8), scheme);
      scene.solver.linear_solver.type = "iterative";
      model::Model model(scene, Tpetra::getDefaultComm());
      const auto report = model.step_to(1);
      EXPECT_TRUE(report.converged) << cell;
      counts.push_back(solve::iterations(report.linear_solves));
    }
    EXPECT_LE(counts[1], 25) << cell << ' ' << scheme;
    EXPECT_LE(counts[1], counts[0] + 6) << cell << ' ' << scheme;
  }
}

/// In a closed box, the source increases the pressure: c_phi dp/dt = source.
TEST(Flow, AClosedBoxFillsUp) {
  for (const std::string cell : all_cells) {
    auto scene = scene_of(cell, 2);
    scene.boundary_conditions.clear();
    scene.flow->source = 6;
    scene.flow->initial_pressure = 7;
    scene.materials.at("rock").compressibility = 0.4;
    model::Model model(scene, Tpetra::getDefaultComm());
    for (Real t : {0.5, 0.75, 2.0}) {
      ASSERT_TRUE(model.step_to(t).converged) << cell;
      const auto error = errors(
          model, [&](const auto&) { return 7 + 15 * t; }, [](const auto&) { return Vector3{}; });
      EXPECT_LT(error[0], 1e-10) << cell;
      EXPECT_LT(error[1], 1e-10) << cell;
    }
  }
}

/// cos(pi x) decays by the factor 1/(1 + dt l/S) per step of implicit Euler, l = (2/h sin(pi h/2))^2 for two-point
/// fluxes.
TEST(Flow, AModeDecaysAsTheSchemeSays) {
  auto scene = scene_of("quadrilateral", 8, "tpfa");
  scene.boundary_conditions.clear();
  scene.flow->source = 0;
  scene.flow->initial_pressure = base::Expression("cos(pi*x)");
  scene.materials.at("rock").compressibility = 0.25;
  model::Model model(scene, Tpetra::getDefaultComm());
  const Real h = 1.0 / 8, root = 2 / h * std::sin(M_PI * h / 2), dt = 0.02;
  Real factor = root / M_PI;  // means over cells at the start
  for (int step = 1; step <= 3; ++step) {
    ASSERT_TRUE(model.step_to(step * dt).converged);
    factor /= 1 + dt * root * root / 0.25;
    const auto error = errors(
        model, [&](const auto& x) { return factor * std::cos(M_PI * x[0]); },
        [&](const auto& x) {  // mean of the fluxes through the west and east sides
          return Vector3{factor * root * std::cos(M_PI * h / 2) * std::sin(M_PI * x[0]), 0, 0};
        });
    EXPECT_LT(error[0], 1e-8);
    EXPECT_LT(error[1], 1e-8);
  }
}

}  // namespace
}  // namespace sprekk::tests
