// Intersections of fractures in a distributed mesh, for output.
#pragma once

#include <vector>

#include "mesh/facets.hpp"
#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// Point (2D) or edge (3D) at faces of several fractures, or of more than two faces of one fracture; as counted in
/// MeshInfo.
struct Intersection {
  std::vector<GlobalIndex>
      nodes;                   ///< point, or ends of the edge, at order 2 also its middle; set numbers of AlikeNodes
  std::vector<Vector> x;       ///< coordinates of these nodes, m
  std::vector<int> fractures;  ///< fracture of each face at the intersection, ascending
};

/// Returns all intersections of the mesh on rank 0, each once, ordered by their nodes; returns none on other ranks.
/// Numbers and order are independent of the number of ranks. Collective.
std::vector<Intersection> intersections(const Mesh& mesh);

}  // namespace sprekk::mesh
