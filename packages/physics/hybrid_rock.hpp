// The hybrid form on a mesh: its operator on cells, and unknowns that start with given values.
#pragma once

#include "mesh/facets.hpp"
#include "physics/hybrid_diffusion.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::physics {

/// Sets [row of the cell, face] what resists on sides of fractures, 1/(exchange A), where anything does.
template <Shape shape>
void set_resistance(HybridCell<shape>& op, const mesh::Mesh& mesh, const std::vector<Real>& exchange) {
  if (std::all_of(exchange.begin(), exchange.end(), [](Real e) { return std::isinf(e); })) return;
  std::vector<int> beside(mesh.n_cells(), -1);
  int n = 0;
  const auto sides = assembly::fracture_sides(mesh);
  for (const auto& [f, side] : sides)
    if (int& row = beside[mesh.fracture_faces[f].cell[side]]; row < 0) row = n++;
  View<Real**> resistance("resistance", n, HybridCell<shape>::n);
  const auto host = Kokkos::create_mirror_view(resistance);
  for (const auto& [f, side] : sides) {
    const auto& face = mesh.fracture_faces[f];
    host(beside[face.cell[side]], face.local_face[side]) = 1 / (exchange[f] * face.area);
  }
  Kokkos::deep_copy(resistance, host);
  op.beside = assembly::to_device(beside, "beside");
  op.resistance = resistance;
}

template <Shape shape>
HybridCell<shape> hybrid_cell(const assembly::Context& context, const HybridDiffusionParameters& parameters) {
  const auto& [gx, gy, gz] = parameters.weight;
  HybridCell<shape> op{.geometry = context.geometry(),
                       .mobility = assembly::to_device(parameters.mobility.values, "mobility"),
                       .number = assembly::material_numbers(context.geometry(), parameters.mobility.number),
                       .weight = {gx, gy, gz},
                       .scheme = parameters.scheme,
                       .fluid = parameters.fluid};
  set_resistance(op, *context.mesh(), parameters.exchange);
  return op;
}

/// Sets unknowns of owned cells to the means of u(x, 0) over them, and those of facets, ridges of fractures among them,
/// to u at their centres.
template <Shape shape>
void set_hybrid(const mesh::Mesh& mesh, const base::Expression& u, const View<Real*>& cells,
                const View<Real*>& facets) {
  constexpr int n_faces = mesh::n_faces(shape), n_ridges = mesh::n_face_corners(shape);
  const auto of_cell = Kokkos::create_mirror_view(cells), of_facet = Kokkos::create_mirror_view(facets);
  const auto put = [&](LocalIndex facet, const mesh::Vector& place) {
    if (facet < mesh.facets->n_owned) of_facet(facet) = u(place, 0);
  };
  for (LocalIndex c = 0; c < mesh.n_cells(); ++c) {
    if (c < mesh.n_owned_cells)
      of_cell(c) = assembly::cell_mean<shape>(mesh, c, [&](const auto& x) { return u(x, 0); })[1];
    for (int k = 0; k < n_faces; ++k)
      put(mesh.facets->of_cell[c * n_faces + k], mesh::face_centre(mesh::face_corners(mesh, c, k)));
  }
  for (LocalIndex f = 0; f < mesh.n_fracture_faces(); ++f)
    for (int k = 0; k < n_ridges; ++k) put(mesh.facets->ridge[f * n_ridges + k], mesh::ridge_centre(mesh, f, k));
  Kokkos::deep_copy(cells, of_cell);
  Kokkos::deep_copy(facets, of_facet);
}

}  // namespace sprekk::physics
