// Uniform refinement after the mesh has been distributed: every rank refines its own part.
#pragma once

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// Turns tetrahedra (which stay the same) such that subdivision() cuts them into the best shapes: the largest sum of
/// squared edges of those inside, whose volumes are equal, becomes the smallest. `mesh` has order 1.
void turn_for_refinement(GlobalMesh& mesh);

/// The mesh with every cell replaced by those of subdivision(), once or more often: 4 cells for one in 2D, 8 in 3D, and
/// 2 or 4 faces for one, which inherit region, piece, owner, fracture or boundary, and side. New nodes lie amid the
/// corners of edges, faces and cells; in fractures each side has its own.
///
/// Cells, nodes and fracture faces are numbered independently of the ranks: on any number of them the mesh is the same
/// to the last bit. Ownership and ghosts are as documented at Mesh, the partition is that of the coarse mesh. No rank
/// holds more than its part with its ghosts, before and after a step. Time n log n, memory n, in the size of the parts.
///
/// `mesh` has order 1, no periodic sides and no marked tips. Throws an Error if a part would have more cells or nodes
/// than a LocalIndex can number, or the mesh more cells than a GlobalIndex can. Collective.
RCP<Mesh> refined(const Mesh& mesh, int times);

}  // namespace sprekk::mesh
