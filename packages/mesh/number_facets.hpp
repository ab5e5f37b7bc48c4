// Numbers of the facets of cells and fracture faces, for fields with unknowns on facets.
#pragma once

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// Returns the global numbers of the ridges of local fracture faces, [face * n_face_corners(shape) + k]. They are
/// consecutive from 0 over all ranks and independent of the partition; see Facets. Collective.
std::vector<GlobalIndex> ridge_ids(const Mesh& mesh);

/// Returns the mesh with its facets, or with those of fractures alone. Cells on tied (periodic) sides share a facet, as
/// do cells across a fracture.
/// Throws an Error if a periodic direction has too few cells, so that different faces or edges have the same corners.
/// Collective.
RCP<const Mesh> with_facets(const RCP<const Mesh>& mesh, bool in_rock = true);

}  // namespace sprekk::mesh
