#include "assembly/geometry.hpp"

#include <cmath>

namespace sprekk::assembly {
namespace {

/// Returns a view of the vector itself if kernels can access host memory, else a copy.
template <class Data, class T, class... Extents>
ConstView<Data> view_of(const std::vector<T>& values, Extents... extents) {
  const typename Kokkos::View<Data, Kokkos::LayoutRight, Kokkos::HostSpace>::const_type host(values.data(), extents...);
  return Kokkos::create_mirror_view_and_copy(Execution::memory_space(), host);
}

/// Implements for_each_face_point for one shape.
template <Shape shape>
void visit_face(const mesh::Mesh& mesh, LocalIndex cell, int local_face, const VisitFacePoint& visit) {
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
    using Rule = Quadrature<face, 4>;  // as accurate for the cell's bubble as the rule of the cell
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

}  // namespace

Geometry::Geometry(const mesh::Mesh& mesh)
    : coordinates(view_of<Real**>(mesh.coordinates, mesh.n_nodes(), mesh.dim())),
      cells(view_of<LocalIndex**>(mesh.cells, mesh.n_cells(), mesh.nodes_per_cell())),
      region(view_of<int*>(mesh.cell_region, mesh.n_cells())) {}

void for_each_cell_point(const mesh::Mesh& mesh, LocalIndex cell, const VisitCellPoint& visit) {
  mesh::for_shape(mesh.shape, [&](auto shape) {
    for_each_cell_point<shape()>(mesh, cell, [&](const auto&, Real volume, const auto& x) { visit(volume, x); });
  });
}

std::array<Real, 2> cell_mean(const mesh::Mesh& mesh, LocalIndex cell,
                              const std::function<Real(const std::array<Real, 3>&)>& value) {
  Real sum = 0, total = 0;
  for_each_cell_point(mesh, cell, [&](Real volume, const auto& x) {
    total += volume;
    sum += volume * value(x);
  });
  return {total, sum / total};
}

void for_each_face_point(const mesh::Mesh& mesh, LocalIndex cell, int local_face, const VisitFacePoint& visit) {
  mesh::for_shape(mesh.shape, [&](auto shape) { visit_face<shape()>(mesh, cell, local_face, visit); });
}

Real face_mean(const mesh::Mesh& mesh, LocalIndex cell, int local_face,
               const std::function<Real(const FaceValues&, const std::array<Real, 3>&)>& value) {
  Real sum = 0, total = 0;
  for_each_face_point(mesh, cell, local_face, [&](const auto& N, Real area, const auto& x) {
    total += area;
    sum += area * value(N, x);
  });
  return sum / total;
}

Real face_bubble(Shape shape, const FaceValues& N) {
  const bool linear = mesh::order(shape) == 1;
  if (mesh::dimension(shape) == 2) return linear ? 4 * N[0] * N[1] : N[2];
  if (mesh::linear(shape) == Shape::tetrahedron) {
    if (linear) return 27 * N[0] * N[1] * N[2];
    return 27 * (N[0] + (N[3] + N[5]) / 2) * (N[1] + (N[3] + N[4]) / 2) * (N[2] + (N[4] + N[5]) / 2);
  }
  if (!linear) return N[8];
  const Real xi = N[1] + N[2] - N[0] - N[3], eta = N[2] + N[3] - N[0] - N[1];
  return (1 - xi * xi) * (1 - eta * eta);
}

FaceValues mean_shares(const mesh::Mesh& mesh, LocalIndex cell, int local_face) {
  FaceValues shares{};
  Real total = 0;
  for_each_face_point(mesh, cell, local_face, [&](const auto& N, Real area, const auto&) {
    total += area;
    for (std::size_t k = 0; k < N.size(); ++k) shares[k] += area * N[k];
  });
  for (auto& share : shares) share /= total;
  return shares;
}

Real bubble_mean(const mesh::Mesh& mesh, LocalIndex cell, int local_face) {
  return face_mean(mesh, cell, local_face, [&](const auto& N, const auto&) { return face_bubble(mesh.shape, N); });
}

std::vector<Real> cell_volumes(const mesh::Mesh& mesh) {
  std::vector<Real> volumes(mesh.n_cells(), 0);
  mesh::for_shape(mesh.shape, [&](auto shape) {
    for (LocalIndex c = 0; c < mesh.n_cells(); ++c)
      for_each_cell_point<shape(), StiffnessQuadrature<shape()>>(
          mesh, c, [&](const auto&, Real share, const auto&) { volumes[c] += share; });
  });
  return volumes;
}

}  // namespace sprekk::assembly
