// From the global mesh to each rank's part.
#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// This rank's part of the mesh, with ownership and ghosts as documented at Mesh. `part` is the rank of each cell.
/// A rank may own no cell. Owned and ghost entities are each in ascending global order. A fracture face's frame and
/// centre (mean of its nodes) are computed from its minus cell and bit-identical on all ranks.
/// Collective; `mesh` and `part` are the same on all ranks. Throws an Error if a part is not a rank, if a node belongs
/// to no cell, or if the two sides of a fracture face do not coincide.
RCP<const Mesh> distribute(const GlobalMesh& mesh, const std::vector<int>& part, RCP<const Comm> comm);

/// The same with the partition() of rank 0, one part per rank. Collective.
RCP<const Mesh> make_distributed(const GlobalMesh& mesh, RCP<const Comm> comm);

}  // namespace sprekk::mesh
