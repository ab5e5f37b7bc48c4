// Edges, volume and distortion of cells of a global mesh.
#pragma once

#include <array>
#include <vector>

#include "mesh/facets.hpp"

namespace sprekk::mesh {

/// Returns for each node of a cell the corners whose mean is this node in a cell with straight edges. The corners are a
/// bit set: bit k is corner k.
std::vector<unsigned> corners_of_nodes(Shape shape);

/// Returns the node permutation that mirrors a cell: node k of the mirrored cell is node [k] of the cell.
std::vector<int> mirrored_nodes(Shape shape);

/// Measures of cells of one shape. Not collective; does not throw.
class CellGeometry {
 public:
  struct Edge {
    int from, to;  ///< corners
    int middle;    ///< node on the edge; -1 in cells of order 1
  };

  explicit CellGeometry(Shape shape);

  const std::vector<Edge>& edges() const { return edges_; }

  /// Minimum and maximum over the corners of the scaled Jacobian c det(a, b[, c]) / (|a| |b| [|c|]). The vectors a, b,
  /// c are the tangents of the edges at the corner; the sign is that of the Jacobian determinant. The factor normalises
  /// regular cells to 1: 2/sqrt(3) for triangles, sqrt(2) for tetrahedra, otherwise 1. The value is 0 for an edge
  /// without length.
  std::array<Real, 2> scaled_jacobian(const GlobalMesh& mesh, GlobalIndex cell) const;

  /// Volume, m^3 (2D: area, m^2), of the cell with straight edges; exact for plane faces.
  Real volume(const GlobalMesh& mesh, GlobalIndex cell) const;

 private:
  Shape shape_;
  std::vector<Edge> edges_;
};

}  // namespace sprekk::mesh
