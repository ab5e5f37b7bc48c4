// A product of three matrices without all of the product of two of them.
#pragma once

#include <vector>

#include "multigrid/node_matrix.hpp"

namespace sprekk::multigrid {

/// R (A P) in slices: for a run of rows of R the rows of A P that these name are made in one of two parts of a buffer,
/// by turns; those that are still in the other part are not made again. Slices are as thin as that repeats little.
/// Rows that other ranks name, and those of ghosts, are at the front of the buffer and stay there.
struct Slices {
  std::vector<LocalIndex> first;        ///< [slice + 1] of its rows of R
  std::vector<std::size_t> first_made;  ///< [1 + slice + 1] in `made`: first come the rows that stay
  View<LocalIndex*> made;               ///< owned rows of A P, in the order in which they are made
  View<std::size_t*> to;                ///< [made] where in the buffer the row begins, in entries
  View<std::size_t*> start_kept;        ///< [all rows + 1] in the buffer, of rows that stay; all others are empty
  View<std::size_t*> at;  ///< [all rows] where a row begins at present: kept rows always, others once made
  std::size_t size = 0;   ///< of the buffer, in entries

  int n() const { return static_cast<int>(first.size()) - 1; }
  std::size_t bytes() const;
};

/// `start` [all rows + 1] tells how many entries the rows of A P have, ghosts' included. The columns of R are these
/// rows. Stored data.
Slices make_slices(const NodeGraph& R, const View<std::size_t*>& start);

}  // namespace sprekk::multigrid
