// Options of multigrid.
#pragma once

namespace sprekk::multigrid {

struct Options {
  int degree = 4;         ///< Chebyshev degree, at least 1; higher for flat cells in contact
  int finest_degree = 0;  ///< smallest degree on the finest level
  int coarse_size = 300;  ///< levels with at most this number of unknowns are solved directly
  /// Scalar matrices: smallest strong coupling of a node on the finest level, relative to its strongest one, see
  /// weak_couplings(). It is halved from level to level.
  double strong = 0;
  double raise = 1e-8;            ///< relative increase of the last diagonal: the matrix is singular for floating parts
  int minimum_per_rank = 100000;  ///< matrix entries per rank; with fewer, a level moves to fewer ranks
};

}  // namespace sprekk::multigrid
