// Scales of an equation system: typical sizes of unknowns and rows under the loads so far.
#pragma once

#include "assembly/structure.hpp"

#include <string>
#include <vector>

namespace sprekk::assembly {

class Scaling {
 public:
  /// Collects the scales of the modules. Throws an Error for names that no module declares.
  explicit Scaling(const Structure& structure);

  /// Evaluates constraints and loads at time t, increases the scales accordingly, and sets the scales of the blocks for
  /// a step of length dt; 0: no step. Collective.
  void update(Structure& structure, Real t, Real dt);
  const Scales& values() const { return scales_; }
  Real of(const std::string& name) const { return scales_.at(name); }
  /// Restores scales. Throws an Error if one is missing.
  void restore(const Scales& saved);

 private:
  void apply_relations();

  Scales scales_;
  std::vector<ScaleRelation> relations_;
};

}  // namespace sprekk::assembly
