// Estimated costs of factors and of multigrid for fields on facets.
#pragma once

#include "base/view.hpp"

namespace sprekk::solve {

/// Matrix of a field with one unknown per facet.
struct FacetMatrix {
  Real n_unknowns = 0;
  int dim = 3;
  bool alone = false;  ///< no other groups of blocks: the factors solve the whole system
  int n_ranks = 1;
};

/// Factors L U in nested dissection (George 1973; Lipton, Rose and Tarjan 1979). With n unknowns they have about
/// n log2(n) entries and n^(3/2) operations in 2D, n^(4/3) and n^2 in 3D, times constants fitted to runs of MUMPS
/// with up to 1e5 unknowns. `perf bandwidth --factors` compares all estimates of this file with measured values.
struct FactorCost {
  Real operations, entries;
};

FactorCost factor_cost(const FacetMatrix& matrix);

/// Seconds of a set-up, and of an application. The set-up of factors excludes the analysis of the graph, that of
/// multigrid includes new aggregates.
struct InverseCost {
  Real setup, application;
};

/// Ranks share factorisations with an efficiency of 1/sqrt(n_ranks); substitutions gain nothing.
InverseCost cost_of_factors(const FacetMatrix& matrix);
/// An application consists of two cycles.
InverseCost cost_of_multigrid(const FacetMatrix& matrix);

/// Returns whether factors take less time than multigrid in a Newton iteration, a set-up and typical applications, and
/// at most 1 GiB per rank.
bool factors_are_cheaper(const FacetMatrix& matrix);

}  // namespace sprekk::solve
