// Complete runs of a scene, and the difference between the unknowns of two runs.
#pragma once

#include "verification/scenes.hpp"

namespace sprekk::tests {

/// Steps of a scene up to the first failure: iterations, and unknowns after each step.
struct Run {
  std::string failure;
  std::vector<int> newton_iterations, cuts;
  std::vector<bool> floating;  ///< whether a floating block was reported
  std::vector<fields::BlockVector> states;
  std::vector<std::string> names;  ///< [block]
  std::vector<Real> scales;        ///< [block] kinematic scales at the end
};

inline Run run(const model::Scene& scene) {
  model::Model model(scene, Tpetra::getDefaultComm());
  Run result;
  for (const Real t : scene.time.times()) {
    const auto report = model.step_to(t);
    result.newton_iterations.push_back(report.newton_iterations);
    result.cuts.push_back(report.cuts);
    result.floating.push_back(!report.floating.empty());
    result.failure = report.reason;
    if (!report.converged) break;
    result.failure.clear();
    result.states.push_back(fields::create_like(model.state()));
    fields::copy(model.state(), result.states.back());
  }
  for (const auto& block : model.system().blocks()) {
    result.names.push_back(block.name);
    result.scales.push_back(block.kinematic_scale);
  }
  return result;
}

/// Returns the largest difference of an unknown after a step, relative to the scales of b. Collective.
inline Real distance(const Run& a, const Run& b, std::size_t step) {
  Real largest = 0;
  for (std::size_t k = 0; k < b.scales.size(); ++k) {
    fields::Vector difference(*a.states[step][k], Teuchos::Copy);
    difference.update(-1, *b.states[step][k], 1);
    largest = std::max<Real>(largest, difference.normInf() / b.scales[k]);
  }
  return largest;
}

inline Real distance(const Run& a, const Run& b) {
  Real largest = 0;
  for (std::size_t step = 0; step < b.states.size(); ++step) largest = std::max(largest, distance(a, b, step));
  return largest;
}

}  // namespace sprekk::tests
