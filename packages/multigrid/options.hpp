// Options of multigrid.
#pragma once

#include <algorithm>
#include <cstddef>

namespace sprekk::multigrid {

struct Options {
  int degree = 4;         ///< Chebyshev degree, at least 1; higher for flat cells in contact
  int finest_degree = 0;  ///< smallest degree on the finest level
  int coarse_size = 300;  ///< levels with at most this number of unknowns are solved directly
  int below_finest = 0;   ///< the same below the finest level, if larger than coarse_size
  /// Scalar matrices: smallest strong coupling of a node on the finest level, relative to its strongest one, see
  /// weak_couplings(). It is halved from level to level.
  double strong = 0;
  double raise = 1e-8;            ///< relative increase of the last diagonal: the matrix is singular for floating parts
  int minimum_per_rank = 100000;  ///< matrix entries per rank; with fewer, a level moves to fewer ranks

  /// Returns the number of unknowns up to which a level is solved directly; 0 is the finest level.
  int direct_limit(std::size_t level) const { return level == 0 ? coarse_size : std::max(coarse_size, below_finest); }
};

}  // namespace sprekk::multigrid
