// Periodic boundaries: nodes on opposite sides share their unknowns.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// Ties the nodes on the second boundary of each pair to those on the first, which must be its translate, so that
/// displacements on both are equal. Faces are matched by their centres, nodes within faces, hence copies at fractures
/// that reach both sides find each other. Tied nodes are renumbered to the end. `mesh` is split and has no tied nodes
/// yet. Throws an Error that names the boundaries and a place if their faces do not match.
GlobalMesh tie_periodic(const GlobalMesh& mesh, const std::vector<std::pair<std::string, std::string>>& pairs);

}  // namespace sprekk::mesh
