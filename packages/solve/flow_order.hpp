// Order of unknowns along a flow, and the rows of a matrix on one rank.
#pragma once

#include <vector>

#include "fields/types.hpp"

namespace sprekk::solve {

/// Square sparse matrix of the owned unknowns of a rank. The columns of a row ascend and contain the diagonal.
struct LocalRows {
  std::vector<std::size_t> start;  ///< [row + 1]
  std::vector<LocalIndex> column;
  std::vector<Real> value;

  LocalIndex n() const { return static_cast<LocalIndex>(start.size()) - 1; }
  /// Returns the position of a column in a row, or the end of the row.
  std::size_t find(LocalIndex row, LocalIndex column) const;
  /// Returns the value in a row and column, 0 if the graph does not contain it.
  Real at(LocalIndex row, LocalIndex column) const;
};

/// Returns an order of the rows along a flow. Row i takes from j if
///   |a_ij| > 2 |a_ji|   and   |a_ij| > 1e-3 sqrt(|a_ii a_jj|).
/// Rows precede those from which they take: strong components of this graph (Tarjan 1972) in topological order,
/// downstream first. Rows of a component keep their order. [position] a permutation of the rows
std::vector<LocalIndex> flow_order(const LocalRows& A);

}  // namespace sprekk::solve
