// Reactions: sums of rows over the unknowns that conditions prescribe.
#pragma once

#include "assembly/structure.hpp"

#include <array>
#include <string>
#include <vector>

namespace sprekk::assembly {

/// Sum of the residuals of a field over the unknowns that a condition prescribes. For motions of bodies: force of the
/// supports on the body.
struct Reaction {
  std::string condition, field;
  std::vector<Real> force;         ///< [component], in the unit of the rows, e.g. N (2D: N/m)
  std::array<Real, 3> moment{};    ///< sum x cross f about the origin, N m; in 2D only the last component, N
  int region = -1, fracture = -1;  ///< place of the condition; -1 both: on a boundary
  Reactions called = {};
};

/// Returns the sums of rows r over the unknowns of each condition. An unknown with two conditions counts for the first.
/// Collective.
std::vector<Reaction> sum_prescribed(const Structure& structure, const fields::BlockVector& r);

}  // namespace sprekk::assembly
