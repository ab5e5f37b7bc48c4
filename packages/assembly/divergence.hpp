// Integrals of the divergence of vector fields over cells, and changes of the volume of fractures.
#pragma once

#include "base/view.hpp"
#include "mesh/mesh.hpp"

#include <functional>

namespace sprekk::assembly {

/// Volumes: V_K is the integral of factor div u over a cell. W_f = |f| n . mean([[u]]) belongs to a fracture face, with
/// n from minus to plus. factor(cell) belongs to a local cell. The functions return derivatives in m^2 (2D: m) with
/// respect to the unknowns of u in m, on the device. Not collective.
using OfCell = std::function<Real(LocalIndex cell)>;

/// dV_K/du for the nodes of the cells: [cell, node * dim + component].
View<Real**> cell_divergence(const mesh::Mesh& mesh, const OfCell& factor);

/// dV_K/dbeta for the face bubbles: [entity of Loop::fracture_sides, component].
View<Real**> bubble_divergence(const mesh::Mesh& mesh, const OfCell& factor);

/// dV_K for the tip functions: [entity of Loop::tip_cells, node * dim + component]. Requires cells of order 1.
View<Real**> tip_divergence(const mesh::Mesh& mesh, const OfCell& factor);

/// Contribution of one side to dW_f/d(u, beta): [entity of Loop::fracture_sides, node * dim + component; component].
View<Real**> side_volumes(const mesh::Mesh& mesh);

/// Contribution of one side to dW_f for the tip functions: [entity of Loop::tip_sides, node * dim + component].
/// Requires cells of order 1.
View<Real**> tip_side_volumes(const mesh::Mesh& mesh);

}  // namespace sprekk::assembly
