#include "model/factor_of_safety.hpp"

#include "base/check.hpp"
#include "base/text.hpp"
#include "model/fracture_table.hpp"
#include "model/model.hpp"
#include "model/steps.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace sprekk::model {
namespace {

constexpr const char* reduction = "strength reduction factor";

/// Sublist with the given name; empty if it does not exist.
Teuchos::ParameterList sublist_of(const Teuchos::ParameterList& list, const std::string& name) {
  return list.isSublist(name) ? list.sublist(name) : Teuchos::ParameterList();
}

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
  for (const auto& [name, stage] : scene.stages)
    for (const auto& named_entry : sublist_of(stage.changes, "Materials")) {
      const auto& material = named_entry.first;
      SPREKK_CHECK(!sublist_of(stage.changes.sublist("Materials"), material).isParameter(reduction),
                   "{}: Sprekk > Stages > {} > Materials > {} > \"{}\": is the result of the search; leave it out",
                   scene.origin, name, material, reduction);
    }
  SPREKK_CHECK(any && !model.mesh().fracture_names.empty(), "{}: has no joint whose strength could be reduced",
               scene.origin);
  std::vector<std::string> stores;
  physics::for_each_physics([&]<physics::HasRates P>(P) {
    if (P::Rates::exist(scene))
      for (const auto& section : P::Rates::sections()) stores.push_back(section);
  });
  SPREKK_CHECK(!model.system().evolves(),
               "{}: a law depends on the rate of its quantities, and so there is no equilibrium at a fixed time",
               scene.origin);
  SPREKK_CHECK(!model.system().has_rates(),
               "{}: its balances contain storage, and so it has no equilibrium at a fixed time: leave out {}",
               scene.origin, base::quoted_list(stores));
}

bool stands(const solve::StepReport& report) { return report.converged && report.floating.empty(); }

/// Floating blocks after convergence, or the reason of the failure.
std::string reason_of(const solve::StepReport& report) {
  if (report.converged) return report.floating;
  const std::string found = "no equilibrium found: ";
  const auto& text = report.reason;
  if (text.rfind(found, 0) != 0) return text;
  return text.substr(found.size(), text.find("; t = ") - found.size());
}

void run_to_the_end(Model& model, Real factor) {
  Steps steps(model);
  solve::StepReport last;
  while (steps.any()) {
    last = steps.take().report;
    if (!last.converged) break;
  }
  const auto strength = factor == 1 ? "its own strength" : fmt::format("its strength divided by {}", factor);
  SPREKK_CHECK(stands(last), "{}: found no equilibrium with {}; a smaller factor, --first {}, may have one: {}",
               model.scene().origin, strength, factor / 2, reason_of(last));
}

/// Tests a factor. Without an equilibrium, the model remains in its previous state.
Reduction reduce(Model& model, const Scene& own, Real factor) {
  try {
    model.change(reduced(own, factor));
  } catch (const Error& error) {  // the same on every rank: invalid joint properties
    return {factor, false, 0, error.what()};
  }
  const auto report = model.find_equilibrium();
  const bool stable = stands(report);
  if (report.converged && !stable) model.take_back();
  return {factor, stable, report.newton_iterations, stable ? "" : reason_of(report)};
}

}  // namespace

FactorOfSafety factor_of_safety(const SafetyOptions& options, RCP<const Comm> comm,
                                const std::function<void(const Reduction&)>& report) {
  Model model(reduced(read_scene(*comm, options.scene, options.overrides), options.first), comm);
  check(model);
  run_to_the_end(model, options.first);
  const Scene own = reduced(model.scene(), 1 / options.first);  // including the changes by stages
  FactorOfSafety found{.stable = options.first, .lost = {}, .reductions = {}, .states = {}};
  const auto in_equilibrium = [&](Real factor) {
    found.reductions.push_back(reduce(model, own, factor));
    if (report) report(found.reductions.back());
    return found.reductions.back().stands;
  };
  constexpr Real growth = 1.5;
  while (!found.lost && found.stable < options.maximum)
    if (const Real next = std::min(growth * found.stable, options.maximum); in_equilibrium(next))
      found.stable = next;
    else
      found.lost = next;
  while (found.lost && *found.lost > (1 + options.tolerance) * found.stable) {
    const Real middle = (found.stable + *found.lost) / 2;
    (in_equilibrium(middle) ? found.stable : *found.lost) = middle;
  }
  model.change(reduced(own, found.stable));
  const auto outputs = model.system().outputs(model.state());
  found.states = digest(described_singles(model.mesh()), fracture_table(model.mesh(), outputs, Grouping::singles));
  return found;
}

}  // namespace sprekk::model
