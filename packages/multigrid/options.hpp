// What can be chosen of multigrid.
#pragma once

namespace sprekk::multigrid {

struct Options {
  int degree = 4;                ///< of Chebyshev's polynomial, at least 1; flat cells in contact take a higher one
  int finest_degree = 0;         ///< at least, on the finest level
  int coarse_size = 300;         ///< no further level below so many unknowns: a direct solve
  int least_of_a_rank = 100000;  ///< numbers of a level's matrix: where ranks have fewer, it moves to fewer ranks
};

}  // namespace sprekk::multigrid
