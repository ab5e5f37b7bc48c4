#include "model/factor_of_safety.hpp"

#include "base/check.hpp"
#include "model/model.hpp"
#include "model/steps.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sprekk::model {
namespace {

bool has_joint(const Material& material) { return material.type == "joint"; }

Scene reduced(const Scene& scene, Real factor) {
  Scene weaker = scene;
  for (auto& [name, material] : weaker.materials)
    if (has_joint(material)) material.strength_reduction *= factor;
  return weaker;
}

void check(const Model& model) {
  const auto& scene = model.scene();
  const bool any = std::any_of(scene.materials.begin(), scene.materials.end(),
                               [](const auto& material) { return has_joint(material.second); });
  SPREKK_CHECK(any && !model.mesh().fracture_names.empty(), "{}: has no joint whose strength could be reduced",
               scene.origin);
  SPREKK_CHECK(!model.system().has_rates(),
               "{}: stores something, and so has no equilibrium at a time: leave out what stores", scene.origin);
}

/// What moves, or why Newton's method failed.
std::string reason_of(const solve::StepReport& report) {
  if (report.converged) return report.loose;
  const std::string found = "no equilibrium found: ";
  const auto& text = report.reason;
  if (text.rfind(found, 0) != 0) return text;
  return text.substr(found.size(), text.find("; t = ") - found.size());
}

void run_to_the_end(Model& model) {
  Steps steps(model);
  while (steps.any()) {
    const auto taken = steps.take();
    SPREKK_CHECK(taken.report.converged, "{}: has no equilibrium with its own strength: {}", model.scene().origin,
                 taken.report.reason);
  }
}

}  // namespace

FactorOfSafety factor_of_safety(const SafetyOptions& options, RCP<const Comm> comm,
                                const std::function<void(const Reduction&)>& tell) {
  Model model(read_scene(*comm, options.scene, options.overrides), comm);
  check(model);
  run_to_the_end(model);
  const Scene own = model.scene();
  FactorOfSafety found{.least = 1, .lost = {}, .reductions = {}};
  const auto stands = [&](Real factor) {
    model.change(reduced(own, factor));
    const auto report = model.find_equilibrium();
    const bool held = report.converged && report.loose.empty();
    found.reductions.push_back({factor, held, report.newton_iterations, held ? "" : reason_of(report)});
    if (tell) tell(found.reductions.back());
    return held;
  };
  constexpr Real growth = 1.5;
  while (!found.lost && found.least < options.most)
    if (const Real next = std::min(growth * found.least, options.most); stands(next))
      found.least = next;
    else
      found.lost = next;
  while (found.lost && *found.lost > (1 + options.tolerance) * found.least) {
    const Real middle = (found.least + *found.lost) / 2;
    (stands(middle) ? found.least : *found.lost) = middle;
  }
  return found;
}

}  // namespace sprekk::model
