// Flow along one fracture face, treated as a cell of dimension d - 1.
#pragma once

#include "mesh/facets.hpp"
#include "transport/hybrid_cell.hpp"

namespace sprekk::transport {

/// Fracture face in its own coordinates, with the flow matrix for a transmissivity. On lines (2D) rt0 and mimetic are
/// the same.
template <Shape shape>
class FacePlane {
 public:
  static constexpr int dim = mesh::dimension(shape), n = mesh::n_face_corners(shape);
  Real T[n][n] = {}, d[n][3] = {};  // flow matrix; vectors from the face centre to the ridge centres, m
  Real area = 0;

  FacePlane(const mesh::Mesh& mesh, LocalIndex face, Real transmissivity, FluxScheme scheme) {
    const auto& f = mesh.fracture_faces[face];
    if constexpr (dim == 2) {
      area = f.area;
      for (int k = 0; k < n; ++k) {
        const auto x = mesh::ridge_centre(mesh, face, k);
        for (int i = 0; i < dim; ++i) d[k][i] = x[i] - f.centre[i];
        for (int j = 0; j < n; ++j)
          T[k][j] = 2 * transmissivity / area * (scheme == FluxScheme::tpfa ? j == k : 1 + (j == k));
      }
    } else {
      constexpr Shape plane = mesh::face_shape(shape);
      const int side = f.cell[mesh::minus] >= 0 ? mesh::minus : mesh::plus;
      Real X[n][2];
      for (int k = 0; k < n; ++k)
        for (int t = 0; t < 2; ++t) {
          X[k][t] = 0;
          for (int i = 0; i < 3; ++i)
            X[k][t] += f.frame[1 + t][i] * (mesh.coordinates[f.nodes[side][k] * 3 + i] - f.centre[i]);
        }
      const CellFaces<plane> ends(X);
      const FlowMatrix<plane> matrix(ends, laws::Mobility::isotropic(transmissivity), scheme);
      area = ends.volume;
      for (int k = 0; k < n; ++k) {
        for (int i = 0; i < 3; ++i) d[k][i] = ends.centre[k][0] * f.frame[1][i] + ends.centre[k][1] * f.frame[2][i];
        for (int j = 0; j < n; ++j) T[k][j] = matrix.T[k][j];
      }
    }
  }
};

}  // namespace sprekk::transport
