// Level of multigrid on fewer ranks than the level above.
#pragma once

#include <vector>

#include "multigrid/aggregates.hpp"

namespace sprekk::multigrid {

/// Transfer of nodes from runs of consecutive ranks to the first rank of each run. This rank then has enough work
/// compared with its messages, and aggregates can join nodes of several ranks. Mesh parts come from recursive
/// bisection, so consecutive ranks are usually adjacent in space. Ranks without nodes take no part in the level. Nodes
/// keep their numbers, which increase with the ranks.
class FewerRanks {
 public:
  /// Creates the graphs of A on about n_ranks ranks, and of the prolongator P from these nodes, and moves `nodes`.
  /// Collective.
  FewerRanks(const NodeMatrix& A, const ShortNodeMatrix& P, Nodes& nodes, int n_ranks);

  void update(const NodeMatrix& A);  ///< copies the values; collective

  const NodeMatrix& matrix() const { return matrix_; }        ///< A on the present ranks
  const ShortNodeMatrix& prolongation() const { return P_; }  ///< P with its values, with these columns
  const NodeGraph& gathered() const { return gathered_; }     ///< nodes before the transfer; ghosts: received nodes
  std::size_t bytes() const { return sizeof(LocalIndex) * (place_.size() + P_.graph.column.extent(0)); }

 private:
  void move(Nodes& nodes) const;

  NodeGraph gathered_;             // rows: those of A, including received ones
  bool takes_ = false;             // this rank has nodes after the transfer
  std::vector<LocalIndex> place_;  // [entry of matrix_] position in the received row
  NodeMatrix matrix_;
  ShortNodeMatrix P_;
};

/// Returns the number of ranks with nodes. Collective.
int n_ranks_of(const NodeGraph& graph);

/// Returns A, whose nodes are all on this rank, as a matrix of this rank only. Stored data.
NodeMatrix alone(const NodeMatrix& A);

}  // namespace sprekk::multigrid
