// Second-order advection, compared with exact solutions, bounds and balances.
#include "warm_boxes.hpp"

namespace sprekk::tests {
namespace {

/// Returns flow with unit capacities along x from 0 to `length` with velocity v and conductivity D. The flow is
/// through rock, n cells long, or along a fracture in rock without conduction and storage.
model::Scene stream(const std::string& cell, bool in_fracture, int n, Real length, Real v, Real D) {
  auto scene = closed_box(cell, in_fracture, 2);
  const bool flat = is_flat(cell);
  scene.mesh.fractures.erase("b");
  scene.fractures.erase("b");
  scene.mesh.cells[0] = n;
  scene.mesh.upper_corner[0] = length;
  if (!in_fracture) {
    scene.mesh.fractures.clear();
    scene.fractures.clear();
    scene.mesh.cells[1] = 1;
    scene.mesh.upper_corner[1] = length / n;
    if (!flat) {
      scene.mesh.cells[2] = 1;
      scene.mesh.upper_corner[2] = length / n;
    }
    warm(scene, 0, D, 1, 1);
    auto& west = scene.boundary_conditions["inflow"];
    west.boundary = "west";
    west.flux = Expression(-v);
    constrain(scene, "east", "0");
    prescribe_temperature(scene, "west", "1");
  } else {
    scene.mesh.fractures["a"].upper_corner[0] = length;
    warm(scene, 0, 1e-12 * D, 0, 1);
    scene.materials.at("rock").permeability = {Expression(1e-30)};
    scene.materials.at("joint").filling_conductivity = Expression(D);
    inject(scene, "west", "a", aperture * v);
    constrain(scene, "east", "0", "a");
    prescribe_temperature(scene, "west", "1", "a");
  }
  scene.heat->advection = "second order";
  return scene;
}

/// Returns the mean error of the temperature over cells, or over faces of a fracture. Collective.
template <class Exact>
Real mean_error(model::Model& model, const std::string& output, const Exact& exact) {
  const auto T = model.output(output).values;
  const auto& mesh = model.mesh();
  std::array<Real, 2> here{}, all{};
  for (std::size_t k = 0; k < T.size(); ++k) {
    const auto e = static_cast<LocalIndex>(k);
    const auto x = output == "temperature" ? mesh::cell_centre(mesh, e) : mesh.fracture_faces[e].centre;
    here[0] += std::abs(T[k] - exact(x[0]));
    here[1] += 1;
  }
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_SUM, 2, here.data(), all.data());
  return all[0] / all[1];
}

std::array<Real, 2> range(model::Model& model, const std::string& output) {
  std::array<Real, 2> here{1e300, 1e300}, all{};
  for (const Real T : model.output(output).values) here = {std::min(here[0], T), std::min(here[1], -T)};
  Teuchos::reduceAll(*model.mesh().comm, Teuchos::REDUCE_MIN, 2, here.data(), all.data());
  return {all[0], -all[1]};
}

/// Ogata and Banks (1961): a front under advection and conduction. The steps decrease with the square of the cell
/// size, because conduction is first order in time.
TEST(SecondOrder, AFrontIsCarriedAlong) {
  constexpr Real D = 3e-6, v = 8e-6, t = 1e6;
  const auto exact = [](Real x) {
    const Real width = 2 * std::sqrt(D * t);
    return (std::erfc((x - v * t) / width) + std::exp(v * x / D) * std::erfc((x + v * t) / width)) / 2;
  };
  EXPECT_NEAR(exact(10), 0.245324337878, 1e-10);
  for (const auto& [cell, in_fracture] :
       {std::pair("quadrilateral", false), {"triangle", false}, {"hexahedron", true}}) {
    std::vector<Real> errors;
    Real of_upwind = 0;
    const std::string output = in_fracture ? "fracture temperature" : "temperature";
    for (const int n : {16, 32, -32}) {
      auto scene = stream(cell, in_fracture, std::abs(n), 25, v, D);
      if (n < 0) scene.heat->advection = "upwind";
      model::Model model(scene, Tpetra::getDefaultComm());
      const int steps = n * n / 16;  // 0.32 cells per step, then 0.16
      for (int k = 1; k <= steps; ++k) ASSERT_TRUE(model.step_to(k * t / steps).converged) << cell;
      const Real found = mean_error(model, output, exact);
      if (n > 0)
        errors.push_back(found);
      else
        of_upwind = found;
    }
    EXPECT_GT(std::log2(errors[0] / errors[1]), 1.7) << cell << ": " << errors[0] << ", " << errors[1];
    EXPECT_LT(errors[1], 0.25 * of_upwind) << cell << in_fracture;
  }
}

/// Steady advection and conduction with a warm outlet, T = (exp(Pe x) - 1)/(exp(Pe) - 1) at Pe = 10.
TEST(SecondOrder, SettlesToTheSteadyState) {
  constexpr Real Pe = 10;
  const auto exact = [](Real x) { return std::expm1(Pe * x) / std::expm1(Pe); };
  EXPECT_NEAR(exact(0.9), 0.367850742, 1e-9);
  for (const std::string cell : {"quadrilateral"}) {
    std::vector<Real> errors;
    for (const int n : {20, 40}) {
      auto scene = stream(cell, false, n, 1, Pe, 1);
      prescribe_temperature(scene, "west", "0");
      prescribe_temperature(scene, "east", "1");
      model::Model model(scene, Tpetra::getDefaultComm());
      const int steps = 6 * n;
      for (int k = 1; k <= steps; ++k) ASSERT_TRUE(model.step_to(0.3 * k / steps).converged) << cell;
      errors.push_back(mean_error(model, "temperature", exact));
    }
    EXPECT_GT(std::log2(errors[0] / errors[1]), 1.7) << cell << ": " << errors[0] << ", " << errors[1];
    EXPECT_LT(errors[1], 2e-3) << cell;
  }
}

/// At a Peclet number of 1000, temperatures stay within the range of inflow and initial values, for an inflow step and
/// for an initial pulse. The pulse conserves its energy while inside.
TEST(SecondOrder, KeepsBoundsAndEnergy) {
  for (const std::string cell : {"quadrilateral", "hexahedron"})
    for (const bool wave : {false, true}) {
      constexpr int n = 50;
      auto scene = stream(cell, false, n, 1, 1, 1e-3);
      if (wave) {
        scene.materials.at("rock").thermal_conductivity = {Expression(1e-12)};
        prescribe_temperature(scene, "west", "0");
        scene.heat->initial_temperature = Expression("x > 0.2 && x < 0.4 ? 1 : 0");
      }
      model::Model model(scene, Tpetra::getDefaultComm());
      for (int k = 1; k <= 20; ++k) {
        ASSERT_TRUE(model.step_to(0.01 * k).converged) << cell;
        const auto [minimum, largest] = range(model, "temperature");
        EXPECT_GE(minimum, -1e-10) << cell << k;
        EXPECT_LE(largest, 1 + 1e-10) << cell << k;
        if (k == 20 && !wave) {
          EXPECT_GT(largest, 1 - 1e-3) << cell;
        }
      }
      if (!wave) continue;
      const auto T = model.output("temperature").values;
      Real here = 0, all = 0;
      for (const Real each : T) here += each / n;
      Teuchos::reduceAll(*model.mesh().comm, Teuchos::REDUCE_SUM, 1, &here, &all);
      EXPECT_NEAR(all, 0.2, 1e-6) << cell;  // minus the outflow of the upwind scheme
    }
}

/// Warm fluid through intersecting fractures: heat balance and bounds in each step.
TEST(SecondOrder, IsInBalanceWhereFracturesMeet) {
  for (const std::string cell : {"quadrilateral", "hexahedron"}) {
    auto scene = closed_box(cell, true, 10);
    if (!is_flat(cell)) scene.mesh.cells[2] = 1;
    scene.materials.at("rock").permeability = {Expression(1e-30)};
    scene.materials.at("joint").filling_conductivity = Expression(1e-9);
    warm(scene, 0, 1e-15, 0, 3);
    scene.heat->advection = "second order";
    inject(scene, "west", "a", 1);
    inject(scene, "east", "a", -0.4);
    constrain(scene, "north", "0", "b");
    prescribe_temperature(scene, "west", "1", "a");
    model::Model model(scene, Tpetra::getDefaultComm());
    const auto& mesh = model.mesh();
    struct Sums {
      Real content = 0, east = 0, north = 0;
    };
    const auto sums = [&] {
      const auto T = model.output("fracture temperature").values;
      std::array<Real, 5> here{}, all{};
      for (std::size_t k = 0; k < T.size(); ++k) {
        const auto& face = mesh.fracture_faces[k];
        here[0] += 3 * aperture * face.area * T[k];
        const bool in_a = std::abs(face.frame[0][1]) > 0.5;
        for (const bool east : {true, false})
          if (in_a == east && face.centre[east ? 0 : 1] > 0.9) {
            here[east ? 1 : 2] += T[k];
            here[east ? 3 : 4] += 1;
          }
      }
      Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_SUM, 5, here.data(), all.data());
      return Sums{all[0], all[1] / all[3], all[2] / all[4]};
    };
    Real before = 0;
    constexpr Real dt = 5e-5;  // half a cell
    for (int k = 1; k <= 50; ++k) {
      ASSERT_TRUE(model.step_to(k * dt).converged) << cell;
      const auto now = sums();
      const Real gained = dt * 3 * (1 - 0.4 * now.east - 0.6 * now.north);
      if (k > 1) {
        EXPECT_NEAR(now.content - before, gained, 1e-5 * dt * 3) << cell << k;
      }
      before = now.content;
      const auto [minimum, largest] = range(model, "fracture temperature");
      EXPECT_GE(minimum, -1e-8) << cell << k;
      EXPECT_LE(largest, 1 + 1e-8) << cell << k;
    }
    EXPECT_GT(sums().east, 0.9) << cell;
  }
}

}  // namespace
}  // namespace sprekk::tests
