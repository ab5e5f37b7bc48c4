// What kernels read of the mesh's cells, and the rule by which they integrate over one.
#pragma once

#include "assembly/reference_cell.hpp"

namespace sprekk::mesh {
struct Mesh;
}

namespace sprekk::assembly {

/// What a kernel over cells reads of the mesh, which must stay as it is.
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

/// Calls use(rule) with the rule for a cell with nodes at X: `Straight`, or CurvedQuadrature where it is not straight.
template <Shape shape, class Straight, class Use>
KOKKOS_INLINE_FUNCTION void with_rule(const Real (&X)[mesh::n_nodes(shape)][mesh::dimension(shape)], const Use& use) {
  if (ReferenceCell<shape>::is_straight(X))
    use(Straight());
  else if constexpr (mesh::order(shape) == 2)
    use(CurvedQuadrature<shape>(X));
}

}  // namespace sprekk::assembly
