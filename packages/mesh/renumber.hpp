// Renumbering; at random to check that results do not depend on it.
#pragma once

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// The same mesh with node i called new_node[i] and cell c called new_cell[c]. `mesh` has no tied nodes.
GlobalMesh permuted(const GlobalMesh& mesh, const std::vector<GlobalIndex>& new_node,
                    const std::vector<GlobalIndex>& new_cell);

/// The same mesh with its nodes and cells in an order drawn with `seed`; the same on every platform.
GlobalMesh renumbered(const GlobalMesh& mesh, unsigned seed);

}  // namespace sprekk::mesh
