#include "solve/factor_cost.hpp"

#include <cmath>

namespace sprekk::solve {
namespace {

constexpr Real n_coupled = 20;                         // applications in a Newton iteration of coupled fields
constexpr Real n_alone = 100, n_alone_by_factors = 3;  // the same for a field without others
constexpr Real max_bytes_per_rank = 1LL << 30;

// seconds on one core
constexpr Real per_operation = 7e-11;
constexpr Real per_entry = 4e-9, per_unknown = 2e-7;     // of a substitution
constexpr Real of_transfer = 5e-6;                       // to MUMPS, per unknown
constexpr Real of_setup = 6e-6, of_two_cycles = 1.5e-6;  // of multigrid, per unknown

}  // namespace

FactorCost factor_cost(const FacetMatrix& matrix) {
  const Real n = matrix.n_unknowns;
  if (matrix.dim < 3) return {15 * std::pow(n, 1.5), 2.5 * n * std::log2(n + 1)};
  return {6.5 * n * n, 8 * std::pow(n, 4.0 / 3)};
}

bool factors_are_cheaper(const FacetMatrix& matrix) {
  const auto cost = factor_cost(matrix);
  const Real n = matrix.n_unknowns, n_ranks = matrix.n_ranks;
  if (sizeof(Real) * cost.entries > max_bytes_per_rank * n_ranks) return false;
  const Real n_cycles = matrix.alone ? n_alone : n_coupled, n_solves = matrix.alone ? n_alone_by_factors : n_coupled;
  const Real factors = per_operation * cost.operations / std::sqrt(n_ranks) + of_transfer * n +
                       n_solves * (per_entry * cost.entries + per_unknown * n);
  return factors < (of_setup + n_cycles * of_two_cycles) * n / n_ranks;
}

}  // namespace sprekk::solve
