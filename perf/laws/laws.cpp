// laws SCENE [PATH=VALUE...]: what a step costs at the beginning of a run and after its end, in seconds of the
// processor, and the Newton iterations of these steps, as JSON. The step is 1; the scene's end says how many there are
// before the late ones. Early and late steps take turns, so that both see the same machine.
#include "model/model.hpp"
#include "perf/program.hpp"

#include <algorithm>
#include <ctime>

namespace {

using namespace sprekk;
using perf::json;

constexpr int unmeasured = 5, early_steps = 10, rounds = 20;

/// What the steps after `begin` cost; appends to both.
void measure_steps(model::Model& model, int begin, std::vector<Real>& seconds, std::vector<Real>& iterations) {
  for (int k = 1; k <= early_steps; ++k) {
    const auto before = std::clock();
    const auto report = model.step_to(begin + k);
    seconds.push_back(static_cast<Real>(std::clock() - before) / CLOCKS_PER_SEC);
    iterations.push_back(report.newton_iterations);
    SPREKK_CHECK(report.converged, "step {}: {}", begin + k, report.reason);
  }
}

Real median(std::vector<Real> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
  return values[values.size() / 2];
}
Real mean(const std::vector<Real>& values) {
  Real sum = 0;
  for (const Real value : values) sum += value;
  return sum / static_cast<Real>(values.size());
}

json measure(const model::Scene& scene, RCP<const Comm> comm) {
  std::vector<Real> seconds[2], iterations[2];  // of early and late steps
  model::Model late(scene, comm);
  int step = static_cast<int>(scene.time.end);
  for (int k = 1; k <= step; ++k) {
    const auto report = late.step_to(k);
    SPREKK_CHECK(report.converged, "step {}: {}", k, report.reason);
  }
  for (int round = 0; round < rounds; ++round) {
    model::Model early(scene, comm);
    for (int k = 1; k <= unmeasured; ++k) early.step_to(k);
    measure_steps(early, unmeasured, seconds[0], iterations[0]);
    measure_steps(late, step, seconds[1], iterations[1]);
    step += early_steps;
  }
  json result;
  for (const int k : {0, 1})
    result[k == 0 ? "early" : "late"] = {{"seconds", median(seconds[k])}, {"newton_iterations", mean(iterations[k])}};
  return result;
}

}  // namespace

int main(int argc, char** argv) { return perf::run("laws", argc, argv, measure); }
