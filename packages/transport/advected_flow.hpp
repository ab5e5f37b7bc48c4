// Local operator of the advection of a quantity by the flow through the ends of an entity.
#pragma once

#include "transport/changed_flow.hpp"

namespace sprekk::transport {

/// Upwind advection between an entity and its ends, see make_advection().
///
/// | symbol   | shape | unit         |                                                        |
/// | x        | m + 1 + n | Pa, m, U | unknowns of the flow [m], u of the entity and its ends |
/// | r        | 1 + n | Q/s          | for energy W                                           |
/// | q        | n     | m^3/s        | outward flow through ends (2D: m^2/s)                  |
/// | capacity |       | Q/(m^3 U)    | c                                                      |
/// | entrance | n     |              | 1: end at which fluid of unknown u may enter           |
template <class Flow, class Carried>
struct Advection {
  static constexpr int n = Flow::n_ends, m = Flow::Columns::size;
  using Columns = typename Joined<typename Flow::Columns, Carried>::Slots;
  using Rows = Carried;
  static_assert(Rows::size == 1 + n);
  Flow flow;
  Real capacity;
  ConstView<char**> entrance = {};  // empty: none

  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&x)[m + 1 + n], Real (&r)[1 + n]) const {
    Real q[n], dq[n][m];
    find_flow(e, x, q, dq);
    r[0] = 0;
    for (int i = 0; i < n; ++i) {
      const Real rise = capacity * q[i] * (x[m + 1 + i] - x[m]);  // along the outward flow
      r[0] += q[i] < 0 ? rise : 0;
      r[1 + i] = q[i] > 0 ? rise : enters(e, i) ? -rise : 0;
    }
  }

  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&x)[m + 1 + n], Real (&J)[1 + n][m + 1 + n]) const {
    Real q[n], dq[n][m];
    find_flow(e, x, q, dq);
    for (auto& row : J)
      for (Real& value : row) value = 0;
    for (int i = 0; i < n; ++i) {
      if (q[i] == 0) continue;
      const auto add = [&](int row, Real c) {
        for (int k = 0; k < m; ++k) J[row][k] += c * dq[i][k] * (x[m + 1 + i] - x[m]);
        J[row][m] -= c * q[i];
        J[row][m + 1 + i] += c * q[i];
      };
      add(q[i] > 0 ? 1 + i : 0, capacity);
      if (q[i] < 0 && enters(e, i)) add(1 + i, -capacity);
    }
  }

 private:
  KOKKOS_INLINE_FUNCTION bool enters(int e, int i) const { return entrance.extent(0) > 0 && entrance(e, i) != 0; }
  /// Computes the flows. Flows at the level of round-off, e.g. through a closed end, are set to zero. They would
  /// otherwise transport the value of one side or the other, depending on the iterate.
  KOKKOS_INLINE_FUNCTION void find_flow(int e, const Real (&x)[m + 1 + n], Real (&q)[n], Real (&dq)[n][m]) const {
    constexpr Real rounding = 64 * 2.2e-16;
    Real drivers[m];
    for (int k = 0; k < m; ++k) drivers[k] = x[k];
    flow.flow(e, drivers, q);
    flow.dflow(e, drivers, dq);
    for (int i = 0; i < n; ++i) {
      Real sum = 0;
      for (int k = 0; k < m; ++k) sum += dq[i][k] * x[k] < 0 ? -dq[i][k] * x[k] : dq[i][k] * x[k];
      if ((q[i] < 0 ? -q[i] : q[i]) <= rounding * sum) q[i] = 0;
    }
  }
};

}  // namespace sprekk::transport
