// Section Stages of a scene: changes at given times.
#pragma once

#include "base/parameters.hpp"
#include "base/types.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::model {

/// Stage of a scene from a given time on: the previous scene with entries added or replaced.
struct Stage {
  Real time = 0;
  std::vector<std::string> without;   ///< removed sections, "Boundary conditions > pull"
  std::vector<std::string> excavate;  ///< regions to be excavated
  std::vector<std::string> backfill;  ///< regions to be filled again
  std::optional<Real> release;        ///< duration of the release of unbalanced forces, s; absent: immediate
  Teuchos::ParameterList changes;     ///< sections as in the scene
  void describe(base::Section& section);
};

using Stages = std::map<std::string, Stage>;

/// Reports stages that do not begin after `start`, or begin at equal times; for a section already read.
void check_stages(base::Section& section, const Stages& stages, Real start);

}  // namespace sprekk::model
