// Flow of a fluid whose properties depend on a transported field.
#pragma once

#include "laws/fluid_response.hpp"
#include "transport/hybrid_cell.hpp"

namespace sprekk::transport {

template <class A, class B>
struct Joined;
template <class... A, class... B>
struct Joined<assembly::Slots<A...>, assembly::Slots<B...>> {
  using Slots = assembly::Slots<A..., B...>;
};

/// Flow of `Flow`, mass divided by rho_0, with the field u of the entity as additional last unknown:
///   q = m d (q_p + d q_g).
/// q_p and q_g are the flows due to pressures and weight. d = rho/rho_0 at the reference pressure and m = mu_0/mu
/// depend on u.
template <class Flow>
struct ChangedFlow {
  static constexpr int n_ends = Flow::n_ends, n = n_ends, m = Flow::Columns::size;
  static_assert(m == 1 + n);
  using Columns = typename Joined<typename Flow::Columns, assembly::Slots<assembly::Slot<1, 1>>>::Slots;
  using Rows = typename Flow::Rows;
  Flow base;
  laws::FluidResponse response;

  KOKKOS_INLINE_FUNCTION auto at(int e) const { return base.at(e); }
  KOKKOS_INLINE_FUNCTION void flow(int e, const Real (&x)[m + 1], Real (&q)[n]) const { flow_of(at(e), x, q); }
  KOKKOS_INLINE_FUNCTION void dflow(int e, const Real (&x)[m + 1], Real (&dq)[n][m + 1]) const {
    dflow_of(at(e), x, dq);
  }

  /// flow() and its derivatives with another HybridFlow in place of at().
  KOKKOS_INLINE_FUNCTION void flow_of(const HybridFlow<n>& here, const Real (&x)[m + 1], Real (&q)[n]) const {
    Real p[m];
    for (int k = 0; k < m; ++k) p[k] = x[k];
    here.heavier(response.density(x[m]).value).flow(p, q);
    const Real factor = response.flow(x[m]).value;
    for (Real& each : q) each *= factor;
  }

  KOKKOS_INLINE_FUNCTION void dflow_of(const HybridFlow<n>& here, const Real (&x)[m + 1], Real (&dq)[n][m + 1]) const {
    Real p[m], q[n], weightless[n], by_p[n][m];
    for (int k = 0; k < m; ++k) p[k] = x[k];
    const auto density = response.density(x[m]), factor = response.flow(x[m]);
    const auto heavy = here.heavier(density.value);
    heavy.flow(p, q);
    heavy.dflow(p, by_p);
    here.heavier(0).flow(p, weightless);
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < m; ++k) dq[i][k] = factor.value * by_p[i][k];
      const Real by_weight = (q[i] - weightless[i]) / density.value;
      dq[i][m] = factor.slope * q[i] + factor.value * density.slope * by_weight;
    }
  }

  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&x)[m + 1], Real (&r)[1 + n]) const {
    Real q[n];
    flow(e, x, q);
    balance(q, r);
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&x)[m + 1], Real (&J)[1 + n][m + 1]) const {
    Real dq[n][m + 1];
    dflow(e, x, dq);
    balance(dq, J);
  }
};

}  // namespace sprekk::transport
