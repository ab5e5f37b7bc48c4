// Numbers of a matrix as they were before others wrote over them.
#pragma once

#include <cstdint>

#include "fields/matrix.hpp"
#include "fields/node_kernels.hpp"

namespace sprekk::fields {

/// A matrix A that never changes, stored in another one, J, but for numbers that may change in J: those of A are kept
/// here. The local columns of J begin with those of A; in others, rows that keep nothing have no places, and numbers of
/// J that are not marked are zero. All members are local unless they say otherwise.
class KeptRows {
 public:
  /// Which numbers of which rows: bit p % 64 of word p / 64 of a row belongs to place p of the row.
  struct Marks {
    static constexpr std::size_t word = 64;

    View<LocalIndex*> number;       // [owned row] -1: none of its numbers
    View<LocalIndex*> row;          // [number]
    View<std::size_t*> first_word;  // [number + 1]
    View<std::uint64_t*> bits;

    /// One thread for each row.
    KOKKOS_FORCEINLINE_FUNCTION void set(LocalIndex of_row, std::size_t place) const {
      bits(first_word(number(of_row)) + place / word) |= std::uint64_t(1) << place % word;
    }
  };

  /// The numbers of J are those of A, all of them so far.
  explicit KeptRows(RCP<const Matrix> J);

  /// Room for marks in these rows, [owned row] not 0, and the marks of what is kept already.
  Marks marks(const View<char*>& rows) const;

  /// From now on the marked numbers may change in J, for good.
  void keep(const Marks& marks);

  /// Those that have marks. [number]
  const View<LocalIndex*>& rows() const { return kept_.marks.row; }
  const RCP<const Matrix>& J() const { return J_; }

  /// Gives the numbers that are kept back, to J or a matrix with its graph.
  void restore(const Matrix& matrix) const;

  /// y += A x, x with the ghosts of A.
  void add_local_product(const Vector& x, Vector& y) const;

  /// y += A x. Collective.
  void add_product(const Vector& x, Vector& y) const;

 private:
  struct Kept {
    Marks marks;
    View<std::uint64_t*> present;    // as marks.bits: it is not zero
    View<std::size_t*> first_value;  // [number + 1]
    View<Real*> value;               // those that are not zero

    /// visit(place, value) for what is kept of a row, in the order of places.
    template <class Visit>
    KOKKOS_FORCEINLINE_FUNCTION void for_values(LocalIndex k, const Visit& visit) const {
      std::size_t i = first_value(k), first = 0;
      for (std::size_t w = marks.first_word(k); w < marks.first_word(k + 1); ++w, first += Marks::word)
        for (std::uint64_t left = marks.bits(w); left != 0; left &= left - 1) {
          const std::size_t bit = lowest_bit(left);
          visit(first + bit, present(w) >> bit & 1 ? value(i++) : 0);
        }
    }
  };

  RCP<const Matrix> J_;
  Kept kept_;
};

}  // namespace sprekk::fields
