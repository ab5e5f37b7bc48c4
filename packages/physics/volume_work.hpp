// The work of a pressure on a volume that displacements change.
#pragma once

#include "assembly/assembler.hpp"

namespace sprekk::physics {

/// A pressure p and displacements that change the volume V it works on.
///
/// | symbol    | shape          | unit  |                                                        |
/// | x         | displacements [m], p | m, Pa | unknowns                                         |
/// | r         | forces [m], dV/dt    | N, m^3/s (2D: m^2/s) | -(p - p_0) dV/du, rate V          |
/// | volume    | [entity, m]    | m^2   | dV/du                                                  |
/// | reference | [entity]       | Pa    | p_0; empty: zero                                       |
/// | rate      |                | 1/s   | of assembly::State                                     |
template <class... Displacements>
struct VolumeWork {
  using Columns = assembly::Slots<Displacements..., assembly::Slot<1, 1>>;
  using Rows = Columns;
  static constexpr int m = Columns::size - 1, last = sizeof...(Displacements);
  static constexpr bool couples(int row, int column) { return (row == last) != (column == last); }
  View<Real**> volume;
  ConstView<Real*> reference = {};
  Real rate = 0;

  KOKKOS_INLINE_FUNCTION void residual(int e, const Real (&x)[m + 1], Real (&r)[m + 1]) const {
    const Real p = x[m] - (reference.extent(0) > 0 ? reference(e) : 0);
    r[m] = 0;
    for (int k = 0; k < m; ++k) {
      r[k] = -volume(e, k) * p;
      r[m] += rate * volume(e, k) * x[k];
    }
  }
  KOKKOS_INLINE_FUNCTION void jacobian(int e, const Real (&)[m + 1], Real (&J)[m + 1][m + 1]) const {
    for (auto& row : J)
      for (Real& value : row) value = 0;
    for (int k = 0; k < m; ++k) {
      J[k][m] = -volume(e, k);
      J[m][k] = rate * volume(e, k);
    }
  }
};

}  // namespace sprekk::physics
