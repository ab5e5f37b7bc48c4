#include "solve/flow_order.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sprekk::solve {

std::size_t LocalRows::find(LocalIndex row, LocalIndex wanted) const {
  const auto begin = column.begin() + static_cast<std::ptrdiff_t>(start[row]),
             end = column.begin() + static_cast<std::ptrdiff_t>(start[row + 1]);
  const auto found = std::lower_bound(begin, end, wanted);
  return found != end && *found == wanted ? static_cast<std::size_t>(found - column.begin()) : start[row + 1];
}

Real LocalRows::at(LocalIndex row, LocalIndex wanted) const {
  const auto k = find(row, wanted);
  return k < start[row + 1] ? value[k] : 0;
}

namespace {

constexpr Real directed = 2, strong = 1e-3;

/// Rows from which a row takes.
struct Sources {
  std::vector<std::size_t> start = {0};  ///< [row + 1]
  std::vector<LocalIndex> row;
};

Sources sources_of(const LocalRows& A) {
  std::vector<Real> size;  // [row] square root of |diagonal|
  for (LocalIndex i = 0; i < A.n(); ++i) size.push_back(std::sqrt(std::abs(A.at(i, i))));
  Sources sources;
  for (LocalIndex i = 0; i < A.n(); ++i) {
    for (auto k = A.start[i]; k < A.start[i + 1]; ++k) {
      const LocalIndex j = A.column[k];
      const Real coupling = std::abs(A.value[k]);
      if (j != i && coupling > strong * size[i] * size[j] && coupling > directed * std::abs(A.at(j, i)))
        sources.row.push_back(j);
    }
    sources.start.push_back(sources.row.size());
  }
  return sources;
}

/// Numbers strong components in the order in which Tarjan's algorithm completes them: each after all its sources.
class Components {
 public:
  explicit Components(const Sources& sources)
      : sources_(sources), of_row_(sources.start.size() - 1, -1), index_(of_row_.size(), -1), low_(of_row_.size()) {
    for (LocalIndex i = 0; i < static_cast<LocalIndex>(of_row_.size()); ++i)
      if (index_[i] < 0) visit_from(i);
  }
  LocalIndex n() const { return n_; }
  const std::vector<LocalIndex>& of_row() const { return of_row_; }

 private:
  void enter(LocalIndex i) {
    index_[i] = low_[i] = n_entered_++;
    open_.push_back(i);
    path_.emplace_back(i, sources_.start[i]);
  }

  void visit_from(LocalIndex root) {
    enter(root);
    while (!path_.empty()) {
      auto& [i, next] = path_.back();
      if (next < sources_.start[i + 1]) {
        const LocalIndex j = sources_.row[next++];
        if (index_[j] < 0)
          enter(j);
        else if (of_row_[j] < 0)
          low_[i] = std::min(low_[i], index_[j]);
        continue;
      }
      const LocalIndex done = i;
      path_.pop_back();
      if (low_[done] == index_[done]) close(done);
      if (!path_.empty()) low_[path_.back().first] = std::min(low_[path_.back().first], low_[done]);
    }
  }

  void close(LocalIndex root) {
    LocalIndex i;
    do {
      i = open_.back();
      open_.pop_back();
      of_row_[i] = n_;
    } while (i != root);
    ++n_;
  }

  const Sources& sources_;
  std::vector<LocalIndex> of_row_, index_, low_, open_;
  std::vector<std::pair<LocalIndex, std::size_t>> path_;  // rows and their next source
  LocalIndex n_ = 0, n_entered_ = 0;
};

}  // namespace

std::vector<LocalIndex> flow_order(const LocalRows& A) {
  const auto sources = sources_of(A);
  const Components components(sources);
  std::vector<LocalIndex> next(components.n() + 1, 0);  // [n - 1 - component] next position
  for (const LocalIndex c : components.of_row()) ++next[components.n() - c];
  for (LocalIndex c = 0; c < components.n(); ++c) next[c + 1] += next[c];
  std::vector<LocalIndex> order(A.n());
  for (LocalIndex i = 0; i < A.n(); ++i) order[next[components.n() - 1 - components.of_row()[i]]++] = i;
  return order;
}

}  // namespace sprekk::solve
