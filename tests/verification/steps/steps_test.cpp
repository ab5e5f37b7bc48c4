// Time steps that choose themselves, of whole scenes.
#include "base/over_ranks.hpp"
#include "model/steps.hpp"
#include "verification/scenes.hpp"

#include <map>

namespace sprekk::tests {
namespace {

/// A scene whose steps are chosen.
model::Scene chosen(const std::string& name, Real tolerance, const std::vector<std::string>& overrides = {}) {
  auto scene = read_scene(name, overrides);
  scene.time.steps.reset();
  scene.time.tolerance = tolerance;
  return scene;
}

/// All steps of a scene that are kept; `visit` sees the model after each.
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

/// Errors are held at the tolerance: n steps of an error of order p cost n ~ tolerance^(-1/p).
TEST(ChosenSteps, GrowInNumberAsTheirOrderSays) {
  for (const auto& [scheme, order] : std::vector<std::pair<std::string, Real>>{{"implicit Euler", 1}, {"BDF2", 2}}) {
    std::vector<Real> n;
    for (const Real tolerance : {4e-4, 1e-4})
      n.push_back(static_cast<Real>(
          go(chosen("verification/terzaghi_2d.xml", tolerance, {"Time.scheme=" + scheme})).size()));
    EXPECT_NEAR(std::log(n[1] / n[0]) / std::log(4), 1 / order, 0.15) << scheme << ": " << n[0] << ", " << n[1];
  }
}

/// The path of fifty steps, whose loads are tables with corners at uneven times: they are met to any bit.
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

/// Without a table nothing names the corners of a triangular wave; steps become short there.
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
  EXPECT_LT(longest * 12 / end, std::sqrt(8 * 1.3e-2 / 0.3));  // (omega dt)^2/8 of the amplitude
  EXPECT_GT(longest * 12 / end, 0.05);
}

/// What is rejected leaves no trace: the steps that were kept, taken again one by one, give the same state.
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
  go(scene, [&](auto& model, auto&) {
    EXPECT_NEAR(mean(model, Outputs(model)["plastic jump local"], 1), slip[k++], 1e-9);
  });
}

/// Slip of the joints after injection has ended, [fracture], and the volume that pores have taken up.
struct AfterShutIn {
  std::vector<Real> slip;
  Real stored = 0, injected = 0;
  std::vector<model::StepTaken> steps;
};

AfterShutIn shut_in(const model::Scene& scene) {
  AfterShutIn after;
  Real begin = 0;
  after.steps = go(scene, [&](auto& model, const auto& step) {
    for (const auto& total : model.system().totals(model.state()))
      if (total.names.back() == "rate") after.injected += total.value * (step.end - begin);
    begin = step.end;
    if (step.end < scene.time.times().back()) return;
    const Outputs out(model);
    const auto& mesh = model.mesh();
    after.slip.assign(mesh.fracture_names.size(), 0);
    for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f)
      after.slip[mesh.fracture_faces[f].fracture] += mesh.fracture_faces[f].area * out.scalar("slip", f);
    for (LocalIndex cell = 0; cell < mesh.n_owned_cells; ++cell)
      after.stored += assembly::cell_volumes(mesh)[cell] * 1e-11 * (out.scalar("pressure", cell) - 10e6);
    after.slip = base::sum_over_ranks(*mesh.comm, after.slip);
    after.stored = base::sum_over_ranks(*mesh.comm, after.stored);
  });
  return after;
}

/// Nothing leaves the box, whose volume stays, and alpha is 1: the rock's pores have all fluid, but for what joints
/// hold, which they took from the rock.
TEST(ChosenSteps, ConserveFluidAndMeetSlipAfterShutIn) {
  auto scene = read_scene("poro/shut_in_2d.xml");
  scene.solver.tolerance = 1e-12;
  const auto chosen = shut_in(scene);
  EXPECT_NEAR(chosen.stored, chosen.injected, 1e-10 * chosen.injected);
  const Real tolerance = *scene.time.tolerance;
  scene.time.tolerance.reset();
  std::vector<Real> ends;
  Real begin = 0;
  for (const auto& step : chosen.steps) {
    for (int k = 1; k < 10; ++k) ends.push_back(begin + (step.end - begin) * k / 10);
    ends.push_back(begin = step.end);
  }
  scene.time.schedule = ends;
  const auto fine = shut_in(scene);
  EXPECT_NEAR(fine.stored, fine.injected, 1e-10 * fine.injected);
  const Real largest = *std::max_element(fine.slip.begin(), fine.slip.end());
  EXPECT_GT(largest, 0);
  for (std::size_t k = 0; k < fine.slip.size(); ++k) EXPECT_NEAR(chosen.slip[k], fine.slip[k], tolerance * largest);
}

}  // namespace
}  // namespace sprekk::tests
