// From the global mesh to each rank's part.
#pragma once

#include <functional>
#include <vector>

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// This rank's part of the mesh, with ownership and ghosts as documented at Mesh. `part` is the rank of each cell.
/// A rank may own no cell. Owned and ghost entities are each in ascending global order. A fracture face's frame and
/// centre (mean of its nodes) are computed from its minus cell and bit-identical on all ranks.
/// Collective; `mesh` and `part` are the same on all ranks. Throws an Error if a part is not a rank, if a node belongs
/// to no cell, or if the two sides of a fracture face do not coincide.
RCP<const Mesh> distribute(const GlobalMesh& mesh, const std::vector<int>& part, RCP<const Comm> comm);

/// Every rank's part of a mesh that only rank 0 holds, as distribute() would give it with the partition() into one part
/// per rank. make() is called on rank 0 only, which then builds and sends the parts one by one: no other rank ever
/// holds more than its part, rank 0 at most the mesh, one part, and that part packed. Collective. An exception on rank
/// 0, in make() too, becomes an Error on all ranks.
RCP<const Mesh> make_distributed(const std::function<GlobalMesh()>& make, RCP<const Comm> comm);

/// The same with the mesh of rank 0; that of other ranks is not read.
RCP<const Mesh> make_distributed(const GlobalMesh& mesh, RCP<const Comm> comm);

}  // namespace sprekk::mesh
