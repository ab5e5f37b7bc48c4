// How blocks are preconditioned, as a scene says it.
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "multigrid/options.hpp"

namespace sprekk::base {
class Section;
}

namespace sprekk::solve {

struct MultigridOptions : multigrid::Options {
  void describe(base::Section& section);
};

/// Of one block, or of the group that begins with it. The lists are handed to the libraries untouched, over the
/// defaults.
struct BlockOptions {
  std::string type = "auto";  ///< auto | multigrid | MueLu | Ifpack2 | Gauss-Seidel | direct
  std::string with;           ///< the block of whose group this one is a part; empty: as the fields ask for
  std::optional<MultigridOptions> multigrid;  ///< of Sprekk's own; absent: the defaults
  Teuchos::ParameterList muelu{"MueLu"}, ifpack2{"Ifpack2"};

  void describe(base::Section& section);
};

/// How the groups of blocks are gone through, with their approximate inverses B_f and x the residual.
struct SweepOptions {
  /// diagonal: y_f = B_f x_f;  forward: y_f = B_f (x - A (y_1 + ... + y_(f-1)))_f;  symmetric: forward, then the same
  /// backward for what is left of x.
  std::string type = "forward";
  std::vector<std::string> order;  ///< the first blocks of all groups; empty: as the fields come

  void describe(base::Section& section);
};

struct PreconditionerOptions {
  std::map<std::string, BlockOptions> blocks;  ///< by their names
  SweepOptions sweep;

  /// What is said of a block, or of no block.
  const BlockOptions& of(const std::string& block) const;
};

}  // namespace sprekk::solve
