// Crack tips: ends of fractures inside the rock.
#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// Marks tips: [node] 1 for a tip, otherwise 0. Tips are corners of fracture faces common to both sides of the face, so
/// node fields are continuous there. In 3D they form the front of the fracture. Nodes tied to a tip are tips. `mesh`
/// is split. Not collective.
std::vector<char> tip_nodes(const GlobalMesh& mesh);

/// Marks tips of a rank's part, ghosts included. `mesh` has no tied nodes. Collective.
std::vector<char> tip_nodes(const Mesh& mesh);

/// Sets mesh.tip for the enrichment of node fields at tips (order 1). It contains the tip nodes, except some on
/// cell faces with only tip corners. There the distance function would vanish on the whole face, and its inverse square
/// root would not be square-integrable. On such a face, the tips with the fewest fracture faces (corners of a fracture)
/// are removed.
void mark_tips(GlobalMesh& mesh);

/// Sets mesh.tip and the numbers of enriched nodes of a rank's part. The numbers are independent of the distribution.
/// `mesh` has no tied nodes. Collective.
void mark_tips(Mesh& mesh);

}  // namespace sprekk::mesh
