// Operations on the values of J_ab, one block at a time.
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

/// Map from a row to the local column of the same unknown.
struct OwnColumn {
  explicit OwnColumn(const Matrix& matrix)
      : rows(matrix.row_map()->getLocalMap()), columns(matrix.column_map()->getLocalMap()) {}
  KOKKOS_INLINE_FUNCTION LocalIndex operator()(LocalIndex row) const {
    return columns.getLocalElement(rows.getGlobalElement(row));
  }
  Map::local_map_type rows, columns;
};

/// Cursor that finds columns in a row. The row must contain each column that is searched, once. Missing columns are
/// counted; find() then returns the beginning of the row.
struct RowCursor {
  const fields::NodeRows::Row row;
  const int width;
  fields::Cursor nodes;
  LocalIndex next = -1;
  std::size_t place_of_next = 0;  // if `next` is an unknown of the same node
  int n_left = 0;                 // remaining unknowns of the node
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

/// Throws an Error with the number of missing columns, if not zero.
inline void check_found(int n_missing) {
  SPREKK_CHECK(n_missing == 0, "elimination: {} numbers have no place in the rows of the matrix that must have them",
               n_missing);
}

/// Sets J_ab to A_ab. Local.
void start_from_bulk(const CondensedBlock& condensed);

/// Returns the rows of prescribed unknowns, row_flags [owned row] != 0, and rows with such a column. Local.
View<LocalIndex*> find_constrained(const CondensedBlock& condensed, const Vector& row_flags);

/// If J_aa stores A_aa of the r-th remaining block, saves the values that the local groups will change. Local.
void keep_condensed(CondensedBlock& condensed, const std::vector<GroupPlan>& groups, int r, int n_remaining);

/// Saves the values that constraints or a diagonal [owned row] will change, likewise. The diagonal may be null. Local.
void keep_constrained(CondensedBlock& condensed, const Vector& row_flags, const RCP<const Vector>& diagonal);

/// Zeroes rows and columns of the flagged unknowns. If `diagonal`, the diagonal keeps its absolute value, or 1 if it is
/// zero. Local.
void constrain(const CondensedBlock& condensed, const Vector& row_flags, bool diagonal);

/// Adds a diagonal [owned row] to J_aa. Local.
void add_diagonal(const Vector& diagonal, const CondensedBlock& condensed);

/// Returns a checksum of all values. If a bit changes, the checksum changes, except with a probability of about 2^-32.
/// Halves of the values, plus keys for their positions, are multiplied and summed (as in NH of Black, Halevi, Krawczyk,
/// Krovetz and Rogaway 1999). Local.
std::uint64_t checksum(const CondensedBlock& condensed);

/// Copy of the values of some rows of a matrix.
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

  /// Restores the values in the matrix. Local.
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
