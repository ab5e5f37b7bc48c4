#include "solve/merged.hpp"

#include <algorithm>

namespace sprekk::solve {

using fields::BlockVector;
using fields::CrsMatrix;
using fields::Map;
using fields::Vector;
using Policy = Kokkos::RangePolicy<Execution>;

Merged::Merged(std::vector<RCP<const Map>> maps, std::vector<RCP<const CrsMatrix>> blocks)
    : maps_(std::move(maps)), blocks_(std::move(blocks)), scales_(maps_.size(), 1) {
  GlobalIndex offset = 0;
  for (const auto& map : maps_) {
    offsets_.push_back(offset);
    offset += map->getGlobalNumElements();
  }
  if (n_blocks() == 1) {
    matrix_ = blocks_.front();
    return;
  }
  matrix_ = merged_ = create();
  find_positions();
}

RCP<CrsMatrix> Merged::create() const {
  std::vector<GlobalIndex> unknowns;
  std::vector<std::size_t> n_entries;
  for (int r = 0; r < n_blocks(); ++r)
    for (LocalIndex row = 0, n = maps_[r]->getNodeNumElements(); row < n; ++row) {
      unknowns.push_back(offsets_[r] + maps_[r]->getGlobalElement(row));
      n_entries.push_back(0);
      for (int s = 0; s < n_blocks(); ++s)
        if (const auto& block = blocks_[r * n_blocks() + s]; !block.is_null())
          n_entries.back() += block->getNumEntriesInLocalRow(row);
    }
  const auto invalid = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  const auto map = rcp(new Map(invalid, unknowns.data(), unknowns.size(), 0, maps_.front()->getComm()));
  const auto matrix =
      rcp(new CrsMatrix(map, Teuchos::arrayView<const std::size_t>(n_entries.data(), n_entries.size())));
  std::vector<GlobalIndex> columns;
  std::vector<Real> zeros;
  for (int r = 0, merged_row = 0; r < n_blocks(); ++r)
    for (LocalIndex row = 0, n = maps_[r]->getNodeNumElements(); row < n; ++row, ++merged_row) {
      columns.clear();
      for (int s = 0; s < n_blocks(); ++s) {
        const auto& block = blocks_[r * n_blocks() + s];
        if (block.is_null()) continue;
        const auto graph = block->getLocalMatrixHost().graph;
        for (auto k = graph.row_map(row); k < graph.row_map(row + 1); ++k)
          columns.push_back(offsets_[s] + block->getColMap()->getGlobalElement(graph.entries(k)));
      }
      zeros.assign(columns.size(), 0);
      matrix->insertGlobalValues(unknowns[merged_row], static_cast<LocalIndex>(columns.size()), zeros.data(),
                                 columns.data());
    }
  matrix->fillComplete(map, map);
  return matrix;
}

void Merged::find_positions() {
  const auto merged = merged_->getLocalMatrixHost().graph;
  const auto& merged_columns = *merged_->getColMap();
  for (int r = 0, first_row = 0; r < n_blocks(); first_row += maps_[r]->getNodeNumElements(), ++r)
    for (int s = 0; s < n_blocks(); ++s) {
      positions_.emplace_back();
      const auto& block = blocks_[r * n_blocks() + s];
      if (block.is_null()) continue;
      const auto graph = block->getLocalMatrixHost().graph;
      positions_.back() = View<LocalIndex*>("positions", graph.entries.extent(0));
      const auto position = Kokkos::create_mirror_view(positions_.back());
      for (LocalIndex row = 0, n_rows = graph.numRows(); row < n_rows; ++row) {
        const auto* begin = &merged.entries(0) + merged.row_map(first_row + row);
        const auto* end = &merged.entries(0) + merged.row_map(first_row + row + 1);
        for (auto k = graph.row_map(row); k < graph.row_map(row + 1); ++k) {
          const auto column =
              merged_columns.getLocalElement(offsets_[s] + block->getColMap()->getGlobalElement(graph.entries(k)));
          position(k) = static_cast<LocalIndex>(std::find(begin, end, column) - &merged.entries(0));
        }
      }
      Kokkos::deep_copy(positions_.back(), position);
    }
}

void Merged::update(const std::vector<Real>& scales) {
  if (n_blocks() == 1) return;
  scales_ = scales;
  merged_->resumeFill();
  for (int r = 0; r < n_blocks(); ++r)
    for (int s = 0; s < n_blocks(); ++s) {
      const auto& block = blocks_[r * n_blocks() + s];
      if (block.is_null()) continue;
      const auto from = block->getLocalMatrixDevice().values, to = merged_->getLocalMatrixDevice().values;
      const auto position = positions_[r * n_blocks() + s];
      const Real scale = scales_[r] * scales_[s];
      Kokkos::parallel_for(
          "merge", Policy(0, position.extent(0)), KOKKOS_LAMBDA(LocalIndex k) { to(position(k)) = scale * from(k); });
    }
  merged_->fillComplete(merged_->getDomainMap(), merged_->getRangeMap());
}

RCP<Vector> Merged::gather(const BlockVector& b) const {
  if (n_blocks() == 1) return b.front();
  const auto all = rcp(new Vector(matrix_->getRangeMap()));
  const auto to = all->getLocalViewDevice(Tpetra::Access::OverwriteAll);
  LocalIndex first = 0;
  for (int r = 0; r < n_blocks(); ++r) {
    const auto from = b[r]->getLocalViewDevice(Tpetra::Access::ReadOnly);
    const Real scale = scales_[r];
    const LocalIndex n = from.extent(0), offset = first;
    Kokkos::parallel_for(
        "gather", Policy(0, n), KOKKOS_LAMBDA(LocalIndex i) { to(offset + i, 0) = scale * from(i, 0); });
    first += n;
  }
  return all;
}

void Merged::scatter(const Vector& y, BlockVector& x) const {
  if (n_blocks() == 1) {
    if (x.front().get() != &y) Tpetra::deep_copy(*x.front(), y);
    return;
  }
  const auto from = y.getLocalViewDevice(Tpetra::Access::ReadOnly);
  LocalIndex first = 0;
  for (int r = 0; r < n_blocks(); ++r) {
    const auto to = x[r]->getLocalViewDevice(Tpetra::Access::OverwriteAll);
    const Real scale = scales_[r];
    const LocalIndex n = to.extent(0), offset = first;
    Kokkos::parallel_for(
        "scatter", Policy(0, n), KOKKOS_LAMBDA(LocalIndex i) { to(i, 0) = scale * from(offset + i, 0); });
    first += n;
  }
}

}  // namespace sprekk::solve
