// Host module with an additional unknown: grout sealed in the fractures, which resists compression.
#pragma once

#include "mesh/extents.hpp"
#include "model/model.hpp"

namespace hosts {

using namespace sprekk;

/// Grout at one side of one fracture face. The volume of grout in the face is |f| (w_n + h), with the mean normal jump
/// w_n. Its pressure p = -K w_n/h acts on both sides. Rows:
///   displacement, side bubble   - p d(volume)/d(u, beta)
///   grout pressure              - |f| (w_n + h p/K)
///
/// | symbol | shape                        | unit      |                                                              |
/// | x      | u [node, dim], beta [dim], p | m, m, Pa  | unknowns                                                     |
/// | r      | rows of these unknowns       | N, N, m^3 |                                                              |
/// | V      | [side, as x]                 | m^2       | d(volume)/d(u, beta, h), part of this side                   |
/// | h_K    |                              | m/Pa      | h/K, thickness at zero displacement over bulk modulus        |
template <mesh::Shape shape>
struct GroutedSide {
  static constexpr int dim = mesh::dimension(shape), n = mesh::n_nodes(shape), p = n * dim + dim;
  using Columns = assembly::Slots<assembly::Slot<n, dim>, assembly::Slot<1, dim>, assembly::Slot<1, 1>>;
  using Rows = Columns;
  static constexpr auto loop = assembly::Loop::fracture_sides;
  static constexpr std::array fields = {"displacement", "side bubble", "grout pressure"};

  View<Real**> V;
  Real h_K;

  KOKKOS_INLINE_FUNCTION void residual(int side, const Real (&x)[p + 1], Real (&r)[p + 1]) const {
    r[p] = -V(side, p) * h_K * x[p];
    for (int c = 0; c < p; ++c) {
      r[c] = -V(side, c) * x[p];
      r[p] -= V(side, c) * x[c];
    }
  }

  KOKKOS_INLINE_FUNCTION void jacobian(int side, const Real (&)[p + 1], Real (&J)[p + 1][p + 1]) const {
    for (auto& row : J)
      for (Real& value : row) value = 0;
    for (int c = 0; c < p; ++c) J[c][p] = J[p][c] = -V(side, c);
    J[p][p] = -V(side, p) * h_K;
  }
};

/// Returns the module with h, m, and K, Pa. In the local group of contact, p is eliminated face by face; with "", p
/// remains in the linear system. Throws an Error for enriched tips.
inline auto make_grout(const mesh::Mesh& mesh, Real h, Real K, const std::string& local_group = "fracture face") {
  const fields::Field pressure{"grout pressure", fields::Entity::fracture_face, 1, "Pa"};
  assembly::Description grout{"grout", fmt::format("h = {} m, K = {} Pa", h, K)};
  grout.unknowns = {{pressure, "stress", {{"displacement", mesh::typical_face_area(mesh)}}}};
  grout.unknowns[0].local_group = local_group;
  grout.linear = true;  // constant and symmetric Jacobian
  return mesh::for_shape(mesh.shape, [&](auto shape) {
    return assembly::make_kernel_module(grout, GroutedSide<shape()>{assembly::layer_volumes(mesh), h / K});
  });
}

}  // namespace hosts
