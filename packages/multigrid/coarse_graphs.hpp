// Graphs of the products that form the next level of multigrid.
#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "multigrid/aggregates.hpp"

namespace sprekk::multigrid {

/// Sets of nodes per row: row i contains node(start(i)) ... node(start(i + 1) - 1), sorted.
template <class Node>
struct Rows {
  View<std::size_t*> start;
  View<Node*> node;
};

/// Returns the rows of which name(i, add) passes the nodes of row i to add, possibly repeatedly; all are below
/// n_columns.
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

/// Returns the rows in global numbers, sorted. Stored data.
Rows<GlobalIndex> to_global(const Rows<LocalIndex>& local, const Map& map);

/// Returns the rows of owned nodes, followed by those of ghosts. Collective.
Rows<GlobalIndex> with_ghosts(const Rows<GlobalIndex>& owned, const Halo& halo);

/// Returns the map of the owned coarse nodes, then all others in `named`; -1 is ignored. Collective.
RCP<const Map> with_named(const RCP<const Map>& owned, const std::vector<View<GlobalIndex*>>& named);

/// Returns local numbers of the nodes in the map; -1 if absent. Stored data.
View<LocalIndex*> to_local(const View<GlobalIndex*>& nodes, const Map& map);

/// Returns the entries of a graph to omit: between nodes out of reach of each other, or weak ones. Collective.
std::vector<bool> far_entries(const NodeGraph& graph, const Nodes& nodes);

/// Adds the numbers of aggregates and their neighbours on other ranks to `coarse`. aggregate: [node of the graph] local
/// number in `numbers`, -1: none. Collective.
void coarsen_beyond(const NodeGraph& graph, const Nodes& nodes, const View<LocalIndex*>& aggregate, const Map& numbers,
                    Nodes& coarse);

/// Marks contact as weak at nodes from which part of it is out of reach, as on faces with a long edge. Differences of
/// both sides that alternate along this edge do no work on contact. A prolongator with a uniform difference on each
/// face would resist them. Contact couples free nodes that are not neighbours. Sets `nodes.contact_edge` of these nodes
/// to their shortest edge, or keeps that of a finer level, and sets 0 elsewhere. Returns the flatness of cells at nodes
/// that were marked on the finer level and are no longer marked. It is the root mean square of the distance of the
/// nearest neighbour over contact_edge; 0 if these are less than a tenth of the nodes in contact. Collective.
Real leave_out_far_contact(const NodeGraph& graph, Nodes& nodes);

}  // namespace sprekk::multigrid
