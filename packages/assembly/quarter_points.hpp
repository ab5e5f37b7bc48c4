// Quarter-point cells of order 2, whose node fields grow with the square root of the distance from crack tips.
#pragma once

#include "mesh/mesh.hpp"

namespace sprekk::assembly {

/// Moves the node on each edge from a tip (see mesh::tip_nodes()) to a corner that is not a tip to a quarter of the
/// edge from the tip. In quadrilaterals and hexahedra, nodes inside the faces and the cell follow the serendipity rule.
/// The map of a cell is then quadratic in the distance from the tip, and its shape functions contain the square root of
/// this distance (Barsoum 1976; Henshell and Shaw 1975). Copies of a node and tied nodes move alike, so cells and sides
/// of fractures remain conforming.
///
/// Two kinds of cells keep the nodes of all edges:
/// - Cells with a face (2D: an edge) whose corners are all tips. They would collapse onto this face, with infinite
///   energy.
/// - Cells whose map would not be one-to-one: its determinant would change sign at a point of CurvedQuadrature.
///
/// `mesh` must have split nodes. A mesh of order 1 remains unchanged. Not collective.
void move_to_quarter_points(mesh::GlobalMesh& mesh);

/// Moves the nodes in the parts of all ranks alike. The parts have no tied nodes. Collective.
void move_to_quarter_points(mesh::Mesh& mesh);

}  // namespace sprekk::assembly
