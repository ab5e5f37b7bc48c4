// Krylov methods of Belos.
#pragma once

#include <functional>
#include <string>

#include "fields/types.hpp"

namespace sprekk::solve {

/// Returns the default parameters of Belos. Stored data.
Teuchos::ParameterList krylov_defaults();

/// Throws a RefusedList if Belos does not have the solver, or the solver rejects a parameter or value. The parameters
/// are tried on a small system. Collective.
void check_krylov(const Teuchos::ParameterList& given, const RCP<const Comm>& comm);

struct KrylovEnd {
  bool ended;  ///< converged, or stopped by round-off; false: too many iterations
  int iterations;
  bool indefinite = false;  ///< conjugate gradients met a direction in which A or M is not positive; x is unusable
};

/// Solves A x = b, starting from x. M approximates A^-1 and preconditions from the right. The method is the "Solver
/// Type" of the parameters, else `usual`. The relative residual is `tolerance` unless the parameters contain one.
/// `maximum`: largest number of iterations; 0: that of the parameters. `before_product`, if given, is called before
/// each product with A and may throw. Exceptions of Belos pass through. Collective.
KrylovEnd krylov(const RCP<const fields::Operator>& A, const RCP<const fields::Operator>& M,
                 const Teuchos::ParameterList& parameters, const std::string& usual, const fields::Vector& b,
                 fields::Vector& x, Real tolerance, int maximum = 0, const std::function<void()>& before_product = {});

}  // namespace sprekk::solve
