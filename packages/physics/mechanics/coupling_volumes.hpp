// Derivatives of pore and fracture volumes with respect to displacements, for the work of a fluid pressure.
#pragma once

#include "base/view.hpp"
#include "mesh/mesh.hpp"

#include <functional>

namespace sprekk::physics {

/// Volumes: V_K is the integral of biot div u over a cell. W_f = |f| n . mean([[u]]) belongs to a fracture face, with n
/// from minus to plus. biot(cell) is Biot's coefficient of a local cell. All derivatives are in m^2 (2D: m) and on the
/// device.
using OfCell = std::function<Real(LocalIndex cell)>;

/// dV_K/du for the nodes of the cells: [cell, node * dim + component].
View<Real**> cell_volumes(const mesh::Mesh& mesh, const OfCell& biot);

/// dV_K/dbeta for the face bubbles: [entity of Loop::fracture_sides, component].
View<Real**> bubble_volumes(const mesh::Mesh& mesh, const OfCell& biot);

/// Contribution of one side to dW_f/d(u, beta): [entity of Loop::fracture_sides, node * dim + component; component].
View<Real**> side_volumes(const mesh::Mesh& mesh);

/// dV_K for the tip functions: [entity of Loop::tip_cells, node * dim + component]. Requires cells of order 1.
View<Real**> tip_cell_volumes(const mesh::Mesh& mesh, const OfCell& biot);

/// Contribution of one side to dW_f for the tip functions: [entity of Loop::tip_sides, node * dim + component].
/// Requires cells of order 1.
View<Real**> tip_side_volumes(const mesh::Mesh& mesh);

}  // namespace sprekk::physics
