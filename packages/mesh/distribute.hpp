// Distribution of the global mesh to the ranks.
#pragma once

#include <functional>
#include <vector>

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// Returns this rank's part of the mesh, with owners and ghosts as documented at Mesh. `part` contains the rank of each
/// cell. A rank may own no cell. Owned entities and ghosts are each in ascending global order. The frame and the centre
/// (mean of the corners) of a fracture face are computed from its minus cell, bitwise identical on all ranks. `mesh`
/// and `part` must be identical on all ranks. Throws an Error if a part is not a rank, a node belongs to no cell, or
/// the sides of a fracture face do not coincide. Collective.
RCP<const Mesh> distribute(const GlobalMesh& mesh, const std::vector<int>& part, RCP<const Comm> comm);

/// Distributes a mesh stored on rank 0 only. The result is that of distribute() with partition() into one part per
/// rank. make() runs on rank 0, which builds and sends the parts one by one. Other ranks store only their part; rank 0
/// stores the mesh, one part, and the packed part. An exception on rank 0, also in make(), becomes an Error on all
/// ranks. Collective.
RCP<const Mesh> make_distributed(const std::function<GlobalMesh()>& make, RCP<const Comm> comm);

/// Distributes the mesh of rank 0; `mesh` is not read on other ranks. Collective.
RCP<const Mesh> make_distributed(const GlobalMesh& mesh, RCP<const Comm> comm);

}  // namespace sprekk::mesh
