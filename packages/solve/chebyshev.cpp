#include "solve/chebyshev.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Teuchos_LAPACK.hpp>
#ifdef __x86_64__
#include <immintrin.h>
#endif

#include <cmath>
#include <vector>

#include "solve/node_kernels.hpp"

namespace sprekk::solve {
namespace {

using Policy = Kokkos::RangePolicy<Execution>;

constexpr Real usual_smallest = 1.0 / 15, margin = 1.1;  // estimates of the largest come from below
constexpr int n_steps = 10;                              // of Lanczos' method

using Short = std::int16_t;
constexpr Real largest_short = 32767;
constexpr Real rounding = 1e-12;  // of a positive definite matrix, scaled, no number is larger than 1 but for that

KOKKOS_INLINE_FUNCTION Short rounded(Real x) {
  x = x > largest_short ? largest_short : x < -largest_short ? -largest_short : x;
  return static_cast<Short>(static_cast<int>(x + 32768.5) - 32768);
}

constexpr int padded(int size) { return (size + 3) / 4 * 4; }

/// A number in [0.5, 1.5) that hardly repeats, for each index of the whole problem.
KOKKOS_INLINE_FUNCTION Real scattered(unsigned long long i) {
  i = (i + 1) * 0x9e3779b97f4a7c15ull;  // as splitmix64 (Steele, Lea and Flood 2014)
  i = (i ^ (i >> 30)) * 0xbf58476d1ce4e5b9ull;
  i = (i ^ (i >> 27)) * 0x94d049bb133111ebull;
  return 0.5 + static_cast<Real>((i ^ (i >> 31)) >> 11) * 0x1p-53;
}

constexpr std::size_t ahead = 4096;  // so many numbers before their turn the memory is asked for them,
constexpr int line = 32;             // and so many it brings at once

/// sum_r = the numbers of row r of n blocks of b x b, which follow one another, times x: column by column of a block,
/// which are read four numbers at a time, of which the last may be the next column's.
template <int b>
KOKKOS_INLINE_FUNCTION void multiply_row(const Short* a, const LocalIndex* column, std::size_t n, const Real* x,
                                         Real* sum) {
  for (int r = 0; r < padded(b); ++r) sum[r] = 0;
  for (std::size_t k = 0; k < n; ++k, a += b * b) {
    const Real* const from = x + static_cast<std::size_t>(column[k]) * b;
    for (int c = 0; c < b; ++c)
      for (int r = 0; r < b; ++r) sum[r] += a[c * b + r] * from[c];
  }
}

#ifdef SPREKK_WIDE_INSTRUCTIONS
/// The same four numbers at a time, as no compiler does it by itself.
template <int b>
__attribute__((target("avx2,fma"))) void multiply_row_wide(const Short* a, const LocalIndex* column, std::size_t n,
                                                           const Real* x, Real* sum) {
  constexpr int n_parts = padded(b) / 4;
  constexpr int n_sums = b < 6 ? b : 3;  // of a row, so that an addition need not wait for the one before
  __m256d sums[n_sums][n_parts];
  for (auto& of_row : sums)
    for (auto& part : of_row) part = _mm256_setzero_pd();
  for (std::size_t k = 0; k < n; ++k, a += b * b) {
    for (int m = 0; m < b * b && b > 1; m += line) __builtin_prefetch(a + ahead + m);
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

/// out(i, sums) for every row node i with the numbers of (A x) there. Collective.
template <int b, class Out>
void for_scaled_rows(const NodeGraph& graph, const View<Short*>& value, const View<float*>& unit, const View<Real*>& x,
                     const Out& out) {
  graph.columns->exchange(x, b);
  const auto start = graph.start;
  const auto column = graph.column;
  const bool wide = has_wide_instructions();
  Kokkos::parallel_for(
      "product of nodes", Policy(0, graph.n_rows()), KOKKOS_LAMBDA(LocalIndex i) {
        const std::size_t begin = start(i), n = start(i + 1) - begin;
        Real sum[padded(b)];
#ifdef SPREKK_WIDE_INSTRUCTIONS
        if (wide)
          multiply_row_wide<b>(&value(b * b * begin), &column(begin), n, &x(0), sum);
        else
#endif
          multiply_row<b>(&value(b * b * begin), &column(begin), n, &x(0), sum);
        for (int r = 0; r < b; ++r) sum[r] *= unit(i * b + r);
        out(i, sum);
      });
}

}  // namespace

Chebyshev::Chebyshev(const NodeMatrix& A)
    : size_(A.height), graph_(A.graph), value_("scaled", A.value.extent(0) + padded(A.height)) {
  const auto vector = [&](LocalIndex n) { return View<Real*>("smoother", static_cast<std::size_t>(n) * size_); };
  const auto& halo = *graph_.columns;
  unit_ = View<float*>("units", static_cast<std::size_t>(halo.n_owned()) * size_);
  root_ = View<Real*>("roots", static_cast<std::size_t>(halo.n_all()) * size_);
  x_ = vector(halo.n_all());
  next_ = vector(halo.n_all());
  b_ = vector(halo.n_owned());
  step_ = vector(halo.n_owned());
}

void Chebyshev::update(const NodeMatrix& A, int degree) {
  degree_ = degree;
  const auto start = graph_.start;
  const auto column = graph_.column;
  const auto a = A.value, root = root_;
  const auto scaled = value_;
  const auto unit = unit_;
  with_sizes(size_, size_, [&](auto size, auto) {
    constexpr int b = size();
    Kokkos::parallel_for(
        "diagonal", Policy(0, graph_.n_rows()), KOKKOS_LAMBDA(LocalIndex i) {
          const std::size_t begin = start(i), n = start(i + 1) - begin;
          for (int r = 0; r < b; ++r) {
            Real diagonal = 0;
            for (std::size_t k = 0; k < n; ++k)
              if (column(begin + k) == i) diagonal = std::fabs(a(b * b * begin + (r * n + k) * b + r));
            root(i * b + r) = diagonal > 0 ? 1 / std::sqrt(diagonal) : 1;
          }
        });
    graph_.columns->exchange(root, b);
    Kokkos::parallel_for(
        "scale", Policy(0, graph_.n_rows()), KOKKOS_LAMBDA(LocalIndex i) {
          const std::size_t begin = start(i), n = start(i + 1) - begin;
          for (int r = 0; r < b; ++r) {
            const Real* const row = &a(b * b * begin + r * n * b);
            const auto number = [&](std::size_t k, int c) {
              return row[k * b + c] * (root(i * b + r) * root(column(begin + k) * b + c));
            };
            const auto store = [&](Real most) {  // in units of most / largest_short; returns the largest
              const Real factor = largest_short / most;
              Real largest = 0;
              for (std::size_t k = 0; k < n; ++k)
                for (int c = 0; c < b; ++c) {
                  const Real x = number(k, c);
                  largest = std::fmax(largest, std::fabs(x));
                  scaled(b * b * (begin + k) + c * b + r) = rounded(factor * x);
                }
              unit(i * b + r) = static_cast<float>(most / largest_short);
              return largest;
            };
            if (const Real largest = store(1); largest > 1 + rounding) store(largest);
          }
        });
  });
  widening_ = 1;
  find_largest_eigenvalue();
}

/// Lanczos' method, from the same vector whatever was set up before. Of a matrix that is not quite symmetric it finds
/// about the largest eigenvalue, too.
void Chebyshev::find_largest_eigenvalue() {
  const auto x = x_, next = next_, last = step_;
  const auto& halo = *graph_.columns;
  const auto nodes = halo.owned()->getLocalMap();
  const int b = size_;
  const Policy rows(0, halo.n_owned() * b);
  Kokkos::parallel_for(
      "start", rows, KOKKOS_LAMBDA(LocalIndex i) {
        next(i) = scattered(nodes.getGlobalElement(i / b) * b + i % b);
        x(i) = 0;
      });
  std::vector<Real> diagonal, beside;  // of the tridiagonal matrix
  for (int k = 0; k < n_steps; ++k) {
    const Real length = std::sqrt(dot(next, next));
    if (!(length > 0)) break;
    if (k > 0) beside.push_back(length);
    Kokkos::parallel_for(
        "next", rows, KOKKOS_LAMBDA(LocalIndex i) {
          last(i) = x(i);
          x(i) = next(i) / length;
        });
    with_sizes(b, b, [&](auto size, auto) {
      constexpr int m = size();
      for_scaled_rows<m>(graph_, value_, unit_, x, [next](LocalIndex i, const Real* sum) {
        for (int r = 0; r < m; ++r) next(i * m + r) = sum[r];
      });
    });
    const Real along = dot(x, next), back = k > 0 ? length : 0;
    diagonal.push_back(along);
    Kokkos::parallel_for(
        "orthogonal", rows, KOKKOS_LAMBDA(LocalIndex i) { next(i) -= along * x(i) + back * last(i); });
  }
  if (diagonal.empty()) return;
  beside.resize(diagonal.size());
  int info = 0;
  Teuchos::LAPACK<int, Real>().STEQR('N', static_cast<int>(diagonal.size()), diagonal.data(), beside.data(), nullptr, 1,
                                     nullptr, &info);
  if (const Real found = std::fmax(-diagonal.front(), diagonal.back()); info == 0 && found > 0) largest_ = found;
}

/// Over all owned nodes.
Real Chebyshev::dot(const View<Real*>& x, const View<Real*>& y) const {
  const auto& halo = *graph_.columns;
  Real here = 0, all = 0;
  Kokkos::parallel_reduce(
      "dot", Policy(0, halo.n_owned() * size_), KOKKOS_LAMBDA(LocalIndex i, Real & sum) { sum += x(i) * y(i); }, here);
  Teuchos::reduceAll(*halo.owned()->getComm(), Teuchos::REDUCE_SUM, 1, &here, &all);
  return all;
}

void Chebyshev::apply(const View<Real*>& b, const View<Real*>& x, bool add) const {
  const Real shorter = static_cast<Real>(usual_degree) / degree_, widest = widening_ * largest_;
  const Real high = margin * widest, low = usual_smallest * shorter * shorter * widest;
  const Real middle = (high + low) / 2, half = (high - low) / 2, sigma = middle / half;
  const auto root = root_;
  const auto scaled = b_, step = step_;
  auto from = x_, to = next_;
  const Policy rows(0, graph_.n_rows() * size_);
  Kokkos::parallel_for(
      "first step", rows, KOKKOS_LAMBDA(LocalIndex i) {
        scaled(i) = root(i) * b(i);
        from(i) = step(i) = scaled(i) / middle;
      });
  Real rho = 1 / sigma;
  for (int k = 1; k < degree_; ++k) {
    const Real next_rho = 1 / (2 * sigma - rho), keep = next_rho * rho, gain = 2 * next_rho / half;
    with_sizes(size_, size_, [&](auto size, auto) {
      constexpr int m = size();
      for_scaled_rows<m>(graph_, value_, unit_, from, [=](LocalIndex i, const Real* sum) {
        for (int r = 0; r < m; ++r) {
          const LocalIndex row = i * m + r;
          step(row) = keep * step(row) + gain * (scaled(row) - sum[r]);
          to(row) = from(row) + step(row);
        }
      });
    });
    std::swap(from, to);
    rho = next_rho;
  }
  Kokkos::parallel_for(
      "scale back", rows, KOKKOS_LAMBDA(LocalIndex i) {
        const Real value = root(i) * from(i);
        x(i) = add ? x(i) + value : value;
      });
}

View<Real*> Chebyshev::damped_inverse_diagonal() const {
  const View<Real*> result("damped inverse diagonal", root_.extent(0));
  const auto root = root_;
  const Real damping = 4.0 / 3 / largest_;
  Kokkos::parallel_for(
      "damped inverse diagonal", Policy(0, root.extent(0)),
      KOKKOS_LAMBDA(LocalIndex i) { result(i) = damping * root(i) * root(i); });
  return result;
}

}  // namespace sprekk::solve
