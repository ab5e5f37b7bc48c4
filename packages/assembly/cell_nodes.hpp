// Mesh data of cells for kernels, and the choice of the quadrature rule of a cell.
#pragma once

#include "assembly/reference_cell.hpp"

namespace sprekk::mesh {
struct Mesh;
}

namespace sprekk::assembly {

/// Mesh data that kernels over cells read. The views may refer to the mesh: do not change or destroy it.
struct Geometry {
  ConstView<Real**> coordinates;  ///< [node, component], m
  ConstView<LocalIndex**> cells;  ///< [cell, local node]
  ConstView<int*> region;         ///< [cell]

  Geometry() = default;
  explicit Geometry(const mesh::Mesh& mesh);

  /// Copies the node coordinates of a cell, [local node][component].
  template <int n, int dim>
  KOKKOS_INLINE_FUNCTION void gather(LocalIndex cell, Real (&X)[n][dim]) const {
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < dim; ++i) X[a][i] = coordinates(cells(cell, a), i);
  }
};

/// Calls use(rule) with the quadrature rule of a cell with nodes at X. The rule is `Straight` for straight cells and
/// CurvedQuadrature for other cells of order 2.
template <Shape shape, class Straight, class Use>
KOKKOS_INLINE_FUNCTION void with_rule(const Real (&X)[mesh::n_nodes(shape)][mesh::dimension(shape)], const Use& use) {
  if (ReferenceCell<shape>::is_straight(X))
    use(Straight());
  else if constexpr (mesh::order(shape) == 2)
    use(CurvedQuadrature<shape>(X));
}

}  // namespace sprekk::assembly
