// Atomic addition to a matrix entry.
#pragma once

#include "fields/matrix.hpp"

namespace sprekk::transport {

using LocalMatrix = fields::CrsMatrix::local_matrix_device_type;

/// Adds to the entry (row, column) of a local matrix. The entry must be in the sparsity pattern.
KOKKOS_INLINE_FUNCTION void add_entry(const LocalMatrix& matrix, LocalIndex row, LocalIndex column, Real value) {
  for (auto i = matrix.graph.row_map(row); i < matrix.graph.row_map(row + 1); ++i)
    if (matrix.graph.entries(i) == column) Kokkos::atomic_add(&matrix.values(i), value);
}

}  // namespace sprekk::transport
