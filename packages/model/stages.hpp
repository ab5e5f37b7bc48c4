// Changes of a scene at given times: its section Stages.
#pragma once

#include "base/parameters.hpp"
#include "base/types.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::model {

/// What a scene is from a time on: the scene before, with entries added or in place of others.
struct Stage {
  Real time = 0;
  std::vector<std::string> without;   ///< sections that end, "Boundary conditions > pull"
  std::vector<std::string> excavate;  ///< regions whose cells are taken away
  std::vector<std::string> backfill;  ///< regions whose cells are put back
  std::optional<Real> release;        ///< how long what is out of balance at first takes to act, s; absent: it acts at
                                      ///< once
  Teuchos::ParameterList changes;     ///< sections as they stand in the scene
  void describe(base::Section& section);
};

using Stages = std::map<std::string, Stage>;

/// Reports stages that do not begin after `start`, or begin at once; in a section that has been read.
void check_stages(base::Section& section, const Stages& stages, Real start);

}  // namespace sprekk::model
