// What is done to the numbers of J_ab one block at a time.
#pragma once

#include <cstdint>

#include "base/check.hpp"
#include "fields/node_kernels.hpp"
#include "solve/elimination_plan.hpp"

namespace sprekk::solve {

inline auto write_values(Vector& v) {
  return Kokkos::subview(v.getLocalViewDevice(Tpetra::Access::ReadWrite), Kokkos::ALL(), 0);
}

inline auto read_values(const Vector& v) {
  return Kokkos::subview(v.getLocalViewDevice(Tpetra::Access::ReadOnly), Kokkos::ALL(), 0);
}

/// [row] the local column of the same unknown.
struct OwnColumn {
  explicit OwnColumn(const Matrix& matrix)
      : rows(matrix.row_map()->getLocalMap()), columns(matrix.column_map()->getLocalMap()) {}
  KOKKOS_INLINE_FUNCTION LocalIndex operator()(LocalIndex row) const {
    return columns.getLocalElement(rows.getGlobalElement(row));
  }
  Map::local_map_type rows, columns;
};

/// Finds columns in a row, which has all that are looked for, and none twice. Those that it has not are counted, and
/// said to stand where it begins.
struct RowCursor {
  const fields::NodeRows::Row row;
  const int width;
  fields::Cursor nodes;
  LocalIndex next = -1;
  std::size_t place_of_next = 0;  // if it is an unknown of the same node
  int n_left = 0;                 // of these
  int n_missing = 0;

  KOKKOS_FORCEINLINE_FUNCTION RowCursor(const fields::NodeRows& of, LocalIndex i)
      : row(of.row(i)), width(of.width), nodes{&of.column(row.first_node), row.n_nodes} {}
  KOKKOS_FORCEINLINE_FUNCTION std::size_t find(LocalIndex column) {
    if (column == next && n_left > 0) {
      --n_left;
      ++next;
      return place_of_next++;
    }
    const LocalIndex component = column % width;
    const std::size_t node = column < 0 ? row.n_nodes : nodes.find(column / width);
    if (node == row.n_nodes) {
      ++n_missing;
      return row.begin;
    }
    const std::size_t found = row.begin + node * width + component;
    next = column + 1;
    place_of_next = found + 1;
    n_left = width - 1 - component;
    return found;
  }
};

/// Throws an Error that says how many columns were not found.
inline void check_found(int n_missing) {
  SPREKK_CHECK(n_missing == 0, "elimination: {} numbers have no place in the rows of the matrix that must have them",
               n_missing);
}

/// J_ab <- A_ab. Local.
void start_from_bulk(const CondensedBlock& condensed);

/// Rows of unknowns that are prescribed, row_flags [owned row] not 0, and those with a column of one. Local.
View<LocalIndex*> find_held(const CondensedBlock& condensed, const Vector& row_flags);

/// If A_aa, of the r-th of the remaining blocks, stands in J_aa: keeps the numbers that the local groups will change.
/// Local.
void keep_condensed(CondensedBlock& condensed, const std::vector<GroupPlan>& groups, int r, int n_remaining);

/// The same of numbers that constraints or a diagonal [owned row], which may be null, will change. Local.
void keep_held(CondensedBlock& condensed, const Vector& row_flags, const RCP<const Vector>& diagonal);

/// Zeroes rows and columns of the flagged unknowns; keeps |diagonal|, or 1 where it is zero, if the block is diagonal.
/// Local.
void constrain(const CondensedBlock& condensed, const Vector& row_flags, bool diagonal);

/// J_aa += a diagonal [owned row]. Local.
void add_diagonal(const Vector& diagonal, const CondensedBlock& condensed);

/// Changes, but for a chance of about 2^-32, when any bit of any value does: halves of values, plus keys that scatter
/// the places, multiplied and summed (as NH of Black, Halevi, Krawczyk, Krovetz and Rogaway 1999). Local.
std::uint64_t checksum(const CondensedBlock& condensed);

/// Values of some rows of a matrix, put aside.
class RowValues {
 public:
  RowValues(const Matrix& matrix, const View<LocalIndex*>& rows)
      : numbers_(matrix.numbers()), rows_(rows), start_("start", rows.extent(0) + 1) {
    const auto numbers = numbers_;
    const auto start = start_;
    std::size_t n = 0;
    Kokkos::parallel_scan(
        "count values", Kokkos::RangePolicy<Execution>(0, rows.extent(0)),
        KOKKOS_LAMBDA(LocalIndex i, std::size_t & sum, bool last) {
          sum += numbers.length(rows(i));
          if (last) start(i + 1) = sum;
        },
        n);
    value_ = View<Real*>(Kokkos::view_alloc("values put aside", Kokkos::WithoutInitializing), n);
    each(KOKKOS_LAMBDA(const Real& in_matrix, Real& aside) { aside = in_matrix; });
  }

  void put_back() const {
    each(KOKKOS_LAMBDA(Real & in_matrix, const Real& aside) { in_matrix = aside; });
  }

  template <class Move>
  void each(const Move& move) const {
    const auto numbers = numbers_;
    const auto rows = rows_;
    const auto start = start_;
    const auto value = value_;
    Kokkos::parallel_for(
        "move values", Kokkos::RangePolicy<Execution>(0, rows.extent(0)), KOKKOS_LAMBDA(LocalIndex i) {
          const auto begin = numbers.row(rows(i)).begin;
          for (std::size_t k = start(i); k < start(i + 1); ++k) move(numbers.value(begin + k - start(i)), value(k));
        });
  }

 private:
  fields::NodeRows numbers_;
  View<LocalIndex*> rows_;
  View<std::size_t*> start_;
  View<Real*> value_;
};

}  // namespace sprekk::solve
