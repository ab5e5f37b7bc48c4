#include "multigrid/galerkin.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <tuple>

#include "multigrid/coarse_graphs.hpp"
#include "multigrid/block_sizes.hpp"

namespace sprekk::multigrid {
namespace {

using Policy = Kokkos::RangePolicy<Execution>;

/// Computes Z += X Y for blocks [h, b] and [b, m] with the given distances of rows.
template <int h, int b, int m, class Number>
KOKKOS_FORCEINLINE_FUNCTION void add_block(const Real* X, std::size_t apart_X, const Number* Y, std::size_t apart_Y,
                                           Real* Z, std::size_t apart_Z) {
  Numbers<m> y[b];
  for (int c = 0; c < b; ++c) y[c].load(Y + c * apart_Y);
  for (int r = 0; r < h; ++r) {
    Numbers<m> z;
    z.load(Z + r * apart_Z);
    for (int c = 0; c < b; ++c) z.add(X[r * apart_X + c], y[c]);
    z.store(Z + r * apart_Z);
  }
}

/// Rounds x to multiples of one unit with an exact sum: the multiple next to `sum`. Changes the largest number by the
/// rounding of all. The unit is 2^-22 times the power of two above the largest number.
KOKKOS_INLINE_FUNCTION void round_with_sum(float* x, std::size_t n, Real sum) {
  std::size_t largest = 0;
  for (std::size_t k = 1; k < n; ++k)
    if (std::fabs(x[k]) > std::fabs(x[largest])) largest = k;
  if (x[largest] == 0) return;
  const Real unit = std::exp2(std::ceil(std::log2(std::fabs(Real(x[largest])))) - 22);
  for (std::size_t k = 0; k < n; ++k) {
    x[k] = static_cast<float>(unit * std::round(x[k] / unit));
    sum -= x[k];
  }
  x[largest] = static_cast<float>(x[largest] + unit * std::round(sum / unit));
}

constexpr std::size_t word = 64;

/// Returns the flags as bits; empty if all are false.
View<std::uint64_t*> in_bits(const std::vector<bool>& flags) {
  if (std::find(flags.begin(), flags.end(), true) == flags.end()) return {};
  const View<std::uint64_t*> bits("bits", (flags.size() + word - 1) / word);
  for (std::size_t k = 0; k < flags.size(); ++k) bits(k / word) |= std::uint64_t(flags[k]) << k % word;
  return bits;
}

KOKKOS_FORCEINLINE_FUNCTION bool is_set(const View<std::uint64_t*>& bits, std::size_t k) {
  return bits.extent(0) > 0 && (bits(k / word) >> k % word & 1) != 0;
}

}  // namespace

Galerkin::Galerkin(const NodeMatrix& A, const Nodes& nodes, const Aggregates& aggregates,
                   const std::vector<Real>& tentative)
    : fine_(A.graph) {
  const auto& halo = *fine_.columns;
  const LocalIndex n_owned = halo.n_owned(), n_all = halo.n_all(), n_coarse = aggregates.n;
  const int size = A.height, n_modes = nodes.n_modes;
  const auto far = far_entries(fine_, nodes);
  const auto invalid = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  const auto coarse_map = rcp(new Map(invalid, n_coarse, 0, halo.owned()->getComm()));

  const View<GlobalIndex*> aggregate("aggregate", n_all);
  for (LocalIndex i = 0; i < n_owned; ++i)
    aggregate(i) = aggregates.of[i] < 0 ? -1 : coarse_map->getGlobalElement(aggregates.of[i]);
  halo.exchange(aggregate, 1);
  tentative_ = View<float*>("tentative prolongator", static_cast<std::size_t>(n_all) * size * n_modes);
  std::transform(tentative.begin(), tentative.end(), tentative_.data(), [](Real x) { return static_cast<float>(x); });
  halo.exchange(tentative_, size * n_modes);

  const auto entries = [&](LocalIndex i, const auto& work) {
    for (std::size_t e = fine_.start(i); e < fine_.start(i + 1); ++e) work(fine_.column(e), e);
  };
  const auto nearby = with_named(coarse_map, {aggregate});
  const auto aggregate_nearby = to_local(aggregate, *nearby);
  const auto P = with_ghosts(to_global(make_rows(n_owned, base::n_local_elements(*nearby),
                                                 [&](LocalIndex i, const auto& add) {
                                                   if (aggregate(i) < 0) return;
                                                   entries(i, [&](LocalIndex j, std::size_t e) {
                                                     if (aggregate(j) >= 0 && !far[e]) add(aggregate_nearby(j));
                                                   });
                                                 }),
                                       *nearby),
                             halo);
  const auto reached = with_named(coarse_map, {P.node});
  const auto column_P_reached = to_local(P.node, *reached);
  const auto AP = with_ghosts(to_global(make_rows(n_owned, base::n_local_elements(*reached),
                                                  [&](LocalIndex i, const auto& add) {
                                                    if (aggregate(i) < 0) return;
                                                    entries(i, [&](LocalIndex j, std::size_t) {
                                                      for (std::size_t s = P.start(j); s < P.start(j + 1); ++s)
                                                        add(column_P_reached(s));
                                                    });
                                                  }),
                                        *reached),
                              halo);
  const auto coarse = std::make_shared<Halo>(coarse_map, with_named(coarse_map, {P.node, AP.node}));
  aggregate_ = to_local(aggregate, *coarse->all());
  far_ = in_bits(far);
  start_P_all_ = P.start;
  column_P_all_ = to_local(P.node, *coarse->all());
  start_AP_all_ = AP.start;
  column_AP_all_ = to_local(AP.node, *coarse->all());

  std::vector<std::vector<LocalIndex>> named_by(n_coarse);  // rows of P with this column
  for (LocalIndex k = 0; k < n_all; ++k)
    for (std::size_t e = P.start(k); e < P.start(k + 1); ++e)
      if (column_P_all_(e) < n_coarse) named_by[column_P_all_(e)].push_back(k);
  const auto R = make_rows(n_coarse, n_all, [&](LocalIndex I, const auto& add) {
    for (const LocalIndex k : named_by[I]) add(k);
  });
  const auto C = make_rows(n_coarse, coarse->n_all(), [&](LocalIndex I, const auto& add) {
    for (std::size_t e = R.start(I); e < R.start(I + 1); ++e)
      for (std::size_t s = AP.start(R.node(e)); s < AP.start(R.node(e) + 1); ++s) add(column_AP_all_(s));
  });

  const auto values = [](std::size_t n) {
    return View<float*>(Kokkos::view_alloc("value", Kokkos::WithoutInitializing), n);
  };
  const std::size_t n_P = P.start(n_owned), block = static_cast<std::size_t>(size) * n_modes;
  value_P_all_ = values(block * P.node.extent(0));
  P_ = {size,
        n_modes,
        {coarse, Kokkos::subview(P.start, Kokkos::pair(0, n_owned + 1)),
         Kokkos::subview(column_P_all_, Kokkos::pair<std::size_t, std::size_t>(0, n_P))},
        value_P_all_};
  R_ = {n_modes, size, {fine_.columns, R.start, R.node}, values(block * R.node.extent(0))};
  coarse_ = {n_modes,
             n_modes,
             {coarse, C.start, C.node},
             View<Real*>(Kokkos::view_alloc("value", Kokkos::WithoutInitializing),
                         static_cast<std::size_t>(n_modes) * n_modes * C.node.extent(0))};
  slices_ = make_slices(R_.graph, start_AP_all_);
  find_members(aggregates);
}

void Galerkin::find_members(const Aggregates& aggregates) {
  const LocalIndex n_owned = fine_.n_rows(), n_coarse = aggregates.n;
  first_member_ = View<std::size_t*>("first members", n_coarse + 1);
  for (const LocalIndex I : aggregates.of)
    if (I >= 0) ++first_member_(I + 1);
  for (LocalIndex I = 0; I < n_coarse; ++I) first_member_(I + 1) += first_member_(I);
  member_ = View<LocalIndex*>("members", first_member_(n_coarse));
  std::vector<std::size_t> next(first_member_.data(), first_member_.data() + n_coarse);
  for (LocalIndex i = 0; i < n_owned; ++i)
    if (aggregates.of[i] >= 0) member_(next[aggregates.of[i]]++) = i;
}

void Galerkin::update(const NodeMatrix& A, const View<Real*>& inverse_diagonal, bool symmetric) {
  const int block = P_.height * P_.width;
  smooth(A, inverse_diagonal);
  fine_.columns->exchange_rows(start_P_all_, value_P_all_, block);
  if (symmetric)
    restrict_symmetric();
  else
    restrict_general(A, inverse_diagonal);
  const View<Real*> AP(Kokkos::view_alloc("slice of A P", Kokkos::WithoutInitializing), block * slices_.size);
  const auto& [first, first_made] = std::tie(slices_.first, slices_.first_made);
  multiply_right(A, AP, first_made[0], first_made[1]);
  fine_.columns->exchange_rows(slices_.start_saved, AP, block);
  for (int s = 0; s < slices_.n(); ++s) {
    multiply_right(A, AP, first_made[s + 1], first_made[s + 2]);
    multiply_left(AP, first[s], first[s + 1]);
  }
}

void Galerkin::smooth(const NodeMatrix& A, const View<Real*>& inverse_diagonal) const {
  const auto graph = fine_;
  const auto a = A.value;
  const auto p = value_P_all_, t = tentative_;
  const auto start = start_P_all_;
  const auto column = column_P_all_, aggregate = aggregate_;
  const auto far = far_;
  with_sizes(P_.height, P_.width, [&](auto size, auto modes) {
    constexpr int b = size(), m = modes();
    Kokkos::parallel_for(
        "smoothed prolongator", Policy(0, graph.n_rows()), KOKKOS_LAMBDA(LocalIndex i) {
          const std::size_t first = start(i), n = start(i + 1) - first, begin = graph.start(i),
                            n_a = graph.start(i + 1) - begin;
          if (n == 0) return;
          Real sum = 0;  // of the row, for one unknown per node
          for (std::size_t s = 0; s < n; ++s) {
            Real sums[b][m] = {};
            for (std::size_t k = 0; k < n_a; ++k) {
              const LocalIndex j = graph.column(begin + k), to = is_set(far, begin + k) ? i : j;
              if (aggregate(j) < 0 || aggregate(to) != column(first + s)) continue;
              const float* const from = &t(static_cast<std::size_t>(to) * b * m);
              for (int r = 0; r < b; ++r) {
                const Real* const a_r = &a(b * b * begin + (r * n_a + k) * b);
                const Real w = inverse_diagonal(static_cast<std::size_t>(i) * b + r);
                for (int c = 0; c < b; ++c)
                  for (int q = 0; q < m; ++q) sums[r][q] -= w * a_r[c] * from[c * m + q];
                if (i == j)
                  for (int q = 0; q < m; ++q) sums[r][q] += from[r * m + q];
              }
            }
            for (int r = 0; r < b; ++r)
              for (int q = 0; q < m; ++q) p(b * m * first + (r * n + s) * m + q) = static_cast<float>(sums[r][q]);
            sum += sums[0][0];
          }
          if (b * m == 1) round_with_sum(&p(first), n, sum);
        });
  });
}

void Galerkin::restrict_symmetric() const {
  const auto p = value_P_all_, r = R_.value;
  const auto start_P = start_P_all_, start = R_.graph.start;
  const auto column = R_.graph.column, column_P = column_P_all_;
  with_sizes(P_.height, P_.width, [&](auto size, auto modes) {
    constexpr int b = size(), m = modes();
    Kokkos::parallel_for(
        "restriction", Policy(0, R_.graph.n_rows()), KOKKOS_LAMBDA(LocalIndex I) {
          const std::size_t begin = start(I), n = start(I + 1) - begin;
          for (std::size_t k = 0; k < n; ++k) {
            const LocalIndex row = column(begin + k);
            const std::size_t first = start_P(row), n_p = start_P(row + 1) - first;
            const std::size_t s = Cursor{&column_P(first), n_p}.find(I);
            for (int q = 0; q < m; ++q)
              for (int c = 0; c < b; ++c)
                r(b * m * begin + (q * n + k) * b + c) = p(b * m * first + (c * n_p + s) * m + q);
          }
        });
  });
}

void Galerkin::restrict_general(const NodeMatrix& A, const View<Real*>& inverse_diagonal) const {
  const auto graph = fine_;
  const auto a = A.value;
  const auto r = R_.value, t = tentative_;
  const auto start = R_.graph.start, first_member = first_member_;
  const auto member = member_, column_R = R_.graph.column, aggregate = aggregate_;
  const auto far = far_;
  with_sizes(P_.height, P_.width, [&](auto size, auto modes) {
    constexpr int b = size(), m = modes();
    Kokkos::parallel_for(
        "restriction", Policy(0, R_.graph.n_rows()), KOKKOS_LAMBDA(LocalIndex I) {
          const std::size_t n = start(I + 1) - start(I);
          float* const row = &r(b * m * start(I));
          for (std::size_t k = 0; k < b * m * n; ++k) row[k] = 0;
          for (std::size_t at = first_member(I); at < first_member(I + 1); ++at) {
            const LocalIndex j = member(at);
            const std::size_t begin = graph.start(j), n_a = graph.start(j + 1) - begin;
            const float* const from = &t(static_cast<std::size_t>(j) * b * m);
            const std::size_t own_place = Cursor{&column_R(start(I)), n}.find(j);
            Cursor cursor{&column_R(start(I)), n};
            for (std::size_t k = 0; k < n_a; ++k) {
              if (aggregate(graph.column(begin + k)) < 0) continue;
              const bool own = graph.column(begin + k) == j, out_of_reach = is_set(far, begin + k);
              const LocalIndex column = out_of_reach ? j : graph.column(begin + k);
              const std::size_t s = out_of_reach ? own_place : cursor.find(column);
              if (s == n) continue;
              for (int q = 0; q < m; ++q) {
                float* const to = row + (q * n + s) * b;
                for (int c = 0; c < b; ++c) {
                  Real sum = 0;
                  for (int d = 0; d < b; ++d) sum += from[d * m + q] * a(b * b * begin + (d * n_a + k) * b + c);
                  sum = (own ? from[c * m + q] : 0) - sum * inverse_diagonal(static_cast<std::size_t>(column) * b + c);
                  to[c] = static_cast<float>(to[c] + sum);
                }
              }
            }
          }
        });
  });
}

void Galerkin::multiply_right(const NodeMatrix& A, const View<Real*>& AP, std::size_t first_made,
                              std::size_t end_made) const {
  const auto graph = fine_;
  const auto a = A.value;
  const auto p = value_P_all_;
  const auto start_P = start_P_all_, start = start_AP_all_;
  const auto column_P = column_P_all_, column = column_AP_all_;
  const auto made = slices_.made;
  const auto to = slices_.to, at_present = slices_.at;
  with_sizes(P_.height, P_.width, [&](auto size, auto modes) {
    constexpr int b = size(), m = modes();
    Kokkos::parallel_for(
        "A P", Policy(first_made, end_made), KOKKOS_LAMBDA(std::size_t k_made) {
          const LocalIndex i = made(k_made);
          const std::size_t n = start(i + 1) - start(i), begin = graph.start(i), n_a = graph.start(i + 1) - begin;
          at_present(i) = to(k_made);
          Real* const row = &AP(b * m * to(k_made));
          for (std::size_t k = 0; k < b * m * n; ++k) row[k] = 0;
          Cursor cursor{&column(start(i)), n};
          std::size_t begins = 0;  // previous start; rows of neighbours often begin alike
          for (std::size_t k = 0; k < n_a; ++k) {
            const LocalIndex j = graph.column(begin + k);
            const std::size_t first_p = start_P(j), n_p = start_P(j + 1) - first_p;
            if (n_p == 0) continue;
            const float* const from = &p(b * m * first_p);
            const Real* const block = &a(b * b * begin + k * b);
            cursor.at = begins;
            for (std::size_t s = 0; s < n_p; ++s) {
              const std::size_t place = cursor.find(column_P(first_p + s));
              if (s == 0) begins = place;
              add_block<b, b, m>(block, n_a * b, from + s * m, n_p * m, row + place * m, n * m);
            }
          }
        });
  });
}

void Galerkin::multiply_left(const View<Real*>& AP, LocalIndex first, LocalIndex end) const {
  const auto r = R_.value;
  const auto out = coarse_.value;
  const auto start_R = R_.graph.start, start_AP = start_AP_all_, start = coarse_.graph.start, at_present = slices_.at;
  const auto column_R = R_.graph.column, column = coarse_.graph.column, column_AP = column_AP_all_;
  with_sizes(P_.height, P_.width, [&](auto size, auto modes) {
    constexpr int b = size(), m = modes();
    Kokkos::parallel_for(
        "R A P", Policy(first, end), KOKKOS_LAMBDA(LocalIndex I) {
          const std::size_t n = start(I + 1) - start(I), begin = start_R(I), n_r = start_R(I + 1) - begin;
          Real* const row = &out(m * m * start(I));
          for (std::size_t k = 0; k < m * m * n; ++k) row[k] = 0;
          Cursor cursor{&column(start(I)), n};
          std::size_t begins = 0;  // previous start
          for (std::size_t k = 0; k < n_r; ++k) {
            const LocalIndex fine = column_R(begin + k);
            const std::size_t n_ap = start_AP(fine + 1) - start_AP(fine);
            if (n_ap == 0) continue;
            const Real* const from = &AP(b * m * at_present(fine));
            Real block[m * b];
            for (int q = 0; q < m; ++q)
              for (int c = 0; c < b; ++c) block[q * b + c] = r(b * m * begin + (q * n_r + k) * b + c);
            cursor.at = begins;
            for (std::size_t s = 0; s < n_ap; ++s) {
              const std::size_t place = cursor.find(column_AP(start_AP(fine) + s));
              if (s == 0) begins = place;
              add_block<m, b, m>(block, b, from + s * m, n_ap * m, row + place * m, n * m);
            }
          }
          for (std::size_t k = 0; k < n; ++k)  // unit diagonal for modes that the aggregate lacks
            for (int q = 0; q < m && column(start(I) + k) == I; ++q)
              if (row[(q * n + k) * m + q] == 0) row[(q * n + k) * m + q] = 1;
        });
  });
}

std::size_t Galerkin::bytes() const {
  return sizeof(float) * (tentative_.extent(0) + value_P_all_.extent(0) + R_.value.extent(0)) +
         sizeof(Real) * coarse_.value.extent(0) +
         sizeof(LocalIndex) * (column_P_all_.extent(0) + column_AP_all_.extent(0) + R_.graph.column.extent(0)) +
         sizeof(std::uint64_t) * far_.extent(0) + slices_.bytes();
}

}  // namespace sprekk::multigrid
