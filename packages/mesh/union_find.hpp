// Union-find structure.
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

#include "base/types.hpp"

namespace sprekk::mesh {

/// Disjoint sets of the numbers 0 ... n-1, initially of one number each. The lowest number represents a set.
class UnionFind {
 public:
  explicit UnionFind(GlobalIndex n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), GlobalIndex{0}); }
  GlobalIndex find(GlobalIndex i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(GlobalIndex a, GlobalIndex b) {
    const auto [low, high] = std::minmax({find(a), find(b)});
    parent_[high] = low;
  }

 private:
  std::vector<GlobalIndex> parent_;
};

}  // namespace sprekk::mesh
