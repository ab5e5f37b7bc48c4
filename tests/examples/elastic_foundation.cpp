#include "examples/elastic_foundation.hpp"

#include "assembly/kernel_module.hpp"

#include <fmt/ranges.h>

namespace sprekk::examples {

namespace {

/// The springs under one boundary face.
///
/// | symbol | shape              | unit |                                                             |
/// | x      | u [node, dim]      | m    | displacement of the face's nodes                            |
/// | r      | [node, dim]        | N    | forces                                                      |
/// | mass   | [face, node, node] | m^2  | integral N_a N_b; zero where the boundary is another one    |
/// | k      | [dim]              | Pa/m | stiffness                                                   |
template <mesh::Shape shape>
struct SprungFace {
  static constexpr int dim = mesh::dimension(shape), n = mesh::n_face_nodes(shape);
  using Columns = assembly::Slots<assembly::Slot<n, dim>>;
  using Rows = Columns;
  static constexpr auto loop = assembly::Loop::boundary_faces;
  static constexpr std::array fields = {"displacement"};

  View<Real***> mass;
  Kokkos::Array<Real, 3> k;

  KOKKOS_INLINE_FUNCTION void residual(int face, const Real (&x)[Columns::size], Real (&r)[Rows::size]) const {
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < dim; ++i) {
        r[a * dim + i] = 0;
        for (int b = 0; b < n; ++b) r[a * dim + i] += k[i] * mass(face, a, b) * x[b * dim + i];
      }
  }

  KOKKOS_INLINE_FUNCTION void jacobian(int face, const Real (&)[Columns::size],
                                       Real (&J)[Rows::size][Columns::size]) const {
    for (auto& row : J)
      for (Real& value : row) value = 0;
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b)
        for (int i = 0; i < dim; ++i) J[a * dim + i][b * dim + i] = k[i] * mass(face, a, b);
  }
};

/// integral N_a N_b over each face of a boundary, [face, node, node]; zero for the faces of others.
template <mesh::Shape shape>
View<Real***> boundary_mass(const mesh::Mesh& mesh, int boundary) {
  constexpr int n = mesh::n_face_nodes(shape);
  const View<Real***> mass("mass", mesh.boundary_faces.size(), n, n);
  const auto host = Kokkos::create_mirror_view(mass);
  for (std::size_t f = 0; f < mesh.boundary_faces.size(); ++f) {
    const auto& face = mesh.boundary_faces[f];
    if (face.boundary != boundary) continue;
    const auto add = [&](const auto& N, Real area, const auto&) {
      for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) host(f, a, b) += area * N[a] * N[b];
    };
    assembly::for_each_face_point<shape>(mesh, face.cell, face.local_face, add);
  }
  Kokkos::deep_copy(mass, host);
  return mass;
}

}  // namespace

std::unique_ptr<assembly::Module> make_elastic_foundation(const mesh::Mesh& mesh,
                                                          const ElasticFoundationParameters& parameters) {
  const auto& k = parameters.stiffness;
  assembly::Description foundation{"elastic foundation",
                                   fmt::format("{}: {}", parameters.boundary, fmt::join(k, ", "))};
  foundation.linear = true;
  foundation.holds_bodies = true;
  return mesh::for_shape(mesh.shape, [&](auto shape) {
    const auto mass = boundary_mass<shape()>(mesh, parameters.boundary);
    return assembly::make_kernel_module(foundation, SprungFace<shape()>{mass, {k[0], k[1], k[2]}});
  });
}

}  // namespace sprekk::examples
