// Numbers the faces of cells, for fields that live there.
#pragma once

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// The numbers of the ridges of local fracture faces, [face * n_face_corners(shape) + k]: see Facets; 0, 1, ... over
/// all ranks, the same for any partition. Collective.
std::vector<GlobalIndex> ridge_ids(const Mesh& mesh);

/// The mesh with its facets. Cells across a tied (periodic) side share a facet, as those across a fracture do.
/// Throws an Error where a tied side has so few cells that its faces, or their edges, have the same corners.
/// Collective.
RCP<const Mesh> with_facets(const RCP<const Mesh>& mesh);

}  // namespace sprekk::mesh
