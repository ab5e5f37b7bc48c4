#include "assembly/scaling.hpp"

#include "base/check.hpp"
#include "base/over_ranks.hpp"

#include <algorithm>

namespace sprekk::assembly {

Scaling::Scaling(const Structure& structure) {
  for (const auto& module : structure.modules) {
    const auto& declaration = module.declaration;
    for (const auto& [name, minimum] : declaration.scales) scales_[name] = std::max(scales_[name], minimum);
    relations_.insert(relations_.end(), declaration.relations.begin(), declaration.relations.end());
  }
  const auto check = [&](const std::string& name) {
    SPREKK_CHECK(scales_.count(name), "no module declares the scale \"{}\"", name);
  };
  for (const auto& relation : relations_) {
    check(relation.larger);
    check(relation.than);
  }
  for (const auto& unknown : structure.unknowns) {
    check(unknown.scale);
    if (!unknown.augmented_by.empty()) check(unknown.augmented_by);
    for (const auto& term : unknown.row) check(term.scale);
  }
}

void Scaling::update(Structure& structure, Real t, Real dt) {
  Scales loads = scales_;
  base::collectively(structure.comm(), [&] {
    for (int b = 0; b < structure.n_blocks(); ++b) {
      structure.constraints[b].evaluate(t);
      Real& largest = loads.at(structure.unknowns[b].scale);
      largest = std::max(largest, structure.constraints[b].largest());
    }
    for (const auto& module : structure.modules) {
      if (!module.loads) continue;
      for (const auto& [name, size] : module.loads->loads(t)) {
        SPREKK_CHECK(loads.count(name), "{}: no module declares the scale \"{}\"", module->name(), name);
        loads.at(name) = std::max(loads.at(name), size);
      }
    }
  });
  for (auto& [name, scale] : scales_) scale = base::max_over_ranks(structure.comm(), loads.at(name));
  apply_relations();
  for (int b = 0; b < structure.n_blocks(); ++b) {
    const auto& unknown = structure.unknowns[b];
    auto& block = structure.blocks[b];
    block.kinematic_scale = scales_.at(unknown.scale);
    block.residual_scale = 0;
    for (const auto& term : unknown.row)
      if (!term.per_step || dt > 0)
        block.residual_scale += term.factor * scales_.at(term.scale) / (term.per_step ? dt : 1);
  }
}

/// Increases the scales by their relations. A chain of relations is no longer than the number of scales. Cyclic
/// relations reproduce a scale up to round-off, which must not increase it.
void Scaling::apply_relations() {
  constexpr Real rounding = 1e-14;
  for (std::size_t pass = 0; pass < scales_.size(); ++pass)
    for (const auto& [larger, factor, than] : relations_)
      if (const Real minimum = factor * scales_.at(than); minimum > (1 + rounding) * scales_.at(larger))
        scales_.at(larger) = minimum;
}

void Scaling::restore(const Scales& saved) {
  for (auto& [name, scale] : scales_) {
    const auto found = saved.find(name);
    SPREKK_CHECK(found != saved.end(), "the scale \"{}\" is missing in the stored state", name);
    scale = found->second;
  }
}

}  // namespace sprekk::assembly
