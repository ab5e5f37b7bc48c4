// Operator of the hybrid form on the cells of a mesh.
#pragma once

#include "base/host_table.hpp"
#include "transport/hybrid_diffusion.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::transport {

/// Sets the resistances of fracture sides, 1/(exchange A), in [row of the cell, face]. Without finite `exchange` the
/// operator is unchanged.
template <Shape shape>
void set_resistance(HybridCell<shape>& op, const mesh::Mesh& mesh, const std::vector<Real>& exchange) {
  if (std::all_of(exchange.begin(), exchange.end(), [](Real e) { return std::isinf(e); })) return;
  std::vector<int> beside(mesh.n_cells(), -1);
  int n = 0;
  const auto sides = assembly::fracture_sides(mesh);
  for (const auto& [f, side] : sides)
    if (int& row = beside[mesh.fracture_faces[f].cell[side]]; row < 0) row = n++;
  const base::HostTable<Real**> resistance("resistance", n, HybridCell<shape>::n);
  for (const auto& [f, side] : sides) {
    const auto& face = mesh.fracture_faces[f];
    resistance(beside[face.cell[side]], face.local_face[side]) = 1 / (exchange[f] * face.area);
  }
  op.beside = assembly::to_device(beside, "beside");
  op.resistance = resistance.on_device();
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

}  // namespace sprekk::transport
