// Tables of cells for kernels, and integrals over cells and faces on the host.
#pragma once

#include "assembly/cell_nodes.hpp"
#include "base/host_table.hpp"
#include "mesh/mesh.hpp"

#include <array>
#include <functional>
#include <vector>

namespace sprekk::assembly {

using base::to_device;

/// Returns the material number of each local cell. If `of_cell` is empty, the number is that of the region.
inline ConstView<int*> material_numbers(const Geometry& geometry, const std::vector<int>& of_cell) {
  return of_cell.empty() ? geometry.region : to_device(of_cell, "material of cells");
}

/// Copies the coordinates of the first n nodes of a cell on the host, n = n_nodes(shape). In a mesh of order 2, a
/// `shape` of order 1 selects the corners.
template <Shape shape>
void gather_host(const mesh::Mesh& mesh, LocalIndex cell, Real (&X)[mesh::n_nodes(shape)][mesh::dimension(shape)]) {
  constexpr int dim = mesh::dimension(shape), n = mesh::n_nodes(shape);
  const LocalIndex* const nodes = &mesh.cells[cell * mesh.nodes_per_cell()];
  for (int a = 0; a < n; ++a)
    for (int i = 0; i < dim; ++i) X[a][i] = mesh.coordinates[nodes[a] * dim + i];
}

/// Calls visit(xi, volume, x) at the points of a quadrature rule, by default that of bubbles. xi is the reference
/// point, x the position, and `volume` the weight of the point, m^3 (m^2 in 2D).
template <Shape shape, class Straight = BubbleQuadrature<shape>, class Visit>
void for_each_cell_point(const mesh::Mesh& mesh, LocalIndex cell, const Visit& visit) {
  constexpr int dim = mesh::dimension(shape), n = mesh::n_nodes(shape);
  Real X[n][dim], N[n], dN[n][dim], xi[dim];
  gather_host<shape>(mesh, cell, X);
  with_rule<shape, Straight>(X, [&](const auto& rule) {
    for (int q = 0; q < rule.n; ++q) {
      const Real weight = rule.at(q, xi);
      ReferenceCell<shape>::shape_functions(xi, N);
      ReferenceCell<shape>::gradients(xi, dN);
      const CellPoint<shape> point(X, dN);
      std::array<Real, 3> x{};
      for (int a = 0; a < n; ++a)
        for (int i = 0; i < dim; ++i) x[i] += N[a] * X[a][i];
      visit(xi, weight * point.volume, x);
    }
  });
}

/// Callback with the weight of a point, m^3 (m^2 in 2D), and its position, m.
using VisitCellPoint = std::function<void(Real volume, const std::array<Real, 3>& x)>;

/// Calls visit at the points of the bubble rule in a cell.
void for_each_cell_point(const mesh::Mesh& mesh, LocalIndex cell, const VisitCellPoint& visit);

/// Returns the volume of a cell and the mean of value(x) over it.
std::array<Real, 2> cell_mean(const mesh::Mesh& mesh, LocalIndex cell,
                              const std::function<Real(const std::array<Real, 3>& x)>& value);

/// Values at the nodes of a face, in the order of face_nodes(shape).
using FaceValues = std::array<Real, mesh::max_face_nodes>;

/// Callback with the face's shape functions, the weight of the point, m^2 (m in 2D), and its position, m.
using VisitFacePoint = std::function<void(const FaceValues& N, Real area, const std::array<Real, 3>& x)>;

/// Calls visit at the quadrature points of a cell face. The rule is exact for degree 5 on affine faces.
void for_each_face_point(const mesh::Mesh& mesh, LocalIndex cell, int local_face, const VisitFacePoint& visit);

/// Returns the mean of value(N, x) over a face; see VisitFacePoint for the arguments.
Real face_mean(const mesh::Mesh& mesh, LocalIndex cell, int local_face,
               const std::function<Real(const FaceValues& N, const std::array<Real, 3>& x)>& value);

/// Returns ReferenceCell::bubble on its own face, from the face's shape functions N.
Real face_bubble(Shape shape, const FaceValues& N);

/// Returns the weight of each node in the mean over a face: mean(v) = sum_k share_k v_k.
FaceValues mean_shares(const mesh::Mesh& mesh, LocalIndex cell, int local_face);

/// Returns the mean of the bubble over its face. On affine faces it is 2/3 (edge), 9/20 (triangle) or 4/9
/// (quadrilateral).
Real bubble_mean(const mesh::Mesh& mesh, LocalIndex cell, int local_face);

/// Returns the volume of each local cell, m^3 (m^2 in 2D). Not collective.
std::vector<Real> cell_volumes(const mesh::Mesh& mesh);

}  // namespace sprekk::assembly
