// Intersections of fractures in a distributed mesh.
#pragma once

#include <vector>

#include "mesh/facets.hpp"
#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// Point (2D) or edge (3D), for output, at faces of several fractures, or of more than two faces of one fracture; as
/// counted in MeshInfo.
struct Intersection {
  std::vector<GlobalIndex>
      nodes;                   ///< point, or ends of the edge, at order 2 also its middle; set numbers of AlikeNodes
  std::vector<Vector> x;       ///< coordinates of these nodes, m
  std::vector<int> fractures;  ///< fracture of each face at the intersection, ascending
};

/// Returns all intersections of the mesh on rank 0, each once, ordered by their nodes; returns none on other ranks.
/// Numbers and order are independent of the number of ranks. Collective.
std::vector<Intersection> intersections(const Mesh& mesh);

/// Edge on an intersection in 3D: ridge of fracture faces.
struct IntersectionEdge {
  LocalIndex facet;            ///< see Facets
  LocalIndex face = -1;        ///< one of its faces,
  int ridge = -1;              ///< and the number of the ridge there
  std::vector<int> fractures;  ///< fracture of each face at the edge, ascending
};

/// Returns the owned edges on intersections, ascending with their facets. Empty in 2D. Requires facets. Not collective.
std::vector<IntersectionEdge> intersection_edges(const Mesh& mesh);

/// Edge of fracture faces at one of its ends, in 3D.
struct EdgeAtPoint {
  LocalIndex facet = -1;         ///< its ridge, see Facets
  std::vector<int> fractures;    ///< fracture of each face at the edge, ascending
  Vector to_point{};             ///< from the middle of the edge to the end, m
  bool is_intersection() const;  ///< see Intersection
};

/// End points of intersections with the edges there: all edges on intersections, and edges with one face. The latter
/// are borders of fractures, also on the boundary of the domain. Complete at points of owned ridges. Points ascend with
/// their global numbers, edges with their facets. Empty in 2D. Requires facets. Not collective.
std::vector<std::vector<EdgeAtPoint>> junctions(const Mesh& mesh);

/// Calls visit(first, second) for the pairs of edges of a junction with at least one on an intersection.
template <class Visit>
void for_each_pair(const std::vector<EdgeAtPoint>& junction, const Visit& visit) {
  for (std::size_t i = 0; i < junction.size(); ++i)
    for (std::size_t j = i + 1; j < junction.size(); ++j)
      if (junction[i].is_intersection() || junction[j].is_intersection()) visit(junction[i], junction[j]);
}

}  // namespace sprekk::mesh
