// Groups of nodes that become the nodes of a coarser level, and the motions of the finer one that they keep.
#pragma once

#include <array>
#include <vector>

#include "multigrid/node_matrix.hpp"

namespace sprekk::multigrid {

/// Which nodes are neighbours of an owned one, in rows as in NodeGraph, without itself.
template <class Node>
struct NeighboursBy {
  std::vector<std::size_t> start;
  std::vector<Node> node;
};
using Neighbours = NeighboursBy<LocalIndex>;  ///< owned ones

/// What is known of the nodes of a level before they are grouped.
struct Nodes {
  Neighbours neighbours;
  NeighboursBy<GlobalIndex> beyond;  ///< those on other ranks, by their number
  std::vector<GlobalIndex> number;   ///< [node] through all ranks, -1 of nodes that were added
  std::vector<bool> free;    ///< [node]: couples to others, ghosts included; those that do not are left to smoothing
  std::vector<Real> motion;  ///< [node, unknown, mode]: motions that cost next to no energy; zero where prescribed
  int n_modes = 0;
  std::vector<std::array<Real, 3>> place;  ///< [node] m; empty: not known
  std::vector<Real> nearest;  ///< [node] m: the distance of the nearest neighbour, on the finest level ghosts included;
                              ///< infinite without one, or where places are not known
  std::vector<bool> weak;  ///< [entry of the graph] a coupling to do without, besides those that are far; empty: none
  std::vector<Real> contact_edge;  ///< [node] m: see leave_out_far_contact(); empty: 0

  /// Adds nodes until there are n: not free, so they are left to smoothing, and their couplings are none of a
  /// neighbour. Stored data.
  void add_smoothed(std::size_t n);
};

/// The entries of the graph of a square matrix that are small beside the diagonals of both nodes, yet not zero but for
/// rounding. Collective.
std::vector<bool> weak_couplings(const NodeMatrix& A);

/// Nodes of a square matrix: neighbours are those whose blocks are not zero but for rounding. `modes` [unknown, mode],
/// null for the constant ones; `places` [node, dim], null if they are not known. Without modes, couplings are weak that
/// are small beside the diagonals of both, and no neighbours: so what conducts well and what does not stay apart
/// (Vanek, Mandel and Brezina 1996). Collective.
Nodes nodes_of(const NodeMatrix& A, const RCP<const MultiVector>& modes,
               const RCP<const MultiVector>& places = Teuchos::null);

/// Finds how near the neighbours on this rank are, where places are known. Stored data.
void find_nearest(Nodes& nodes);

/// How far each node reaches, [node] m: not much farther than to its nearest neighbour. Nodes couple strongly that one
/// of the two reaches: in cells that are much longer than wide, those across short edges, where a smoother does little;
/// what they join is less flat on the next level. Without limit where places are not known. Stored data.
std::vector<Real> reach(const Nodes& nodes);

/// The aggregate of each owned node, -1 of one that is not free: a node whose neighbours in reach are all in no
/// aggregate yet makes one with them, what is left joins the neighbouring aggregate that it touches most (Vanek, Mandel
/// and Brezina 1996). One with fewer nodes than `enough` also takes neighbours of these neighbours, those first that
/// most of these are neighbours of. Aggregates hold nodes of one rank only. Stored data.
struct Aggregates {
  LocalIndex n = 0;
  std::vector<LocalIndex> of;
};
Aggregates aggregate(const Nodes& nodes, std::size_t enough = 0);

/// An orthonormal basis of the motions on each aggregate: [node, unknown, mode], zero for motions that others make up.
/// `coarse` receives the nodes that the aggregates become, with the same motions in terms of the basis, but for
/// neighbours on other ranks: see coarsen_beyond(). Stored data.
std::vector<Real> tentative_prolongator(const Nodes& nodes, const Aggregates& aggregates, Nodes& coarse);

}  // namespace sprekk::multigrid
