// Cells of order 2 whose displacement grows with the square root of the distance from crack tips.
#pragma once

#include "mesh/mesh.hpp"

namespace sprekk::assembly {

/// Moves the node on each edge from a tip (see mesh::tip_nodes()) to a node that is none to a quarter of the edge from
/// the tip, and the nodes inside of the faces and cells of quadrilaterals and hexahedra around it to where the nodes on
/// their edges and corners put them (serendipity). So the map of a cell is quadratic in the distance from the tip, and
/// its shape functions hold the square root of that distance (Barsoum 1976, Henshell and Shaw 1975). Copies of a node
/// and nodes tied to each other move alike: cells and sides of fractures stay conforming.
///
/// All edges of a cell keep their nodes if the corners of one of its faces (2D: the ends of an edge) are all tips, for
/// it would collapse onto that face, with a strain energy that is not finite; and if its map would not be one to one:
/// if the sign of its determinant would change at a point of CurvedQuadrature.
///
/// `mesh` is split; nothing happens in a mesh of order 1. Not collective.
void move_to_quarter_points(mesh::GlobalMesh& mesh);

/// The same of every rank's part, which has no tied nodes. Collective.
void move_to_quarter_points(mesh::Mesh& mesh);

}  // namespace sprekk::assembly
