// Crack tips: where fractures end inside of the rock.
#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// Which nodes are tips, [node] 1 or 0: the corners of fracture faces that both sides of the face share, so that the
/// displacement cannot jump there. In 3D they line the fracture's front. Nodes tied to a tip are tips. `mesh` is split;
/// not collective.
std::vector<char> tip_nodes(const GlobalMesh& mesh);

}  // namespace sprekk::mesh
