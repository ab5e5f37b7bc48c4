// Renumbering of meshes: an order with short distances in memory; a random order, which tests that results are
// independent of it.
#pragma once

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// Returns the mesh with node i renumbered to new_node[i] and cell c to new_cell[c]. `mesh` has no tied nodes.
GlobalMesh permuted(const GlobalMesh& mesh, const std::vector<GlobalIndex>& new_node,
                    const std::vector<GlobalIndex>& new_cell);

/// Returns the mesh with nodes and cells in the order of their positions on a Morton curve, and fracture faces in the
/// order of their minus cells. Neighbours in space are then close in memory: products with matrices of large networks
/// read fewer cache lines. `mesh` has no tied nodes. Not collective.
GlobalMesh in_spatial_order(const GlobalMesh& mesh);

/// Returns the mesh with a random order of nodes and cells for `seed`, identical on every platform.
GlobalMesh renumbered(const GlobalMesh& mesh, unsigned seed);

}  // namespace sprekk::mesh
