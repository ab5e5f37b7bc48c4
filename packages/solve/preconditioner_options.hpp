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

/// Options of Sprekk's multigrid. Absent values depend on the field.
struct MultigridOptions {
  std::optional<int> degree, coarsest;  ///< Options::degree, Options::coarse_size
  int minimum_per_rank = multigrid::Options().minimum_per_rank;

  /// For fields on nodes or cells, in the dimension `dim`. In 2D, large levels below the finest are solved directly:
  /// factors of 2D matrices are small, and aggregates that do not cross fractures would become worse from level to
  /// level.
  multigrid::Options of_nodes(int dim) const;
  /// For the corners of a scalar field on facets, in the dimension `dim`. The coarsest level is larger, because
  /// aggregates represent constants in single fractures less well, and factors of matrices with one unknown per node
  /// are small. Higher degrees, and in 2D aggregates along strong couplings, serve anisotropic coefficients. In 3D such
  /// aggregates would be small, and the coarse levels large. The diagonal of the last level is raised less, because
  /// coefficients may differ by a factor of 1e10.
  multigrid::Options of_corners(int dim) const;
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
