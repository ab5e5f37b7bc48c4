#include "multigrid/coarse_graphs.hpp"

#include <cmath>

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

std::vector<bool> far_entries(const NodeGraph& graph, const Nodes& nodes) {
  auto far = nodes.weak;
  far.resize(graph.n_entries(), false);
  const auto& halo = *graph.columns;
  const View<Real*> ball("place and reach", static_cast<std::size_t>(halo.n_all()) * 4);
  const auto reaches = reach(nodes);
  for (std::size_t i = 0; i < nodes.place.size(); ++i) {
    for (int k = 0; k < 3; ++k) ball(4 * i + k) = nodes.place[i][k];
    ball(4 * i + 3) = reaches[i];
  }
  halo.exchange(ball, 4);
  for (LocalIndex i = 0; i < graph.n_rows(); ++i)
    for (std::size_t e = graph.start(i); e < graph.start(i + 1); ++e) {
      const Real *const a = &ball(4 * i), *const b = &ball(4 * graph.column(e));
      far[e] = far[e] || std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) > std::fmax(a[3], b[3]);
    }
  return far;
}

}  // namespace sprekk::multigrid
