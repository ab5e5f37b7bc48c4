// Evaluates local operators in a kernel loop; compares and times them.
#pragma once

#include "base/view.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace sprekk::device {

/// Results of one operator: values of all entities, scales of their differences, and computing time.
struct Case {
  std::vector<Real> value, scale;
  Real seconds = 0;  ///< per entity, residual and Jacobian
};

/// Results by name. `inputs` are computed once, by the reference program.
struct Report {
  std::map<std::string, Case> cases;
  std::map<std::string, std::vector<Real>> inputs;
  bool has_inputs = false;
  int n_timed = 0;  ///< entities of a timed loop; 0: no timing
};

template <class T>
auto host_of(const T& view) {
  return Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view);
}

/// Returns a view filled on the host by fill(host view).
template <class Data, class Fill, class... Extents>
View<Data> filled(const Fill& fill, Extents... extents) {
  const View<Data> view("view", extents...);
  const auto host = Kokkos::create_mirror_view(view);
  fill(host);
  Kokkos::deep_copy(view, host);
  return view;
}

/// Random numbers in [low, high), equal on all machines.
class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  Real operator()(Real low, Real high) { return low + (high - low) * (engine_() * 0x1p-32); }
  bool chance(Real share) { return engine_() * 0x1p-32 < share; }

 private:
  std::mt19937 engine_;
};

/// True if an operator returns the contact state.
template <class Op, class = void>
constexpr bool has_state_of = false;
template <class Op>
constexpr bool has_state_of<Op, std::void_t<typename Op::Point>> = true;

template <class Op>
struct Kernel {
  static constexpr int n_rows = Op::Rows::size, n_columns = Op::Columns::size;
  static constexpr bool has_state = has_state_of<Op>;
  static constexpr int size = n_rows * (1 + n_columns) + has_state;
  Op op;
  View<Real**> x;    // [entity, column]
  View<Real**> out;  // [entity, residual, Jacobian by rows[, contact state]]

  KOKKOS_INLINE_FUNCTION void operator()(int e) const {
    Real local[n_columns], r[n_rows], J[n_rows][n_columns];
    for (int k = 0; k < n_columns; ++k) local[k] = x(e, k);
    op.residual(e, local, r);
    op.jacobian(e, local, J);
    for (int i = 0; i < n_rows; ++i) {
      out(e, i) = r[i];
      for (int k = 0; k < n_columns; ++k) out(e, n_rows + i * n_columns + k) = J[i][k];
    }
    if constexpr (has_state) out(e, size - 1) = static_cast<int>(op.point(e, local).state);
  }
};

/// Evaluates an operator once (values and scales), or repeatedly (time only).
template <class Op>
Case evaluated(const Op& op, const View<Real**>& x, bool timed) {
  using K = Kernel<Op>;
  const int n = static_cast<int>(x.extent(0));
  const K kernel{op, x, View<Real**>("out", n, K::size)};
  const auto run_with = [n](const K& kernel) {
    Kokkos::parallel_for("evaluate", Kokkos::RangePolicy<Execution>(0, n), kernel);
    Kokkos::fence();
  };
  const auto run = [&] { run_with(kernel); };
  run();
  Case result;
  if (timed) {
    result.seconds = 1e300;
    for (int round = 0; round < 5; ++round) {
      const auto begin = std::chrono::steady_clock::now();
      run();
      const std::chrono::duration<Real> took = std::chrono::steady_clock::now() - begin;
      result.seconds = std::min(result.seconds, took.count() / n);
    }
    return result;
  }
  // Scales of differences, with the mean size u of an unknown. Residual: sum of |J_ik x_k|; J_ik: the largest |J_il|
  // u_l over u_k, or, up to 1000 times larger, the change of J_ik per relative change of the unknowns, as where a
  // return to the strength is nearly singular; contact state: 1, i.e. equality.
  const auto unknowns = host_of(x), numbers = host_of(kernel.out);
  constexpr Real change = 1e-6;
  const auto changed_x = filled<Real**>(
      [&](const auto& view) {
        for (int e = 0; e < n; ++e)
          for (int k = 0; k < K::n_columns; ++k) view(e, k) = unknowns(e, k) * (1 + (k % 3 - 1) * change);
      },
      n, K::n_columns);
  const K other{op, changed_x, View<Real**>("out", n, K::size)};
  run_with(other);
  const auto changed = host_of(other.out);
  std::vector<Real> unit(K::n_columns, 0);
  for (int e = 0; e < n; ++e)
    for (int k = 0; k < K::n_columns; ++k) unit[k] += std::abs(unknowns(e, k)) / n;
  for (int e = 0; e < n; ++e) {
    for (int j = 0; j < K::size; ++j) result.value.push_back(numbers(e, j));
    std::vector<Real> of_rows, of_entries;
    for (int i = 0; i < K::n_rows; ++i) {
      Real sum = std::abs(numbers(e, i)), maximum = 0;
      const auto J = [&](int k) { return std::abs(numbers(e, K::n_rows + i * K::n_columns + k)); };
      for (int k = 0; k < K::n_columns; ++k) {
        sum += J(k) * std::abs(unknowns(e, k));
        maximum = std::max(maximum, J(k) * unit[k]);
      }
      of_rows.push_back(sum);
      for (int k = 0; k < K::n_columns; ++k) {
        const int place = K::n_rows + i * K::n_columns + k;
        const Real per_change = std::abs(changed(e, place) - numbers(e, place)) / change;
        of_entries.push_back(std::clamp(per_change, maximum / unit[k], 1e3 * maximum / unit[k]));
      }
    }
    for (const auto* part : {&of_rows, &of_entries})
      result.scale.insert(result.scale.end(), part->begin(), part->end());
    if (K::has_state) result.scale.push_back(1);
  }
  return result;
}

/// Adds a case; make(n) returns an operator and unknowns of n entities.
template <class Make>
void add_case(Report& report, const std::string& name, int n, int n_timed, const Make& make) {
  const auto [op, x] = make(n);
  Case& result = report.cases[name] = evaluated(op, x, false);
  if (n_timed == 0) return;
  const auto [many, unknowns] = make(n_timed);
  result.seconds = evaluated(many, unknowns, true).seconds;
}

void add_faces(Report& report);
void add_cells(Report& report);

}  // namespace sprekk::device
