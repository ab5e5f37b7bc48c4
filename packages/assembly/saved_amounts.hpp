// Amounts in the rows of storage terms, saved as the first histories of a module, one per block of rows.
#pragma once

#include "assembly/term.hpp"

#include <vector>

namespace sprekk::assembly {

/// Subtracts the saved amounts, times the rate of the state, from the rows of the blocks.
void subtract_saved(const State& state, const std::vector<int>& blocks, const Rows& rows);
/// Multiplies the saved amounts by `old`. Adds the rows of the terms at the rate 1, times `factor`.
void save_amounts(State& state, const std::vector<int>& blocks, const std::vector<Term>& terms, Real old, Real factor);
/// Returns the sum of the amounts on this rank. Local.
Real sum_of_saved(const State& state, const std::vector<int>& blocks);

}  // namespace sprekk::assembly
