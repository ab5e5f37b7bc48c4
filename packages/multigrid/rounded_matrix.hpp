// A matrix of blocks in two bytes a number: what smoothers read.
#pragma once

#include <cstdint>

#include "fields/node_kernels.hpp"
#include "multigrid/node_matrix.hpp"
#ifdef SPREKK_WIDE_INSTRUCTIONS
#include <immintrin.h>
#endif

namespace sprekk::multigrid {

/// S A S for a diagonal matrix S, in whole multiples of a unit that each row has: 1/32640 of 1, or of the row's largest
/// number where that is more. Numbers are off by at most half of that; with S = D^-1/2, D the diagonal of a positive
/// definite A, none is larger than 1, and the matrix is as symmetric as A (32640 = 2^7 3 5 17, so that 1/2, 1/3 and
/// the like, which the last bit of A could push to either side, are multiples themselves).
class RoundedMatrix {
 public:
  using Number = std::int16_t;

  explicit RoundedMatrix(const NodeMatrix& A);

  /// Takes the values of A, `scale` [all nodes, unknown] being S. What is no number makes products none.
  void update(const NodeMatrix& A, const View<Real*>& scale);

  /// out(i, sums) for every row node i with the b numbers of (S A S x) there, x [all nodes, unknown], whose ghosts it
  /// exchanges first; b is the size of blocks. `wide`: in instructions that not every processor has. Collective.
  template <int b, class Out>
  void multiply(const View<Real*>& x, const Out& out, bool wide = fields::has_wide_instructions()) const;

  std::size_t bytes() const { return sizeof(Number) * value_.extent(0) + sizeof(float) * unit_.extent(0); }

 private:
  NodeGraph graph_;
  View<Number*> value_;  // [entry, column, row], and a few numbers more
  View<float*> unit_;    // [owned node, unknown] what 1 stands for in that row
};

namespace rounded {

using Number = RoundedMatrix::Number;

constexpr int padded(int size) { return (size + 3) / 4 * 4; }

/// sum_r = the numbers in row r of n blocks of b x b, which follow one another, times x. sum [padded(b)]
template <int b>
KOKKOS_INLINE_FUNCTION void multiply_row(const Number* a, const LocalIndex* column, std::size_t n, const Real* x,
                                         Real* sum) {
  for (int r = 0; r < b; ++r) sum[r] = 0;
  for (std::size_t k = 0; k < n; ++k, a += b * b) {
    const Real* const from = x + static_cast<std::size_t>(column[k]) * b;
    for (int c = 0; c < b; ++c)
      for (int r = 0; r < b; ++r) sum[r] += a[c * b + r] * from[c];
  }
}

#ifdef SPREKK_WIDE_INSTRUCTIONS
/// The same, column by column of a block, of which four numbers are read at a time: the last ones may be the next
/// column's, and their sums are not used. Compilers convert such numbers in halves.
template <int b>
__attribute__((target("avx2,fma"))) void multiply_row_wide(const Number* a, const LocalIndex* column, std::size_t n,
                                                           const Real* x, Real* sum) {
  constexpr std::size_t ahead = 4096;  // so many numbers before their turn the memory is asked for them,
  constexpr int line = 32;             // and so many it brings at once
  constexpr int n_parts = padded(b) / 4;
  constexpr int n_sums = b < 6 ? b : 3;  // of a row, so that an addition need not wait for the one before
  __m256d sums[n_sums][n_parts];
  for (auto& of_row : sums)
    for (auto& part : of_row) part = _mm256_setzero_pd();
  for (std::size_t k = 0; k < n; ++k, a += b * b) {
    for (int m = 0; m < b * b && b > 1; m += line) fields::prefetch(a + ahead + m);
    const Real* const from = x + static_cast<std::size_t>(column[k]) * b;
    for (int c = 0; c < b; ++c)
      for (int p = 0; p < n_parts; ++p) {
        const __m128i four = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(a + c * b + 4 * p));
        auto& to = sums[c % n_sums][p];
        to = _mm256_fmadd_pd(_mm256_cvtepi32_pd(_mm_cvtepi16_epi32(four)), _mm256_broadcast_sd(from + c), to);
      }
  }
  for (int p = 0; p < n_parts; ++p) {
    for (int m = 1; m < n_sums; ++m) sums[0][p] = _mm256_add_pd(sums[0][p], sums[m][p]);
    _mm256_storeu_pd(sum + 4 * p, sums[0][p]);
  }
}
#endif

}  // namespace rounded

template <int b, class Out>
void RoundedMatrix::multiply(const View<Real*>& x, const Out& out, [[maybe_unused]] bool wide) const {
  graph_.columns->exchange(x, b);
  const auto start = graph_.start;
  const auto unit = unit_;
  const Number* const value = value_.data();
  const LocalIndex* const column = graph_.column.data();
  const Real* const from = x.data();
  Kokkos::parallel_for(
      "product of rounded nodes", Kokkos::RangePolicy<Execution>(0, graph_.n_rows()), KOKKOS_LAMBDA(LocalIndex i) {
        const std::size_t begin = start(i), n = start(i + 1) - begin;
        Real sum[rounded::padded(b)];
#ifdef SPREKK_WIDE_INSTRUCTIONS
        if (wide)
          rounded::multiply_row_wide<b>(value + b * b * begin, column + begin, n, from, sum);
        else
#endif
          rounded::multiply_row<b>(value + b * b * begin, column + begin, n, from, sum);
        for (int r = 0; r < b; ++r) sum[r] *= unit(i * b + r);
        out(i, sum);
      });
}

}  // namespace sprekk::multigrid
