// Where fractures meet in a mesh that is distributed, for pictures; hierarchy.hpp tells more of a mesh on one rank.
#pragma once

#include <vector>

#include "mesh/facets.hpp"
#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// A point (2D) or an edge (3D) at which faces of several fractures end, or more than two of one: what MeshInfo counts.
struct Intersection {
  std::vector<GlobalIndex> nodes;  ///< its point, or the ends of its edge and at order 2 its middle; numbers of copies
  std::vector<Vector> x;           ///< where they are, metre
  std::vector<int> fractures;      ///< of each face that ends here, ascending
};

/// All intersections of the mesh, each once, on rank 0, by their nodes; none on other ranks. Their numbers, and so
/// their order, are the same on any number of ranks. Collective.
std::vector<Intersection> intersections(const Mesh& mesh);

}  // namespace sprekk::mesh
