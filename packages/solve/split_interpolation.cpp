#include "solve/split_interpolation.hpp"

#include <Tpetra_CrsMatrix.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "base/over_ranks.hpp"

namespace sprekk::solve {
namespace {

using fields::Map;
using fields::MultiVector;

constexpr Real rounding = 1e-12;  // smaller couplings, relative to the diagonals, are zero
constexpr Real weak = 0.1;        // largest weak coupling, relative to the diagonals

/// Returns the values of the owned rows for all columns of A. Collective.
MultiVector with_ghosts(const CrsMatrix& A, const MultiVector& owned) {
  const auto import = A.getGraph()->getImporter();
  MultiVector all(A.getColMap(), owned.getNumVectors());
  import.is_null() ? all.assign(owned) : all.doImport(owned, *import, Tpetra::INSERT);
  return all;
}

/// Calls visit(row, column, value) for the entries of the owned rows that are not zero, with global columns.
template <class Visit>
void for_entries(const CrsMatrix& P, const Visit& visit) {
  const auto local = P.getLocalMatrixHost();
  const auto columns = P.getColMap()->getLocalMap();
  for (LocalIndex row = 0; row < local.numRows(); ++row)
    for (auto k = local.graph.row_map(row); k < local.graph.row_map(row + 1); ++k)
      if (local.values(k) != 0) visit(row, columns.getGlobalElement(local.graph.entries(k)), local.values(k));
}

/// Strong couplings of the owned rows of a square matrix, without the diagonal.
struct Strong {
  std::vector<std::size_t> start;
  std::vector<LocalIndex> column;
};

/// Calls visit(entry, row, column, size relative to the diagonals) for the entries of the owned rows outside of the
/// diagonal. Collective.
template <class Visit>
void for_couplings(const CrsMatrix& A, const Visit& visit) {
  fields::Vector diagonal(A.getRowMap());
  A.getLocalDiagCopy(diagonal);
  const auto everywhere = with_ghosts(A, diagonal);
  const auto of_row = diagonal.getLocalViewHost(Tpetra::Access::ReadOnly),
             of_column = everywhere.getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto local = A.getLocalMatrixHost();
  const auto rows = A.getRowMap()->getLocalMap(), columns = A.getColMap()->getLocalMap();
  for (LocalIndex row = 0; row < local.numRows(); ++row)
    for (auto k = local.graph.row_map(row); k < local.graph.row_map(row + 1); ++k) {
      const LocalIndex column = local.graph.entries(k);
      const Real unit = std::sqrt(std::abs(of_row(row, 0) * of_column(column, 0)));
      if (columns.getGlobalElement(column) == rows.getGlobalElement(row)) continue;
      visit(k, row, column, unit > 0 ? std::abs(local.values(k)) / unit : 0);
    }
}

/// Collective.
Strong strong_couplings(const CrsMatrix& A) {
  Strong strong;
  strong.start.assign(base::n_local_elements(*A.getRowMap()) + 1, 0);
  for_couplings(A, [&](std::size_t, LocalIndex row, LocalIndex column, Real size) {
    if (size > weak) strong.column.push_back(column);
    strong.start[row + 1] = strong.column.size();
  });
  for (std::size_t row = 1; row < strong.start.size(); ++row)
    strong.start[row] = std::max(strong.start[row], strong.start[row - 1]);
  return strong;
}

/// Labels of the entries of P. An entry starts with a label of its own. Entries of one column in strongly coupled rows
/// take the smallest label of both, until nothing changes. Rows without an entry in a column of a strongly coupled row
/// are guests of this column. They connect its rows, for example the faces of a cell that are perpendicular to each
/// other, whose coupling may be zero.
class Labels {
 public:
  Labels(const CrsMatrix& A, const CrsMatrix& P, const Strong& strong) : rows_(A.getRowMap()) {
    for (const GlobalIndex row : base::local_elements(*rows_)) at_.push_back(A.getColMap()->getLocalElement(row));
    find_columns(A, P, strong);
    join(A, P, strong);
  }

  /// Label of the entry of an owned row in a column.
  GlobalIndex operator()(std::size_t row, GlobalIndex column) const { return label_[place(row, column)]; }
  /// Returns whether the entry has its first label.
  bool is_first(std::size_t row, GlobalIndex column) const { return (*this)(row, column) == own(row, column); }

 private:
  static constexpr GlobalIndex none = GlobalIndex(1) << 52;  // exact in double precision

  std::size_t place(std::size_t row, GlobalIndex column) const {
    const auto begin = column_.begin() + at_[row] * width_;
    return std::lower_bound(begin, begin + width_, column) - column_.begin();
  }
  GlobalIndex own(std::size_t row, GlobalIndex column) const {
    const auto slot = static_cast<GlobalIndex>(place(row, column)) - GlobalIndex(at_[row]) * width_;
    return rows_->getGlobalElement(static_cast<LocalIndex>(row)) * width_ + slot;
  }

  /// Returns the numbers [column of A, slot] for those of the owned rows. Collective.
  std::vector<GlobalIndex> everywhere(const CrsMatrix& A, const std::vector<std::vector<GlobalIndex>>& owned,
                                      int width) const {
    MultiVector x(rows_, width);
    x.putScalar(static_cast<Real>(none));
    {
      const auto view = x.getLocalViewHost(Tpetra::Access::ReadWrite);
      for (std::size_t row = 0; row < owned.size(); ++row)
        for (std::size_t s = 0; s < owned[row].size(); ++s) view(row, s) = static_cast<Real>(owned[row][s]);
    }
    const auto all = with_ghosts(A, x);
    const auto view = all.getLocalViewHost(Tpetra::Access::ReadOnly);
    std::vector<GlobalIndex> result;
    for (std::size_t column = 0; column < view.extent(0); ++column)
      for (int s = 0; s < width; ++s) result.push_back(static_cast<GlobalIndex>(view(column, s)));
    return result;
  }

  /// Finds the columns of the entries and of guests, in ascending order.
  void find_columns(const CrsMatrix& A, const CrsMatrix& P, const Strong& strong) {
    const auto width = static_cast<int>(P.getGlobalMaxNumRowEntries());
    std::vector<std::vector<GlobalIndex>> of_rows(at_.size());
    for_entries(P, [&](LocalIndex row, GlobalIndex column, Real) { of_rows[row].push_back(column); });
    const auto of_all = everywhere(A, of_rows, width);
    int most = 0;
    for (std::size_t row = 0; row < at_.size(); ++row) {
      auto& columns = of_rows[row];
      for (std::size_t k = strong.start[row]; k < strong.start[row + 1]; ++k)
        for (int s = 0; s < width; ++s)
          if (const auto column = of_all[strong.column[k] * width + s]; column < none) columns.push_back(column);
      std::sort(columns.begin(), columns.end());
      columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
      most = std::max(most, static_cast<int>(columns.size()));
    }
    width_ = base::max_over_ranks(*rows_->getComm(), most);
    column_ = everywhere(A, of_rows, width_);
  }

  void join(const CrsMatrix& A, const CrsMatrix& P, const Strong& strong) {
    label_.assign(column_.size(), none);
    for_entries(P, [&](LocalIndex row, GlobalIndex column, Real) { label_[place(row, column)] = own(row, column); });
    const auto pairs = joined_places(strong);
    bool changed = true;
    while (base::on_any_rank(*rows_->getComm(), changed)) {
      std::vector<std::vector<GlobalIndex>> owned;
      for (const LocalIndex at : at_)
        owned.emplace_back(label_.begin() + at * width_, label_.begin() + (at + 1) * width_);
      label_ = everywhere(A, owned, width_);
      changed = false;
      for (bool again = true; again; changed = changed || again) {
        again = false;
        for (const auto& [here, there] : pairs)
          if (label_[there] < label_[here]) {
            label_[here] = label_[there];
            again = true;
          }
      }
    }
  }

  /// Returns the places of owned rows with the same column in strongly coupled rows: (place, place in the other row).
  std::vector<std::pair<int, int>> joined_places(const Strong& strong) const {
    std::vector<std::pair<int, int>> pairs;
    for (std::size_t row = 0; row < at_.size(); ++row)
      for (std::size_t k = strong.start[row]; k < strong.start[row + 1]; ++k) {
        int here = at_[row] * width_, there = strong.column[k] * width_;
        const int end_here = here + width_, end_there = there + width_;
        while (here < end_here && there < end_there && column_[here] < none) {
          if (column_[here] == column_[there]) pairs.emplace_back(here, there);
          column_[here] < column_[there] ? ++here : ++there;
        }
      }
    return pairs;
  }

  RCP<const Map> rows_;
  int width_ = 0;
  std::vector<LocalIndex> at_;               // [owned row] local column of A
  std::vector<GlobalIndex> column_, label_;  // [local column of A, slot]; `none` in empty slots, and labels of guests
};

/// Map with the elements of each rank of another map, numbered consecutively. Collective.
RCP<const Map> consecutive(const Map& map) {
  return rcp(new const Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(), base::n_local_elements(map), 0,
                           map.getComm()));
}

/// Returns the consecutive numbers of the elements of `all` in the map `owned`. Collective.
std::vector<GlobalIndex> numbered(const RCP<const Map>& owned, const RCP<const Map>& all) {
  const auto map = consecutive(*owned);
  fields::Vector of_owned(owned), of_all(all);
  {
    const auto view = of_owned.getLocalViewHost(Tpetra::Access::OverwriteAll);
    for (std::size_t i = 0; i < view.extent(0); ++i)
      view(i, 0) = static_cast<Real>(map->getGlobalElement(static_cast<LocalIndex>(i)));
  }
  of_all.doImport(of_owned, Tpetra::Import<LocalIndex, GlobalIndex>(owned, all), Tpetra::INSERT);
  const auto view = of_all.getLocalViewHost(Tpetra::Access::ReadOnly);
  std::vector<GlobalIndex> numbers;
  for (std::size_t i = 0; i < view.extent(0); ++i) numbers.push_back(static_cast<GlobalIndex>(view(i, 0)));
  return numbers;
}

}  // namespace

std::vector<bool> weak_couplings(const CrsMatrix& A) {
  std::vector<bool> is_weak(base::n_local_entries(A), false);
  for_couplings(A, [&](std::size_t entry, LocalIndex, LocalIndex, Real size) {
    is_weak[entry] = size > rounding && size <= weak;
  });
  return is_weak;
}

RCP<const CrsMatrix> split_interpolation(const CrsMatrix& A, const RCP<const CrsMatrix>& P) {
  const auto is_weak = weak_couplings(A);
  const bool any_weak = std::find(is_weak.begin(), is_weak.end(), true) != is_weak.end();
  if (!base::on_any_rank(*A.getComm(), any_weak)) return P;
  const auto strong = strong_couplings(A);
  const Labels labels(A, *P, strong);
  std::vector<GlobalIndex> columns, others;
  for_entries(*P, [&](LocalIndex row, GlobalIndex column, Real) {
    (labels.is_first(row, column) ? columns : others).push_back(labels(row, column));
  });
  const auto domain = fields::make_map(columns, A.getComm());
  std::sort(others.begin(), others.end());
  others.erase(std::unique(others.begin(), others.end()), others.end());
  for (const GlobalIndex label : others)
    if (!domain->isNodeGlobalElement(label)) columns.push_back(label);
  const auto of = fields::make_map(columns, A.getComm());
  const auto numbers = numbered(domain, of);
  std::vector<std::size_t> start(base::n_local_elements(*A.getRowMap()) + 1, 0);
  std::vector<LocalIndex> column_of;
  std::vector<Real> value;
  for_entries(*P, [&](LocalIndex row, GlobalIndex column, Real entry) {
    column_of.push_back(of->getLocalElement(labels(row, column)));
    value.push_back(entry);
    start[row + 1] = column_of.size();
  });
  for (std::size_t row = 1; row < start.size(); ++row) start[row] = std::max(start[row], start[row - 1]);
  const auto shared = [](auto& values) { return Teuchos::arcp(rcp(new auto(std::move(values)))); };
  const auto split = rcp(new CrsMatrix(A.getRowMap(), fields::make_map(numbers, A.getComm()), shared(start),
                                       shared(column_of), shared(value)));
  split->expertStaticFillComplete(consecutive(*domain), A.getRowMap());
  return split;
}

}  // namespace sprekk::solve
