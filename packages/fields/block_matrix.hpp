// A matrix of named blocks.
#pragma once

#include "fields/types.hpp"

#include <vector>

namespace sprekk::fields {

/// n x n blocks of Tpetra matrices; a block that no module writes is absent (null). Row maps, domain and range maps of
/// block (i, j) are the owned maps of blocks i and j.
class BlockMatrix {
 public:
  explicit BlockMatrix(int n_blocks = 0) : n_(n_blocks), blocks_(n_blocks * n_blocks) {}

  int n_blocks() const { return n_; }
  const RCP<CrsMatrix>& operator()(int row, int column) const { return blocks_[row * n_ + column]; }
  RCP<CrsMatrix>& operator()(int row, int column) { return blocks_[row * n_ + column]; }

  /// y = sum_j A_ij x_j for every i. Collective.
  void apply(const BlockVector& x, BlockVector& y) const {
    for (int i = 0; i < n_; ++i) {
      y[i]->putScalar(0);
      for (int j = 0; j < n_; ++j)
        if (!(*this)(i, j).is_null()) (*this)(i, j)->apply(*x[j], *y[i], Teuchos::NO_TRANS, 1.0, 1.0);
    }
  }

 private:
  int n_;
  std::vector<RCP<CrsMatrix>> blocks_;
};

}  // namespace sprekk::fields
