// Largest values over all ranks, with their positions.
#pragma once

#include "mesh/facets.hpp"

#include <limits>
#include <vector>

namespace sprekk::mesh {

/// Largest value and its position. Among equal values, the smallest position counts (x, then y, then z), on any
/// partition.
struct Extreme {
  static constexpr Real none = -std::numeric_limits<Real>::max();  ///< value without offers
  Real value = none;
  Vector x{};

  void offer(Real other, const Vector& at) {
    if (other > value || (other == value && at < x)) *this = {other, at};
  }
};

/// Replaces each element by the largest over all ranks. Collective.
void take_largest(const Comm& comm, std::vector<Extreme>& all);

}  // namespace sprekk::mesh
