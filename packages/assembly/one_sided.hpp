// Values of expressions at nodes where fractures end on the boundary: each copy of such a node has a side of its own.
#pragma once

#include "base/expression.hpp"
#include "mesh/facets.hpp"

#include <vector>

namespace sprekk::assembly {

/// [node] 1 for nodes of fractures that have a copy on another side; 0 for all others, among them tips.
std::vector<char> nodes_with_copies(const mesh::Mesh& mesh);
std::vector<char> nodes_with_copies(const mesh::GlobalMesh& mesh);

/// The limit of g(x + s d, t) for s -> 0, s > 0, where g jumps at x; g(x, t) itself where it does not, and for d = 0.
/// A jump: over 1e-6 of |d| the value changes by more than half of its change over 1e-4 of |d|, and by more than 1e-9
/// of itself. So x may be 1e-6 of |d| from the jump, as coordinates in mesh files are. x, d in metre. Throws an Error
/// where g has no value.
Real one_sided(const base::Expression& g, const mesh::Vector& x, const mesh::Vector& d, Real t);

}  // namespace sprekk::assembly
