// Cells of order 2 from cells of order 1.
#pragma once

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// Adds nodes at midpoints of edges, and of faces and interiors of quadrilaterals and hexahedra; edges remain straight.
/// Old nodes preserve their numbers, new nodes follow. `mesh` must have order 1 and must not be split yet. A later
/// split treats new nodes like all others, so an edge between two tip nodes inside a fracture opens. The cost is linear
/// in the number of cells. Throws an Error for other meshes. Not collective.
GlobalMesh raise_order(GlobalMesh mesh);

/// Raises the order of a distributed, split mesh. In fractures, each set of cells connected through faces outside
/// fractures gets its own node. Cells and ghosts are unchanged; node numbers are independent of the distribution.
/// Throws an Error for tied nodes or marked crack tips. Collective.
RCP<Mesh> raise_order(const Mesh& mesh);

}  // namespace sprekk::mesh
