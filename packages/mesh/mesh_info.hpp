// Summary of a mesh: sizes, quality, intersections of fractures.
#pragma once

#include <string>
#include <vector>

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

struct MeshInfo {
  struct Part {
    std::string name;
    GlobalIndex n = 0;  ///< cells of a region, faces of a boundary or fracture
    Real measure = 0;   ///< volume of a region, area of a boundary or fracture (2D: area, length), straight edges
  };
  Shape shape;
  GlobalIndex n_cells = 0, n_nodes = 0;
  GlobalIndex n_copies = 0;  ///< nodes added by splitting along fractures
  std::vector<Part> regions, boundaries, fractures;
  GlobalIndex n_fracture_faces = 0;

  /// Ridges are the points (2D) or edges (3D) around fracture faces. A tip is a ridge of one fracture face inside the
  /// mesh. An intersection is a ridge of faces of several fractures, or of more than two faces.
  GlobalIndex n_tips = 0, n_intersections = 0;
  GlobalIndex n_tip_nodes = 0;            ///< corners on tips
  GlobalIndex n_intersection_points = 0;  ///< 2D: n_intersections; 3D: corners of more than two intersection edges

  Real shortest_edge = 0, mean_edge = 0, longest_edge = 0;  ///< m; the mean counts an edge once per cell
  Real largest_edge_ratio = 0;                              ///< longest over shortest edge of one cell
  GlobalIndex cell_of_largest_edge_ratio = 0;
  Real smallest_scaled_jacobian = 0;  ///< see CellGeometry
  GlobalIndex cell_of_smallest_scaled_jacobian = 0;

  /// Unknowns of a simulation with contact: dim per node, 2 dim per fracture face, dim per fracture face.
  GlobalIndex n_of_nodes = 0, n_of_bubbles = 0, n_of_faces = 0;
};

/// Measures a mesh before or after split(). Cells are numbered from 0. Throws an Error if the mesh has no cells, or if
/// more than two cells share a face. Not collective.
MeshInfo describe(const GlobalMesh& mesh);

/// Returns the summary as lines of text for a terminal; the last line ends with a newline.
std::string to_text(const MeshInfo& info);

}  // namespace sprekk::mesh
