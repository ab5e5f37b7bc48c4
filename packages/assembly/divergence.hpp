// Integrals of the divergence of vector fields over cells, and changes of the volume of fractures.
#pragma once

#include "assembly/loop.hpp"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace sprekk::assembly {

/// Volumes: V_K is the integral of factor div u over a cell K. W_f = |f| n . mean([[u]]) belongs to a fracture face,
/// with n from minus to plus. All derivatives are in m^2 (2D: m) with respect to the unknowns of u in m, on the device.
/// No function is collective.

/// Names of the fields that contribute to u: nodes, bubbles of fracture sides, tip functions.
using VectorFields = std::array<const char*, 3>;

/// Divergence of a field over the entities of a loop.
struct Divergence {
  Loop loop;
  std::string field;
  View<Real**> volume = {};            ///< dV_K/du [entity, unknown of the entity]
  std::vector<LocalIndex> cells = {};  ///< [entity] K
};

/// Returns loops and fields of a mesh: nodes, bubbles if there are fractures, tip functions if tips are enriched.
std::vector<Divergence> divergence_fields(const mesh::Mesh& mesh, const VectorFields& names);
/// Returns the same with volumes and cells. factor(cell) belongs to a local cell. Tip functions require cells of
/// order 1.
std::vector<Divergence> divergence(const mesh::Mesh& mesh, const VectorFields& names,
                                   const std::function<Real(LocalIndex)>& factor);

/// Contribution of one side to dW_f/d(u, beta): [entity of Loop::fracture_sides, node * dim + component; component].
View<Real**> side_volumes(const mesh::Mesh& mesh);

/// Coefficients V of the volume of a layer between the sides, m^2 (2D: m): [entity of Loop::fracture_sides, as
/// side_volumes(), and 1]. A layer of thickness h at u = 0 has the volume W_f + |f| h. The sum of V . (u, beta, h) over
/// both sides of a face gives this volume; each side contributes half of the thickness. Throws an Error if tips are
/// enriched.
View<Real**> layer_volumes(const mesh::Mesh& mesh);

/// Contribution of one side to dW_f for the tip functions: [entity of Loop::tip_sides, node * dim + component].
/// Requires cells of order 1.
View<Real**> tip_side_volumes(const mesh::Mesh& mesh);

}  // namespace sprekk::assembly
