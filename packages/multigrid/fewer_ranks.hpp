// A level of multigrid on fewer ranks than the one above.
#pragma once

#include <memory>
#include <vector>

#include "multigrid/aggregates.hpp"

namespace sprekk::multigrid {

/// Runs of neighbouring ranks hand their nodes to the first rank of the run, so that it has enough to do for the
/// messages it waits for, and aggregates can join what several ranks had. Parts of a mesh come from recursive
/// bisection: those with numbers next to each other lie next to each other. Ranks that have handed over their nodes
/// take no part in the level. Nodes keep their numbers, which go through the ranks.
class FewerRanks {
 public:
  /// Makes the graphs of A, whose nodes go to about n_ranks ranks, and of P, which interpolates from these nodes, and
  /// moves what is known of them. Collective.
  FewerRanks(const NodeMatrix& A, const ShortNodeMatrix& P, Nodes& nodes, int n_ranks);

  void update(const NodeMatrix& A);  ///< takes the values; collective

  const NodeMatrix& matrix() const { return matrix_; }        ///< A where its nodes are now
  const ShortNodeMatrix& prolongation() const { return P_; }  ///< P, with its values, for such columns
  const NodeGraph& gathered() const { return gathered_; }     ///< nodes where they were, and as ghosts those taken over
  std::size_t bytes() const { return sizeof(LocalIndex) * (place_.size() + P_.graph.column.extent(0)); }

 private:
  void move(Nodes& nodes) const;

  NodeGraph gathered_;             // its rows: of A, those taken over among them
  bool takes_ = false;             // this rank has nodes now
  std::vector<LocalIndex> place_;  // [entry of matrix_] where in the row that was handed over
  NodeMatrix matrix_;
  ShortNodeMatrix P_;
};

/// How many ranks have nodes. Collective.
int n_ranks_of(const NodeGraph& graph);

/// A, all of whose nodes this rank has, without the other ranks. Stored data.
NodeMatrix alone(const NodeMatrix& A);

}  // namespace sprekk::multigrid
