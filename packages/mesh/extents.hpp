// How large the domain and its fractures are.
#pragma once

#include <vector>

#include "mesh/facets.hpp"

namespace sprekk::mesh {

/// Size of the domain's bounding box in each direction, m; in 2D the third is zero. Collective.
Vector domain_extents(const Mesh& mesh);

/// The largest of them. Collective.
Real largest_extent(const Mesh& mesh);

/// The area of the face of a typical cell (2D: its length): the domain's bounding box is shared out among the cells.
/// Collective.
Real typical_face_area(const Mesh& mesh);

/// The domain_extents() of each fracture. Collective.
std::vector<Vector> fracture_extents(const Mesh& mesh);
/// The same of each single fracture.
std::vector<Vector> single_fracture_extents(const Mesh& mesh);

}  // namespace sprekk::mesh
