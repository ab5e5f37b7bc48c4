// Forces between one side of a fracture face and the adjacent rock.
#pragma once

#include "assembly/reference_cell.hpp"
#include "assembly/slots.hpp"

namespace sprekk::physics {

/// Balance of one side of a fracture face; all coefficients are constant. u: nodal displacements, or the tip
/// displacements with psi_a instead of N_a.
///
/// | symbol    | shape            | unit |                                                            |
/// | x         | u [node, dim], beta [dim], lambda [dim] | m, m, Pa | unknowns                       |
/// | r         | displacement rows [node, dim], side bubble rows [dim] | N | forces                    |
/// | coupling  | [side, dim, node dim] | N/m  | integral sigma(N_a e_j) : grad(b e_i)                 |
/// | stiffness | [side]           | N/m  | alpha                                                      |
/// | push      | [side, node]     | m^2  | s |f| times the node's share in the face mean; s: sign of the side |
/// | bubble    | [side]           | m^2  | s |f| mean(b)                                              |
/// | frame     | [side, dim, dim] | -    | rows n, t1[, t2]                                           |
/// | force     | [side, dim]      | N    | load on the bubble: integral F_i b, initial stress         |
/// | nodal     | [side, node dim] | N    | load on the nodes: initial stress; empty: none             |
/// | pressure  | [side]           | Pa   | fluid pressure; empty: none                                |
template <mesh::Shape shape>
struct BalancedSide {
  using Cell = assembly::ReferenceCell<shape>;
  static constexpr int dim = Cell::dim, n = Cell::n_nodes;
  using Columns = assembly::Slots<assembly::Slot<n, dim>, assembly::Slot<1, dim>, assembly::Slot<1, dim>>;
  using Rows = assembly::Slots<assembly::Slot<n, dim>, assembly::Slot<1, dim>>;
  static constexpr int beta = n * dim, lambda = beta + dim;  // offsets in x
  static constexpr bool couples(int row, int column) { return row > 0 || column > 0; }

  View<Real***> coupling, frame;
  View<Real*> stiffness, bubble, pressure;
  View<Real**> push, force, nodal;

  explicit BalancedSide(std::size_t n_sides)
      : coupling("coupling", n_sides, dim, n * dim),
        frame("frame", n_sides, dim, dim),
        stiffness("stiffness", n_sides),
        bubble("bubble", n_sides),
        push("push", n_sides, n),
        force("force", n_sides, dim) {}

  KOKKOS_INLINE_FUNCTION void residual(int side, const Real (&x)[Columns::size], Real (&r)[Rows::size]) const {
    const Real p = pressure.extent(0) > 0 ? pressure(side) : 0;
    Real traction[dim] = {};  // global components
    for (int i = 0; i < dim; ++i)
      for (int k = 0; k < dim; ++k) traction[i] += frame(side, k, i) * (x[lambda + k] - (k == 0 ? p : 0));
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < dim; ++i) {
        r[a * dim + i] = push(side, a) * traction[i] - (nodal.extent(0) > 0 ? nodal(side, a * dim + i) : 0);
        for (int k = 0; k < dim; ++k) r[a * dim + i] += coupling(side, k, a * dim + i) * x[beta + k];
      }
    for (int k = 0; k < dim; ++k) {
      r[beta + k] = stiffness(side) * x[beta + k] + bubble(side) * traction[k] - force(side, k);
      for (int c = 0; c < n * dim; ++c) r[beta + k] += coupling(side, k, c) * x[c];
    }
  }

  KOKKOS_INLINE_FUNCTION void jacobian(int side, const Real (&)[Columns::size],
                                       Real (&J)[Rows::size][Columns::size]) const {
    for (auto& row : J)
      for (Real& value : row) value = 0;
    for (int k = 0; k < dim; ++k) {
      for (int c = 0; c < n * dim; ++c) J[beta + k][c] = J[c][beta + k] = coupling(side, k, c);
      J[beta + k][beta + k] = stiffness(side);
      for (int i = 0; i < dim; ++i) {
        for (int a = 0; a < n; ++a) J[a * dim + i][lambda + k] = push(side, a) * frame(side, k, i);
        J[beta + i][lambda + k] = bubble(side) * frame(side, k, i);
      }
    }
  }
};

}  // namespace sprekk::physics
