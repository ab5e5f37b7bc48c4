// Block matrix with two bytes per entry, for smoothers.
#pragma once

#include <cstdint>

#include "fields/node_kernels.hpp"
#include "multigrid/node_matrix.hpp"
#ifdef SPREKK_WIDE_INSTRUCTIONS
#include <immintrin.h>
#endif

namespace sprekk::multigrid {

/// S A S for a diagonal matrix S, in multiples of a unit per row. The unit is 1/32640, or the largest entry of the row
/// over 32640 if this entry exceeds 1. The error is at most half a unit. With S = D^-1/2 and the diagonal D of a
/// positive definite A, no entry exceeds 1. The matrix is then as symmetric as A. As 32640 = 2^7 3 5 17, entries such
/// as 1/2 and 1/3 are exact multiples, and the last bit of A cannot change their rounding.
class RoundedMatrix {
 public:
  using Number = std::int16_t;

  explicit RoundedMatrix(const NodeMatrix& A);

  /// Copies the values of A. scale: S, [all nodes, unknown]. NaN entries make products NaN.
  void update(const NodeMatrix& A, const View<Real*>& scale);

  /// Calls out(i, sums) for each row node i with the b values of (S A S x) there; b is the block size. x: [all nodes,
  /// unknown], its ghosts are exchanged first. `wide`: use instructions that some processors lack. Collective.
  template <int b, class Out>
  void multiply(const View<Real*>& x, const Out& out, bool wide = fields::has_wide_instructions()) const;

  std::size_t bytes() const { return sizeof(Number) * value_.extent(0) + sizeof(float) * unit_.extent(0); }

 private:
  NodeGraph graph_;
  View<Number*> value_;  // [entry, column, row], and some padding
  View<float*> unit_;    // [owned node, unknown] unit of the row
};

namespace rounded {

using Number = RoundedMatrix::Number;

constexpr int padded(int size) { return (size + 3) / 4 * 4; }

/// Sets sum_r to row r of n adjacent blocks b x b times x. sum [padded(b)]
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
/// Computes the same with vector instructions, column by column of a block. Four values are read at a time; the last
/// ones may belong to the next column, and their sums are not used. Compilers convert such values in halves.
template <int b>
__attribute__((target("avx2,fma"))) void multiply_row_wide(const Number* a, const LocalIndex* column, std::size_t n,
                                                           const Real* x, Real* sum) {
  constexpr std::size_t ahead = 4096;  // prefetch distance in values,
  constexpr int line = 32;             // and values per cache line
  constexpr int n_parts = padded(b) / 4;
  constexpr int n_sums = b < 6 ? b : 3;  // sums per row, so that an addition need not wait for the previous one
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
