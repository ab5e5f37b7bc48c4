#include "solve/joined.hpp"

#include <algorithm>
#include <numeric>

#include "solve/columns.hpp"

namespace sprekk::solve {
namespace {

using fields::BlockVector;
using fields::CrsMatrix;
using fields::Map;
using fields::MultiVector;
using fields::Vector;
using Policy = Kokkos::RangePolicy<Execution>;

RCP<const Map> one_after_another(const std::vector<RCP<const Map>>& maps, const std::vector<GlobalIndex>& offsets) {
  if (maps.size() == 1) return maps.front();
  std::vector<GlobalIndex> unknowns;
  for (std::size_t r = 0; r < maps.size(); ++r)
    for (LocalIndex i = 0, n = maps[r]->getNodeNumElements(); i < n; ++i)
      unknowns.push_back(offsets[r] + maps[r]->getGlobalElement(i));
  const auto invalid = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  return rcp(new Map(invalid, unknowns.data(), unknowns.size(), 0, maps.front()->getComm()));
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
std::vector<char> of_columns(const CrsMatrix& matrix, const Vector& flags) {
  Vector columns(matrix.getColMap());
  spread(flags, matrix, columns);
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
    first += map->getNodeNumElements();
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

void Joined::scatter(const Vector& y, BlockVector& x) const {
  if (n_blocks() == 1 && x.front().get() == &y) return;
  const auto from = y.getLocalViewDevice(Tpetra::Access::ReadOnly);
  for (int r = 0; r < n_blocks(); ++r) {
    const auto to = x[r]->getLocalViewDevice(Tpetra::Access::OverwriteAll);
    const Real scale = scales_[r];
    const LocalIndex offset = firsts_[r];
    Kokkos::parallel_for(
        "scatter", Policy(0, to.extent(0)), KOKKOS_LAMBDA(LocalIndex i) { to(i, 0) = scale * from(offset + i, 0); });
  }
}

RCP<const fields::Operator> joined_operator(std::shared_ptr<const Joined> joined, Blocks blocks) {
  if (joined->n_blocks() == 1) return blocks.front();
  return rcp(new JoinedOperator(std::move(joined), std::move(blocks)));
}

JoinedMatrix::JoinedMatrix(std::shared_ptr<const Joined> joined, Blocks blocks, std::vector<RCP<Vector>> chosen,
                           Columns columns)
    : joined_(std::move(joined)), blocks_(std::move(blocks)) {
  if (chosen.empty() && joined_->n_blocks() == 1) {
    matrix_ = blocks_.front();
    std::vector<LocalIndex> all(matrix_->getNodeNumRows());
    std::iota(all.begin(), all.end(), 0);
    rows_ = on_device("rows", all);
    return;
  }
  if (chosen.empty())
    for (int r = 0; r < joined_->n_blocks(); ++r) {
      chosen.push_back(rcp(new Vector(joined_->map(r))));
      chosen.back()->putScalar(1);
    }
  create(chosen, columns);
  find_entries();
}

void JoinedMatrix::create(const std::vector<RCP<Vector>>& chosen, Columns which) {
  const int n = joined_->n_blocks();
  std::vector<std::vector<char>> taken(n * n);  // [r * n + s][column]
  for (int k = 0; k < n * n; ++k)
    if (!blocks_[k].is_null()) taken[k] = of_columns(*blocks_[k], *chosen[k % n]);
  std::vector<GlobalIndex> unknowns;
  std::vector<LocalIndex> rows;
  std::vector<std::vector<GlobalIndex>> columns;
  for (int r = 0; r < n; ++r) {
    const auto row_taken = chosen[r]->getLocalViewHost(Tpetra::Access::ReadOnly);
    for (LocalIndex row = 0, n_rows = row_taken.extent(0); row < n_rows; ++row) {
      if (row_taken(row, 0) == 0) continue;
      unknowns.push_back(joined_->offset(r) + joined_->map(r)->getGlobalElement(row));
      rows.push_back(joined_->first(r) + row);
      columns.emplace_back();
      for (int s = 0; s < n; ++s) {
        const auto& block = blocks_[r * n + s];
        if (block.is_null()) continue;
        const auto graph = block->getLocalMatrixHost().graph;
        for (auto k = graph.row_map(row); k < graph.row_map(row + 1); ++k)
          if (which == Columns::all || taken[r * n + s][graph.entries(k)])
            columns.back().push_back(joined_->offset(s) + block->getColMap()->getGlobalElement(graph.entries(k)));
      }
    }
  }
  const auto invalid = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  const auto map = rcp(new Map(invalid, unknowns.data(), unknowns.size(), 0, joined_->map()->getComm()));
  std::vector<std::size_t> n_entries;
  for (const auto& row : columns) n_entries.push_back(row.size());
  matrix_ = own_ = rcp(new CrsMatrix(map, Teuchos::arrayView<const std::size_t>(n_entries.data(), n_entries.size())));
  std::vector<Real> zeros;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    zeros.assign(columns[i].size(), 0);
    own_->insertGlobalValues(unknowns[i], static_cast<LocalIndex>(columns[i].size()), zeros.data(), columns[i].data());
  }
  own_->fillComplete(which == Columns::all ? joined_->map() : RCP<const Map>(map), map);
  rows_ = on_device("rows", rows);
}

void JoinedMatrix::find_entries() {
  const int n = joined_->n_blocks();
  const auto graph = matrix_->getLocalMatrixHost().graph;
  const auto& columns = *matrix_->getColMap();
  const auto rows = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), rows_);
  std::vector<LocalIndex> row_of(joined_->map()->getNodeNumElements(), -1);
  for (std::size_t i = 0; i < rows.extent(0); ++i) row_of[rows(i)] = static_cast<LocalIndex>(i);
  for (int k = 0; k < n * n; ++k) {
    entries_.emplace_back();
    const auto& block = blocks_[k];
    if (block.is_null()) continue;
    std::vector<LocalIndex> from, to;
    const auto source = block->getLocalMatrixHost().graph;
    for (LocalIndex i = 0, n_rows = source.numRows(); i < n_rows; ++i) {
      const LocalIndex row = row_of[joined_->first(k / n) + i];
      if (row < 0) continue;
      const auto *begin = &graph.entries(0) + graph.row_map(row), *end = &graph.entries(0) + graph.row_map(row + 1);
      for (auto j = source.row_map(i); j < source.row_map(i + 1); ++j) {
        const auto number = joined_->offset(k % n) + block->getColMap()->getGlobalElement(source.entries(j));
        const auto* found = std::find(begin, end, columns.getLocalElement(number));
        if (found == end) continue;
        from.push_back(static_cast<LocalIndex>(j));
        to.push_back(static_cast<LocalIndex>(found - &graph.entries(0)));
      }
    }
    entries_.back() = {on_device("from", from), on_device("to", to)};
  }
}

void JoinedMatrix::update() {
  if (own_.is_null()) return;
  const int n = joined_->n_blocks();
  own_->resumeFill();
  for (int k = 0; k < n * n; ++k) {
    if (blocks_[k].is_null()) continue;
    const auto source = blocks_[k]->getLocalMatrixDevice().values, target = own_->getLocalMatrixDevice().values;
    const auto from = entries_[k].from, to = entries_[k].to;
    const Real scale = joined_->scale(k / n) * joined_->scale(k % n);
    Kokkos::parallel_for(
        "join", Policy(0, from.extent(0)), KOKKOS_LAMBDA(LocalIndex j) { target(to(j)) = scale * source(from(j)); });
  }
  own_->fillComplete(own_->getDomainMap(), own_->getRangeMap());
}

}  // namespace sprekk::solve
