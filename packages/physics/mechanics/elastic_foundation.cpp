#include "physics/mechanics/elastic_foundation.hpp"

#include "assembly/kernel_module.hpp"
#include "base/host_table.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace sprekk::physics {

namespace {

/// Springs under one boundary face.
///
/// | symbol | shape              | unit |                                                             |
/// | x      | u [node, dim]      | m    | displacement of the face's nodes                            |
/// | r      | [node, dim]        | N    | forces                                                      |
/// | mass   | [face, node, node] | m^2  | integral N_a N_b; zero on other boundaries                  |
/// | K      | [face, dim, dim]   | Pa/m | stiffness                                                   |
template <mesh::Shape shape>
struct SprungFace {
  static constexpr int dim = mesh::dimension(shape), n = mesh::n_face_nodes(shape);
  using Columns = assembly::Slots<assembly::Slot<n, dim>>;
  using Rows = Columns;
  static constexpr auto loop = assembly::Loop::boundary_faces;
  static constexpr std::array fields = {"displacement"};

  View<Real***> mass, K;

  KOKKOS_INLINE_FUNCTION void residual(int face, const Real (&x)[Columns::size], Real (&r)[Rows::size]) const {
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < dim; ++i) {
        r[a * dim + i] = 0;
        for (int b = 0; b < n; ++b)
          for (int j = 0; j < dim; ++j) r[a * dim + i] += K(face, i, j) * mass(face, a, b) * x[b * dim + j];
      }
  }

  KOKKOS_INLINE_FUNCTION void jacobian(int face, const Real (&)[Columns::size],
                                       Real (&J)[Rows::size][Columns::size]) const {
    for (int a = 0; a < n; ++a)
      for (int b = 0; b < n; ++b)
        for (int i = 0; i < dim; ++i)
          for (int j = 0; j < dim; ++j) J[a * dim + i][b * dim + j] = K(face, i, j) * mass(face, a, b);
  }
};

/// Calls use(number, face) for the faces with springs.
template <class Use>
void for_each_sprung(const mesh::Mesh& mesh, const ElasticFoundationParameters& parameters, const Use& use) {
  for (std::size_t f = 0; f < mesh.boundary_faces.size(); ++f) {
    const auto& face = mesh.boundary_faces[f];
    const bool here = parameters.region < 0 || mesh.cell_region[face.cell] == parameters.region;
    if (face.boundary == parameters.boundary && here) use(f, face);
  }
}

/// Computes integral N_a N_b over the faces with springs, [face, node, node]; zero on other faces.
template <mesh::Shape shape>
View<Real***> boundary_mass(const mesh::Mesh& mesh, const ElasticFoundationParameters& parameters) {
  constexpr int n = mesh::n_face_nodes(shape);
  const base::HostTable<Real***> mass("mass", mesh.boundary_faces.size(), n, n);
  for_each_sprung(mesh, parameters, [&](std::size_t f, const auto& face) {
    const auto add = [&](const auto& N, Real area, const auto&) {
      for (int a = 0; a < n; ++a)
        for (int b = 0; b < n; ++b) mass(f, a, b) += area * N[a] * N[b];
    };
    assembly::for_each_face_point(mesh, face.cell, face.local_face, add);
  });
  return mass.on_device();
}

/// Outward unit normal of a face.
mesh::Vector normal_of(const mesh::Mesh& mesh, const mesh::Mesh::BoundaryFace& face) {
  using mesh::operator*;
  const auto area = mesh::area_vector(mesh::face_corners(mesh, face.cell, face.local_face));
  return (1 / mesh::norm(area)) * area;
}

/// Computes K of the faces with springs, [face, dim, dim]; zero on other faces.
View<Real***> stiffness(const mesh::Mesh& mesh, const ElasticFoundationParameters& parameters) {
  const auto& k = parameters.stiffness;
  const base::HostTable<Real***> K("K", mesh.boundary_faces.size(), mesh.dim(), mesh.dim());
  for_each_sprung(mesh, parameters, [&](std::size_t f, const auto& face) {
    const auto n = normal_of(mesh, face);
    for (int i = 0; i < mesh.dim(); ++i)
      for (int j = 0; j < mesh.dim(); ++j)
        K(f, i, j) = parameters.along_normal ? k[0] * n[i] * n[j] : i == j ? k[i] : 0;
  });
  return K.on_device();
}

/// Components of the displacement with a spring, of local nodes.
std::vector<contact::Support> supports(const mesh::Mesh& mesh, const ElasticFoundationParameters& parameters) {
  std::set<std::pair<LocalIndex, int>> constrained;
  std::vector<contact::Support> all;
  for_each_sprung(mesh, parameters, [&](std::size_t, const auto& face) {
    for (int k = 0; k < mesh::n_face_nodes(mesh.shape); ++k) {
      const int corner = mesh::face_nodes(mesh.shape)[face.local_face][k];
      const LocalIndex node = mesh.free_node(mesh.cells[face.cell * mesh.nodes_per_cell() + corner]);
      if (parameters.along_normal && parameters.stiffness[0] > 0)
        all.push_back({node * mesh.dim(), 0, normal_of(mesh, face)});
      for (int i = 0; i < mesh.dim() && !parameters.along_normal; ++i)
        if (parameters.stiffness[i] > 0) constrained.emplace(node * mesh.dim() + i, i);
    }
  });
  for (const auto& [unknown, component] : constrained) all.push_back({unknown, component});
  return all;
}

}  // namespace

std::unique_ptr<assembly::Module> make_elastic_foundation(const mesh::Mesh& mesh,
                                                          const ElasticFoundationParameters& parameters) {
  const auto& k = parameters.stiffness;
  assembly::Description foundation{
      "elastic foundation", fmt::format("{}, {}: {}{}", parameters.boundary, parameters.region, fmt::join(k, ", "),
                                        parameters.along_normal ? " along the normal" : "")};
  foundation.linear = true;
  foundation.constrains_bodies = *std::max_element(k.begin(), k.end()) > 0;
  foundation.supports = supports(mesh, parameters);
  return mesh::for_shape(mesh.shape, [&](auto shape) {
    const auto mass = boundary_mass<shape()>(mesh, parameters);
    const auto K = stiffness(mesh, parameters);
    return assembly::make_kernel_module(foundation, SprungFace<shape()>{mass, K});
  });
}

}  // namespace sprekk::physics
