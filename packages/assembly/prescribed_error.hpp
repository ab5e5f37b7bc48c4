// By how much the values at nodes miss what is prescribed between them.
#pragma once

#include "assembly/constraints.hpp"

#include <vector>

namespace sprekk::assembly {

/// Nodes take the values g of conditions on a field of nodes; their interpolant I g misses a curved g between them, to
/// one side throughout. The mean of g - I g over the prescribed faces around a node at time t, in the field's unit
/// [owned unknown], 0 where nothing is prescribed: added to the nodes it makes up for that. Collective; Error on every
/// rank where g has no value between nodes.
fields::Vector prescribed_error(const mesh::Mesh& mesh, const fields::Layout& layout,
                                const std::vector<DirichletCondition>& conditions, Real t);

}  // namespace sprekk::assembly
