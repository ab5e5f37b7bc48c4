// Rows of a matrix as they were before others wrote over them.
#pragma once

#include <cstdint>

#include "fields/types.hpp"

namespace sprekk::fields {

/// A matrix A that never changes, most of whose rows are stored as those of another matrix J: what J has in the other
/// ones is J's affair, and those of A are kept here. The local columns of J begin with those of A; in rows that are not
/// kept J has no others. All members are local unless they say otherwise.
class KeptRows {
 public:
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
    static constexpr std::size_t word = 64;

    View<LocalIndex*> number;        // [owned row] -1: it is J's
    View<LocalIndex*> row;           // [number]
    View<std::size_t*> first_value;  // [number + 1] of those that are not 0
    View<std::size_t*> first_word;   // [number + 1]
    View<std::uint64_t*> present;    // bit k % 64 of word k / 64 of a row: it has a value in place k of its row of J
    View<Real*> value;

    /// visit(place, value) for the values of a row that is kept, in their order.
    template <class Visit>
    KOKKOS_FORCEINLINE_FUNCTION void for_values(LocalIndex k, const Visit& visit) const {
      std::size_t i = first_value(k), place = 0;
      for (std::size_t w = first_word(k); w < first_word(k + 1); ++w, place += word)
        for (std::uint64_t left = present(w); left != 0; left &= left - 1) visit(place + lowest(left), value(i++));
    }
    KOKKOS_FORCEINLINE_FUNCTION static std::size_t lowest(std::uint64_t bits) { return __builtin_ctzll(bits); }
  };

  RCP<const CrsMatrix> J_;
  Rows kept_;
};

}  // namespace sprekk::fields
