// Rows of a matrix as they were before others wrote over them.
#pragma once

#include <cstdint>
#include <limits>

#include "fields/types.hpp"

namespace sprekk::fields {

/// A matrix A that never changes, most of whose rows are stored as those of another matrix J: what J has in the other
/// ones is J's affair, and those of A are kept here. The local columns of J begin with those of A; in rows that are not
/// kept J has no others. All members are local unless they say otherwise.
class KeptRows {
 public:
  using Place = std::uint16_t;  ///< in a row; no row may have more
  static constexpr std::size_t longest_row = std::numeric_limits<Place>::max();

  /// The values of J are those of A, in all rows so far.
  explicit KeptRows(RCP<const CrsMatrix> J);

  /// From now on the values of these rows may change in J: [owned row] not 0. Rows stay kept for good.
  void keep(const View<char*>& rows);

  /// Those that are kept. [number]
  const View<LocalIndex*>& rows() const { return kept_.row; }

  /// Gives the rows that are kept the values of A, in J or a matrix with its graph.
  void restore(const CrsMatrix& matrix) const;

  /// y += A x, x with the ghosts of A.
  void add_local_product(const Vector& x, Vector& y) const;

  /// y += A x. Collective.
  void add_product(const Vector& x, Vector& y) const;

 private:
  struct Rows {
    View<LocalIndex*> number;  // [owned row] -1: it is J's
    View<LocalIndex*> row;     // [number]
    View<std::size_t*> start;  // [number + 1] of values that are not 0
    View<Place*> place;        // of a value in its row of J
    View<Real*> value;
  };

  RCP<const CrsMatrix> J_;
  Rows kept_;
};

}  // namespace sprekk::fields
