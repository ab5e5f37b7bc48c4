// Volume of a layer between the sides of a fracture.
#pragma once

#include "assembly/geometry.hpp"
#include "assembly/loop.hpp"
#include "base/check.hpp"
#include "base/host_table.hpp"

namespace sprekk::assembly {

/// Returns the coefficients V of the layer volume, m^2 (m in 2D), [side of Loop::fracture_sides, node dim + dim + 1]. A
/// layer of thickness h at u = 0 has the volume |f| (w_n + h) on a face f, with the mean w_n of n . (u+ - u-).
/// The sum of V . (u [node of the side's cell, dim], beta [dim], h) over both sides of a face gives this volume. Each
/// side contributes half of the thickness. Throws an Error if tips are enriched. Not collective.
template <Shape shape>
View<Real**> layer_volumes(const mesh::Mesh& mesh) {
  SPREKK_CHECK(
      mesh.n_global_enriched == 0,
      "the volume of a layer in a fracture is not known where crack tips are enriched; give the mesh plain tips");
  constexpr int dim = mesh::dimension(shape), bubble = mesh::n_nodes(shape) * dim;
  const auto sides = fracture_sides(mesh);
  const base::HostTable<Real**> V("layer volumes", sides.size(), bubble + dim + 1);
  for (std::size_t s = 0; s < sides.size(); ++s) {
    const auto& face = mesh.fracture_faces[sides[s][0]];
    const int side = sides[s][1], local_face = face.local_face[side];
    const auto shares = mean_shares(mesh, face.cell[side], local_face);
    const Real mean = bubble_mean(mesh, face.cell[side], local_face);
    for (int i = 0; i < dim; ++i) {
      const Real area = (side == mesh::plus ? face.area : -face.area) * face.frame[0][i];
      for (int k = 0; k < mesh::n_face_nodes(shape); ++k)
        V(s, mesh::face_nodes(shape)[local_face][k] * dim + i) = area * shares[k];
      V(s, bubble + i) = area * mean;
    }
    V(s, bubble + dim) = face.area / 2;
  }
  return V.on_device();
}

}  // namespace sprekk::assembly
