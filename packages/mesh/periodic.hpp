// Periodic boundaries: nodes on opposite sides share their unknowns.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "mesh/mesh.hpp"

namespace sprekk::mesh {

/// Ties the nodes on the second boundary of each pair to those on the first, so node fields on both are equal. The
/// second boundary must be a translation of the first. Faces are matched by their centres, then nodes within faces.
/// Node copies at fractures on both sides are therefore matched correctly. Tied nodes get the highest numbers. `mesh`
/// must be split and have no tied nodes. Throws an Error with the boundaries and a location if faces do not match.
GlobalMesh tie_periodic(const GlobalMesh& mesh, const std::vector<std::pair<std::string, std::string>>& pairs);

}  // namespace sprekk::mesh
