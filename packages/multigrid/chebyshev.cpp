#include "multigrid/chebyshev.hpp"

#include <Teuchos_LAPACK.hpp>

#include <cmath>
#include <vector>

#include "base/over_ranks.hpp"
#include "multigrid/block_sizes.hpp"

namespace sprekk::multigrid {
namespace {

using Policy = Kokkos::RangePolicy<Execution>;

constexpr Real usual_smallest = 1.0 / 15, margin = 1.1;  // estimates are below the largest eigenvalue
constexpr int n_steps = 10;                              // of Lanczos' method

/// Returns a pseudo-random number in [0.5, 1.5) for each global index.
KOKKOS_INLINE_FUNCTION Real scattered(unsigned long long i) {
  i = (i + 1) * 0x9e3779b97f4a7c15ull;  // splitmix64 (Steele, Lea and Flood 2014)
  i = (i ^ (i >> 30)) * 0xbf58476d1ce4e5b9ull;
  i = (i ^ (i >> 27)) * 0x94d049bb133111ebull;
  return 0.5 + static_cast<Real>((i ^ (i >> 31)) >> 11) * 0x1p-53;
}

}  // namespace

Chebyshev::Chebyshev(const NodeMatrix& A) : size_(A.height), graph_(A.graph), matrix_(A) {
  const auto vector = [&](LocalIndex n) { return View<Real*>("smoother", static_cast<std::size_t>(n) * size_); };
  const auto& halo = *graph_.columns;
  root_ = View<Real*>("roots", static_cast<std::size_t>(halo.n_all()) * size_);
  x_ = vector(halo.n_all());
  next_ = vector(halo.n_all());
  step_ = vector(halo.n_owned());
}

void Chebyshev::update(const NodeMatrix& A, int degree) {
  degree_ = degree;
  const auto start = graph_.start;
  const auto column = graph_.column;
  const auto a = A.value, root = root_;
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
  });
  graph_.columns->exchange(root, size_);
  matrix_.update(A, root);
  widening_ = 1;
  find_largest_eigenvalue();
}

/// Estimates the largest eigenvalue by Lanczos' method with a fixed start vector. For slightly nonsymmetric matrices
/// the estimate is approximate. Collective.
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
      matrix_.multiply<m>(x, [next](LocalIndex i, const Real* sum) {
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

/// Returns the product over all owned nodes. Collective.
Real Chebyshev::dot(const View<Real*>& x, const View<Real*>& y) const {
  const auto& halo = *graph_.columns;
  Real here = 0;
  Kokkos::parallel_reduce(
      "dot", Policy(0, halo.n_owned() * size_), KOKKOS_LAMBDA(LocalIndex i, Real & sum) { sum += x(i) * y(i); }, here);
  return base::sum_over_ranks(*halo.owned()->getComm(), here);
}

void Chebyshev::apply(const ConstView<Real*>& b, const View<Real*>& x, bool add) const {
  const Real shorter = static_cast<Real>(usual_degree) / degree_, widest = widening_ * largest_;
  const Real high = margin * widest, low = usual_smallest * shorter * shorter * widest;
  const Real middle = (high + low) / 2, half = (high - low) / 2, sigma = middle / half;
  const auto root = root_;
  const auto step = step_;
  auto from = x_, to = next_;
  const Policy rows(0, graph_.n_rows() * size_);
  Kokkos::parallel_for(
      "first step", rows, KOKKOS_LAMBDA(LocalIndex i) { from(i) = step(i) = root(i) * b(i) / middle; });
  Real rho = 1 / sigma;
  for (int k = 1; k < degree_; ++k) {
    const Real next_rho = 1 / (2 * sigma - rho), keep = next_rho * rho, gain = 2 * next_rho / half;
    with_sizes(size_, size_, [&](auto size, auto) {
      constexpr int m = size();
      matrix_.multiply<m>(from, [=](LocalIndex i, const Real* sum) {
        for (int r = 0; r < m; ++r) {
          const LocalIndex row = i * m + r;
          step(row) = keep * step(row) + gain * (root(row) * b(row) - sum[r]);
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

}  // namespace sprekk::multigrid
