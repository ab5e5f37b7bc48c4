// Saved values of a matrix that shares its storage with another one.
#pragma once

#include <cstdint>

#include "fields/matrix.hpp"
#include "fields/node_kernels.hpp"

namespace sprekk::fields {

/// Constant matrix A stored in another matrix J. Values of A that may change in J are saved here. The local columns of
/// J begin with those of A. In other columns, rows without saved values have no entries, and unmarked values of J are
/// zero. All members are local unless stated otherwise.
class SavedRows {
 public:
  /// Marks of values: bit p % 64 of word p / 64 of a row belongs to place p of the row.
  struct Marks {
    static constexpr std::size_t word = 64;

    View<LocalIndex*> number;       // [owned row] -1: no marks
    View<LocalIndex*> row;          // [number]
    View<std::size_t*> first_word;  // [number + 1]
    View<std::uint64_t*> bits;

    /// Marks a place of a row. Rows may be processed in parallel, but each row by one thread only.
    KOKKOS_FORCEINLINE_FUNCTION void set(LocalIndex of_row, std::size_t place) const {
      bits(first_word(number(of_row)) + place / word) |= std::uint64_t(1) << place % word;
    }
  };

  /// Creates the storage. J must contain the values of A; none is saved yet.
  explicit SavedRows(RCP<const Matrix> J);

  /// Returns marks with space for these rows ([owned row], not 0) and the marks of all saved values.
  Marks marks(const View<char*>& rows) const;

  /// Saves the marked values of J. From now on they may change in J, permanently.
  void keep(const Marks& marks);

  /// Rows with marks. [number]
  const View<LocalIndex*>& rows() const { return saved_.marks.row; }
  const RCP<const Matrix>& J() const { return J_; }

  /// Copies the saved values to J or to a matrix with its graph.
  void restore(const Matrix& matrix) const;

  /// Computes y += A x with the ghosts of x.
  void add_local_product(const Vector& x, Vector& y) const;

  /// Computes y += A x. Collective.
  void add_product(const Vector& x, Vector& y) const;

 private:
  struct Saved {
    Marks marks;
    View<std::uint64_t*> present;    // as marks.bits: the value is not zero
    View<std::size_t*> first_value;  // [number + 1]
    View<Real*> value;               // non-zero saved values

    /// Calls visit(place, value) for the saved values of a row, in the order of places.
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
  Saved saved_;
};

}  // namespace sprekk::fields
