// Options of preconditioners, as entries of scenes.
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
  std::optional<int> coarsest;  ///< replaces coarse_size; absent: 300, or 4000 for fields on facets

  void describe(base::Section& section);
};

/// Options of one block, or of the group that begins with it. The lists are passed to the libraries unchanged, on top
/// of the defaults.
struct BlockOptions {
  std::string type = "auto";  ///< auto | multigrid | MueLu | Ifpack2 | Gauss-Seidel | ILU | direct
  std::string with;           ///< block whose group includes this block; empty: as declared by the fields
  std::optional<MultigridOptions> multigrid;  ///< of Sprekk's multigrid; absent: the defaults
  Teuchos::ParameterList muelu{"MueLu"}, ifpack2{"Ifpack2"};

  void describe(base::Section& section);
};

/// Options of the sweep over groups with approximate inverses B_f. x is the residual.
struct SweepOptions {
  /// diagonal: y_f = B_f x_f;  forward: y_f = B_f (x - A (y_1 + ... + y_(f-1)))_f;  symmetric: forward, then backward
  /// on the remaining residual.
  std::string type = "forward";
  std::vector<std::string> order;  ///< first blocks of all groups; empty: in the order of the fields

  void describe(base::Section& section);
};

struct PreconditionerOptions {
  std::map<std::string, BlockOptions> blocks;  ///< by name
  SweepOptions sweep;

  /// Returns the options of a block, or the defaults.
  const BlockOptions& of(const std::string& block) const;
};

}  // namespace sprekk::solve
