#include "multigrid/aggregates.hpp"

#include "base/check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprekk::multigrid {
namespace {

constexpr Real rounding = 1e-12;     // smaller blocks, relative to the diagonals, are zero
constexpr Real least = 0.02;         // smallest strong coupling, relative to the geometric mean of the diagonals
constexpr Real independent = 1e-10;  // smallest independent part of a motion, relative
constexpr Real infinite = std::numeric_limits<Real>::infinity();
constexpr Real steps = 3;  // reach of a node in distances of its nearest neighbour; the diagonal of a cube is 1.7

/// Returns the largest entry of each diagonal block, including ghosts. Collective.
View<Real*> diagonal_sizes(const NodeMatrix& A) {
  const auto& graph = A.graph;
  const View<Real*> size("size", graph.columns->n_all());
  for (LocalIndex i = 0; i < graph.n_rows(); ++i) {
    const std::size_t begin = graph.start(i), n = graph.start(i + 1) - begin;
    for (std::size_t k = 0; k < n; ++k)
      if (graph.column(begin + k) == i)
        for (int r = 0; r < A.height; ++r)
          size(i) = std::fmax(size(i), std::fabs(A.value(A.height * A.width * begin + (r * n + k) * A.width + r)));
  }
  graph.columns->exchange(size, 1);
  return size;
}

Real distance(const Real* a, const Real* b) { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }
Real distance(const std::array<Real, 3>& a, const std::array<Real, 3>& b) { return distance(a.data(), b.data()); }

Real largest(const Real* values, int n) {
  Real result = 0;
  for (int k = 0; k < n; ++k) result = std::fmax(result, std::fabs(values[k]));
  return result;
}

/// Returns the positions of all nodes, including ghosts, [node, 3]. Collective.
View<Real*> all_places(const NodeGraph& graph, const std::vector<std::array<Real, 3>>& owned) {
  const View<Real*> all("places", static_cast<std::size_t>(graph.columns->n_all()) * 3);
  for (std::size_t i = 0; i < owned.size(); ++i) std::copy_n(owned[i].data(), 3, &all(3 * i));
  graph.columns->exchange(all, 3);
  return all;
}

/// Sorts the values and removes repetitions.
template <class T>
void make_set(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// Returns the neighbours of aggregates: the aggregates of their nodes' neighbours.
Neighbours coarsen(const Neighbours& fine, const Aggregates& aggregates) {
  std::vector<std::vector<LocalIndex>> found(aggregates.n);
  for (std::size_t i = 0; i < aggregates.of.size(); ++i)
    for (std::size_t k = fine.start[i]; k < fine.start[i + 1]; ++k) {
      const LocalIndex I = aggregates.of[i], J = aggregates.of[fine.node[k]];
      if (I >= 0 && J >= 0 && I != J) found[I].push_back(J);
    }
  Neighbours coarse;
  coarse.start.push_back(0);
  for (auto& one : found) {
    make_set(one);
    coarse.node.insert(coarse.node.end(), one.begin(), one.end());
    coarse.start.push_back(coarse.node.size());
  }
  return coarse;
}

}  // namespace

std::vector<bool> weak_couplings(const NodeMatrix& A, Real strong) {
  const auto& graph = A.graph;
  const auto diagonal = diagonal_sizes(A);
  std::vector<Real> size(graph.n_entries(), 0);                      // relative; 0: round-off, and the node itself
  const View<Real*> strongest("strongest", graph.columns->n_all());  // [node] relative entry
  for (LocalIndex i = 0; i < graph.n_rows(); ++i) {
    const std::size_t begin = graph.start(i), n = graph.start(i + 1) - begin;
    for (std::size_t k = 0; k < n; ++k) {
      const LocalIndex j = graph.column(begin + k);
      Real maximum = 0;
      for (int r = 0; r < A.height && j != i; ++r)
        maximum = std::fmax(maximum, largest(&A.value(A.height * A.width * begin + (r * n + k) * A.width), A.width));
      const Real mean = std::sqrt(diagonal(i) * diagonal(j));
      const bool positive = strong > 0 && A.height == 1 && A.value(begin + k) > 0;
      if (maximum > rounding * mean) size[begin + k] = positive ? rounding : maximum / mean;
      strongest(i) = std::fmax(strongest(i), size[begin + k]);
    }
  }
  graph.columns->exchange(strongest, 1);
  std::vector<bool> weak(size.size(), false);
  for (LocalIndex i = 0; i < graph.n_rows(); ++i)
    for (std::size_t k = graph.start(i); k < graph.start(i + 1); ++k)
      weak[k] = size[k] > 0 && size[k] < std::fmax(least, strong * std::fmin(strongest(i), strongest(graph.column(k))));
  return weak;
}

Nodes nodes_of(const NodeMatrix& A, const RCP<const MultiVector>& modes, const RCP<const MultiVector>& places,
               Real strong) {
  const auto& graph = A.graph;
  const int size = A.height;
  const auto n_rows = graph.n_rows();
  const auto diagonal = diagonal_sizes(A);
  Nodes nodes;
  nodes.free.assign(n_rows, false);
  nodes.n_modes = modes.is_null() ? size : static_cast<int>(modes->getNumVectors());
  nodes.motion.assign(static_cast<std::size_t>(n_rows) * size * nodes.n_modes, 0);
  nodes.neighbours.start.push_back(0);
  nodes.beyond.start.push_back(0);
  using Given = decltype(std::declval<const MultiVector&>().getLocalViewHost(Tpetra::Access::ReadOnly));
  const Given given = modes.is_null() ? Given() : modes->getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto motion = [&](LocalIndex row, int m) { return modes.is_null() ? Real(row % size == m) : given(row, m); };
  if (!places.is_null()) {
    const auto x = places->getLocalViewHost(Tpetra::Access::ReadOnly);
    nodes.place.resize(n_rows);
    for (LocalIndex i = 0; i < n_rows; ++i)
      for (std::size_t k = 0; k < x.extent(1); ++k) nodes.place[i][k] = x(i, k);
  }
  nodes.nearest.assign(n_rows, infinite);
  const auto place = all_places(graph, nodes.place);
  std::vector<bool> prescribed(size);
  if (modes.is_null()) nodes.weak = weak_couplings(A, strong);
  for (LocalIndex i = 0; i < n_rows; ++i) {
    const std::size_t begin = graph.start(i), n = graph.start(i + 1) - begin;
    prescribed.assign(size, true);
    for (std::size_t k = 0; k < n; ++k) {
      const LocalIndex j = graph.column(begin + k);
      const Real zero = rounding * std::sqrt(diagonal(i) * diagonal(j));
      Real maximum = 0;
      for (int r = 0; r < size; ++r) {
        const Real* const row = &A.value(size * size * begin + (r * n + k) * size);
        const Real here = j != i ? largest(row, size) : std::fmax(largest(row, r), largest(row + r + 1, size - r - 1));
        prescribed[r] = prescribed[r] && here <= zero;
        if (j != i) maximum = std::fmax(maximum, here);
      }
      if (maximum <= zero) continue;
      if (!nodes.weak.empty() && nodes.weak[begin + k]) continue;
      nodes.free[i] = true;
      if (j < n_rows)
        nodes.neighbours.node.push_back(j);
      else
        nodes.beyond.node.push_back(graph.columns->all()->getGlobalElement(j));
      if (j != i && !places.is_null())
        nodes.nearest[i] = std::fmin(nodes.nearest[i], distance(&place(3 * i), &place(3 * j)));
    }
    nodes.neighbours.start.push_back(nodes.neighbours.node.size());
    nodes.beyond.start.push_back(nodes.beyond.node.size());
    nodes.number.push_back(graph.columns->owned()->getGlobalElement(i));
    for (int r = 0; r < size; ++r)
      for (int m = 0; m < nodes.n_modes && !prescribed[r]; ++m)
        nodes.motion[(static_cast<std::size_t>(i) * size + r) * nodes.n_modes + m] = motion(i * size + r, m);
  }
  return nodes;
}

void Nodes::add_smoothed(std::size_t n) {
  const std::size_t before = free.size();
  if (n == before) return;
  SPREKK_CHECK(weak.empty(), "multigrid: couplings of nodes that are added are not known");
  if (before > 0) motion.resize(motion.size() / before * n, 0);
  free.resize(n, false);
  if (!place.empty()) place.resize(n);
  nearest.resize(n, infinite);
  neighbours.start.resize(n + 1, neighbours.node.size());
  beyond.start.resize(n + 1, beyond.node.size());
  number.resize(n, -1);
}

void find_nearest(Nodes& nodes) {
  nodes.nearest.assign(nodes.free.size(), infinite);
  for (std::size_t i = 0; i < nodes.place.size(); ++i)
    for (std::size_t k = nodes.neighbours.start[i]; k < nodes.neighbours.start[i + 1]; ++k)
      nodes.nearest[i] = std::fmin(nodes.nearest[i], distance(nodes.place[i], nodes.place[nodes.neighbours.node[k]]));
}

std::vector<Real> reach(const Nodes& nodes) {
  auto result = nodes.nearest;
  for (Real& r : result) r *= steps;
  return result;
}

Aggregates aggregate(const Nodes& nodes, std::size_t enough) {
  const auto& [start, neighbour] = nodes.neighbours;
  const auto reaches = reach(nodes);
  const auto n = static_cast<LocalIndex>(nodes.free.size());
  Aggregates result;
  auto& of = result.of;
  of.assign(n, -1);
  const auto each = [&, &start = start, &neighbour = neighbour](LocalIndex i, const auto& work) {
    for (std::size_t k = start[i]; k < start[i + 1]; ++k)
      if (const LocalIndex j = neighbour[k];
          nodes.place.empty() || distance(nodes.place[i], nodes.place[j]) <= std::fmax(reaches[i], reaches[j]))
        work(j);
  };
  std::vector<LocalIndex> members, links(n, 0), near;
  const auto take = [&](LocalIndex i, LocalIndex j) {
    if (!nodes.free[j] || of[j] >= 0) return;
    of[j] = of[i];
    members.push_back(j);
  };
  const auto make = [&](LocalIndex i) {
    of[i] = result.n++;
    members.assign(1, i);
    each(i, [&](LocalIndex j) { take(i, j); });
    if (members.size() >= enough) return;
    for (const LocalIndex j : members)
      each(j, [&](LocalIndex k) {
        if (nodes.free[k] && of[k] < 0 && links[k]++ == 0) near.push_back(k);
      });
    std::stable_sort(near.begin(), near.end(), [&](LocalIndex k, LocalIndex l) { return links[k] > links[l]; });
    for (const LocalIndex k : near) {
      if (members.size() < enough) take(i, k);
      links[k] = 0;
    }
    near.clear();
  };
  for (LocalIndex i = 0; i < n; ++i) {
    bool alone = nodes.free[i] && of[i] < 0 && start[i + 1] > start[i];
    each(i, [&](LocalIndex j) { alone = alone && of[j] < 0; });
    if (alone) make(i);
  }
  std::vector<LocalIndex> joined = of, touched(result.n, 0);
  for (LocalIndex i = 0; i < n; ++i) {
    if (!nodes.free[i] || of[i] >= 0) continue;
    each(i, [&](LocalIndex j) {
      if (of[j] < 0) return;
      ++touched[of[j]];
      if (joined[i] < 0 || touched[of[j]] > touched[joined[i]]) joined[i] = of[j];
    });
    each(i, [&](LocalIndex j) {
      if (of[j] >= 0) touched[of[j]] = 0;
    });
  }
  of = joined;
  for (LocalIndex i = 0; i < n; ++i)
    if (nodes.free[i] && of[i] < 0) make(i);
  return result;
}

std::vector<Real> tentative_prolongator(const Nodes& nodes, const Aggregates& aggregates, Nodes& coarse) {
  const int m = nodes.n_modes,
            size = static_cast<int>(nodes.motion.size() / std::max<std::size_t>(1, nodes.free.size() * m));
  std::vector<std::vector<LocalIndex>> members(aggregates.n);
  for (std::size_t i = 0; i < aggregates.of.size(); ++i)
    if (aggregates.of[i] >= 0) members[aggregates.of[i]].push_back(static_cast<LocalIndex>(i));
  std::vector<Real> basis(nodes.motion.size(), 0);
  coarse.neighbours = coarsen(nodes.neighbours, aggregates);
  coarse.free.assign(aggregates.n, true);
  coarse.n_modes = m;
  if (!nodes.place.empty()) {
    coarse.place.assign(aggregates.n, {});
    for (LocalIndex I = 0; I < aggregates.n; ++I)
      for (LocalIndex i : members[I])
        for (int k = 0; k < 3; ++k) coarse.place[I][k] += nodes.place[i][k] / static_cast<Real>(members[I].size());
  }
  find_nearest(coarse);
  coarse.contact_edge.assign(aggregates.n, 0);
  for (std::size_t i = 0; i < nodes.contact_edge.size(); ++i)
    if (const Real edge = nodes.contact_edge[i]; edge > 0 && aggregates.of[i] >= 0)
      if (Real& to = coarse.contact_edge[aggregates.of[i]]; to == 0 || edge < to) to = edge;
  coarse.motion.assign(static_cast<std::size_t>(aggregates.n) * m * m, 0);
  for (LocalIndex I = 0; I < aggregates.n; ++I) {
    const std::size_t rows = members[I].size() * size;
    std::vector<Real> q(rows * m);  // column by column
    const auto at = [&](std::size_t row) {
      return (members[I][row / size] * static_cast<std::size_t>(size) + row % size) * m;
    };
    for (int c = 0; c < m; ++c)
      for (std::size_t row = 0; row < rows; ++row) q[c * rows + row] = nodes.motion[at(row) + c];
    const auto dot = [&](int a, int b) {
      Real sum = 0;
      for (std::size_t row = 0; row < rows; ++row) sum += q[a * rows + row] * q[b * rows + row];
      return sum;
    };
    for (int c = 0; c < m; ++c) {
      Real* const motion = &coarse.motion[static_cast<std::size_t>(I) * m * m];  // [row, mode], upper triangular
      const Real before = std::sqrt(dot(c, c));
      for (int again = 0; again < 2; ++again)
        for (int a = 0; a < c; ++a) {
          const Real part = dot(a, c);
          motion[a * m + c] += part;
          for (std::size_t row = 0; row < rows; ++row) q[c * rows + row] -= part * q[a * rows + row];
        }
      const Real left = std::sqrt(dot(c, c));
      const bool own = left > independent * before;
      const Real unit = size * m == 1 ? 1 : left;
      motion[c * m + c] = own ? unit : 0;
      for (std::size_t row = 0; row < rows; ++row) q[c * rows + row] = own ? q[c * rows + row] / unit : 0;
    }
    for (int c = 0; c < m; ++c)
      for (std::size_t row = 0; row < rows; ++row) basis[at(row) + c] = q[c * rows + row];
  }
  return basis;
}

}  // namespace sprekk::multigrid
