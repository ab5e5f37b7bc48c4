// laws SCENE [PATH=VALUE...]: what a step of a point in 3D costs at the beginning of its path and at the end, in
// seconds of the processor, and how often it evaluates the law, as JSON. A time step is a 64th of a turn of the path.
// Early and late turns alternate, so that both see the same machine, and each early way begins with another turn of the
// path, for a way that is gone again and again is foreseen by the processor.
#include "model/point_driver.hpp"

#include <Tpetra_Core.hpp>
#include <nlohmann/json.hpp>

#include <ctime>
#include <iostream>

namespace {

using namespace sprekk;
using nlohmann::json;

constexpr int unmeasured = 10, turn = 64, rounds = 400;

/// Of the steps of a turn, one value a turn.
struct Cost {
  std::vector<Real> seconds, evaluations;

  json medians() const { return {{"seconds", median(seconds)}, {"evaluations", median(evaluations)}}; }
  static Real median(std::vector<Real> values) {
    std::nth_element(values.begin(), values.begin() + values.size() / 2, values.end());
    return values[values.size() / 2];
  }
};

/// A point on its way, step by step.
class Way {
 public:
  Way(const model::PointScene& scene, const model::PointPath& path, long begin)
      : driver_(path, scene.materials.at(path.material)), step_(scene.time.end / scene.time.steps.value_or(1)), done_(begin) {}
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
  model::PointDriver<3> driver_;
  Real step_;
  long done_;
};

json measure(const model::PointScene& scene) {
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
    const auto scene = model::read_point_scene(*Tpetra::getDefaultComm(), argv[1], {argv + 2, argv + argc});
    std::cout << measure(scene).dump(2) << '\n';
  } catch (const Error& error) {
    std::cerr << "laws: " << error.what() << '\n';
    return 1;
  }
  return 0;
}
