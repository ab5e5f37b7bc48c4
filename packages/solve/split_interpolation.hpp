// Coarse unknowns for each side of a discontinuity of the coefficients.
#pragma once

#include <vector>

#include "fields/types.hpp"

namespace sprekk::solve {

using fields::CrsMatrix;

/// Returns whether the entries of the owned rows of A are weak couplings:
///   0 < |a_ij| <= 0.1 sqrt(|a_ii a_jj|) .
/// Conductivities that differ by a factor of about 30 or more cause weak couplings. Collective.
std::vector<bool> weak_couplings(const CrsMatrix& A);

/// Returns an interpolation like P in which a column has one copy for each set of its rows that strong couplings of A
/// connect, directly or through rows next to them. Row i keeps its values and takes the copy of its set. Weak couplings
/// and zeros do not connect rows. A function that is constant in each region of equal coefficients is then a coarse
/// function, also where regions of the larger coefficient meet in an edge or a point only. Zero values of P are
/// omitted. Returns P itself if A has no such couplings. A and P have the same rows. Collective.
RCP<const CrsMatrix> split_interpolation(const CrsMatrix& A, const RCP<const CrsMatrix>& P);

}  // namespace sprekk::solve
