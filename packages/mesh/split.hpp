// Turns marked faces of a mesh into fractures: splits nodes and orients the faces.
#pragma once

#include <optional>
#include <vector>

#include "mesh/facets.hpp"

namespace sprekk::mesh {

/// A cell's face that belongs to a fracture; either of its two cells may name it.
struct MarkedFace {
  int fracture;  ///< index into fracture_names
  GlobalIndex cell;
  int local_face;
  int single = 0;  ///< index into single_fractures
};

/// What the user says about a fracture's normal.
struct Orientation {
  std::optional<Vector> reference;  ///< the normal has a positive product with it
  bool swap_sides = false;          ///< reverse the normal that the rule gives
};

/// The mesh with its nodes split along the marked faces, and with fracture_faces.
///
/// Around each node the cells are connected through unmarked faces. Each connected set of cells has its own copy of the
/// node: the set of the lowest cell keeps the old number, copies are appended. So tips stay whole, a crossing of two
/// fractures has four copies, a T three. parent_node keeps the old number of each node.
///
/// `mesh` has conforming cells of positive volume, fracture_names, and no fracture faces; without single_fractures,
/// each fracture becomes one. fracture_faces come in the order of `marked`, without repetitions, oriented by orient().
/// `orientations` is empty or has one entry per fracture. Throws an Error if a face belongs to two fractures or lies on
/// the boundary, or if a fracture has no face.
GlobalMesh split(GlobalMesh mesh, const std::vector<MarkedFace>& marked,
                 const std::vector<Orientation>& orientations = {});

/// The mesh with its nodes split along the fracture faces that it has already, each with its cells and sides. It is not
/// yet split otherwise.
GlobalMesh split_along_faces(GlobalMesh mesh);

/// Swaps the sides of fracture faces such that normals (from minus to plus) are consistent. `mesh` is not yet split.
///
/// Normals are made consistent by walking over edges (2D: nodes) that exactly two faces of a fracture share. Each
/// connected piece then gets its sign from its area-weighted normal: a positive product with the reference direction;
/// without one, the last component (z, y, x) that is not zero relative to the area (1e-8) is positive; a piece whose
/// area-weighted normal vanishes points outward. swap_sides reverses the result. Throws an Error if a piece is
/// one-sided or its normal is perpendicular (1e-8) to the reference direction.
void orient(const GlobalMesh& mesh, std::vector<GlobalMesh::FractureFace>& faces,
            const std::vector<Orientation>& orientations);

}  // namespace sprekk::mesh
