#include "multigrid/fewer_ranks.hpp"

#include <Teuchos_DefaultMpiComm.hpp>

#include <algorithm>
#include <numeric>

#include "base/over_ranks.hpp"
#include "multigrid/coarse_graphs.hpp"

namespace sprekk::multigrid {
namespace {

const auto count_them = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();

/// Returns the number of nodes of this rank after the transfer: those of a run that begins with this rank, or none.
/// Runs have similar numbers of nodes. Collective.
GlobalIndex n_taken(const Map& owned, int n_runs) {
  const auto& comm = *owned.getComm();
  const auto counts = base::gather_over_ranks(comm, std::vector<GlobalIndex>{base::n_local_elements(owned)});
  const auto all = std::accumulate(counts.begin(), counts.end(), GlobalIndex{0});
  GlobalIndex before = 0, taken = 0;
  int first = -1;  // first rank of the present run
  for (GlobalIndex rank = 0, run = -1, n_ranks = comm.getSize(); rank < n_ranks; ++rank) {
    const GlobalIndex n = counts[rank], its_run = (2 * before + n) * n_runs / (2 * all);
    before += n;
    if (n > 0 && std::exchange(run, its_run) != its_run) first = static_cast<int>(rank);
    if (first == comm.getRank()) taken += n;
  }
  return taken;
}

/// Returns local neighbours and those on other ranks, all by global number.
Rows<GlobalIndex> all_neighbours(const Nodes& nodes) {
  const auto n = nodes.free.size();
  Rows<GlobalIndex> rows{View<std::size_t*>("start", n + 1),
                         View<GlobalIndex*>("node", nodes.neighbours.node.size() + nodes.beyond.node.size())};
  std::size_t at = 0;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = nodes.neighbours.start[i]; k < nodes.neighbours.start[i + 1]; ++k)
      rows.node(at++) = nodes.number[nodes.neighbours.node[k]];
    for (std::size_t k = nodes.beyond.start[i]; k < nodes.beyond.start[i + 1]; ++k)
      rows.node(at++) = nodes.beyond.node[k];
    rows.start(i + 1) = at;
  }
  return rows;
}

}  // namespace

FewerRanks::FewerRanks(const NodeMatrix& A, const ShortNodeMatrix& P, Nodes& nodes, int n_ranks) {
  const auto& before = A.graph.columns->owned();
  const auto& comm = before->getComm();
  const GlobalIndex n = n_taken(*before, n_ranks);
  takes_ = n > 0;
  const auto now = rcp(new const Map(count_them, static_cast<std::size_t>(n), 0, comm));
  std::vector<GlobalIndex> here(takes_ ? n : base::n_local_elements(*before));
  std::iota(here.begin(), here.end(), before->getMinGlobalIndex());
  gathered_.columns = std::make_shared<Halo>(before, fields::make_map(here, comm));

  Rows<GlobalIndex> named{A.graph.start, View<GlobalIndex*>("node", A.graph.n_entries())};
  for (std::size_t e = 0; e < A.graph.n_entries(); ++e)
    named.node(e) = A.graph.columns->all()->getGlobalElement(A.graph.column(e));
  named = with_ghosts(named, *gathered_.columns);
  gathered_.start = named.start;
  if (!takes_) named = {View<std::size_t*>("start", 1), {}};
  const auto columns = std::make_shared<Halo>(now, with_named(now, {named.node}));
  const auto column = to_local(named.node, *columns->all());
  place_.resize(column.extent(0));
  const View<LocalIndex*> sorted("column", column.extent(0));
  for (std::size_t i = 0; i + 1 < named.start.extent(0); ++i) {
    const std::size_t begin = named.start(i), end = named.start(i + 1);
    std::iota(place_.begin() + begin, place_.begin() + end, 0);
    std::sort(place_.begin() + begin, place_.begin() + end,
              [&](LocalIndex k, LocalIndex l) { return column(begin + k) < column(begin + l); });
    for (std::size_t e = begin; e < end; ++e) sorted(e) = column(begin + place_[e]);
  }
  matrix_ = {
      A.height, A.width, {columns, named.start, sorted}, View<Real*>("value", A.height * A.width * sorted.extent(0))};

  const View<GlobalIndex*> of_P("columns", P.graph.n_entries());
  for (std::size_t e = 0; e < P.graph.n_entries(); ++e)
    of_P(e) = P.graph.columns->all()->getGlobalElement(P.graph.column(e));
  const auto back = std::make_shared<Halo>(now, with_named(now, {of_P}));
  P_ = {P.height, P.width, {back, P.graph.start, to_local(of_P, *back->all())}, P.value};
  move(nodes);
}

void FewerRanks::update(const NodeMatrix& A) {
  const std::size_t block = static_cast<std::size_t>(A.height) * A.width;
  const auto value = takes_ ? matrix_.value : A.value;  // ranks that transfer nodes
  if (takes_) std::copy_n(A.value.data(), A.value.extent(0), value.data());
  gathered_.columns->exchange_rows(gathered_.start, value, static_cast<int>(block));
  std::vector<Real> row;
  for (LocalIndex i = 0; i < matrix_.graph.n_rows(); ++i) {
    const std::size_t begin = matrix_.graph.start(i), n = matrix_.graph.start(i + 1) - begin;
    Real* const to = &value(block * begin);
    row.assign(to, to + block * n);
    for (int r = 0; r < A.height; ++r)
      for (std::size_t k = 0; k < n; ++k)
        std::copy_n(&row[(r * n + place_[begin + k]) * A.width], A.width, to + (r * n + k) * A.width);
  }
}

void FewerRanks::move(Nodes& nodes) const {
  const auto& halo = *gathered_.columns;
  const auto n_before = static_cast<std::size_t>(halo.n_owned()), n = static_cast<std::size_t>(matrix_.graph.n_rows());
  const int m = nodes.n_modes, of_motion = m * m, width = of_motion + 6;
  const View<Real*> known("known", static_cast<std::size_t>(halo.n_all()) * width);
  for (std::size_t i = 0; i < n_before; ++i) {
    Real* const to = &known(i * width);
    std::copy_n(&nodes.motion[i * of_motion], of_motion, to);
    if (!nodes.place.empty()) std::copy_n(nodes.place[i].data(), 3, to + of_motion);
    to[of_motion + 3] = nodes.nearest[i];
    to[of_motion + 4] = nodes.contact_edge[i];
    to[of_motion + 5] = nodes.free[i];
  }
  halo.exchange(known, width);
  const auto neighbours = with_ghosts(all_neighbours(nodes), halo);
  const bool has_places = base::on_any_rank(*halo.owned()->getComm(), !nodes.place.empty());
  Nodes moved;
  moved.n_modes = m;
  moved.motion.resize(n * of_motion);
  moved.place.resize(has_places ? n : 0);
  moved.neighbours.start.push_back(0);
  moved.beyond.start.push_back(0);
  const auto& map = *matrix_.graph.columns->owned();
  for (std::size_t i = 0; i < n; ++i) {
    const Real* const from = &known(i * width);
    std::copy_n(from, of_motion, &moved.motion[i * of_motion]);
    if (has_places) std::copy_n(from + of_motion, 3, moved.place[i].data());
    moved.nearest.push_back(from[of_motion + 3]);
    moved.contact_edge.push_back(from[of_motion + 4]);
    moved.free.push_back(from[of_motion + 5] != 0);
    moved.number.push_back(map.getGlobalElement(static_cast<LocalIndex>(i)));
    for (std::size_t k = neighbours.start(i); k < neighbours.start(i + 1); ++k) {
      const GlobalIndex node = neighbours.node(k);
      if (map.isNodeGlobalElement(node))
        moved.neighbours.node.push_back(map.getLocalElement(node));
      else
        moved.beyond.node.push_back(node);
    }
    moved.neighbours.start.push_back(moved.neighbours.node.size());
    moved.beyond.start.push_back(moved.beyond.node.size());
  }
  find_nearest(moved);
  nodes = std::move(moved);
}

int n_ranks_of(const NodeGraph& graph) {
  return base::sum_over_ranks(*graph.columns->owned()->getComm(), static_cast<int>(graph.n_rows() > 0));
}

NodeMatrix alone(const NodeMatrix& A) {
  const auto self = rcp(new const Teuchos::MpiComm<int>(MPI_COMM_SELF));
  const auto map = rcp(new const Map(count_them, static_cast<std::size_t>(A.graph.n_rows()), 0, self));
  return {A.height, A.width, {std::make_shared<Halo>(map, map), A.graph.start, A.graph.column}, A.value};
}

}  // namespace sprekk::multigrid
