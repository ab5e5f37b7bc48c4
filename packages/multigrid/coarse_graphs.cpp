#include "multigrid/coarse_graphs.hpp"

#include <array>
#include <cmath>
#include <set>
#include <unordered_map>

#include "base/over_ranks.hpp"

namespace sprekk::multigrid {

Rows<GlobalIndex> to_global(const Rows<LocalIndex>& local, const Map& map) {
  Rows<GlobalIndex> rows{local.start, View<GlobalIndex*>("node", local.node.extent(0))};
  for (std::size_t k = 0; k < local.node.extent(0); ++k) rows.node(k) = map.getGlobalElement(local.node(k));
  for (std::size_t i = 0; i + 1 < local.start.extent(0); ++i)
    std::sort(rows.node.data() + rows.start(i), rows.node.data() + rows.start(i + 1));
  return rows;
}

Rows<GlobalIndex> with_ghosts(const Rows<GlobalIndex>& owned, const Halo& halo) {
  const LocalIndex n_owned = halo.n_owned(), n_all = halo.n_all();
  const View<GlobalIndex*> length("length", n_all);
  for (LocalIndex i = 0; i < n_owned; ++i) length(i) = owned.start(i + 1) - owned.start(i);
  halo.exchange(length, 1);
  Rows<GlobalIndex> all{View<std::size_t*>("start", n_all + 1), {}};
  for (LocalIndex i = 0; i < n_all; ++i) all.start(i + 1) = all.start(i) + length(i);
  all.node = View<GlobalIndex*>("node", all.start(n_all));
  std::copy_n(owned.node.data(), owned.node.extent(0), all.node.data());
  halo.exchange_rows(all.start, all.node, 1);
  return all;
}

RCP<const Map> with_named(const RCP<const Map>& owned, const std::vector<View<GlobalIndex*>>& named) {
  std::vector<GlobalIndex> others;
  for (const auto& nodes : named)
    for (std::size_t k = 0; k < nodes.extent(0); ++k)
      if (nodes(k) >= 0 && !owned->isNodeGlobalElement(nodes(k))) others.push_back(nodes(k));
  std::sort(others.begin(), others.end());
  others.erase(std::unique(others.begin(), others.end()), others.end());
  const auto mine = base::local_elements(*owned);
  std::vector<GlobalIndex> all(mine.begin(), mine.end());
  all.insert(all.end(), others.begin(), others.end());
  const auto invalid = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  return rcp(new Map(invalid, Teuchos::arrayViewFromVector(all), 0, owned->getComm()));
}

View<LocalIndex*> to_local(const View<GlobalIndex*>& nodes, const Map& map) {
  const View<LocalIndex*> local("local", nodes.extent(0));
  for (std::size_t k = 0; k < nodes.extent(0); ++k) local(k) = map.getLocalElement(nodes(k));
  return local;
}

namespace {

/// Returns whether the nodes of each entry are out of reach of each other, [entry]. Collective.
std::vector<bool> out_of_reach(const NodeGraph& graph, const Nodes& nodes, const std::vector<Real>& reaches) {
  std::vector<bool> far(graph.n_entries(), false);
  const auto& halo = *graph.columns;
  const View<Real*> ball("place and reach", static_cast<std::size_t>(halo.n_all()) * 4);
  for (std::size_t i = 0; i < nodes.place.size(); ++i) {
    for (int k = 0; k < 3; ++k) ball(4 * i + k) = nodes.place[i][k];
    ball(4 * i + 3) = reaches[i];
  }
  halo.exchange(ball, 4);
  for (LocalIndex i = 0; i < graph.n_rows(); ++i)
    for (std::size_t e = graph.start(i); e < graph.start(i + 1); ++e) {
      const Real *const a = &ball(4 * i), *const b = &ball(4 * graph.column(e));
      far[e] = std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) > std::fmax(a[3], b[3]);
    }
  return far;
}

/// Returns the local numbers of the nodes in `beyond`, [entry of `beyond`]; -1: not among the columns. Collective.
std::vector<LocalIndex> ghosts_beyond(const NodeGraph& graph, const Nodes& nodes) {
  const LocalIndex n_all = graph.columns->n_all();
  const View<GlobalIndex*> number("number", n_all);
  std::copy(nodes.number.begin(), nodes.number.end(), number.data());
  graph.columns->exchange(number, 1);
  std::unordered_map<GlobalIndex, LocalIndex> local;
  for (LocalIndex j = graph.n_rows(); j < n_all; ++j) local[number(j)] = j;
  std::vector<LocalIndex> ghosts;
  for (const GlobalIndex node : nodes.beyond.node) {
    const auto found = local.find(node);
    ghosts.push_back(found == local.end() ? -1 : found->second);
  }
  return ghosts;
}

}  // namespace

void coarsen_beyond(const NodeGraph& graph, const Nodes& nodes, const View<LocalIndex*>& aggregate, const Map& numbers,
                    Nodes& coarse) {
  const auto ghosts = ghosts_beyond(graph, nodes);
  std::vector<std::set<GlobalIndex>> found(coarse.free.size());
  for (LocalIndex i = 0; i < graph.n_rows(); ++i)
    for (std::size_t k = nodes.beyond.start[i]; k < nodes.beyond.start[i + 1] && aggregate(i) >= 0; ++k)
      if (const LocalIndex j = ghosts[k]; j >= 0 && aggregate(j) >= 0)
        found[aggregate(i)].insert(numbers.getGlobalElement(aggregate(j)));
  coarse.beyond = {{0}, {}};
  for (std::size_t I = 0; I < found.size(); ++I) {
    coarse.number.push_back(numbers.getGlobalElement(static_cast<LocalIndex>(I)));
    coarse.beyond.node.insert(coarse.beyond.node.end(), found[I].begin(), found[I].end());
    coarse.beyond.start.push_back(coarse.beyond.node.size());
  }
}

std::vector<bool> far_entries(const NodeGraph& graph, const Nodes& nodes) {
  auto far = out_of_reach(graph, nodes, reach(nodes));
  for (std::size_t e = 0; e < nodes.weak.size(); ++e) far[e] = far[e] || nodes.weak[e];
  return far;
}

Real leave_out_far_contact(const NodeGraph& graph, Nodes& nodes) {
  const auto far = out_of_reach(graph, nodes, reach(nodes));
  const auto& [start, neighbour] = nodes.neighbours;
  nodes.weak.assign(graph.n_entries(), false);
  nodes.contact_edge.resize(nodes.free.size(), 0);
  const auto ghosts = ghosts_beyond(graph, nodes);
  const View<Real*> free("free", graph.columns->n_all());
  for (LocalIndex i = 0; i < graph.n_rows(); ++i) free(i) = nodes.free[i];
  graph.columns->exchange(free, 1);
  std::vector<LocalIndex> neighbour_of(graph.columns->n_all(), -1);
  std::vector<std::size_t> contact;  // entries of a row
  std::array<double, 3> here{};      // sum of squares, number, nodes in contact
  for (LocalIndex i = 0; i < graph.n_rows(); ++i) {
    neighbour_of[i] = i;
    for (std::size_t k = start[i]; k < start[i + 1]; ++k) neighbour_of[neighbour[k]] = i;
    for (std::size_t k = nodes.beyond.start[i]; k < nodes.beyond.start[i + 1]; ++k)
      if (ghosts[k] >= 0) neighbour_of[ghosts[k]] = i;
    contact.clear();
    bool out = false;
    for (std::size_t e = graph.start(i); e < graph.start(i + 1); ++e) {
      const LocalIndex j = graph.column(e);
      if (neighbour_of[j] == i || free(i) == 0 || free(j) == 0) continue;
      contact.push_back(e);
      out = out || far[e];
    }
    here[2] += !contact.empty();
    Real& edge = nodes.contact_edge[i];
    if (out) {
      for (const std::size_t e : contact) nodes.weak[e] = true;
      if (edge == 0) edge = nodes.nearest[i];
    } else {
      if (edge > 0 && std::isfinite(nodes.nearest[i])) {
        here[0] += std::pow(nodes.nearest[i] / edge, 2);
        ++here[1];
      }
      edge = 0;
    }
  }
  const auto all = base::sum_over_ranks(*graph.columns->owned()->getComm(), here);
  constexpr Real few = 0.1;  // e.g. slivers of networks
  return all[1] > few * all[2] ? std::sqrt(all[0] / all[1]) : 0;
}

}  // namespace sprekk::multigrid
