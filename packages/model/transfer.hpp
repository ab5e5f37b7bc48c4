// Transfer of a state to a bisected mesh.
#pragma once

#include "assembly/prolongation.hpp"
#include "assembly/system.hpp"

namespace sprekk::model {

/// Transfers unknowns x and histories to a system of the same modules on a bisected mesh. `x_to` is its initial state
/// on entry. The changes since the initial state are prolonged, so each state that equals its initial state remains so.
/// Amounts, such as storage increases, are divided among the children of a cell or face, so their sums remain. The
/// increase of a stored quantity since the initial state remains, also where nodes have moved. Time, step length and
/// scales are those of `from`, whose histories are invalid afterwards if nodes have moved. Collective.
void transfer(const assembly::Prolongation& prolongation, assembly::System& from, const fields::BlockVector& x,
              assembly::System& to, fields::BlockVector& x_to);

}  // namespace sprekk::model
