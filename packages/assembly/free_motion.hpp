// What boundary conditions and ties leave free to move as a whole.
#pragma once

#include "assembly/constraints.hpp"
#include "mesh/facets.hpp"

#include <string>
#include <vector>

namespace sprekk::assembly {

/// A rigid motion of one body at small rotation, v(x) = translation + rotation x (x - centre).
struct FreeMotion {
  int body;  ///< see mesh::find_bodies()
  mesh::Vector translation, rotation, centre;
};

/// A basis of the rigid motions of the bodies that no condition on "displacement" and no tie prevents: those that
/// vanish in every held component and move nodes that share their unknowns alike. Contact cannot prevent them either,
/// since a body includes all that fractures join. In 3D six, in 2D three for each body without any support. A motion
/// that takes several bodies along counts once for each of them. Empty: everything is held. Not collective.
std::vector<FreeMotion> free_motions(const mesh::GlobalMesh& mesh, const std::vector<DirichletCondition>& conditions);

/// "can move along (1, 0)", "can rotate about the axis (0, 0, 1) through (0, 1, 0)"; in 2D about a point.
std::string to_text(const FreeMotion& motion, int dim);

/// A body that can move, how, and what helps; empty if everything is held. Not collective.
std::string unheld(const mesh::GlobalMesh& mesh, const std::vector<DirichletCondition>& conditions);

}  // namespace sprekk::assembly
