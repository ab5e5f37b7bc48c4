// Removal of stored zeros from matrices.
#pragma once

#include "fields/types.hpp"

namespace sprekk::fields {

/// Returns A without stored zeros, on the same maps. Returns A itself if it has none on any rank. Collective.
RCP<CrsMatrix> without_zeros(const RCP<CrsMatrix>& A);

}  // namespace sprekk::fields
