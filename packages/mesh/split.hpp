// Fractures from marked faces: splitting of nodes, orientation of faces.
#pragma once

#include <optional>
#include <vector>

#include "mesh/facets.hpp"

namespace sprekk::mesh {

/// Face of a cell on a fracture. It may be given from either of its two cells.
struct MarkedFace {
  int fracture;  ///< index into fracture_names
  GlobalIndex cell;
  int local_face;
  int single = 0;  ///< index into single_fractures
};

/// User input for the normal of a fracture.
struct Orientation {
  std::optional<Vector> reference;  ///< the product of the normal with this vector is positive
  bool swap_sides = false;          ///< reverse the normal given by the rule
};

/// Splits the nodes of a mesh along the marked faces and fills fracture_faces. Not collective.
///
/// The cells at each node are connected through unmarked faces. Each connected set of cells gets its own copy of the
/// node. The set with the lowest cell takes the old number; copies are appended. Hence tips are not split, a crossing
/// of two fractures has four copies, and a T three. parent_node stores the original of each node.
///
/// `mesh` must have conforming cells of positive volume, fracture_names, and no fracture faces. Without
/// single_fractures, each fracture becomes one single fracture. fracture_faces are in the order of `marked`, without
/// repetition, oriented by orient(). `orientations` is empty or has one entry per fracture. Throws an Error if a face
/// belongs to two fractures or lies on the boundary, or if a fracture has no face.
GlobalMesh split(GlobalMesh mesh, const std::vector<MarkedFace>& marked,
                 const std::vector<Orientation>& orientations = {});

/// Splits the nodes of a mesh along its fracture faces, whose cells and sides are already set. `mesh` must not be split
/// yet.
GlobalMesh split_along_faces(GlobalMesh mesh);

/// Swaps the sides of fracture faces for consistent normals (from minus to plus). `mesh` is not split yet.
///
/// Faces are neighbours if exactly two faces of a fracture share an edge (2D: a node). Normals are propagated between
/// neighbours. The sign of each connected piece follows from its area-weighted normal, by the first rule that applies:
/// * with a reference direction, the product with it is positive;
/// * the last component (z, y, x) larger than 1e-8 times the area is positive;
/// * if the area-weighted normal vanishes, the normals point outward.
///
/// swap_sides reverses the result. Throws an Error if a piece is one-sided, or if its normal is perpendicular (to 1e-8)
/// to the reference direction.
void orient(const GlobalMesh& mesh, std::vector<GlobalMesh::FractureFace>& faces,
            const std::vector<Orientation>& orientations);

}  // namespace sprekk::mesh
