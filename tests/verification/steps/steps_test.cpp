// Adaptive time steps of whole scenes.
#include "base/over_ranks.hpp"
#include "model/steps.hpp"
#include "verification/scenes.hpp"

#include <map>
#include <utility>

namespace sprekk::tests {
namespace {

/// Returns a scene with adaptive steps.
model::Scene chosen(const std::string& name, Real tolerance, const std::vector<std::string>& overrides = {}) {
  auto scene = read_scene(name, overrides);
  scene.time.steps.reset();
  scene.time.tolerance = tolerance;
  return scene;
}

/// Runs all steps of a scene and returns the accepted ones; calls visit(model, step) after each.
template <class Visit>
std::vector<model::StepTaken> go(const model::Scene& scene, const Visit& visit) {
  model::Model model(scene, Tpetra::getDefaultComm());
  model::Steps steps(model);
  std::vector<model::StepTaken> all;
  while (steps.any()) {
    all.push_back(steps.take());
    EXPECT_TRUE(all.back().report.converged) << all.back().report.reason;
    if (!all.back().report.converged) break;
    visit(model, all.back());
  }
  return all;
}

std::vector<model::StepTaken> go(const model::Scene& scene) {
  return go(scene, [](auto&, auto&) {});
}

/// Errors are controlled at the tolerance: with order p, the number of steps is n ~ tolerance^(-1/p).
TEST(ChosenSteps, GrowInNumberAsTheirOrderSays) {
  const std::map<std::string, std::pair<int, Real>> cases = {{"implicit Euler", {1, 5e-4}}, {"BDF2", {2, 1e-4}}};
  for (const auto& [scheme, numbers] : cases) {
    const auto& [order, minimum] = numbers;
    std::vector<Real> n;
    for (const Real tolerance : {4 * minimum, minimum})
      n.push_back(
          static_cast<Real>(go(chosen("verification/terzaghi_2d.xml", tolerance, {"Time.scheme=" + scheme})).size()));
    EXPECT_NEAR(std::log(n[1] / n[0]) / std::log(4), 1.0 / order, 0.15) << scheme << ": " << n[0] << ", " << n[1];
  }
}

/// Loads are tables with knots at irregular times. Steps end exactly at knots and scheduled times.
TEST(ChosenSteps, EndAtKnotsAndAtTimesOfASchedule) {
  auto scene = chosen("verification/turning_shear_3d.xml", 0.05);
  scene.time.schedule = {0.37, 2};
  std::vector<Real> ends;
  for (const auto& step : go(scene)) {
    ends.push_back(step.end);
    EXPECT_EQ(step.report.time, step.end);
    EXPECT_EQ(step.at_time, step.end == 0.37 || step.end == 2);
  }
  for (const Real t : {0.37, 1.0, 2.0}) EXPECT_EQ(std::count(ends.begin(), ends.end(), t), 1) << t;
}

/// Sinusoidal load without a table: the error control limits the step length.
TEST(ChosenSteps, SeeLoadsThatTurnWithinAStep) {
  auto scene = chosen("verification/cyclic_2d.xml", 1e-2);
  const Real end = scene.time.times().back();
  for (auto& [name, condition] : scene.boundary_conditions)
    for (auto& component : condition.displacement)
      if (!component.constant_in_time()) {
        component = base::Expression("0.3*sin(12*t/" + std::to_string(end) + ")");
        component.compile();
      }
  Real longest = 0;
  for (const auto& step : go(scene)) longest = std::max(longest, step.end - step.begin);
  EXPECT_LT(longest * 12 / end, std::sqrt(8 * 1.3e-2 / 0.3));  // (omega dt)^2/8 relative to the amplitude
  EXPECT_GT(longest * 12 / end, 0.05);
}

/// Rejected steps have no effect: the accepted steps, repeated with a schedule, give the same states.
TEST(ChosenSteps, RejectWithoutATrace) {
  auto scene = chosen("verification/turning_shear_3d.xml", 0.02);
  int n_rejected = 0;
  std::vector<Real> ends, slip;
  go(scene, [&](auto& model, const auto& step) {
    n_rejected += step.n_rejected;
    ends.push_back(step.end);
    slip.push_back(mean(model, Outputs(model)["plastic jump local"], 1));
  });
  EXPECT_GT(n_rejected, 0);
  scene.time.tolerance.reset();
  scene.time.schedule = ends;
  std::size_t k = 0;
  go(scene,
     [&](auto& model, auto&) { EXPECT_NEAR(mean(model, Outputs(model)["plastic jump local"], 1), slip[k++], 1e-9); });
}

/// State at the end of a run, after injection.
struct AfterShutIn {
  std::vector<Real> slip, pressure;  ///< [owned face], [owned cell]
  Real stored = 0, injected = 0;     ///< volumes
  std::vector<model::StepTaken> steps;
};

AfterShutIn shut_in(const model::Scene& scene) {
  AfterShutIn after;
  after.steps = go(scene, [&](auto& model, const auto& step) {
    for (const auto& total : model.system().totals(model.state()))
      if (total.names.back() == "rate") after.injected += total.value * (step.end - step.begin);
    if (step.end < scene.time.times().back()) return;
    const Outputs out(model);
    const auto& mesh = model.mesh();
    const auto volumes = assembly::cell_volumes(mesh);
    for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) after.slip.push_back(out.scalar("slip", f));
    for (LocalIndex cell = 0; cell < mesh.n_owned_cells; ++cell) {
      after.pressure.push_back(out.scalar("pressure", cell) - 10e6);
      after.stored += volumes[cell] * 1e-11 * after.pressure.back();
    }
    after.stored = base::sum_over_ranks(*mesh.comm, after.stored);
  });
  return after;
}

/// Returns the root mean square of a - b, relative to the largest value of b. Collective.
Real difference(const std::vector<Real>& a, const std::vector<Real>& b) {
  const auto comm = Tpetra::getDefaultComm();
  Real square = 0, largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    square += (a[i] - b[i]) * (a[i] - b[i]);
    largest = std::max(largest, std::abs(b[i]));
  }
  const auto n = base::sum_over_ranks(*comm, static_cast<Real>(a.size()));
  return std::sqrt(base::sum_over_ranks(*comm, square) / n) / base::max_over_ranks(*comm, largest);
}

/// The box has no outflow and constant volume, and the Biot coefficient is 1. Pores store the injected volume by their
/// compressibility, because fluid in joints replaces rock volume. Slip begins at a threshold pressure and depends on
/// the pressure change above it. Its relative error is therefore up to three times larger.
TEST(ChosenSteps, ConserveFluidAndMeetSlipAfterShutIn) {
  auto scene = read_scene("poro/shut_in_2d.xml", {"Time.tolerance=0.03"});
  scene.solver.tolerance = 1e-12;
  const auto chosen = shut_in(scene);
  EXPECT_NEAR(chosen.stored, chosen.injected, 1e-10 * chosen.injected);
  const Real tolerance = *scene.time.tolerance;
  scene.time.tolerance.reset();
  std::vector<Real> ends;
  for (const auto& step : chosen.steps)
    for (int k = 1; k <= 10; ++k) ends.push_back(k == 10 ? step.end : step.begin + (step.end - step.begin) * k / 10);
  scene.time.schedule = ends;
  const auto fine = shut_in(scene);
  EXPECT_NEAR(fine.stored, fine.injected, 1e-10 * fine.injected);
  EXPECT_LE(difference(chosen.pressure, fine.pressure), tolerance);
  EXPECT_LE(difference(chosen.slip, fine.slip), 3 * tolerance);
  EXPECT_GT(difference(std::vector<Real>(fine.slip.size(), 0), fine.slip), 0.1);
}

}  // namespace
}  // namespace sprekk::tests
