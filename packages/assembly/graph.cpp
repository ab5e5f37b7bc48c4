// Matrix graphs, and positions of stencils in them.
#include "assembly/loop.hpp"
#include "base/check.hpp"
#include "base/host_table.hpp"

#include <algorithm>
#include <numeric>

namespace sprekk::assembly {

using fields::Layout;

namespace {

using HostTable = decltype(base::to_host(ConstView<LocalIndex**>()));

std::shared_ptr<const Writers> writers_of(const Stencil& rows, LocalIndex n_rows) {
  const auto saved = rows.writers.lock();
  if (saved && *saved) {
    SPREKK_CHECK((*saved)->n_rows() == n_rows, "the graph has {} rows, required are {}", (*saved)->n_rows(), n_rows);
    return *saved;
  }
  const auto writers = std::make_shared<const Writers>(rows.first, n_rows);
  if (saved) *saved = writers;
  return writers;
}

using Couplings = std::vector<std::pair<Stencil, Stencil>>;

/// Sorted columns of each group of rows, group after group, and their number by the first row of the group.
struct Columns {
  std::vector<LocalIndex> columns, counts;

  Columns(LocalIndex n_rows, LocalIndex n_columns, const Couplings& couplings)
      : counts(n_rows, 0), end_of_(n_columns, 0) {
    for (const auto& [rows, row_columns] : couplings) {
      writers_.push_back(writers_of(rows, n_rows));
      first_.push_back(base::to_host(row_columns.first));
    }
    for (LocalIndex row = 0; row < n_rows; row += couplings.front().first.width) {
      for (std::size_t k = 0; k < couplings.size(); ++k)
        writers_[k]->for_each(row, [&](LocalIndex e, LocalIndex) {
          for (std::size_t c = 0; c < first_[k].extent(1); ++c) add(first_[k](e, c), couplings[k].second.width);
        });
      const std::size_t before = columns.size();
      finish_row();
      counts[row] = static_cast<LocalIndex>(columns.size() - before);
    }
  }

 private:
  void add(LocalIndex first, int width) {
    if (first < 0) return;
    if (end_of_[first] == 0) groups_.push_back(first);
    end_of_[first] = std::max(end_of_[first], first + width);
  }
  void finish_row() {
    std::sort(groups_.begin(), groups_.end());
    LocalIndex next = 0;  // groups may overlap
    for (LocalIndex first : groups_) {
      for (next = std::max(next, first); next < end_of_[first]; ++next) columns.push_back(next);
      end_of_[first] = 0;
    }
    groups_.clear();
  }

  std::vector<std::shared_ptr<const Writers>> writers_;  // [coupling]
  std::vector<HostTable> first_;                         // [coupling](entity, group)
  std::vector<LocalIndex> end_of_, groups_;  // [first column] end of a group in the current row, else 0; these columns
};

}  // namespace

Writers::Writers(const ConstView<LocalIndex**>& first, LocalIndex n_rows) : start_(n_rows + 2, 0) {
  const auto host = base::to_host(first);
  const auto for_owned = [&](const auto& visit) {
    for (std::size_t e = 0; e < host.extent(0); ++e)
      for (std::size_t r = 0; r < host.extent(1); ++r)
        if (const LocalIndex row = host(e, r); row >= 0 && row < n_rows)
          visit(row, std::array<LocalIndex, 2>{static_cast<LocalIndex>(e), static_cast<LocalIndex>(r)});
  };
  for_owned([&](LocalIndex row, const auto&) { ++start_[row + 2]; });
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  entries_.resize(start_.back());
  for_owned([&](LocalIndex row, const auto& entry) { entries_[start_[row + 1]++] = entry; });
}

ConstView<LocalIndex***> find_positions(const fields::CrsMatrix& matrix, const Stencil& rows, const Stencil& columns) {
  const auto graph = matrix.getCrsGraph()->getLocalGraphHost();
  const auto writers = writers_of(rows, graph.numRows());
  const auto column_first = base::to_host(columns.first);
  const base::HostTable<LocalIndex***> positions("positions", rows.first.extent(0), rows.first.extent(1),
                                                 column_first.extent(1));
  Kokkos::deep_copy(positions.host(), -1);
  std::vector<LocalIndex> position_of(base::n_local_elements(*matrix.getColMap()),
                                      0);  // [column] position in the row; other columns: arbitrary
  for (LocalIndex row = 0, n_rows = graph.numRows(); row < n_rows; row += rows.width) {
    if (!writers->any(row)) continue;
    const auto begin = graph.row_map(row), length = graph.row_map(row + 1) - begin;
    for (std::size_t k = 0; k < length; ++k) position_of[graph.entries(begin + k)] = static_cast<LocalIndex>(k);
    writers->for_each(row, [&](LocalIndex e, LocalIndex r) {
      for (std::size_t c = 0; c < positions.extent(2); ++c) {
        const LocalIndex column = column_first(e, c);
        if (column < 0) continue;
        const LocalIndex k = position_of[column];
        SPREKK_CHECK(static_cast<std::size_t>(k) < length && graph.entries(begin + k) == column,
                     "row {} has no entry for column {}", row, column);
        positions(e, r, c) = k;
      }
    });
  }
  return positions.on_device();
}

RCP<fields::CrsMatrix> make_matrix(const Layout& row_layout, const Layout& column_layout, const Couplings& couplings) {
  const int width = couplings.front().first.width;
  for (const auto& [rows, _] : couplings)
    SPREKK_CHECK(rows.width == width, "rows of {} are written in groups of {} and of {}", row_layout.field().name,
                 width, rows.width);
  const LocalIndex n_rows = row_layout.n_owned();
  const Columns columns(n_rows, base::n_local_elements(*column_layout.ghosted()), couplings);
  using Graph = fields::CrsGraph::local_graph_device_type;
  const Graph::row_map_type::non_const_type row_start("row start", n_rows + 1);
  const Graph::entries_type::non_const_type row_columns("columns", width * columns.columns.size());
  const auto start = Kokkos::create_mirror_view(row_start);
  const auto entries = Kokkos::create_mirror_view(row_columns);
  auto from = columns.columns.begin();
  for (LocalIndex row = 0; row < n_rows; row += width) {
    const LocalIndex count = columns.counts[row];
    for (int i = row; i < row + width; ++i) {
      std::copy_n(from, count, entries.data() + start(i));
      start(i + 1) = start(i) + count;
    }
    from += count;
  }
  Kokkos::deep_copy(row_start, start);
  Kokkos::deep_copy(row_columns, entries);
  const auto graph = rcp(new fields::CrsGraph(row_layout.owned(), column_layout.ghosted(), row_start, row_columns));
  const bool no_ghosts = column_layout.owned()->isSameAs(*column_layout.ghosted());
  graph->expertStaticFillComplete(column_layout.owned(), row_layout.owned(),
                                  no_ghosts ? Teuchos::null : column_layout.import());
  const auto matrix = rcp(new fields::CrsMatrix(graph));
  matrix->fillComplete(column_layout.owned(), row_layout.owned());
  return matrix;
}

}  // namespace sprekk::assembly
