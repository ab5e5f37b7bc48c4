// Cells of bad shape and the sets of facets around them.
#pragma once

#include <vector>

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// Ratio d r / R of the radii of the inscribed and the circumscribed circle (3D: sphere) of a local cell with straight
/// edges: 1 if the cell is regular, 0 if it is flat. 1 for cells that are no simplices.
Real radius_ratio(const Mesh& mesh, LocalIndex cell);

/// Returns disjoint sets of owned facets: the facets of cells with a radius ratio below 0.1, in one set if the cells
/// share a facet. The bound is halved within sets above `max_size` facets, and for all sets while the squares of their
/// sizes add up to more than 10 times the number of owned facets. A set ends at the facets of other ranks. The mesh
/// must have facets. Local.
std::vector<std::vector<LocalIndex>> facets_of_flat_cells(const Mesh& mesh, std::size_t max_size = 300);

}  // namespace sprekk::mesh
