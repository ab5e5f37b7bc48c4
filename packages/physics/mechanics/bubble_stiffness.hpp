// Stiffness of the face bubble.
#pragma once

#include "assembly/geometry.hpp"
#include "base/check.hpp"
#include "laws/elasticity.hpp"

#include <Teuchos_LAPACK.hpp>

namespace sprekk::physics {

/// Largest eigenvalue of B_ij = integral sigma(b e_i) : grad(b e_j) over a cell, N/m, for the face function b of one of
/// its faces. Throws an Error if the eigenvalue solver fails.
template <mesh::Shape shape>
Real bubble_stiffness(const mesh::Mesh& mesh, LocalIndex cell, int local_face, const laws::Elasticity& law) {
  using Cell = assembly::ReferenceCell<shape>;
  constexpr int dim = Cell::dim, n = Cell::n_nodes;
  Real X[n][dim], dN[n][dim], db[dim], gb[dim], B[dim * dim] = {}, eigenvalues[dim], work[16];
  assembly::gather_host<shape>(mesh, cell, X);
  assembly::for_each_cell_point<shape>(mesh, cell, [&](const Real(&xi)[dim], Real volume, const auto&) {
    Cell::gradients(xi, dN);
    Cell::bubble(local_face, xi, db);
    assembly::CellPoint<shape>(X, dN).gradient(db, gb);
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j) B[i * dim + j] += volume * law.stiffness(gb, gb, i, j);
  });
  int info = 0;
  Teuchos::LAPACK<int, Real>().SYEV('N', 'U', dim, B, dim, eigenvalues, work, 16, &info);
  SPREKK_CHECK(info == 0, "fracture face of cell {}: the bubble's stiffness has no eigenvalues", mesh.cell_id[cell]);
  return eigenvalues[dim - 1];
}

}  // namespace sprekk::physics
