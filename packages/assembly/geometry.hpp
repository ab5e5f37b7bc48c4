// Tables of cells for kernels, and integrals over cells and faces on the host.
#pragma once

#include "assembly/cell_nodes.hpp"
#include "mesh/mesh.hpp"

#include <array>
#include <cmath>
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

/// The coordinates of a cell's nodes, on the host.
template <Shape shape>
void gather_host(const mesh::Mesh& mesh, LocalIndex cell, Real (&X)[mesh::n_nodes(shape)][mesh::dimension(shape)]) {
  constexpr int dim = mesh::dimension(shape), n = mesh::n_nodes(shape);
  for (int a = 0; a < n; ++a)
    for (int i = 0; i < dim; ++i) X[a][i] = mesh.coordinates[mesh.cells[cell * n + a] * dim + i];
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

/// Values at the nodes of a face, in the order of face_nodes(shape).
using FaceValues = std::array<Real, mesh::max_face_nodes>;

/// Calls visit(N, area, x) at quadrature points of a face of a cell (exact for degree 5 on affine faces): values of the
/// face's node functions, area that the point stands for, place.
template <Shape shape, class Visit>
void for_each_face_point(const mesh::Mesh& mesh, LocalIndex cell, int local_face, const Visit& visit) {
  constexpr int dim = mesh::dimension(shape), n = mesh::n_face_nodes(shape);
  Real X[mesh::n_nodes(shape)][dim];
  gather_host<shape>(mesh, cell, X);
  const auto nodes = mesh::face_nodes(shape)[local_face];
  const auto finish = [&](const FaceValues& N, const std::array<FaceValues, 2>& dN, Real weight) {
    std::array<Real, 3> x{}, s{}, t{};
    for (int k = 0; k < n; ++k)
      for (int i = 0; i < dim; ++i) {
        x[i] += N[k] * X[nodes[k]][i];
        s[i] += dN[0][k] * (X[nodes[k]][i] - X[nodes[0]][i]);
        t[i] += dN[1][k] * (X[nodes[k]][i] - X[nodes[0]][i]);
      }
    const Real cx = s[1] * t[2] - s[2] * t[1], cy = s[2] * t[0] - s[0] * t[2], cz = s[0] * t[1] - s[1] * t[0];
    const Real stretch = dim == 2 ? std::hypot(s[0], s[1]) : std::sqrt(cx * cx + cy * cy + cz * cz);
    visit(N, weight * stretch, x);
  };
  if constexpr (dim == 2) {
    for (int q = 0; q < 3; ++q) {
      const Real s = Gauss<3>::point(q), weight = Gauss<3>::weight(q);
      if (n == 2)
        finish({(1 - s) / 2, (1 + s) / 2}, {{{-0.5, 0.5}, {}}}, weight);
      else
        finish({s * (s - 1) / 2, s * (s + 1) / 2, 1 - s * s}, {{{s - 0.5, s + 0.5, -2 * s}, {}}}, weight);
    }
  } else {
    constexpr Shape corners = mesh::linear(shape) == Shape::tetrahedron ? Shape::triangle : Shape::quadrilateral;
    constexpr Shape face = mesh::order(shape) == 1 ? corners : mesh::quadratic(corners);
    using Face = ReferenceCell<face>;
    Real xi[2], N[n], dN[n][2];
    using Rule = Quadrature<face, 4>;  // as exact for a bubble of the cell behind as the rule in that cell
    for (int q = 0; q < Rule::n; ++q) {
      const Real weight = Rule::at(q, xi);
      Face::shape_functions(xi, N);
      Face::gradients(xi, dN);
      FaceValues values{};
      std::array<FaceValues, 2> gradients{};
      for (int k = 0; k < n; ++k) {
        values[k] = N[k];
        gradients[0][k] = dN[k][0];
        gradients[1][k] = dN[k][1];
      }
      finish(values, gradients, weight);
    }
  }
}

/// The mean over a face of value(N, x), see for_each_face_point.
template <Shape shape, class Value>
Real face_mean(const mesh::Mesh& mesh, LocalIndex cell, int local_face, const Value& value) {
  Real sum = 0, total = 0;
  for_each_face_point<shape>(mesh, cell, local_face, [&](const auto& N, Real area, const auto& x) {
    total += area;
    sum += area * value(N, x);
  });
  return sum / total;
}

/// A cell's volume and the mean of value(x) over it.
template <Shape shape, class Value>
std::array<Real, 2> cell_mean(const mesh::Mesh& mesh, LocalIndex cell, const Value& value) {
  Real sum = 0, total = 0;
  for_each_cell_point<shape>(mesh, cell, [&](const auto&, Real volume, const auto& x) {
    total += volume;
    sum += volume * value(x);
  });
  return {total, sum / total};
}

/// The face function of ReferenceCell::bubble on its face, from the values of the face's node functions.
template <Shape shape>
Real face_bubble(const FaceValues& N) {
  constexpr bool linear = mesh::order(shape) == 1;
  if (mesh::dimension(shape) == 2) return linear ? 4 * N[0] * N[1] : N[2];
  if (mesh::linear(shape) == Shape::tetrahedron) {
    if (linear) return 27 * N[0] * N[1] * N[2];
    return 27 * (N[0] + (N[3] + N[5]) / 2) * (N[1] + (N[3] + N[4]) / 2) * (N[2] + (N[4] + N[5]) / 2);
  }
  if (!linear) return N[8];
  const Real xi = N[1] + N[2] - N[0] - N[3], eta = N[2] + N[3] - N[0] - N[1];
  return (1 - xi * xi) * (1 - eta * eta);
}

/// Share of each node in the mean over a face: mean(v) = sum_k share_k v_k.
template <Shape shape>
FaceValues mean_shares(const mesh::Mesh& mesh, LocalIndex cell, int local_face) {
  FaceValues shares{};
  Real total = 0;
  for_each_face_point<shape>(mesh, cell, local_face, [&](const auto& N, Real area, const auto&) {
    total += area;
    for (std::size_t k = 0; k < N.size(); ++k) shares[k] += area * N[k];
  });
  for (auto& share : shares) share /= total;
  return shares;
}

/// Mean of the face function over a face; 2/3 on edges, 9/20 on triangles, 4/9 on quadrilaterals where the face is an
/// affine map of the reference cell's.
template <Shape shape>
Real bubble_mean(const mesh::Mesh& mesh, LocalIndex cell, int local_face) {
  return face_mean<shape>(mesh, cell, local_face, [](const auto& N, const auto&) { return face_bubble<shape>(N); });
}

/// Of each local cell, m^3 (m^2 in 2D). Not collective.
std::vector<Real> cell_volumes(const mesh::Mesh& mesh);

}  // namespace sprekk::assembly
