// Product of three matrices without storage of the whole product of two of them.
#pragma once

#include <vector>

#include "multigrid/node_matrix.hpp"

namespace sprekk::multigrid {

/// Plan of R (A P) in slices. A slice is a range of rows of R. The rows of A P that it needs are computed in one of two
/// parts of a buffer, in turn. Rows that are still in the other part are not computed again. Slices are as thin as
/// possible with few repetitions. Rows needed by other ranks, and rows of ghosts, stay at the front of the buffer.
struct Slices {
  std::vector<LocalIndex> first;        ///< [slice + 1] first row of R
  std::vector<std::size_t> first_made;  ///< [1 + slice + 1] first entry of `made`; the rows that stay come first
  View<LocalIndex*> made;               ///< owned rows of A P in the order of their computation
  View<std::size_t*> to;                ///< [made] start of the row in the buffer, in entries
  View<std::size_t*> start_saved;       ///< [all rows + 1] start of rows that stay in the buffer; others are empty
  View<std::size_t*> at;  ///< [all rows] present start of a row: always for rows that stay, others once computed
  std::size_t size = 0;   ///< size of the buffer in entries

  int n() const { return static_cast<int>(first.size()) - 1; }
  std::size_t bytes() const;
};

/// Returns the plan. start: [all rows + 1] of the entries of rows of A P, including ghosts. The columns of R are these
/// rows. Stored data.
Slices make_slices(const NodeGraph& R, const View<std::size_t*>& start);

}  // namespace sprekk::multigrid
