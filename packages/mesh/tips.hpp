// Crack tips: where fractures end inside of the rock.
#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// Which nodes are tips, [node] 1 or 0: the corners of fracture faces that both sides of the face share, so that the
/// displacement cannot jump there. In 3D they line the fracture's front. Nodes tied to a tip are tips. `mesh` is split;
/// not collective.
std::vector<char> tip_nodes(const GlobalMesh& mesh);

/// The same of a rank's part, ghosts included. `mesh` has no tied nodes. Collective.
std::vector<char> tip_nodes(const Mesh& mesh);

/// Sets mesh.tip, for the enrichment of the displacement around tips (order 1): all tip nodes but so many that no face
/// of a cell has tips only, for a function that is zero all over a face has no square-integrable inverse root. Of such
/// a face those nodes are left out that touch the fewest fracture faces: the corners of a fracture.
void mark_tips(GlobalMesh& mesh);

/// The same of every rank's part, with the numbers of enriched nodes, which do not depend on the ranks. `mesh` has no
/// tied nodes. Collective.
void mark_tips(Mesh& mesh);

}  // namespace sprekk::mesh
