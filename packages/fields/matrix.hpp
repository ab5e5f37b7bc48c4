// Sparse matrices with one column index for all unknowns of a node.
#pragma once

#include <type_traits>

#include "fields/types.hpp"

namespace sprekk::fields {

/// Sparse matrix on this rank in blocks [height, width], one for each pair of coupled nodes. Row node i has the column
/// nodes column(start(i)) ... column(start(i + 1) - 1). Its `height` rows of values are consecutive and begin with
/// value(height * width * start(i)), as in a Tpetra matrix. Each column node is stored once instead of height * width
/// times. The unknowns of local node n are width * n ... width * n + width - 1.
struct NodeRows {
  int height = 1, width = 1;  ///< 1 to 3
  View<std::size_t*> start;
  View<LocalIndex*> column;
  View<Real*> value;

  struct Row {
    std::size_t first_node, n_nodes;  ///< range in column
    std::size_t begin;                ///< index of its first value
  };

  LocalIndex n_rows() const { return height * (static_cast<LocalIndex>(start.extent(0)) - 1); }
  KOKKOS_FORCEINLINE_FUNCTION Row row(LocalIndex i) const {
    const LocalIndex node = i / height;
    const std::size_t first = start(node), n = start(node + 1) - first;
    return {first, n, width * (height * first + (i - node * height) * n)};
  }
  KOKKOS_FORCEINLINE_FUNCTION std::size_t length(LocalIndex i) const {
    return width * (start(i / height + 1) - start(i / height));
  }
  /// Calls visit(column, index in value) in the order of places.
  template <class Visit>
  KOKKOS_FORCEINLINE_FUNCTION void for_row(LocalIndex i, const Visit& visit) const {
    const Row r = row(i);
    std::size_t place = r.begin;
    for (std::size_t k = r.first_node; k < r.first_node + r.n_nodes; ++k)
      for (int c = 0; c < width; ++c) visit(column(k) * width + c, place++);
  }

  /// Product of a row with x [column]; w is the width. Terms are distributed over several sums, so additions do not
  /// depend on the previous one. Place p of the row contributes to sums[p % n_sums<w>].
  template <int w>
  static constexpr int n_sums = w == 3 ? 6 : 4;
  template <int w>
  KOKKOS_FORCEINLINE_FUNCTION Real product(LocalIndex i, const Real* x) const {
    constexpr int n = n_sums<w>, at_once = n / w;
    const Row r = row(i);
    const LocalIndex* const node = &column(r.first_node);
    const Real* a = &value(r.begin);
    Real sums[n] = {};
    std::size_t k = 0;
    for (; k + at_once <= r.n_nodes; k += at_once, a += n)
      for (int m = 0; m < at_once; ++m)
        for (int c = 0; c < w; ++c) sums[m * w + c] += a[m * w + c] * x[node[k + m] * w + c];
    for (int m = 0; k + m < r.n_nodes; ++m)
      for (int c = 0; c < w; ++c) sums[m * w + c] += a[m * w + c] * x[node[k + m] * w + c];
    return total(sums);
  }
  template <int n>
  KOKKOS_FORCEINLINE_FUNCTION static Real total(const Real (&sums)[n]) {
    Real sum = 0;
    for (int s = 0; s < n; s += 2) sum += sums[s] + sums[s + 1];
    return sum;
  }
};

/// Calls work(w) with the width as a compile-time constant.
template <class Work>
void with_width(int width, const Work& work) {
  if (width == 3)
    work(std::integral_constant<int, 3>());
  else if (width == 2)
    work(std::integral_constant<int, 2>());
  else
    work(std::integral_constant<int, 1>());
}

/// Distributed matrix of NodeRows. Without nodal blocks, the blocks are single numbers.
class Matrix : public Operator {
 public:
  /// Creates a zero matrix with a graph in the format of Tpetra. Row i has the columns column(start(i)) ...
  /// column(start(i + 1) - 1), ascending local numbers of `columns`. Blocks [height, width] are used if the graph
  /// consists of such blocks, both are at most 3, and nodes have the unknowns width * n ... in `columns`. Collective.
  Matrix(const RCP<const Map>& rows, const RCP<const Map>& columns, const RCP<const Map>& domain,
         const View<std::size_t*>& start, const View<LocalIndex*>& column, int height, int width);
  /// Creates a matrix of these rows, on the nodes of `rows` and `columns`. Collective unless `domain` and `columns` are
  /// the same object.
  Matrix(const RCP<const Map>& rows, const RCP<const Map>& columns, const RCP<const Map>& domain, NodeRows numbers);
  /// Wraps A and shares its values. Not collective.
  explicit Matrix(const RCP<const CrsMatrix>& A);

  RCP<const Map> getDomainMap() const override { return domain_; }
  RCP<const Map> getRangeMap() const override { return rows_; }
  const RCP<const Map>& row_map() const { return rows_; }
  const RCP<const Map>& column_map() const { return columns_; }
  const RCP<const Import>& import() const { return import_; }  ///< null: columns and domain are the same

  const NodeRows& numbers() const { return numbers_; }

  /// Returns a Tpetra matrix that shares the values. The first call is collective and stores the matrix.
  RCP<CrsMatrix> crs() const;

  /// Computes y = alpha A x + beta y for different x and y, both with constant stride. Throws an Error for a transposed
  /// product. Collective.
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp mode = Teuchos::NO_TRANS, Real alpha = 1,
             Real beta = 0) const override;

  /// Copies the diagonal to d [row]; zero where the graph has no entry. Local.
  void copy_diagonal(Vector& d) const;

  /// Copies x [domain] with its ghosts to values [column]. Collective.
  void spread(const Vector& x, Vector& values) const;

 private:
  RCP<const Map> rows_, columns_, domain_;
  RCP<const Import> import_;
  NodeRows numbers_;
  mutable RCP<MultiVector> x_;  // [column] x with ghosts; null before the first use
  mutable RCP<CrsMatrix> crs_;
};

/// Wraps A as a Matrix that shares its values. Not collective.
inline RCP<const Matrix> wrapped(const RCP<const CrsMatrix>& A) { return rcp(new const Matrix(A)); }

}  // namespace sprekk::fields
