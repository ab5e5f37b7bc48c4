// Edges, volume and distortion of the cells of a global mesh.
#pragma once

#include <array>
#include <vector>

#include "mesh/facets.hpp"

namespace sprekk::mesh {

/// For each node of a cell, as a set of bits, the corners whose mean it is in a cell with straight sides: bit k is
/// corner k.
std::vector<unsigned> corners_of_nodes(Shape shape);

/// The order of the nodes that turns a cell inside out: node k of the mirrored cell is node [k] of the cell.
std::vector<int> mirrored_nodes(Shape shape);

/// Measures of cells of one shape. Not collective; throws nothing.
class CellGeometry {
 public:
  struct Edge {
    int from, to;  ///< corners
    int middle;    ///< node on it; -1 in cells of order 1
  };

  explicit CellGeometry(Shape shape);

  const std::vector<Edge>& edges() const { return edges_; }

  /// The smallest and the largest of det(a, b[, c]) / (|a| |b| [|c|]) over the corners, where a, b, c are the tangents
  /// of the edges there, so that its sign is that of the Jacobian determinant; times 2/sqrt(3) for triangles and
  /// sqrt(2) for tetrahedra, so that it is 1 in regular cells. 0 where an edge has no length.
  std::array<Real, 2> scaled_jacobian(const GlobalMesh& mesh, GlobalIndex cell) const;

  /// The volume (2D: area) between the straight edges; exact for plane faces.
  Real volume(const GlobalMesh& mesh, GlobalIndex cell) const;

 private:
  Shape shape_;
  std::vector<Edge> edges_;
};

}  // namespace sprekk::mesh
