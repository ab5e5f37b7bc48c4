// Numbers the faces of cells, for fields that live there.
#pragma once

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// The mesh with its facets. Cells across a tied (periodic) side share a facet; those across a fracture do not.
/// Collective.
RCP<const Mesh> with_facets(const RCP<const Mesh>& mesh);

}  // namespace sprekk::mesh
