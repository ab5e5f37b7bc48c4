// Numbers the faces of cells, for fields that live there.
#pragma once

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// The mesh with its facets. Cells across a tied (periodic) side share a facet; those across a fracture do not.
/// Throws an Error where a tied side has so few cells that its faces have the same corners. Collective.
RCP<const Mesh> with_facets(const RCP<const Mesh>& mesh);

}  // namespace sprekk::mesh
