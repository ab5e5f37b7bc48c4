// The rows of a matrix of blocks times a vector, for those who go on with the numbers at once.
#pragma once

#include <algorithm>

#include "solve/node_kernels.hpp"
#include "solve/node_matrix.hpp"

namespace sprekk::solve {

/// The sum of a_k x_k over n numbers, in double precision.
template <class Number>
KOKKOS_FORCEINLINE_FUNCTION Real dot(const Number* a, const Real* x, std::size_t n) {
  constexpr int lanes = 4;
  Real sums[2][lanes] = {};  // so that an addition need not wait for the one before
  std::size_t k = 0;
  for (; k + 2 * lanes <= n; k += 2 * lanes) {
    for (int l = 0; l < lanes; ++l) sums[0][l] += a[k + l] * x[k + l];
    for (int l = 0; l < lanes; ++l) sums[1][l] += a[k + lanes + l] * x[k + lanes + l];
  }
  for (; k + lanes <= n; k += lanes)
    for (int l = 0; l < lanes; ++l) sums[0][l] += a[k + l] * x[k + l];
  for (int l = 0; l < lanes; ++l) sums[0][l] += sums[1][l];
  Real sum = (sums[0][0] + sums[0][1]) + (sums[0][2] + sums[0][3]);
  for (; k < n; ++k) sum += a[k] * x[k];
  return sum;
}

/// out(i, sums, height) for every row node i, with the numbers of (A x) there. What a row needs of x is brought
/// together first; then its numbers are read one after another, as they lie in memory, which makes the best of it:
/// three or six rows side by side take up to four times as long. Exchanges the ghosts of x [all columns] first.
/// Collective.
template <class Number, class Out>
void for_rows(const NodeMatrixOf<Number>& A, const View<Real*>& x, const Out& out) {
  const auto& graph = A.graph;
  graph.columns->exchange(x, A.width);
  with_sizes(A.height, A.width, [&](auto height, auto width) {
    constexpr int h = height(), w = width();
    constexpr std::size_t at_once = 64;  // blocks
    const auto start = graph.start;
    const auto column = graph.column;
    const auto value = A.value;
    Kokkos::parallel_for(
        "product of nodes", Kokkos::RangePolicy<Execution>(0, graph.n_rows()), KOKKOS_LAMBDA(LocalIndex i) {
          const std::size_t begin = start(i), n = start(i + 1) - begin;
          Real sums[h] = {}, from[w * at_once];
          for (std::size_t first = 0; first < n; first += at_once) {
            const std::size_t end = std::min(n, first + at_once), length = w * (end - first);
            for (std::size_t k = first; k < end; ++k)
              for (int c = 0; c < w; ++c)
                from[w * (k - first) + c] = x(static_cast<std::size_t>(column(begin + k)) * w + c);
            for (int r = 0; r < h; ++r) sums[r] += dot(&value(w * (h * begin + r * n + first)), from, length);
          }
          out(i, sums, height);
        });
  });
}

}  // namespace sprekk::solve
