// How displacements change the room for a fluid: what its pressure works on.
#pragma once

#include "base/view.hpp"
#include "mesh/mesh.hpp"

#include <functional>

namespace sprekk::physics {

/// Below, V_K = integral of biot div u over a cell and W_f = |f| n . mean([[u]]) of a fracture face, n from minus to
/// plus; biot(cell) is Biot's coefficient of a local cell. All are m^2 (2D: m), on the device.
using OfCell = std::function<Real(LocalIndex cell)>;

/// dV_K/du of the cells' nodes: [cell, node * dim + component].
View<Real**> cell_volumes(const mesh::Mesh& mesh, const OfCell& biot);

/// dV_K/dbeta of the sides' bubbles: [entity of Loop::fracture_sides, component].
View<Real**> bubble_volumes(const mesh::Mesh& mesh, const OfCell& biot);

/// This side's part of dW_f/d(u, beta): [entity of Loop::fracture_sides, node * dim + component; component].
View<Real**> side_volumes(const mesh::Mesh& mesh);

/// dV_K of the tip functions: [entity of Loop::tip_cells, node * dim + component]; cells of order 1.
View<Real**> tip_cell_volumes(const mesh::Mesh& mesh, const OfCell& biot);

/// Part of dW_f of the tip functions on a side: [entity of Loop::tip_sides, node * dim + component]; cells of order 1.
View<Real**> tip_side_volumes(const mesh::Mesh& mesh);

}  // namespace sprekk::physics
