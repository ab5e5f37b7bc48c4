// Tables of cells for kernels, and integrals over cells and faces on the host.
#pragma once

#include "assembly/cell_nodes.hpp"
#include "mesh/mesh.hpp"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace sprekk::assembly {

template <class T>
ConstView<T*> to_device(const std::vector<T>& from, const std::string& name) {
  View<T*> to(name, from.size());
  const auto host = Kokkos::create_mirror_view(to);
  for (std::size_t i = 0; i < from.size(); ++i) host(i) = from[i];
  Kokkos::deep_copy(to, host);
  return to;
}

/// Which of the different materials each local cell has: as told, or, if nothing is, the number of its region.
inline ConstView<int*> material_numbers(const Geometry& geometry, const std::vector<int>& of_cell) {
  return of_cell.empty() ? geometry.region : to_device(of_cell, "material of cells");
}

/// Coordinates of the first n nodes of a cell on the host, n being that of `shape`: of a mesh of order 2 and a shape of
/// order 1 the corners.
template <Shape shape>
void gather_host(const mesh::Mesh& mesh, LocalIndex cell, Real (&X)[mesh::n_nodes(shape)][mesh::dimension(shape)]) {
  constexpr int dim = mesh::dimension(shape), n = mesh::n_nodes(shape);
  const LocalIndex* const nodes = &mesh.cells[cell * mesh.nodes_per_cell()];
  for (int a = 0; a < n; ++a)
    for (int i = 0; i < dim; ++i) X[a][i] = mesh.coordinates[nodes[a] * dim + i];
}

/// Calls visit(xi, volume, x) at the points of a rule, by default one for bubbles: reference point, volume that it
/// stands for, place.
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

/// The volume that a point stands for, m^3 (m^2 in 2D), and its place.
using VisitCellPoint = std::function<void(Real volume, const std::array<Real, 3>& x)>;

/// Calls visit at the points of the rule for bubbles in a cell.
void for_each_cell_point(const mesh::Mesh& mesh, LocalIndex cell, const VisitCellPoint& visit);

/// A cell's volume and the mean of value(x) over it.
std::array<Real, 2> cell_mean(const mesh::Mesh& mesh, LocalIndex cell,
                              const std::function<Real(const std::array<Real, 3>& x)>& value);

/// Values at the nodes of a face, in the order of face_nodes(shape).
using FaceValues = std::array<Real, mesh::max_face_nodes>;

/// Values of the face's node functions, the area that a point stands for, m^2 (m in 2D), and its place.
using VisitFacePoint = std::function<void(const FaceValues& N, Real area, const std::array<Real, 3>& x)>;

/// Calls visit at quadrature points of a face of a cell, exact for degree 5 on affine faces.
void for_each_face_point(const mesh::Mesh& mesh, LocalIndex cell, int local_face, const VisitFacePoint& visit);

/// The mean over a face of value(N, x), see VisitFacePoint.
Real face_mean(const mesh::Mesh& mesh, LocalIndex cell, int local_face,
               const std::function<Real(const FaceValues& N, const std::array<Real, 3>& x)>& value);

/// The face function of ReferenceCell::bubble on its face, from the values of the face's node functions.
Real face_bubble(Shape shape, const FaceValues& N);

/// Share of each node in the mean over a face: mean(v) = sum_k share_k v_k.
FaceValues mean_shares(const mesh::Mesh& mesh, LocalIndex cell, int local_face);

/// Mean of the face function over a face; 2/3 on edges, 9/20 on triangles, 4/9 on quadrilaterals where the face is an
/// affine map of the reference cell's.
Real bubble_mean(const mesh::Mesh& mesh, LocalIndex cell, int local_face);

/// Of each local cell, m^3 (m^2 in 2D). Not collective.
std::vector<Real> cell_volumes(const mesh::Mesh& mesh);

}  // namespace sprekk::assembly
