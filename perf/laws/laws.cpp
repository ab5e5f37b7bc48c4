// laws SCENE [PATH=VALUE...]: prints the cost of a step of a 3D point at the beginning and the end of its path as
// JSON, in CPU seconds and law evaluations per step. A turn of the path has 64 steps. Early and late turns
// alternate, so that both run under the same machine load. Each early path begins with another turn, because the
// branch predictor learns repeated paths.
#include "laboratory/point_driver.hpp"

#include <Tpetra_Core.hpp>
#include <nlohmann/json.hpp>

#include <ctime>
#include <iostream>

namespace {

using namespace sprekk;
using nlohmann::json;

constexpr int unmeasured = 10, turn = 64, rounds = 400;

/// Cost per step, one value per turn.
struct Cost {
  std::vector<Real> seconds, evaluations;

  json medians() const { return {{"seconds", median(seconds)}, {"evaluations", median(evaluations)}}; }
  static Real median(std::vector<Real> values) {
    std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
    return values[values.size() / 2];
  }
};

/// Point that advances along its path step by step.
class Way {
 public:
  Way(const laboratory::PointScene& scene, const laboratory::PointPath& path, long begin)
      : driver_(path, scene.materials.at(path.material)),
        step_(scene.time.end / scene.time.steps.value_or(1)),
        done_(begin) {}
  void go(int steps) {
    for (int k = 0; k < steps; ++k, ++done_) driver_.advance(done_ * step_, (done_ + 1) * step_);
  }
  void go_a_turn(Cost& cost) {
    const auto evaluations = driver_.evaluations();
    const auto begin = std::clock();
    go(turn);
    cost.seconds.push_back(static_cast<Real>(std::clock() - begin) / CLOCKS_PER_SEC / turn);
    cost.evaluations.push_back(static_cast<Real>(driver_.evaluations() - evaluations) / turn);
  }

 private:
  laboratory::PointDriver<3> driver_;
  Real step_;
  long done_;
};

json measure(const laboratory::PointScene& scene) {
  const auto& path = *scene.paths().at(0).second;
  Cost of_first, of_second, of_late;
  Way late(scene, path, 0);
  late.go(scene.time.steps.value_or(1));
  for (int round = 0; round < rounds; ++round) {
    Way early(scene, path, round * turn);
    early.go(unmeasured);
    early.go_a_turn(of_first);
    early.go_a_turn(of_second);
    late.go_a_turn(of_late);
  }
  return {{"first", of_first.medians()}, {"second", of_second.medians()}, {"late", of_late.medians()}};
}

}  // namespace

int main(int argc, char** argv) {
  Tpetra::ScopeGuard guard(&argc, &argv);
  try {
    SPREKK_CHECK(argc > 1, "usage: laws SCENE [PATH=VALUE...]");
    const auto scene = laboratory::read_point_scene(*Tpetra::getDefaultComm(), argv[1], {argv + 2, argv + argc});
    std::cout << measure(scene).dump(2) << '\n';
  } catch (const Error& error) {
    std::cerr << "laws: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
