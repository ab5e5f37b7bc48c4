// From cells of order 1 to cells of order 2.
#pragma once

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// The mesh with nodes added in the middle of edges (and of the faces and insides of quadrilaterals and hexahedra), so
/// that its cells keep their straight sides. Nodes keep their numbers; new ones follow. `mesh` has order 1 and is not
/// yet split: splitting treats the new nodes like all others, so that an edge between two tip nodes that lies in a
/// fracture opens. Linear in the number of cells.
GlobalMesh raise_order(GlobalMesh mesh);

/// The same of a distributed mesh, which is split: places in fractures get a node for each set of cells that faces
/// connect which are in no fracture. Cells and their ghosts stay; the numbers of nodes do not depend on the ranks.
/// Throws an Error if there are tied nodes, or crack tips that are marked. Collective.
RCP<Mesh> raise_order(const Mesh& mesh);

}  // namespace sprekk::mesh
