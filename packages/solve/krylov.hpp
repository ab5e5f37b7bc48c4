// Krylov methods of Belos.
#pragma once

#include <functional>
#include <string>

#include "fields/types.hpp"

namespace sprekk::solve {

/// What Belos is handed unless a scene says otherwise. Stored data.
Teuchos::ParameterList krylov_defaults();

/// Throws a RefusedList where Belos has no such solver, the solver no such parameter, or it refuses a value: tried on
/// a small system. Collective.
void check_krylov(const Teuchos::ParameterList& given, const RCP<const Comm>& comm);

struct KrylovEnd {
  bool ended;  ///< by itself: converged, or stopped where rounding leaves no more to gain; false: too many iterations
  int iterations;
  bool indefinite = false;  ///< conjugate gradients met a direction in which A or M is not positive; x is of no use
};

/// Solves A x = b from x on, M about A^-1 from the right, by the "Solver Type" of the parameters, or by `usual`, to the
/// relative residual `tolerance` unless they have one, with at most `most` iterations, or theirs where it is 0.
/// `before_product`, if there is one, is called before each product with A and may throw. Throws what Belos throws.
/// Collective.
KrylovEnd krylov(const RCP<const fields::Operator>& A, const RCP<const fields::Operator>& M,
                 const Teuchos::ParameterList& parameters, const std::string& usual, const fields::Vector& b,
                 fields::Vector& x, Real tolerance, int most = 0, const std::function<void()>& before_product = {});

}  // namespace sprekk::solve
