#include "solve/factor_cost.hpp"

#include <cmath>

namespace sprekk::solve {
namespace {

constexpr Real n_coupled = 20;                         // applications in a Newton iteration of coupled fields
constexpr Real n_alone = 100, n_alone_by_factors = 3;  // the same for a field without others
constexpr Real max_bytes_per_rank = 1LL << 30;

// CPU seconds, fitted to `perf bandwidth --factors`
constexpr Real per_operation = 2.2e-11;
constexpr Real per_entry = 6e-10, per_unknown = 3e-7;                                  // of a substitution
constexpr Real of_transfer = 1.1e-6;                                                   // to MUMPS, per unknown
constexpr Real of_setup = 3.5e-6, of_two_cycles_2d = 6.5e-7, of_two_cycles_3d = 3e-7;  // of multigrid, per unknown

}  // namespace

FactorCost factor_cost(const FacetMatrix& matrix) {
  const Real n = matrix.n_unknowns;
  if (matrix.dim < 3) return {12.5 * std::pow(n, 1.5), 2.5 * n * std::log2(n + 1)};
  return {4.3 * n * n, 7 * std::pow(n, 4.0 / 3)};
}

InverseCost cost_of_factors(const FacetMatrix& matrix) {
  const auto [operations, entries] = factor_cost(matrix);
  const Real n = matrix.n_unknowns;
  return {per_operation * operations / std::sqrt(Real(matrix.n_ranks)) + of_transfer * n,
          per_entry * entries + per_unknown * n};
}

InverseCost cost_of_multigrid(const FacetMatrix& matrix) {
  const Real n = matrix.n_unknowns / matrix.n_ranks;
  return {of_setup * n, (matrix.dim < 3 ? of_two_cycles_2d : of_two_cycles_3d) * n};
}

bool factors_are_cheaper(const FacetMatrix& matrix) {
  if (sizeof(Real) * factor_cost(matrix).entries > max_bytes_per_rank * matrix.n_ranks) return false;
  const auto factors = cost_of_factors(matrix), multigrid = cost_of_multigrid(matrix);
  const Real n_cycles = matrix.alone ? n_alone : n_coupled, n_solves = matrix.alone ? n_alone_by_factors : n_coupled;
  return factors.setup + n_solves * factors.application < multigrid.setup + n_cycles * multigrid.application;
}

}  // namespace sprekk::solve
