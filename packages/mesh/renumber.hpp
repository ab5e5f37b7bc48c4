// Random renumbering, to check that results do not depend on the numbering.
#pragma once

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// The same mesh with its nodes and cells in an order drawn with `seed`; the same on every platform.
GlobalMesh renumbered(const GlobalMesh& mesh, unsigned seed);

}  // namespace sprekk::mesh
