// Uniform refinement of a distributed mesh: each rank refines its own part.
#pragma once

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// Rotates the local corner numbers of tetrahedra such that subdivision() gives the best shapes. It minimises the
/// largest sum of squared edges of the inner children, which have equal volumes. `mesh` has order 1.
void turn_for_refinement(GlobalMesh& mesh);

/// Replaces every cell by the cells of subdivision(), `times` times. A cell becomes 4 cells in 2D and 8 in 3D; a face
/// becomes 2 or 4 faces. Children inherit region, piece, owner, fracture, boundary, and side. New nodes are the means
/// of the corners of edges, faces and cells; each side of a fracture has its own.
///
/// Numbers of cells, nodes and fracture faces are independent of the distribution, and the mesh is bitwise identical
/// for any number of ranks. Owners and ghosts are as documented at Mesh, with the partition of the coarse mesh. Each
/// rank stores only its part with ghosts, before and after a step. With n the size of the part, time is O(n log n) and
/// memory O(n).
///
/// `mesh` has order 1, no periodic sides and no marked tips. Throws an Error if the cells or nodes exceed the range of
/// LocalIndex or GlobalIndex, or if they exceed the memory. Collective.
RCP<Mesh> refined(const Mesh& mesh, int times);

}  // namespace sprekk::mesh
