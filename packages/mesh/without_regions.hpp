// Excavation: mesh without the cells of some regions.
#pragma once

#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// Removes the cells of the given regions from a mesh; the other cells remain on their ranks.
///
/// * Walls: faces of remaining cells whose opposite cell was removed become boundary faces, also across fractures.
///   Their boundary has the name of the region and exists even without faces.
/// * Fracture faces with a removed cell, and nodes without cells, are removed.
/// * Numbers: entities are renumbered in their order; Mesh::origin contains the previous numbers.
/// * Facets: present if `whole` has them.
///
/// Returns `whole` if `regions` is empty. Throws an Error if a region does not exist, no cell remains, or the mesh has
/// periodic sides. Collective.
RCP<const Mesh> without_regions(const RCP<const Mesh>& whole, const std::vector<std::string>& regions);

}  // namespace sprekk::mesh
