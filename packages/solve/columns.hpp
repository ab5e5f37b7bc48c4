// Values for the columns of a matrix on a rank.
#pragma once

#include "fields/types.hpp"

namespace sprekk::solve {

/// columns <- x with ghosts, in the order of the columns of A on this rank. x [domain of A], columns [column map of A].
/// Collective.
inline void spread(const fields::Vector& x, const fields::CrsMatrix& A, fields::Vector& columns) {
  const auto import = A.getGraph()->getImporter();
  if (import.is_null())
    Tpetra::deep_copy(columns, x);
  else
    columns.doImport(x, *import, Tpetra::INSERT);
}

}  // namespace sprekk::solve
