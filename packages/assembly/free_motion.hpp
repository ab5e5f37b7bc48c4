// Rigid motions that boundary conditions and ties do not prevent.
#pragma once

#include "assembly/constraints.hpp"
#include "contact/rigid_motion.hpp"
#include "mesh/facets.hpp"

#include <string>
#include <vector>

namespace sprekk::assembly {

using contact::FreeMotion;

/// Returns a basis of the rigid motions that neither `conditions` on node vectors nor ties prevent. A free motion is
/// zero in every prescribed component and equal at nodes with common unknowns. A body includes all rock joined by
/// fractures, so contact cannot prevent these motions. A body without any support has six motions in 3D and three in
/// 2D. A motion of several bodies is listed once for each of them. The result is empty if all bodies are supported. Not
/// collective.
std::vector<FreeMotion> free_motions(const mesh::GlobalMesh& mesh, const std::vector<DirichletCondition>& conditions);

/// Returns an error message with a free body, its motions and a remedy; empty if all bodies are supported. Not
/// collective.
std::string unconstrained(const mesh::GlobalMesh& mesh, const std::vector<DirichletCondition>& conditions);

}  // namespace sprekk::assembly
