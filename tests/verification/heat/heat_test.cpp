// Heat conduction, compared with exact solutions of the equations and of the discretisation.
#include "../scenes.hpp"
#include "assembly/jacobian_check.hpp"
#include "unit/assembly/dense.hpp"

namespace sprekk::tests {
namespace {

constexpr const char* all_cells[] = {"triangle", "quadrilateral", "tetrahedron", "hexahedron"};

bool is_flat(const std::string& cell) { return cell == "triangle" || cell == "quadrilateral"; }

/// Returns the insulated unit square or cube with n cells along each edge.
model::Scene box(const std::string& cell, int n) {
  model::Scene scene;
  const int dim = is_flat(cell) ? 2 : 3;
  scene.mesh.cell = cell;
  scene.mesh.lower_corner.assign(dim, 0);
  scene.mesh.upper_corner.assign(dim, 1);
  scene.mesh.cells.assign(dim, n);
  auto& rock = scene.materials["rock"];
  rock.type = "elastic";
  rock.thermal_conductivity = {base::Expression(2)};
  rock.heat_capacity = 3;
  scene.bulk.material = "rock";
  scene.bulk.rigid = true;
  scene.heat.emplace().initial_temperature = 0;
  return scene;
}

std::vector<std::string> sides(const model::Scene& scene) {
  return scene.mesh.cells.size() == 2 ? std::vector<std::string>{"west", "east", "south", "north"}
                                      : std::vector<std::string>{"west", "east", "south", "north", "bottom", "top"};
}

void prescribe_side(model::Scene& scene, const std::string& side, const std::string& temperature) {
  scene.boundary_conditions[side].boundary = side;
  scene.boundary_conditions[side].temperature = base::Expression(temperature);
}

/// Returns the root mean squares, over cells, of the errors of temperature and heat flux. Collective.
template <class Temperature, class Flux>
std::array<Real, 2> errors(model::Model& model, const Temperature& T, const Flux& q) {
  const auto temperature = model.output("temperature").values, flux = model.output("heat flux").values;
  const auto& mesh = model.mesh();
  std::array<Real, 2> here{}, all{};
  for (LocalIndex c = 0; c < mesh.n_owned_cells; ++c) {
    const auto x = mesh::cell_centre(mesh, c);
    const Vector3 exact = q(x);
    here[0] += std::pow(temperature[c] - T(x), 2);
    for (int i = 0; i < mesh.dim(); ++i) here[1] += std::pow(flux[3 * c + i] - exact[i], 2);
  }
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_SUM, 2, here.data(), all.data());
  for (auto& sum : all) sum = std::sqrt(sum / static_cast<Real>(mesh.n_global_cells));
  return all;
}

/// Anisotropic rock with prescribed temperatures on all sides except a prescribed flux in the east.
TEST(Heat, ConstantGradientIsExact) {
  const Vector3 gradient = {0.7, -0.3, 0.45};
  const Matrix3 K = {{{4, 1, 0.6}, {1, 2, 0.4}, {0.6, 0.4, 3}}};
  for (const std::string cell : all_cells) {
    auto scene = box(cell, 3);
    const int dim = is_flat(cell) ? 2 : 3;
    using Tensor = std::vector<base::Expression>;
    scene.materials.at("rock").thermal_conductivity = dim == 2 ? Tensor{4, 2, 1} : Tensor{4, 2, 3, 1, 0.4, 0.6};
    for (const auto& side : sides(scene))
      prescribe_side(scene, side, dim == 2 ? "0.7*x - 0.3*y" : "0.7*x - 0.3*y + 0.45*z");
    Vector3 flux{};
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) flux[i] -= K[i][j] * gradient[j];
    auto& east = scene.boundary_conditions.at("east");
    east.temperature.reset();
    east.heat_flux = base::Expression(flux[0]);
    scene.materials.at("rock").heat_capacity = 0;
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1).converged) << cell;
    const auto error = errors(
        model, [&](const auto& x) { return mesh::dot(gradient, x); }, [&](const auto&) { return flux; });
    EXPECT_LT(error[0], 1e-11) << cell;
    EXPECT_LT(error[1], 1e-11) << cell;
  }
}

/// A heat capacity by an expression of the coordinates equals one by regions.
TEST(Heat, CapacityMayDependOnThePlace) {
  for (const std::string cell : all_cells) {
    std::vector<std::vector<Real>> found;
    for (const bool by_regions : {false, true}) {
      auto scene = box(cell, 4);
      prescribe_side(scene, "west", "t");
      auto& rock = scene.materials.at("rock");
      rock.heat_capacity = by_regions ? base::Expression(3) : base::Expression("x < 0.5 ? 3 : 6");
      if (by_regions) {
        auto upper = scene.mesh.upper_corner, lower = scene.mesh.lower_corner;
        lower[0] = 0.5;
        scene.mesh.regions["east"] = {lower, upper};
        scene.materials["dense"] = rock;
        scene.materials["dense"].heat_capacity = 6;
        scene.regions["east"].material = "dense";
      }
      model::Model model(scene, Tpetra::getDefaultComm());
      for (const Real t : {0.1, 0.3}) ASSERT_TRUE(model.step_to(t).converged) << cell;
      found.push_back(model.output("temperature").values);
    }
    for (std::size_t c = 0; c < found[0].size(); ++c) EXPECT_NEAR(found[0][c], found[1][c], 1e-13) << cell;
  }
}

/// From 5 K in the west, h = 1, through rock of conductivity 2 to 1 K in the east, h = 4: q = 4/(1 + 1/2 + 1/4).
TEST(Heat, TransferIsAResistanceInSeries) {
  const Real q = 4 / 1.75;
  for (const std::string cell : all_cells) {
    auto scene = box(cell, 4);
    prescribe_side(scene, "west", "5");
    prescribe_side(scene, "east", "1");
    scene.boundary_conditions.at("west").heat_transfer_coefficient = base::Expression(1);
    scene.boundary_conditions.at("east").heat_transfer_coefficient = base::Expression(4);
    scene.materials.at("rock").heat_capacity = 0;
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1).converged) << cell;
    const auto error = errors(
        model, [&](const auto& x) { return 5 - q - q / 2 * x[0]; },
        [&](const auto&) {
          return Vector3{q, 0, 0};
        });
    EXPECT_LT(error[0], 1e-11) << cell;
    EXPECT_LT(error[1], 1e-11) << cell;
    Real west = 0, east = 0;
    for (const auto& total : model.system().totals(model.state())) {
      ASSERT_EQ(total.names.at(0), "heat_inflows");
      (total.names.at(1) == "west" ? west : east) += total.value;
    }
    EXPECT_NEAR(west, q, 1e-11) << cell;
    EXPECT_NEAR(east, -q, 1e-11) << cell;
  }
}

/// T = product of sin(pi x_i), steady with the source 2 dim pi^2 T.
TEST(Heat, ErrorsShrinkWithTheCells) {
  for (const std::string cell : all_cells) {
    const int dim = is_flat(cell) ? 2 : 3;
    const std::string bump = dim == 2 ? "sin(pi*x)*sin(pi*y)" : "sin(pi*x)*sin(pi*y)*sin(pi*z)";
    const auto product = [&](const Vector3& x, int along) {  // product, or -2 times its derivative
      Real value = along < 0 ? 1 : -2;
      for (int i = 0; i < dim; ++i) value *= i == along ? M_PI * std::cos(M_PI * x[i]) : std::sin(M_PI * x[i]);
      return value;
    };
    std::vector<std::array<Real, 2>> error;
    for (int n : {4, 8}) {
      auto scene = box(cell, dim == 2 ? 4 * n : n);
      for (const auto& side : sides(scene)) prescribe_side(scene, side, "0");
      scene.heat->source = base::Expression(fmt::format("{}*pi^2*{}", 2 * dim, bump));
      scene.materials.at("rock").heat_capacity = 0;
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged) << cell;
      error.push_back(errors(
          model, [&](const Vector3& x) { return product(x, -1); },
          [&](const Vector3& x) {
            return Vector3{product(x, 0), product(x, 1), dim == 3 ? product(x, 2) : 0};
          }));
    }
    EXPECT_GT(std::log2(error[0][0] / error[1][0]), 1.8) << cell;
    EXPECT_GT(std::log2(error[0][1] / error[1][1]), 0.9) << cell;
  }
}

/// Insulated rock with the source cos(t): T = T_0 + sin(t)/(rho c), uniform, hence only with time error.
TEST(Heat, OrderInTime) {
  for (const std::string cell : {"triangle", "hexahedron"})
    for (const auto& [scheme, order] : {std::pair("implicit Euler", 1), std::pair("BDF2", 2)}) {
      std::vector<Real> error;
      for (int n : {20, 40}) {
        auto scene = box(cell, 2);
        scene.heat->source = base::Expression("cos(t)");
        scene.heat->initial_temperature = 300;
        scene.time.scheme = scheme;
        model::Model model(scene, Tpetra::getDefaultComm());
        for (int k = 1; k <= n; ++k) ASSERT_TRUE(model.step_to(Real(k) / n).converged) << cell << ' ' << scheme;
        const Real exact = 300 + std::sin(1) / 3;
        error.push_back(errors(
            model, [&](const auto&) { return exact; }, [](const auto&) { return Vector3{}; })[0]);
      }
      EXPECT_NEAR(std::log2(error[0] / error[1]), order, 0.15) << cell << ' ' << scheme;
    }
}

/// The inflow at the sides equals the gain of the rock.
TEST(Heat, IsInBalance) {
  for (const std::string cell : all_cells) {
    auto scene = box(cell, 3);
    scene.heat->initial_temperature = base::Expression("10 + x*y");
    prescribe_side(scene, "west", "20 + t");
    prescribe_side(scene, "north", "0");
    scene.boundary_conditions.at("north").heat_transfer_coefficient = base::Expression(0.7);
    auto& south = scene.boundary_conditions["south"];
    south.boundary = "south";
    south.heat_flux = base::Expression("1 + t");
    model::Model model(scene, Tpetra::getDefaultComm());
    Real stored = 0, inflow = 0;
    const auto content = [&] {
      Real here = 0, all = 0;
      const auto T = model.output("temperature").values;
      for (LocalIndex c = 0; c < model.mesh().n_owned_cells; ++c) here += 3 * T[c];
      Teuchos::reduceAll(*model.mesh().comm, Teuchos::REDUCE_SUM, 1, &here, &all);
      return all / static_cast<Real>(model.mesh().n_global_cells);  // cells of equal size
    };
    ASSERT_TRUE(model.step_to(0.1).converged) << cell;
    const Real before = content();
    for (int k = 2; k <= 4; ++k) {
      ASSERT_TRUE(model.step_to(0.1 * k).converged) << cell;
      for (const auto& reaction : model.system().reactions(model.state())) inflow += 0.1 * reaction.force.at(0);
      for (const auto& total : model.system().totals(model.state())) inflow += 0.1 * total.value;
    }
    stored = content() - before;
    EXPECT_GT(std::abs(stored), 0.1) << cell;
    EXPECT_NEAR(stored, inflow, 1e-10) << cell;
  }
}

/// xml/heat/cooling_2d.xml and _3d.xml: T = 350 - 50 erfc(x/sqrt(4 kappa t)).
TEST(Heat, AHalfSpaceCools) {
  for (const std::string name : {"cooling_2d", "cooling_3d"}) {
    const auto scene = read_scene("heat/" + name + ".xml");
    model::Model model(scene, Tpetra::getDefaultComm());
    for (const Real t : scene.time.times()) ASSERT_TRUE(model.step_to(t).converged);
    const Real kappa = 1e-6, t = scene.time.end;
    const auto exact = [&](const Vector3& x) { return 350 - 50 * std::erfc(x[0] / std::sqrt(4 * kappa * t)); };
    const auto flux = [&](const Vector3& x) {
      return Vector3{-2.5 * 50 / std::sqrt(M_PI * kappa * t) * std::exp(-x[0] * x[0] / (4 * kappa * t)), 0, 0};
    };
    const auto error = errors(model, exact, flux);
    EXPECT_LT(error[0], 5e-3) << name;  // 3e-3
    EXPECT_LT(error[1], 5e-3) << name;  // 3e-3
  }
}

/// Deformable rock under body force: displacements are those without heat, temperatures those of rigid rock.
TEST(Heat, GoesBesideMechanics) {
  for (const std::string cell : all_cells) {
    auto both = box(cell, 3);
    const int dim = is_flat(cell) ? 2 : 3;
    prescribe_side(both, "west", "20");
    auto& rock = both.materials.at("rock");
    rock.E = 100;
    rock.nu = 0.25;
    auto& floor = both.boundary_conditions["floor"];
    floor.boundary = "south";
    floor.displacement.assign(dim, base::Expression(0));
    both.bulk.body_force.assign(dim, base::Expression(1));
    auto rigid = both, cold = both;
    both.bulk.rigid = false;
    rigid.bulk.body_force.clear();
    rigid.boundary_conditions.erase("floor");
    cold.bulk.rigid = false;
    cold.heat.reset();
    cold.boundary_conditions.erase("west");
    model::Model of_both(both, Tpetra::getDefaultComm()), of_rigid(rigid, Tpetra::getDefaultComm()),
        of_cold(cold, Tpetra::getDefaultComm());
    for (auto* model : {&of_both, &of_rigid, &of_cold}) ASSERT_TRUE(model->step_to(0.1).converged) << cell;
    const auto same = [&](model::Model& other, const std::string& name) {
      const auto a = of_both.output(name).values, b = other.output(name).values;
      for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], 1e-9 * (1 + std::abs(b[k]))) << cell;
    };
    same(of_rigid, "temperature");
    same(of_cold, "displacement");
  }
}

TEST(Heat, ARegionIsConstrained) {
  for (const std::string cell : all_cells) {
    auto scene = box(cell, 4);
    const int dim = is_flat(cell) ? 2 : 3;
    std::vector<Real> middle(dim, 1);
    middle[0] = 0.5;
    scene.mesh.regions["warm"] = {scene.mesh.lower_corner, middle};
    scene.regions["warm"].temperature = base::Expression(7);
    prescribe_side(scene, "east", "1");
    scene.materials.at("rock").heat_capacity = 0;
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1).converged) << cell;
    const auto error = errors(
        model, [](const auto& x) { return x[0] < 0.5 ? 7 : 7 - 12 * (x[0] - 0.5); },
        [](const auto& x) {
          return Vector3{x[0] < 0.5 ? 0 : 24.0, 0, 0};
        });
    EXPECT_LT(error[0], 1e-10) << cell;
    EXPECT_LT(error[1], 1e-10) << cell;
  }
}

TEST(Heat, JacobianIsItsDerivative) {
  for (const std::string cell : all_cells) {
    auto scene = box(cell, 3);
    prescribe_side(scene, "west", "1");
    prescribe_side(scene, "north", "2");
    scene.boundary_conditions.at("north").heat_transfer_coefficient = base::Expression("1 + x");
    model::Model model(scene, Tpetra::getDefaultComm());
    auto& system = model.system();
    system.set_time(1, 0.5);
    auto x = system.initial();
    test::randomize(x, 1, 1);
    system.commit(x);
    test::randomize(x, 1, 2);
    for (const auto& e : assembly::check_jacobian(system, x, 1e-5))
      EXPECT_LE(e.error, 1e-8) << cell << ": " << e.row << ", " << e.column;
  }
}

}  // namespace
}  // namespace sprekk::tests
