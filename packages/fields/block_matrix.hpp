// Matrix of named blocks.
#pragma once

#include "fields/saved_rows.hpp"

#include <memory>
#include <vector>

namespace sprekk::fields {

/// Matrix of n x n Tpetra matrices. A block without contributions is null. Block (i, j) has the owned map of block i as
/// row and range map, and the owned map of block j as domain map.
class BlockMatrix {
 public:
  explicit BlockMatrix(int n_blocks = 0) : n_(n_blocks), blocks_(n_blocks * n_blocks), saved_(n_blocks) {}

  int n_blocks() const { return n_; }
  const RCP<CrsMatrix>& operator()(int row, int column) const { return blocks_[row * n_ + column]; }
  RCP<CrsMatrix>& operator()(int row, int column) { return blocks_[row * n_ + column]; }

  /// Declares that block (b, b) is stored in another matrix, described by `saved`. The block itself becomes null.
  void share(int b, const std::shared_ptr<SavedRows>& saved) {
    (*this)(b, b) = Teuchos::null;
    saved_[b] = saved;
  }
  /// Returns the storage of block (b, b) in another matrix; null if the block is stored here.
  const std::shared_ptr<SavedRows>& saved(int b) const { return saved_[b]; }

  /// Computes y_i = sum_j A_ij x_j for every i. Collective.
  void apply(const BlockVector& x, BlockVector& y) const {
    for (int i = 0; i < n_; ++i) {
      y[i]->putScalar(0);
      for (int j = 0; j < n_; ++j)
        if (i == j && saved_[i])
          saved_[i]->add_product(*x[i], *y[i]);
        else if (!(*this)(i, j).is_null())
          (*this)(i, j)->apply(*x[j], *y[i], Teuchos::NO_TRANS, 1.0, 1.0);
    }
  }

  /// Computes y += A_ij x with the ghosts of x. No effect if the block is absent. Local.
  void add_local_product(int i, int j, const Vector& x, Vector& y) const {
    if (i == j && saved_[i])
      saved_[i]->add_local_product(x, y);
    else if (!(*this)(i, j).is_null())
      (*this)(i, j)->localApply(x, y, Teuchos::NO_TRANS, 1.0, 1.0);
  }

 private:
  int n_;
  std::vector<RCP<CrsMatrix>> blocks_;
  std::vector<std::shared_ptr<SavedRows>> saved_;  // [diagonal block]
};

}  // namespace sprekk::fields
