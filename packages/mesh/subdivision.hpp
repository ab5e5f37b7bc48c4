// How a cell is cut into smaller ones of its shape.
#pragma once

#include <array>
#include <vector>

#include "mesh/shape.hpp"

namespace sprekk::mesh {

/// The cells of order 1 that fill a cell, whose corners are the nodes of the cell of order 2: 4 in 2D, 8 in 3D, each as
/// large as the others and oriented as the cell. The first ones lie at its corners, in their order, and are half as
/// large copies of it. What they leave of a triangle is another; of a tetrahedron an octahedron, cut along the diagonal
/// between the middles of the edges 0-2 and 1-3 (Bey 1995), so that all descendants of a tetrahedron have no more than
/// three shapes.
struct Subdivision {
  /// A part of a face: a face of one of the cells.
  struct Part {
    int child, local_face;
    std::array<int, 4> nodes;  ///< its corners in the order of face_nodes(), as nodes of the face of order 2; -1 unused
  };

  std::vector<std::array<int, 8>> children;  ///< [child][corner] node of the cell of order 2; -1 unused
  std::vector<std::vector<Part>> of_face;    ///< [face][part] the k-th part has the face's corner k, a last one none

  int n_children() const { return static_cast<int>(children.size()); }
  int n_parts() const { return static_cast<int>(of_face.front().size()); }
};

Subdivision subdivision(Shape shape);

}  // namespace sprekk::mesh
