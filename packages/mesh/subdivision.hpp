// Subdivision of a cell into smaller cells of its shape.
#pragma once

#include <array>
#include <vector>

#include "mesh/shape.hpp"

namespace sprekk::mesh {

/// Cells of order 1 that fill a cell: 4 in 2D, 8 in 3D, of equal volume and with the orientation of the cell. Their
/// corners are nodes of the cell of order 2. The first ones are copies at its corners, in their order, at scale 1/2. In
/// a triangle, one triangle remains. In a tetrahedron, an octahedron remains. It is cut along the diagonal between the
/// midpoints of the edges 0-2 and 1-3 (Bey 1995), so all descendants have at most three shapes.
struct Subdivision {
  /// Part of a face: one face of a child.
  struct Part {
    int child, local_face;
    std::array<int, 4> nodes;  ///< corners in the order of face_nodes(), as nodes of the face of order 2; -1 unused
  };

  std::vector<std::array<int, 8>> children;  ///< [child][corner] node of the cell of order 2; -1 unused
  std::vector<std::vector<Part>> of_face;    ///< [face][part] part k has corner k of the face, the next one none

  int n_children() const { return static_cast<int>(children.size()); }
  int n_parts() const { return static_cast<int>(of_face.front().size()); }
};

/// Returns the subdivision of a cell; for shapes of order 2 that of the cell of order 1.
Subdivision subdivision(Shape shape);

}  // namespace sprekk::mesh
