// Locations of probes: entities and weights that give the value at a place.
#pragma once

#include "fields/layout.hpp"
#include "mesh/facets.hpp"

#include <vector>

namespace sprekk::model {

/// Weighted contribution of an entity on this rank to a value.
struct Share {
  LocalIndex entity;
  Real weight;
};
using Shares = std::vector<Share>;

/// Returns the shares for values at points. Nodal outputs are interpolated with the shape functions of the cell at the
/// point. Cell outputs are the value of this cell, face outputs that of the nearest fracture face. Among several cells
/// or faces, the lowest number is used, so values are independent of the distribution. The shares of a point sum to 1
/// over all ranks. Throws an Error for points outside the mesh. For fracture faces, it also throws if the distance to
/// all fractures exceeds 1e-6 of the largest extent of the domain. Collective.
std::vector<Shares> shares_at(const mesh::Mesh& mesh, fields::Entity entity, const std::vector<mesh::Vector>& points);

/// Returns the shares for integrals of outputs on nodes or cells over a boundary, an index into boundary_names. Local.
Shares shares_on_boundary(const mesh::Mesh& mesh, fields::Entity entity, int boundary);
/// Returns the shares for integrals of outputs on nodes or cells over a region, an index into region_names. Local.
Shares shares_in_region(const mesh::Mesh& mesh, fields::Entity entity, int region);
/// Returns the shares for integrals of outputs on fracture faces over a set of fractures or a single fracture. Local.
Shares shares_on_fractures(const mesh::Mesh& mesh, bool is_set, int number);

}  // namespace sprekk::model
