#include "solve/condensed_block.hpp"

#include "fields/node_kernels.hpp"

namespace sprekk::solve {
namespace {

using Policy = Kokkos::RangePolicy<Execution>;

View<LocalIndex*> numbers_of(const View<char*>& chosen) {
  LocalIndex n = 0;
  const Policy all(0, chosen.extent(0));
  Kokkos::parallel_reduce(
      "count", all, KOKKOS_LAMBDA(LocalIndex i, LocalIndex & sum) { sum += chosen(i) != 0; }, n);
  const View<LocalIndex*> numbers("numbers", n);
  Kokkos::parallel_scan(
      "number", all, KOKKOS_LAMBDA(LocalIndex i, LocalIndex & sum, bool last) {
        if (last && chosen(i)) numbers(sum) = i;
        sum += chosen(i) != 0;
      });
  return numbers;
}

}  // namespace

void start_from_bulk(const CondensedBlock& condensed) {
  if (condensed.saved) return condensed.saved->restore(*condensed.matrix);
  const auto to = condensed.matrix->numbers();
  Kokkos::deep_copy(to.value, 0.0);
  if (condensed.bulk.is_null()) return;
  const auto from = condensed.bulk->numbers();
  const auto column = condensed.bulk_column;
  int n_missing = 0;
  Kokkos::parallel_reduce(
      "copy bulk", Policy(0, from.n_rows()),
      KOKKOS_LAMBDA(LocalIndex row, int& missing) {
        RowCursor cursor(to, row);
        from.for_row(row, [&](LocalIndex c, std::size_t k) { to.value(cursor.find(column(c))) = from.value(k); });
        missing += cursor.n_missing;
      },
      n_missing);
  check_found(n_missing);
}

View<LocalIndex*> find_constrained(const CondensedBlock& condensed, const Vector& row_flags) {
  const auto numbers = condensed.matrix->numbers();
  const auto row_flag = read_values(row_flags);
  const auto column_flag = condensed.constrained;
  const View<char*> constrained("constrained", numbers.n_rows());
  Kokkos::parallel_for(
      "constrained rows", Policy(0, constrained.extent(0)), KOKKOS_LAMBDA(LocalIndex row) {
        bool here = row_flag(row) != 0;
        numbers.for_row(row, [&](LocalIndex column, std::size_t) { here = here || column_flag(column) != 0; });
        constrained(row) = here;
      });
  return numbers_of(constrained);
}

void keep_condensed(CondensedBlock& condensed, const std::vector<GroupPlan>& groups, int r, int n_remaining) {
  if (!condensed.saved) return;
  const auto numbers = condensed.matrix->numbers();
  const View<char*> changes("changes", numbers.n_rows());
  const Policy rows(0, changes.extent(0));
  for (const auto& group : groups) {
    const auto first = group.coupling[r].row_start;
    Kokkos::parallel_for(
        "condensed rows", rows, KOKKOS_LAMBDA(LocalIndex row) {
          if (first(row) < first(row + 1)) changes(row) = 1;
        });
  }
  const auto marks = condensed.saved->marks(changes);
  for (const auto& group : groups) {
    const auto coupling = group.coupling[r];
    const auto column_start = group.response[r].column_start;
    const auto column = group.column[r * n_remaining + r];
    int n_missing = 0;
    Kokkos::parallel_reduce(
        "condensed numbers", rows,
        KOKKOS_LAMBDA(LocalIndex row, int& missing) {
          RowCursor cursor(numbers, row);
          for (LocalIndex pair = coupling.row_start(row); pair < coupling.row_start(row + 1); ++pair)
            for (auto c = column_start(coupling.slot(pair)); c < column_start(coupling.slot(pair) + 1); ++c)
              marks.set(row, cursor.find(column(c)) - cursor.row.begin);
          missing += cursor.n_missing;
        },
        n_missing);
    check_found(n_missing);
  }
  condensed.saved->keep(marks);
  condensed.rows = condensed.saved->rows();
}

void keep_constrained(CondensedBlock& condensed, const Vector& row_flags, const RCP<const Vector>& diagonal) {
  if (!condensed.saved) return;
  const auto numbers = condensed.matrix->numbers();
  const View<char*> changes("changes", numbers.n_rows());
  const Policy rows(0, changes.extent(0));
  const auto constrained = condensed.constrained_rows;
  Kokkos::parallel_for(
      "constrained rows", Policy(0, constrained.extent(0)),
      KOKKOS_LAMBDA(LocalIndex i) { changes(constrained(i)) = 1; });
  const Vector none(row_flags.getMap());
  const auto added = read_values(diagonal.is_null() ? none : *diagonal);
  Kokkos::parallel_for(
      "raised rows", rows, KOKKOS_LAMBDA(LocalIndex row) {
        if (added(row) != 0) changes(row) = 1;
      });
  const auto marks = condensed.saved->marks(changes);
  const OwnColumn own_column(*condensed.matrix);
  const auto row_flag = read_values(row_flags);
  const auto column_flag = condensed.constrained;
  Kokkos::parallel_for(
      "constrained numbers", rows, KOKKOS_LAMBDA(LocalIndex row) {
        if (changes(row) == 0) return;
        const std::size_t begin = numbers.row(row).begin;
        const LocalIndex raised = added(row) != 0 ? own_column(row) : -1;
        numbers.for_row(row, [&](LocalIndex column, std::size_t k) {
          if (row_flag(row) != 0 || column_flag(column) != 0 || column == raised) marks.set(row, k - begin);
        });
      });
  condensed.saved->keep(marks);
  condensed.rows = condensed.saved->rows();
}

void constrain(const CondensedBlock& condensed, const Vector& row_flags, bool diagonal) {
  const auto numbers = condensed.matrix->numbers();
  const OwnColumn own_column(*condensed.matrix);
  const auto row_flag = read_values(row_flags);
  const auto column_flag = condensed.constrained;
  const auto constrained = condensed.constrained_rows;
  Kokkos::parallel_for(
      "constrain", Policy(0, constrained.extent(0)), KOKKOS_LAMBDA(LocalIndex i) {
        const LocalIndex row = constrained(i), own = diagonal ? own_column(row) : -1;
        numbers.for_row(row, [&](LocalIndex column, std::size_t k) {
          if (row_flag(row) == 0 && column_flag(column) == 0) return;
          const Real size = base::fabs(numbers.value(k));
          numbers.value(k) = column == own ? (size > 0 ? size : 1) : 0;
        });
      });
}

void add_diagonal(const Vector& diagonal, const CondensedBlock& condensed) {
  const auto numbers = condensed.matrix->numbers();
  const OwnColumn own_column(*condensed.matrix);
  const auto added = read_values(diagonal);
  const auto changed = condensed.rows;
  Kokkos::parallel_for(
      "add diagonal", Policy(0, changed.extent(0)), KOKKOS_LAMBDA(LocalIndex i) {
        const LocalIndex row = changed(i), own = own_column(row);
        if (added(row) == 0) return;
        numbers.for_row(row, [&](LocalIndex column, std::size_t k) {
          if (column == own) numbers.value(k) += added(row);
        });
      });
}

std::uint64_t checksum(const CondensedBlock& condensed) {
  const auto numbers = condensed.matrix->numbers();
  const auto rows = condensed.rows;
  std::uint64_t sum = 0;
  fields::in_widest_instructions([&] {
    Kokkos::parallel_reduce(
        "checksum", Policy(0, rows.extent(0)),
        KOKKOS_LAMBDA(LocalIndex i, std::uint64_t & partial) {
          const auto begin = numbers.row(rows(i)).begin;
          const auto n = static_cast<std::uint32_t>(numbers.length(rows(i)));
          for (std::uint32_t k = 0; k < n; ++k) {
            const auto bits = __builtin_bit_cast(std::uint64_t, numbers.value(begin + k));
            std::uint32_t key = (static_cast<std::uint32_t>(begin) + k) * 0x9e3779b1u;
            key = (key ^ (key >> 15)) * 0x85ebca6bu;
            const std::uint32_t low = static_cast<std::uint32_t>(bits) + key;
            const std::uint32_t high = static_cast<std::uint32_t>(bits >> 32) + (key ^ (key >> 13)) * 0xc2b2ae35u;
            partial += static_cast<std::uint64_t>(low) * high;
          }
        },
        sum);
  });
  return sum;
}

}  // namespace sprekk::solve
