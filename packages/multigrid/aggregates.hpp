// Aggregates of nodes, which form the nodes of the next level, and the motions they preserve.
#pragma once

#include <array>
#include <vector>

#include "multigrid/node_matrix.hpp"
#include "multigrid/options.hpp"

namespace sprekk::multigrid {

/// Neighbours of each owned node, without the node itself; rows as in NodeGraph.
template <class Node>
struct NeighboursBy {
  std::vector<std::size_t> start;
  std::vector<Node> node;
};
using Neighbours = NeighboursBy<LocalIndex>;  ///< neighbours on this rank

/// Nodes of a level before aggregation.
struct Nodes {
  Neighbours neighbours;
  NeighboursBy<GlobalIndex> beyond;  ///< neighbours on other ranks, by global number
  std::vector<GlobalIndex> number;   ///< [node] global number; -1: node added by add_smoothed()
  std::vector<bool> free;    ///< [node] couples to others, including ghosts; other nodes are treated by smoothing only
  std::vector<Real> motion;  ///< [node, unknown, mode] motions with almost no energy; zero where prescribed
  int n_modes = 0;
  std::vector<std::array<Real, 3>> place;  ///< [node] m; empty: unknown
  std::vector<Real> nearest;  ///< [node] distance of the nearest neighbour, m, on the finest level including ghosts;
                              ///< infinite without neighbours or positions
  std::vector<bool> weak;     ///< [entry of the graph] coupling to omit, besides far ones; empty: none
  std::vector<Real> contact_edge;  ///< [node] m, see leave_out_far_contact(); empty: 0

  /// Adds nodes up to a number of n. The new nodes are not free: they are treated by smoothing only and have no
  /// neighbours. Throws an Error if weak couplings are known. Stored data.
  void add_smoothed(std::size_t n);
};

/// Returns the weak entries of the graph of a square matrix, except round-off. Relative to the geometric mean of the
/// diagonals of both nodes, entries are weak below 0.02, and below `strong` times the largest entry of either node.
/// With `strong` > 0, positive entries of scalar matrices are weak and do not count as the largest one. Collective.
std::vector<bool> weak_couplings(const NodeMatrix& A, Real strong);

/// Returns the nodes of a square matrix. Neighbours have blocks above round-off. `modes`: [unknown, mode], null for
/// constants. `places`: [node, dim], m, null if unknown. Without modes, weak_couplings() are no neighbours: regions of
/// high and low conductivity remain separate (Vanek, Mandel and Brezina 1996). Collective.
Nodes nodes_of(const NodeMatrix& A, const RCP<const MultiVector>& modes,
               const RCP<const MultiVector>& places = Teuchos::null, Real strong = Options().strong);

/// Sets the distances of the nearest neighbours on this rank, where positions are known. Stored data.
void find_nearest(Nodes& nodes);

/// Returns the reach of each node, [node] m: a few distances of its nearest neighbour; infinite for unknown positions.
/// Two nodes are strongly coupled if one reaches the other. Elongated cells are thus coarsened across their short
/// edges, where smoothing is inefficient, and are less flat on the next level. Stored data.
std::vector<Real> reach(const Nodes& nodes);

/// Aggregates of nodes, by number; -1: not free. A node whose neighbours within reach all have no aggregate forms one
/// with them. Remaining nodes join the neighbouring aggregate with most links (Vanek, Mandel and Brezina 1996). An
/// aggregate with fewer nodes than `enough` also includes second neighbours, those with most links first. Aggregates do
/// not cross ranks. Stored data.
struct Aggregates {
  LocalIndex n = 0;
  std::vector<LocalIndex> of;
};
Aggregates aggregate(const Nodes& nodes, std::size_t enough = 0);

/// Returns an orthonormal basis of the motions on each aggregate, [node, unknown, mode]; zero for dependent motions. A
/// single motion of single unknowns is its own basis.
/// `coarse` receives the nodes formed by the aggregates, with the same motions in this basis. Neighbours on other ranks
/// follow in coarsen_beyond(). Stored data.
std::vector<Real> tentative_prolongator(const Nodes& nodes, const Aggregates& aggregates, Nodes& coarse);

}  // namespace sprekk::multigrid
