#include "solve/joined.hpp"

#include <algorithm>
#include <numeric>
#include <unordered_map>

namespace sprekk::solve {
namespace {

using fields::BlockVector;
using fields::CrsMatrix;
using fields::Map;
using fields::Matrix;
using fields::MultiVector;
using fields::Vector;
using Policy = Kokkos::RangePolicy<Execution>;

RCP<const Map> one_after_another(const std::vector<RCP<const Map>>& maps, const std::vector<GlobalIndex>& offsets) {
  if (maps.size() == 1) return maps.front();
  std::vector<GlobalIndex> unknowns;
  for (std::size_t r = 0; r < maps.size(); ++r)
    for (LocalIndex i = 0, n = base::n_local_elements(*maps[r]); i < n; ++i)
      unknowns.push_back(offsets[r] + maps[r]->getGlobalElement(i));
  return fields::make_map(unknowns, maps.front()->getComm());
}

class JoinedOperator : public fields::Operator {
 public:
  JoinedOperator(std::shared_ptr<const Joined> joined, Blocks blocks)
      : joined_(std::move(joined)), blocks_(std::move(blocks)) {}
  RCP<const Map> getDomainMap() const override { return joined_->map(); }
  RCP<const Map> getRangeMap() const override { return joined_->map(); }

  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, Real alpha, Real beta) const override {
    const int n = joined_->n_blocks();
    for (int r = 0; r < n; ++r) {
      const auto to = y.offsetViewNonConst(joined_->map(r), joined_->first(r));
      Real kept = beta;
      for (int s = 0; s < n; ++s) {
        if (blocks_[r * n + s].is_null()) continue;
        const auto from = x.offsetView(joined_->map(s), joined_->first(s));
        const Real factor = alpha * joined_->scale(r) * joined_->scale(s);
        blocks_[r * n + s]->apply(*from, *to, Teuchos::NO_TRANS, factor, kept);
        kept = 1;
      }
      if (kept != 1) to->scale(kept);
    }
  }

 private:
  std::shared_ptr<const Joined> joined_;
  Blocks blocks_;
};

/// The flags of the matrix' columns, from those of its domain.
std::vector<char> of_columns(const Matrix& matrix, const Vector& flags) {
  Vector columns(matrix.column_map());
  matrix.spread(flags, columns);
  const auto values = columns.getLocalViewHost(Tpetra::Access::ReadOnly);
  std::vector<char> taken(values.extent(0));
  for (std::size_t i = 0; i < taken.size(); ++i) taken[i] = values(i, 0) != 0;
  return taken;
}

View<LocalIndex*> on_device(const std::string& name, const std::vector<LocalIndex>& values) {
  View<LocalIndex*> view(name, values.size());
  Kokkos::deep_copy(view, Kokkos::View<const LocalIndex*, Kokkos::HostSpace>(values.data(), values.size()));
  return view;
}

}  // namespace

Joined::Joined(std::vector<RCP<const Map>> maps) : maps_(std::move(maps)), scales_(maps_.size(), 1) {
  GlobalIndex offset = 0;
  LocalIndex first = 0;
  for (const auto& map : maps_) {
    offsets_.push_back(offset);
    firsts_.push_back(first);
    offset += map->getGlobalNumElements();
    first += base::n_local_elements(*map);
  }
  map_ = one_after_another(maps_, offsets_);
}

RCP<Vector> Joined::gather(const BlockVector& b) const {
  if (n_blocks() == 1) return b.front();
  const auto all = rcp(new Vector(map_));
  const auto to = all->getLocalViewDevice(Tpetra::Access::OverwriteAll);
  for (int r = 0; r < n_blocks(); ++r) {
    const auto from = b[r]->getLocalViewDevice(Tpetra::Access::ReadOnly);
    const Real scale = scales_[r];
    const LocalIndex offset = firsts_[r];
    Kokkos::parallel_for(
        "gather", Policy(0, from.extent(0)), KOKKOS_LAMBDA(LocalIndex i) { to(offset + i, 0) = scale * from(i, 0); });
  }
  return all;
}

BlockVector Joined::scatter(const RCP<Vector>& y) const {
  if (n_blocks() == 1) return {y};
  BlockVector x;
  const auto from = y->getLocalViewDevice(Tpetra::Access::ReadOnly);
  for (int r = 0; r < n_blocks(); ++r) {
    x.push_back(rcp(new Vector(maps_[r])));
    const auto to = x[r]->getLocalViewDevice(Tpetra::Access::OverwriteAll);
    const Real scale = scales_[r];
    const LocalIndex offset = firsts_[r];
    Kokkos::parallel_for(
        "scatter", Policy(0, to.extent(0)), KOKKOS_LAMBDA(LocalIndex i) { to(i, 0) = scale * from(offset + i, 0); });
  }
  return x;
}

RCP<const fields::Operator> joined_operator(std::shared_ptr<const Joined> joined, Blocks blocks) {
  if (joined->n_blocks() == 1) return blocks.front();
  return rcp(new JoinedOperator(std::move(joined), std::move(blocks)));
}

JoinedRows::JoinedRows(std::shared_ptr<const Joined> joined, Blocks blocks, const View<LocalIndex*>& rows)
    : joined_(std::move(joined)), blocks_(std::move(blocks)), rows_(rows), columns_(blocks_.size()) {
  const auto host = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), rows);
  for (int r = 0; r < joined_->n_blocks(); ++r)
    first_row_.push_back(static_cast<LocalIndex>(
        std::lower_bound(host.data(), host.data() + host.extent(0), joined_->first(r)) - host.data()));
  first_row_.push_back(static_cast<LocalIndex>(rows.extent(0)));
}

void JoinedRows::subtract_product(const MultiVector& x, MultiVector& y) const {
  const int n = joined_->n_blocks();
  const std::size_t n_vectors = x.getNumVectors();
  const auto rows = rows_;
  for (int k = 0; k < n * n; ++k) {
    if (blocks_[k].is_null()) continue;
    RCP<const MultiVector> from = x.offsetView(joined_->map(k % n), joined_->first(k % n));
    if (const auto& import = blocks_[k]->import(); !import.is_null()) {
      auto& columns = columns_[k];
      if (columns.is_null() || columns->getNumVectors() != n_vectors)
        columns = rcp(new MultiVector(blocks_[k]->column_map(), n_vectors));
      columns->doImport(*from, *import, Tpetra::INSERT);
      from = columns;
    }
    const auto A = blocks_[k]->numbers();
    const auto values = from->getLocalViewDevice(Tpetra::Access::ReadOnly);
    const auto to = y.getLocalViewDevice(Tpetra::Access::ReadWrite);
    const Real scale = joined_->scale(k / n) * joined_->scale(k % n);
    const LocalIndex first = joined_->first(k / n);
    fields::with_width(A.width, [&](auto width) {
      constexpr int w = width();
      for (std::size_t v = 0; v < n_vectors; ++v) {
        const Real* const from_v = Kokkos::subview(values, Kokkos::ALL(), v).data();
        Kokkos::parallel_for(
            "subtract rows", Policy(first_row_[k / n], first_row_[k / n + 1]),
            KOKKOS_LAMBDA(LocalIndex i) { to(i, v) -= scale * A.product<w>(rows(i) - first, from_v); });
      }
    });
  }
}

JoinedMatrix::JoinedMatrix(std::shared_ptr<const Joined> joined, Blocks blocks, std::vector<RCP<Vector>> chosen)
    : joined_(std::move(joined)), blocks_(std::move(blocks)) {
  if (chosen.empty() && joined_->n_blocks() == 1) {
    matrix_ = blocks_.front()->crs();
    std::vector<LocalIndex> all(base::n_local_rows(*matrix_));
    std::iota(all.begin(), all.end(), 0);
    rows_ = on_device("rows", all);
    return;
  }
  if (chosen.empty())
    for (int r = 0; r < joined_->n_blocks(); ++r) {
      chosen.push_back(rcp(new Vector(joined_->map(r))));
      chosen.back()->putScalar(1);
    }
  create(chosen);
}

void JoinedMatrix::create(const std::vector<RCP<Vector>>& chosen) {
  std::vector<GlobalIndex> unknowns;
  std::vector<LocalIndex> rows;
  for (int r = 0; r < joined_->n_blocks(); ++r) {
    const auto taken = chosen[r]->getLocalViewHost(Tpetra::Access::ReadOnly);
    for (LocalIndex row = 0, n_rows = taken.extent(0); row < n_rows; ++row) {
      if (taken(row, 0) == 0) continue;
      unknowns.push_back(joined_->offset(r) + joined_->map(r)->getGlobalElement(row));
      rows.push_back(joined_->first(r) + row);
    }
  }
  rows_ = on_device("rows", rows);
  const auto invalid = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  const auto map = rcp(new Map(invalid, unknowns.data(), unknowns.size(), 0, joined_->map()->getComm()));
  RCP<const Map> columns;
  const auto places = number_columns(chosen, *map, columns);
  std::vector<std::size_t> start;
  const auto of_entries = find_runs(rows, places, start);
  const Teuchos::ArrayRCP<std::size_t> row_start(start.size());
  const Teuchos::ArrayRCP<LocalIndex> column(of_entries.size());
  std::copy(start.begin(), start.end(), row_start.begin());
  std::copy(of_entries.begin(), of_entries.end(), column.begin());
  matrix_ = own_ = rcp(new CrsMatrix(map, columns, 0));
  own_->setAllValues(row_start, column, Teuchos::ArrayRCP<Real>(of_entries.size(), 0));
  own_->expertStaticFillComplete(map, map);
}

/// The columns of all entries, and where those of each row start; and which entry of which block goes where.
std::vector<LocalIndex> JoinedMatrix::find_runs(const std::vector<LocalIndex>& rows, const Places& places,
                                                std::vector<std::size_t>& start) {
  const int n = joined_->n_blocks();
  struct Entry {
    LocalIndex column;
    int block;
    LocalIndex from;
  };
  std::vector<Entry> of_row;
  std::vector<std::vector<LocalIndex>> from(n * n), to(n * n), length(n * n);
  const auto add = [&](int k, LocalIndex place, LocalIndex place_here) {
    if (!from[k].empty() && place == from[k].back() + length[k].back() &&
        place_here == to[k].back() + length[k].back()) {
      ++length[k].back();
      return;
    }
    from[k].push_back(place);
    to[k].push_back(place_here);
    length[k].push_back(1);
  };
  std::vector<LocalIndex> columns;
  start.push_back(0);
  for (const LocalIndex joined_row : rows) {
    int r = n - 1;
    while (joined_row < joined_->first(r)) --r;
    const LocalIndex row = joined_row - joined_->first(r);
    of_row.clear();
    for (int k = r * n; k < (r + 1) * n; ++k) {
      if (blocks_[k].is_null()) continue;
      blocks_[k]->numbers().for_row(row, [&](LocalIndex c, std::size_t place) {
        if (const LocalIndex column = places[k][c]; column >= 0)
          of_row.push_back({column, k, static_cast<LocalIndex>(place)});
      });
    }
    std::sort(of_row.begin(), of_row.end(), [](const Entry& a, const Entry& b) { return a.column < b.column; });
    for (const auto& entry : of_row) {
      add(entry.block, entry.from, static_cast<LocalIndex>(columns.size()));
      columns.push_back(entry.column);
    }
    start.push_back(columns.size());
  }
  for (int k = 0; k < n * n; ++k)
    runs_.push_back({on_device("from", from[k]), on_device("to", to[k]), on_device("length", length[k])});
  return columns;
}

/// For each block the columns' places in the matrix, -1 for those that it does not have: of owned unknowns as in its
/// domain, then of ghosts.
JoinedMatrix::Places JoinedMatrix::number_columns(const std::vector<RCP<Vector>>& chosen, const Map& domain,
                                                  RCP<const Map>& columns) const {
  const int n = joined_->n_blocks();
  const auto owned = base::local_elements(domain);
  std::vector<GlobalIndex> all(owned.begin(), owned.end());
  std::unordered_map<GlobalIndex, LocalIndex> ghosts;
  Places places(n * n);
  for (int k = 0; k < n * n; ++k) {
    if (blocks_[k].is_null()) continue;
    const auto& of_block = *blocks_[k]->column_map();
    const auto taken = of_columns(*blocks_[k], *chosen[k % n]);
    places[k].assign(taken.size(), -1);
    for (std::size_t c = 0; c < taken.size(); ++c) {
      if (!taken[c]) continue;
      const GlobalIndex unknown = joined_->offset(k % n) + of_block.getGlobalElement(static_cast<LocalIndex>(c));
      places[k][c] = domain.getLocalElement(unknown);
      if (places[k][c] >= 0) continue;
      const auto [at, is_new] = ghosts.emplace(unknown, static_cast<LocalIndex>(all.size()));
      if (is_new) all.push_back(unknown);
      places[k][c] = at->second;
    }
  }
  const auto invalid = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  columns = rcp(new Map(invalid, Teuchos::arrayViewFromVector(all), 0, domain.getComm()));
  return places;
}

void JoinedMatrix::update() {
  if (own_.is_null()) return;
  const int n = joined_->n_blocks();
  own_->resumeFill();
  for (int k = 0; k < n * n; ++k) {
    if (blocks_[k].is_null()) continue;
    const auto source = blocks_[k]->numbers().value;
    const auto target = own_->getLocalMatrixDevice().values;
    const auto from = runs_[k].from, to = runs_[k].to, length = runs_[k].length;
    const Real scale = joined_->scale(k / n) * joined_->scale(k % n);
    Kokkos::parallel_for(
        "join", Policy(0, from.extent(0)), KOKKOS_LAMBDA(LocalIndex j) {
          for (LocalIndex i = 0; i < length(j); ++i) target(to(j) + i) = scale * source(from(j) + i);
        });
  }
  own_->fillComplete(own_->getDomainMap(), own_->getRangeMap());
}

}  // namespace sprekk::solve
