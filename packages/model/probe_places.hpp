// Where probes look: which entities of a mesh a value at a place is made of.
#pragma once

#include "fields/layout.hpp"
#include "mesh/facets.hpp"

#include <string>
#include <vector>

namespace sprekk::model {

/// A part of a value at a place: weight times that of an entity of this rank.
struct Share {
  LocalIndex entity;
  Real weight;
};
using Shares = std::vector<Share>;

/// Of values at points, of outputs on nodes, cells or fracture faces: the values of the nodes of the cell at the point
/// by its shape functions, that of the cell, that of the nearest face. Of several cells or faces the one with the
/// lowest number counts, so values do not depend on the ranks. The shares of a point, over all ranks, add up to 1.
/// Error: a point is outside of the mesh or, of faces, off all fractures by more than 1e-6 of the domain's largest
/// extent. Collective.
std::vector<Shares> shares_at(const mesh::Mesh& mesh, fields::Entity entity, const std::vector<mesh::Vector>& points);

/// Of integrals over a boundary, with an index into boundary_names, of outputs on nodes or cells. Local.
Shares shares_on_boundary(const mesh::Mesh& mesh, fields::Entity entity, int boundary);
/// The same over a region, by its index.
Shares shares_in_region(const mesh::Mesh& mesh, fields::Entity entity, int region);
/// Over the faces of a set of fractures, or of a single one, of outputs on fracture faces. Local.
Shares shares_on_fractures(const mesh::Mesh& mesh, bool is_set, int number);

}  // namespace sprekk::model
