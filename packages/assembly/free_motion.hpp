// What boundary conditions and ties leave free to move as a whole.
#pragma once

#include "assembly/constraints.hpp"
#include "contact/rigid_motion.hpp"
#include "mesh/facets.hpp"

#include <string>
#include <vector>

namespace sprekk::assembly {

using contact::FreeMotion;

/// A basis of the rigid motions of the bodies that no condition on "displacement" and no tie prevents: those that
/// vanish in every held component and move nodes that share their unknowns alike. Contact cannot prevent them either,
/// since a body includes all that fractures join. In 3D six, in 2D three for each body without any support. A motion
/// that takes several bodies along counts once for each of them. Empty: everything is held. Not collective.
std::vector<FreeMotion> free_motions(const mesh::GlobalMesh& mesh, const std::vector<DirichletCondition>& conditions);

/// A body that can move, how, and what helps; empty if everything is held. Not collective.
std::string unheld(const mesh::GlobalMesh& mesh, const std::vector<DirichletCondition>& conditions);

}  // namespace sprekk::assembly
