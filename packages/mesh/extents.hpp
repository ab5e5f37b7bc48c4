// Sizes of the domain and of its fractures.
#pragma once

#include <vector>

#include "mesh/facets.hpp"

namespace sprekk::mesh {

/// Size of the bounding box of the domain in each direction, m; the third is 0 in 2D. Collective.
Vector domain_extents(const Mesh& mesh);

/// Largest size of the bounding box of the domain, m. Collective.
Real largest_extent(const Mesh& mesh);

/// Face area of a typical cell, m^2 (2D: length, m): (V/n)^((d-1)/d). V is the volume of the bounding box of the
/// domain, n the number of cells. Collective.
Real typical_face_area(const Mesh& mesh);

/// Length of a fracture face, m; in 3D the root of its area.
Real length_of(const Mesh& mesh, const Mesh::FractureFace& face);

/// Parts of the normals of a boundary in each direction: the largest |n_i| of its faces, 0 within rounding.
/// Not collective.
std::vector<Real> parts_of_normals(const GlobalMesh& mesh, int boundary);

/// Size of the bounding box of each fracture in each direction, m. Collective.
std::vector<Vector> fracture_extents(const Mesh& mesh);
/// Size of the bounding box of each single fracture in each direction, m. Collective.
std::vector<Vector> single_fracture_extents(const Mesh& mesh);

}  // namespace sprekk::mesh
