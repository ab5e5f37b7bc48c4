// Graphs of the products that lead to the next level of multigrid.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "multigrid/aggregates.hpp"

namespace sprekk::multigrid {

/// Sets of nodes, one for each row: row i has node(start(i)) ... node(start(i + 1) - 1), sorted.
template <class Node>
struct Rows {
  View<std::size_t*> start;
  View<Node*> node;
};

/// name(i, add) hands the nodes of row i to add, perhaps several times the same; all are below n_columns.
template <class Name>
Rows<LocalIndex> make_rows(LocalIndex n, LocalIndex n_columns, const Name& name) {
  std::vector<LocalIndex> all, last_row(n_columns, -1);
  Rows<LocalIndex> rows{View<std::size_t*>("start", n + 1), {}};
  for (LocalIndex i = 0; i < n; ++i) {
    name(i, [&](LocalIndex node) {
      if (std::exchange(last_row[node], i) != i) all.push_back(node);
    });
    std::sort(all.begin() + rows.start(i), all.end());
    rows.start(i + 1) = all.size();
  }
  rows.node = View<LocalIndex*>("node", all.size());
  std::copy(all.begin(), all.end(), rows.node.data());
  return rows;
}

/// The same rows, sorted by global numbers. Stored data.
Rows<GlobalIndex> to_global(const Rows<LocalIndex>& local, const Map& map);

/// The rows of owned nodes, with those of ghosts after them. Collective.
Rows<GlobalIndex> with_ghosts(const Rows<GlobalIndex>& owned, const Halo& halo);

/// Owned coarse nodes, then all others that are named; -1 is none. Collective.
RCP<const Map> with_named(const RCP<const Map>& owned, const std::vector<View<GlobalIndex*>>& named);

/// Stored data.
View<LocalIndex*> to_local(const View<GlobalIndex*>& nodes, const Map& map);

/// The entries of a graph to do without: between nodes out of each other's reach, or weak ones. Collective.
std::vector<bool> far_entries(const NodeGraph& graph, const Nodes& nodes);

/// Adds to `coarse` the numbers of aggregates and their neighbours on other ranks; `aggregate` [node of the graph] in
/// local numbers of `numbers`, -1: none. Collective.
void coarsen_beyond(const NodeGraph& graph, const Nodes& nodes, const View<LocalIndex*>& aggregate, const Map& numbers,
                    Nodes& coarse);

/// Makes contact weak at nodes from which some of it is out of reach, as in faces with a long edge: jumps that
/// alternate along that edge do no work on contact, so that a prolongator which took all of a face to jump alike would
/// resist them. Contact is what couples free nodes that are no neighbours. Puts the shortest edge of such
/// nodes into `nodes.contact_edge`, that of a finer level where there is one, and 0 of all others; returns how flat
/// cells are at nodes that are left out now and were not on the finer level: the distance of their nearest neighbour
/// over that edge, the root of the mean square; 0 if they are less than a tenth of those in contact. Collective.
Real leave_out_far_contact(const NodeGraph& graph, Nodes& nodes);

}  // namespace sprekk::multigrid
