// Matrices with places for what they have only.
#pragma once

#include "fields/types.hpp"

namespace sprekk::fields {

/// A without places for zeros, on the same maps; A itself where it has none. Collective.
RCP<CrsMatrix> without_zeros(const RCP<CrsMatrix>& A);

}  // namespace sprekk::fields
