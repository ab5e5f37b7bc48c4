// Comparison of the Jacobian of each module with finite differences of its residual.
#pragma once

#include "assembly/system.hpp"

#include <string>
#include <vector>

namespace sprekk::assembly {

/// Error of the derivative of a module's row block with respect to one block of unknowns.
struct JacobianError {
  std::string module, row, column;  ///< names of the module and the blocks
  Real error;                       ///< max |J d - difference| over the rows of the block / max |J| |d|
};

/// Compares J d with central differences (r(x + h d) - r(x - h d))/(2 h) for each module and pair of blocks. The
/// `n_directions` directions d are pseudo-random, with entries up to the kinematic scale of the block. For a pair
/// without declared coupling, J = 0, and the error is relative to the residual scale of the row block. The distance of
/// x from any change of contact state must exceed h. Collective; the result is the same on all ranks.
std::vector<JacobianError> check_jacobian(System& system, const fields::BlockVector& x, Real h = 1e-4,
                                          int n_directions = 3);

}  // namespace sprekk::assembly
