// Excavation: a mesh without the cells of some of its regions.
#pragma once

#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// The part of a mesh that is left without the cells of regions, each rank's cells staying where they are. Walls, where
/// cells are gone on the other side of a face or of a fracture face, are boundary faces of a boundary called like the
/// region, which is there even if it has no face. Fracture faces with a side in a region are gone, and so are nodes
/// without cells. Entities are numbered anew in their order; Mesh::origin has the numbers that they had. With facets
/// where `whole` has some; `whole` itself if there is no region. Error: a region is not there, no cell is left, or the
/// mesh has periodic sides. Collective.
RCP<const Mesh> without_regions(const RCP<const Mesh>& whole, const std::vector<std::string>& regions);

}  // namespace sprekk::mesh
