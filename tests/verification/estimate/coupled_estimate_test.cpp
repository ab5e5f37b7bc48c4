// Error estimates of coupled flow, heat and mechanics, compared with solutions that are exact up to mesh errors.
#include "estimate/goals.hpp"
#include "model/error_estimates.hpp"
#include "verification/heat/warm_boxes.hpp"

#include <Teuchos_DefaultMpiComm.hpp>

namespace sprekk::tests {
namespace {

struct Measured {
  Real value, error;
  std::optional<Real> lack;  // signed, of balances
};

/// Returns value and estimated error of a quantity after all steps.
Measured measure(model::Scene scene, const model::Quantity& quantity, RCP<const Comm> comm = Tpetra::getDefaultComm()) {
  scene.accuracy.emplace().quantities["goal"] = quantity;
  scene.accuracy->quantities["goal"].relative = 0.01;
  model::Model model(scene, comm);
  auto estimator = model::make_error_estimator(model, 0);
  estimate::Goals goals(estimator, model.scene().accuracy->functionals());
  std::optional<Real> lack;
  const auto times = model.scene().time.times();
  for (const Real t : times) {
    EXPECT_TRUE(model.step_to(t).converged);
    const auto outputs = Outputs(model).all();
    const auto state = model::present_state(model, outputs);
    const auto estimate = estimator(state);
    goals.add(state, estimate, t == times.back());
    goals.weigh(state, estimate, t == times.back());
    for (const auto& error : estimator.errors())
      if (error->names().is_balance && error->goals()->knows(quantity.what))
        lack = error->goals()->evaluate(quantity, state, &*estimate.correction).error;
  }
  Real marked = 0;  // sum of all shares, which is one
  for (const Real share : goals.indicators({{"goal", 1}})) marked += share;
  Real all = 0;
  Teuchos::reduceAll(*model.mesh().comm, Teuchos::REDUCE_SUM, 1, &marked, &all);
  EXPECT_NEAR(all, 1, 1e-10);
  const auto& goal = goals.estimates().at("goal");
  return {goal.value, goal.error, lack};
}

/// Compares estimate and error on several meshes; the error must decrease with the given order.
void compare(const std::string& name, const model::Quantity& quantity, Real exact, Real order,
             const std::vector<model::Scene>& scenes) {
  SCOPED_TRACE(name + ", " + quantity.title());
  Real before = 0;
  for (const auto& scene : scenes) {
    const auto got = measure(scene, quantity);
    const Real missed = std::abs(got.value - exact);
    if (Tpetra::getDefaultComm()->getRank() == 0)
      fmt::print("  {}, {}: {:.2e} of {:.3g}, estimate {:.2f}\n", name, quantity.title(), missed, exact,
                 got.error / missed);
    EXPECT_GE(got.error / missed, 0.5);
    EXPECT_LE(got.error / missed, 2);
    if (got.lack) EXPECT_GT(*got.lack * (exact - got.value), 0);
    if (before > 0) EXPECT_NEAR(std::log2(before / missed), order, 0.5);
    before = missed;
  }
}

model::Quantity through(const std::string& what, const std::string& boundary, const std::string& component = "x") {
  model::Quantity quantity;
  quantity.what = what;
  quantity.boundary = boundary;
  quantity.component = component;
  return quantity;
}

constexpr int n_steps = 4;
constexpr Real dt = 0.05, lambda = 2, G = 1, alpha = 0.8, mobility = 0.3, storage = 0.5;
constexpr Real modulus = lambda + 2 * G, rate = M_PI * M_PI / 4;  // eigenvalue of -d^2/dy^2 for cos(pi y/2)

/// Returns a column of width 1/2 and height 1 between walls, on a floor, with a free top.
model::Scene column(const std::string& cell, int order, int n) {
  const bool flat = is_flat(cell);
  std::vector<std::string> sets = {
      "Mesh.cell=" + cell,
      fmt::format("Mesh.order={}", order),
      flat ? "Mesh.lower corner={0, 0}" : "Mesh.lower corner={0, 0, 0}",
      flat ? "Mesh.upper corner={0.5, 1}" : "Mesh.upper corner={0.5, 0.5, 1}",
      flat ? fmt::format("Mesh.cells={{{}, {}}}", n / 2, n) : fmt::format("Mesh.cells={{{0}, {0}, {1}}}", n / 2, n),
      fmt::format("Materials.rock.Lame's first parameter={}", lambda),
      fmt::format("Materials.rock.shear modulus={}", G),
      fmt::format("Time.end={}", n_steps * dt),
      fmt::format("Time.steps={}", n_steps)};
  auto scene = read_scene(flat ? "verification/terzaghi_2d.xml" : "verification/terzaghi_3d.xml", sets);
  for (auto& [name, condition] : scene.boundary_conditions) condition.traction.clear();
  return scene;
}

/// With a free top, the vertical strain is alpha (p - p_0)/M. Thus p_0, a cosine of the height, decays by a constant
/// factor per step. The stress change at the walls is -alpha (1 - lambda/M) times the pressure change.
TEST(CoupledEstimate, ConsolidationOfAColumn) {
  const Real left = std::pow(1 + mobility / (storage + alpha * alpha / modulus) * rate * dt, -n_steps);
  for (const std::string cell : {"triangle", "tetrahedron"})
    for (const int order : {1, 2}) {
      const bool flat = is_flat(cell);
      const Real width = flat ? 0.5 : 0.25, wall = flat ? 1 : 0.5;
      std::vector<model::Scene> scenes;
      for (const int n : flat ? std::vector{8, 16} : std::vector{4, 8}) {
        auto scene = column(cell, order, n);
        auto& rock = scene.materials.at("rock");
        rock.biot = Expression(alpha);
        rock.permeability = {Expression(mobility)};
        rock.compressibility = storage;
        scene.flow->viscosity = 1;
        scene.flow->initial_pressure = Expression(flat ? "cos(pi*y/2)" : "cos(pi*z/2)");
        scenes.push_back(scene);
      }
      const auto name = fmt::format("{} of order {}", cell, order);
      compare(name, through("flow", flat ? "north" : "top"), -mobility * M_PI / 2 * left * width, 2, scenes);
      compare(name, through("reaction", "east"), alpha * (1 - lambda / modulus) * (1 - left) * wall * 2 / M_PI, 2,
              scenes);
    }
}

/// Same problem for heat: rock shrinks as it cools, with the wall stress -3K alpha_T (1 - lambda/M) times the
/// temperature change.
TEST(CoupledEstimate, CoolingOfAColumn) {
  constexpr Real conductivity = 0.3, capacity = 0.7, expansion = 0.2, stiffness = (3 * lambda + 2 * G) * expansion;
  const Real left = std::pow(1 + conductivity / capacity * rate * dt, -n_steps);
  for (const std::string cell : {"triangle", "tetrahedron"}) {
    const bool flat = is_flat(cell);
    const Real width = flat ? 0.5 : 0.25, wall = flat ? 1 : 0.5;
    std::vector<model::Scene> scenes;
    for (const int n : flat ? std::vector{8, 16} : std::vector{4, 8}) {
      auto scene = column(cell, 1, n);
      scene.flow.reset();
      scene.boundary_conditions.erase("top");
      warm(scene, 0, conductivity, capacity, 0);
      scene.materials.at("rock").permeability.clear();
      scene.materials.at("rock").thermal_expansion = Expression(expansion);
      scene.heat->initial_temperature = Expression(flat ? "cos(pi*y/2)" : "cos(pi*z/2)");
      prescribe_temperature(scene, flat ? "north" : "top", "0");
      scenes.push_back(scene);
    }
    compare(cell, through("heat flow", flat ? "north" : "top"), -conductivity * M_PI / 2 * left * width, 2, scenes);
    compare(cell, through("reaction", "east"), stiffness * (1 - lambda / modulus) * (1 - left) * wall * 2 / M_PI, 2,
            scenes);
  }
}

/// Steady heat advection from west to east with conduction, upwind: T = (e^(P x) - 1)/(e^P - 1).
TEST(CoupledEstimate, HeatThatAFluidCarries) {
  constexpr Real P = 3, conductivity = 0.5;
  for (const std::string cell : {"triangle", "tetrahedron"}) {
    const bool flat = is_flat(cell);
    std::vector<model::Scene> scenes;
    for (const int n : flat ? std::vector{16, 32} : std::vector{8, 16}) {
      auto scene = closed_box(cell, false, n);
      scene.mesh.fractures["a"] = {flat ? std::vector<Real>{0.5, 0} : std::vector<Real>{0.5, 0, 0},
                                   flat ? std::vector<Real>{0.5, 1} : std::vector<Real>{0.5, 1, 1}};
      scene.flow->viscosity = 1;
      constrain(scene, "west", "1");
      constrain(scene, "east", "0");
      warm(scene, 0, conductivity, 0, P * conductivity);
      for (auto& [name, material] : scene.materials) {
        if (material.type == "joint") {
          material.filling_conductivity = Expression(10);
          material.tangential_permeability = Expression(1e-9);
        } else {
          material.permeability = {Expression(1)};
        }
      }
      prescribe_temperature(scene, "west", "0");
      prescribe_temperature(scene, "east", "1");
      scenes.push_back(scene);
    }
    model::Quantity temperature;
    temperature.what = "temperature";
    compare(cell, temperature, std::expm1(P / 2) / std::expm1(P), 1, scenes);
  }
}

/// A fracture that is opened and cooled by fluid, so short that most ranks have no part of it.
TEST(CoupledEstimate, SameOnAnyNumberOfRanks) {
  for (const std::string cell : {"triangle", "tetrahedron"}) {
    const bool flat = is_flat(cell);
    auto scene = column(cell, 1, 8);
    using Corner = std::vector<Real>;
    scene.mesh.fractures["a"] = {flat ? Corner{0.25, 0.875} : Corner{0.25, 0.25, 0.875},
                                 flat ? Corner{0.5, 0.875} : Corner{0.5, 0.5, 0.875}};
    scene.fractures["a"].material = "joint";
    auto& joint = scene.materials["joint"];
    joint.type = "joint";
    joint.friction_coefficient = Expression(0.6);
    joint.initial_aperture = Expression(0.1);
    auto& rock = scene.materials.at("rock");
    rock.biot = Expression(alpha);
    rock.permeability = {Expression(mobility)};
    rock.compressibility = storage;
    scene.flow->viscosity = 1;
    scene.boundary_conditions.at("top").pressure = Expression("t");
    scene.time.scheme = "BDF2";
    scene.time.steps = 2;
    warm(scene, 2, 0.3, 0.7, 0.5);
    rock.thermal_expansion = Expression(0.01);
    prescribe_temperature(scene, flat ? "north" : "top", "1");
    const RCP<const Comm> alone = rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF));
    for (const std::string what : flat ? std::vector{"opening", "pressure", "temperature"} : std::vector{"opening"}) {
      SCOPED_TRACE(cell + ", " + what);
      model::Quantity quantity;
      quantity.what = what;
      const auto together = measure(scene, quantity), single = measure(scene, quantity, alone);
      EXPECT_NEAR(together.value, single.value, 1e-6 * std::abs(single.value));
      EXPECT_NEAR(together.error, single.error, 1e-4 * single.error);
      EXPECT_GT(single.error, 1e-6 * std::abs(single.value));
    }
  }
}

}  // namespace
}  // namespace sprekk::tests
