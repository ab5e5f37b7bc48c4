#include "solve/joined.hpp"

#include <algorithm>
#include <unordered_map>

namespace sprekk::solve {
namespace {

using fields::BlockVector;
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
      Real retained = beta;
      for (int s = 0; s < n; ++s) {
        if (blocks_[r * n + s].is_null()) continue;
        const auto from = x.offsetView(joined_->map(s), joined_->first(s));
        const Real factor = alpha * joined_->scale(r) * joined_->scale(s);
        blocks_[r * n + s]->apply(*from, *to, Teuchos::NO_TRANS, factor, retained);
        retained = 1;
      }
      if (retained != 1) to->scale(retained);
    }
  }

 private:
  std::shared_ptr<const Joined> joined_;
  Blocks blocks_;
};

/// Returns the number of unknowns of a node if equal in all blocks, else 1.
int common_size(const Blocks& blocks) {
  int size = 0;
  for (const auto& block : blocks) {
    if (block.is_null()) continue;
    const auto numbers = block->numbers();
    if (numbers.height != numbers.width || (size > 0 && numbers.height != size)) return 1;
    size = numbers.height;
  }
  return std::max(1, size);
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

JoinedMatrix::JoinedMatrix(std::shared_ptr<const Joined> joined, Blocks blocks)
    : joined_(std::move(joined)), blocks_(std::move(blocks)) {
  if (joined_->n_blocks() == 1) {
    matrix_ = blocks_.front();
    return;
  }
  const int here = common_size(blocks_);  // ranks without rows may differ
  int minimum = here, maximum = here;
  const auto& comm = *joined_->map()->getComm();
  Teuchos::reduceAll(comm, Teuchos::REDUCE_MIN, 1, &here, &minimum);
  Teuchos::reduceAll(comm, Teuchos::REDUCE_MAX, 1, &here, &maximum);
  size_ = minimum == maximum ? here : 1;
  RCP<const Map> columns;
  find_runs(number_columns(columns));
  matrix_ = rcp(new Matrix(joined_->map(), columns, joined_->map(), numbers_));
}

/// Returns, for each block, the matrix numbers of its column nodes. Owned nodes are numbered as in the domain, then
/// ghosts.
JoinedMatrix::Nodes JoinedMatrix::number_columns(RCP<const Map>& columns) const {
  const int n = joined_->n_blocks();
  const auto& domain = *joined_->map();
  const auto owned = base::local_elements(domain);
  std::vector<GlobalIndex> all(owned.begin(), owned.end());
  std::unordered_map<GlobalIndex, LocalIndex> ghosts;  // by the first unknown of the node
  Nodes nodes(n * n);
  for (int k = 0; k < n * n; ++k) {
    if (blocks_[k].is_null()) continue;
    const auto& of_block = *blocks_[k]->column_map();
    for (LocalIndex c = 0, end = base::n_local_elements(of_block); c < end; c += size_) {
      const GlobalIndex unknown = joined_->offset(k % n) + of_block.getGlobalElement(c);
      if (const LocalIndex here = domain.getLocalElement(unknown); here >= 0) {
        nodes[k].push_back(here / size_);
        continue;
      }
      const auto [at, is_new] = ghosts.emplace(unknown, static_cast<LocalIndex>(all.size()) / size_);
      for (int i = 0; i < size_ && is_new; ++i) all.push_back(unknown + i);
      nodes[k].push_back(at->second);
    }
  }
  const auto invalid = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  columns = rcp(new Map(invalid, Teuchos::arrayViewFromVector(all), 0, domain.getComm()));
  return nodes;
}

/// Finds the graph of the matrix, and the positions of the blocks' entries in it.
void JoinedMatrix::find_runs(const Nodes& nodes) {
  const int n = joined_->n_blocks();
  struct Entry {
    LocalIndex column;
    int block;
    LocalIndex from;
  };
  struct Found {
    std::vector<LocalIndex> row, from, to, length;
  };
  std::vector<Entry> of_row;
  std::vector<Found> found(n * n);
  std::vector<LocalIndex> columns;
  std::vector<std::size_t> start(1, 0);
  const auto add = [&](Found& runs, LocalIndex row, LocalIndex from, LocalIndex to) {
    if (!runs.row.empty() && runs.row.back() == row && from == runs.from.back() + runs.length.back() &&
        to == runs.to.back() + runs.length.back()) {
      ++runs.length.back();
      return;
    }
    runs.row.push_back(row);
    runs.from.push_back(from);
    runs.to.push_back(to);
    runs.length.push_back(1);
  };
  for (int r = 0; r < n; ++r)
    for (LocalIndex i = 0, end = base::n_local_elements(*joined_->map(r)) / size_; i < end; ++i) {
      of_row.clear();
      for (int k = r * n; k < (r + 1) * n; ++k) {
        if (blocks_[k].is_null()) continue;
        const auto& numbers = blocks_[k]->numbers();
        if (size_ > 1 || numbers.height * numbers.width == 1) {
          for (auto e = numbers.start(i); e < numbers.start(i + 1); ++e)
            of_row.push_back({nodes[k][numbers.column(e)], k, static_cast<LocalIndex>(e - numbers.start(i))});
        } else {
          LocalIndex from = 0;
          numbers.for_row(i, [&](LocalIndex c, std::size_t) { of_row.push_back({nodes[k][c], k, from++}); });
        }
      }
      std::sort(of_row.begin(), of_row.end(), [](const Entry& a, const Entry& b) { return a.column < b.column; });
      for (std::size_t e = 0; e < of_row.size(); ++e) {
        add(found[of_row[e].block], static_cast<LocalIndex>(start.size()) - 1, of_row[e].from,
            static_cast<LocalIndex>(e));
        columns.push_back(of_row[e].column);
      }
      start.push_back(columns.size());
    }
  numbers_ = {size_, size_, View<std::size_t*>("start", start.size()), on_device("columns", columns),
              View<Real*>("numbers", size_ * size_ * columns.size())};
  std::copy(start.begin(), start.end(), numbers_.start.data());
  for (const auto& runs : found)
    runs_.push_back({on_device("row", runs.row), on_device("from", runs.from), on_device("to", runs.to),
                     on_device("length", runs.length)});
}

void JoinedMatrix::update() {
  const int n = joined_->n_blocks();
  for (int k = 0; k < n * n && n > 1; ++k) {
    if (blocks_[k].is_null()) continue;
    const auto given = blocks_[k]->numbers(), own = numbers_;
    const auto row = runs_[k].row, from = runs_[k].from, to = runs_[k].to, length = runs_[k].length;
    const Real scale = joined_->scale(k / n) * joined_->scale(k % n);
    const int size = size_;
    const LocalIndex first = joined_->first(k / n);
    Kokkos::parallel_for(
        "join", Policy(0, row.extent(0)), KOKKOS_LAMBDA(LocalIndex j) {
          for (int i = 0; i < size; ++i) {
            const LocalIndex unknown = size * row(j) + i;
            const Real* const source = &given.value(given.row(unknown - first).begin + size * from(j));
            Real* const target = &own.value(own.row(unknown).begin + size * to(j));
            for (LocalIndex e = 0; e < size * length(j); ++e) target[e] = scale * source[e];
          }
        });
  }
}

}  // namespace sprekk::solve
