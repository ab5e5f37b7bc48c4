// One-sided values of expressions at nodes where fractures end on the boundary.
#pragma once

#include "base/expression.hpp"
#include "mesh/facets.hpp"

#include <vector>

namespace sprekk::assembly {

/// Return 1 for nodes [node] on fractures that have a copy on another side, else 0. Fracture tips have no copies.
std::vector<char> nodes_with_copies(const mesh::Mesh& mesh);
std::vector<char> nodes_with_copies(const mesh::GlobalMesh& mesh);

/// Returns the limit of g(x + s d, t) for s -> 0, s > 0, if g is discontinuous at x. Otherwise, and for d = 0, returns
/// g(x, t). x and d are in metres. A discontinuity is a change over 1e-6 |d| of more than half the change over 1e-4
/// |d|, and of more than 1e-9 of the value. So x may be up to 1e-6 |d| away from it, which allows for rounded
/// coordinates in mesh files. Throws an Error where g has no value.
Real one_sided(const base::Expression& g, const mesh::Vector& x, const mesh::Vector& d, Real t);

}  // namespace sprekk::assembly
