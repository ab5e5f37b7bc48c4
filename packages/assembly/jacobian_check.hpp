// Every module's Jacobian against finite differences of its residual.
#pragma once

#include "assembly/system.hpp"

#include <string>
#include <vector>

namespace sprekk::assembly {

/// How far a module's derivative in the unknowns of one block is from differences of its residual.
struct JacobianError {
  std::string module, row, column;  ///< names of the module and of the blocks
  Real error;  ///< max |J d - difference| over the rows of the block / max |J| |d|; 0 where both vanish
};

/// Compares, for each module and each pair of blocks, J d with central differences (r(x + h d) - r(x - h d))/(2 h) in
/// `n_directions` pseudo-random directions d, whose entries are of the size of the block's kinematic scale. A pair that
/// the module does not declare must have zero differences; then the error is relative to the block's residual scale. x
/// must lie further than h from any change of contact state. Collective; the same numbers on every rank.
std::vector<JacobianError> check_jacobian(System& system, const fields::BlockVector& x, Real h = 1e-4,
                                          int n_directions = 3);

}  // namespace sprekk::assembly
