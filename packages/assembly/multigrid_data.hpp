// Data of a block for multigrid: coordinates, near-null space, interpolation from elements of order 1.
#pragma once

#include "assembly/module.hpp"

namespace sprekk::assembly {

/// Sets coordinates, near_null_space, interpolation and patches of a block with a near-null space. A block on facets
/// has the last two. Collective.
void set_multigrid(const mesh::Mesh& mesh, NearNullSpace near_null_space, const fields::Layout& layout,
                   fields::Block& block);

}  // namespace sprekk::assembly
