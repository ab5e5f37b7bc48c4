#include "multigrid/node_matrix.hpp"

#include <algorithm>
#include <unordered_map>
#include <vector>

#include "base/over_ranks.hpp"
#include "multigrid/block_sizes.hpp"

namespace sprekk::multigrid {
namespace {

/// Nodes of unknowns: halo of owned nodes, followed by ghosts, and [local column] -> node.
struct ColumnNodes {
  std::shared_ptr<const Halo> halo;
  std::vector<LocalIndex> node;
};

ColumnNodes column_nodes(const CrsMatrix& A, int size) {
  const auto &rows = *A.getRowMap(), &columns = *A.getColMap();
  const LocalIndex n_owned = base::n_local_elements(rows) / size;
  std::vector<GlobalIndex> nodes(n_owned);
  std::unordered_map<GlobalIndex, LocalIndex> local;
  for (LocalIndex i = 0; i < n_owned; ++i) {
    nodes[i] = rows.getGlobalElement(size * i) / size;
    for (int c = 0; c < size; ++c)
      SPREKK_CHECK(rows.getGlobalElement(size * i + c) == size * nodes[i] + c,
                   "unknowns of a node must be consecutive");
    local[nodes[i]] = i;
  }
  ColumnNodes result;
  for (LocalIndex c = 0, n = base::n_local_elements(columns); c < n; ++c) {
    const GlobalIndex node = columns.getGlobalElement(c) / size;
    const auto [at, is_new] = local.emplace(node, static_cast<LocalIndex>(nodes.size()));
    if (is_new) nodes.push_back(node);
    result.node.push_back(at->second);
  }
  const std::vector<GlobalIndex> owned(nodes.begin(), nodes.begin() + n_owned);
  result.halo =
      std::make_shared<Halo>(fields::make_map(owned, rows.getComm()), fields::make_map(nodes, rows.getComm()));
  return result;
}

/// Returns whether the columns of each node are adjacent, and the rows of each node have equal columns.
template <class Graph>
bool in_blocks(const Graph& graph, const ColumnNodes& columns, const Map& map, int size) {
  const auto n_columns = static_cast<LocalIndex>(columns.node.size());
  for (LocalIndex c = 0; c < n_columns; ++c)
    if (columns.node[c] != c / size || map.getGlobalElement(c) % size != c % size) return false;
  if (n_columns % size != 0) return false;
  for (LocalIndex row = 0, n = graph.numRows(); row < n; ++row) {
    const auto first = graph.row_map(row - row % size), begin = graph.row_map(row);
    const auto length = graph.row_map(row + 1) - begin;
    if (length % size != 0 || graph.row_map(row - row % size + 1) - first != length) return false;
    for (std::size_t k = 0; k < length; ++k)
      if (graph.entries(begin + k) != graph.entries(first + k) || graph.entries(begin + k - k % size) % size != 0 ||
          graph.entries(begin + k) != graph.entries(begin + k - k % size) + static_cast<LocalIndex>(k % size))
        return false;
  }
  return true;
}

template <class Local>
NodeMatrix shared(const Local& A, int size) {
  NodeMatrix result{size, size, {}, A.values};
  const LocalIndex n = A.numRows() / size;
  result.graph.start = View<std::size_t*>("start", n + 1);
  result.graph.column = View<LocalIndex*>("column", A.nnz() / (size * size));
  for (LocalIndex i = 0; i < n; ++i) {
    const std::size_t begin = A.graph.row_map(size * i), start = begin / (size * size);
    const std::size_t length = (A.graph.row_map(size * i + 1) - begin) / size;
    result.graph.start(i + 1) = start + length;
    for (std::size_t k = 0; k < length; ++k) result.graph.column(start + k) = A.graph.entries(begin + size * k) / size;
  }
  return result;
}

template <class Local>
NodeMatrix copied(const Local& A, const ColumnNodes& columns, const Map& map, int size) {
  NodeMatrix result{size, size, {}, {}};
  const LocalIndex n = A.numRows() / size;
  result.graph.start = View<std::size_t*>("start", n + 1);
  std::vector<LocalIndex> found, last(columns.halo->n_all(), -1);
  for (LocalIndex i = 0; i < n; ++i) {
    for (auto k = A.graph.row_map(size * i); k < A.graph.row_map(size * (i + 1)); ++k) {
      const LocalIndex node = columns.node[A.graph.entries(k)];
      if (std::exchange(last[node], i) != i) found.push_back(node);
    }
    std::sort(found.begin() + result.graph.start(i), found.end());
    result.graph.start(i + 1) = found.size();
  }
  result.graph.column = View<LocalIndex*>("column", found.size());
  std::copy(found.begin(), found.end(), result.graph.column.data());
  result.value = View<Real*>("value", size * size * found.size());
  for (LocalIndex row = 0; row < n * size; ++row) {
    const std::size_t begin = result.graph.start(row / size), end = result.graph.start(row / size + 1);
    Real* const values = result.value.data() + size * (size * begin + (row % size) * (end - begin));
    for (auto k = A.graph.row_map(row); k < A.graph.row_map(row + 1); ++k) {
      const LocalIndex column = A.graph.entries(k);
      const auto at = std::lower_bound(found.begin() + begin, found.begin() + end, columns.node[column]);
      values[size * (at - found.begin() - begin) + map.getGlobalElement(column) % size] = A.values(k);
    }
  }
  return result;
}

/// Computes sums_r += a_rk x_k over n values of h rows with the given distance.
template <int h, class Number>
KOKKOS_FORCEINLINE_FUNCTION void add_products(const Number* a, std::size_t apart, const Real* x, std::size_t n,
                                              Real* sums) {
  constexpr int lanes = 4, n_sums = h < 6 ? 2 : 1;  // an addition need not wait for the previous one
  constexpr std::size_t ahead = 8192, line = 64;    // bytes; prefetch distance
  Numbers<lanes> wide[n_sums][h];
  const auto add = [&](std::size_t k, int to) {
    Numbers<lanes> of_x;
    of_x.load(x + k);
    for (int r = 0; r < h; ++r) {
      Numbers<lanes> of_a;
      of_a.load(a + r * apart + k);
      wide[to][r].head += of_a.head * of_x.head;
    }
  };
  std::size_t k = 0;
  for (; k + n_sums * lanes <= n; k += n_sums * lanes) {
    const char* const next = reinterpret_cast<const char*>(a + h * k) + ahead;
    for (std::size_t l = 0; l < h * n_sums * lanes * sizeof(Number); l += line) fields::prefetch(next + l);
    for (int l = 0; l < n_sums; ++l) add(k + l * lanes, l);
  }
  for (; k + lanes <= n; k += lanes) add(k, 0);
  for (; k < n; ++k)
    for (int r = 0; r < h; ++r) sums[r] += a[r * apart + k] * x[k];
  for (int r = 0; r < h; ++r) {
    for (int l = 1; l < n_sums; ++l) wide[0][r].head += wide[l][r].head;
    Real sum[lanes];
    wide[0][r].store(sum);
    sums[r] += (sum[0] + sum[1]) + (sum[2] + sum[3]);
  }
}

/// Calls out(i, sums, height) for each row node i with the values of (A x). The required values of x are gathered
/// first. Rows are read side by side with explicit prefetching, since the processor does not predict so many streams.
/// Exchanges the ghosts of x [all columns] first. Collective.
template <class Number, class Out>
void for_rows(const NodeMatrixOf<Number>& A, const View<Real*>& x, const Out& out) {
  const auto& graph = A.graph;
  graph.columns->exchange(x, A.width);
  with_sizes(A.height, A.width, [&](auto height, auto width) {
    constexpr int h = height(), w = width();
    constexpr std::size_t at_once = 128;  // blocks
    const auto start = graph.start;
    const auto column = graph.column;
    const auto value = A.value;
    Kokkos::parallel_for(
        "product of nodes", Kokkos::RangePolicy<Execution>(0, graph.n_rows()), KOKKOS_LAMBDA(LocalIndex i) {
          const std::size_t begin = start(i), n = start(i + 1) - begin;
          Real sums[h] = {}, from[w * at_once];
          for (std::size_t first = 0; first < n; first += at_once) {
            const std::size_t end = n - first < at_once ? n : first + at_once, length = w * (end - first);
            for (std::size_t k = first; k < end; ++k)
              for (int c = 0; c < w; ++c)
                from[w * (k - first) + c] = x(static_cast<std::size_t>(column(begin + k)) * w + c);
            add_products<h>(&value(w * (h * begin + first)), w * n, from, length, sums);
          }
          out(i, sums, height);
        });
  });
}

}  // namespace

NodeMatrix node_matrix(const Matrix& A, int size) {
  const auto& numbers = A.numbers();
  const auto &rows = *A.row_map(), &columns = *A.column_map();
  bool rows_first = base::n_local_elements(columns) >= base::n_local_elements(rows);
  for (LocalIndex i = 0, n = base::n_local_elements(rows); i < n && rows_first; ++i)
    rows_first = columns.getGlobalElement(i) == rows.getGlobalElement(i);
  const bool in_nodes = rows_first && numbers.height == size && numbers.width == size;
  if (!base::on_all_ranks(*rows.getComm(), in_nodes)) return node_matrix(*A.crs(), size);
  const auto nodes = [size](const Map& unknowns) {
    std::vector<GlobalIndex> numbers;
    for (LocalIndex i = 0, n = base::n_local_elements(unknowns); i < n; i += size)
      numbers.push_back(unknowns.getGlobalElement(i) / size);
    return fields::make_map(numbers, unknowns.getComm());
  };
  const auto halo = std::make_shared<Halo>(nodes(rows), nodes(columns));
  return {size, size, {halo, numbers.start, numbers.column}, numbers.value};
}

NodeMatrix node_matrix(const CrsMatrix& A, int size) {
  const auto columns = column_nodes(A, size);
  const auto local = A.getLocalMatrixHost();
  const auto& map = *A.getColMap();
  auto result = in_blocks(local.graph, columns, map, size) ? shared(local, size) : copied(local, columns, map, size);
  result.graph.columns = columns.halo;
  return result;
}

RCP<CrsMatrix> crs_matrix(const NodeMatrix& A) {
  const int size = A.height;
  const auto unknowns = [&](const Map& nodes) {
    std::vector<GlobalIndex> all;
    for (const GlobalIndex node : base::local_elements(nodes))
      for (int c = 0; c < size; ++c) all.push_back(size * node + c);
    const auto invalid = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
    return rcp(new Map(invalid, Teuchos::arrayViewFromVector(all), 0, nodes.getComm()));
  };
  const auto rows = unknowns(*A.graph.columns->owned()), columns = unknowns(*A.graph.columns->all());
  const std::size_t n = A.graph.n_rows();
  Teuchos::ArrayRCP<std::size_t> start(n * size + 1);
  Teuchos::ArrayRCP<LocalIndex> column(A.value.extent(0));
  Teuchos::ArrayRCP<Real> value(A.value.extent(0));
  for (std::size_t i = 0, at = 0; i < n * size; ++i) {
    const std::size_t begin = A.graph.start(i / size), end = A.graph.start(i / size + 1);
    const Real* const values = A.value.data() + size * (size * begin + (i % size) * (end - begin));
    start[i] = at;
    for (std::size_t k = begin; k < end; ++k)
      for (int c = 0; c < size; ++c, ++at) {
        column[at] = size * A.graph.column(k) + c;
        value[at] = values[size * (k - begin) + c];
      }
    start[i + 1] = at;
  }
  const auto result = rcp(new CrsMatrix(rows, columns, 0));
  result->setAllValues(start, column, value);
  result->expertStaticFillComplete(rows, rows);
  return result;
}

template <class Number>
void product(const NodeMatrixOf<Number>& A, const View<Real*>& x, const View<Real*>& y) {
  for_rows(A, x, [y](LocalIndex i, const Real* sum, auto height) {
    for (int k = 0; k < height(); ++k) y(i * height() + k) = sum[k];
  });
}

template <class Number>
void add_product(const NodeMatrixOf<Number>& A, const View<Real*>& x, const View<Real*>& y) {
  for_rows(A, x, [y](LocalIndex i, const Real* sum, auto height) {
    for (int k = 0; k < height(); ++k) y(i * height() + k) += sum[k];
  });
}

template void product(const NodeMatrix&, const View<Real*>&, const View<Real*>&);
template void product(const ShortNodeMatrix&, const View<Real*>&, const View<Real*>&);
template void add_product(const NodeMatrix&, const View<Real*>&, const View<Real*>&);
template void add_product(const ShortNodeMatrix&, const View<Real*>&, const View<Real*>&);

void residual(const NodeMatrix& A, const View<Real*>& x, const ConstView<Real*>& b, const View<Real*>& r) {
  for_rows(A, x, [b, r](LocalIndex i, const Real* sum, auto height) {
    for (int k = 0; k < height(); ++k) r(i * height() + k) = b(i * height() + k) - sum[k];
  });
}

}  // namespace sprekk::multigrid
