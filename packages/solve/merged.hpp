// Several blocks as one: a matrix and vectors whose unknowns are those of all blocks, one block after another.
#pragma once

#include <vector>

#include "fields/block_problem.hpp"

namespace sprekk::solve {

/// S A S for a matrix A in blocks, with a number s_r per block on the diagonal of S; of a single block, A itself.
/// Unknowns of each block must be numbered 0, 1, ... over all ranks; so are those of the merged system. All members are
/// collective unless they return stored data.
class Merged {
 public:
  /// Blocks [r * n + s], null where they do not couple; their graphs stay as they are.
  Merged(std::vector<RCP<const fields::Map>> maps, std::vector<RCP<const fields::CrsMatrix>> blocks);

  /// Takes over the present values of the blocks.
  void update(const std::vector<Real>& scales);

  const RCP<const fields::CrsMatrix>& matrix() const { return matrix_; }
  Real scale(int r) const { return scales_[r]; }
  /// S b; of a single block, b itself.
  RCP<fields::Vector> gather(const fields::BlockVector& b) const;
  /// x <- S y.
  void scatter(const fields::Vector& y, fields::BlockVector& x) const;

 private:
  int n_blocks() const { return static_cast<int>(maps_.size()); }
  RCP<fields::CrsMatrix> create() const;
  void find_positions();

  std::vector<RCP<const fields::Map>> maps_;          // [r]
  std::vector<RCP<const fields::CrsMatrix>> blocks_;  // [r * n + s]
  std::vector<GlobalIndex> offsets_;                  // [r] first unknown
  std::vector<View<LocalIndex*>> positions_;          // [r * n + s](value of the block) -> value of the matrix
  std::vector<Real> scales_;                          // [r]
  RCP<fields::CrsMatrix> merged_;                     // null of a single block
  RCP<const fields::CrsMatrix> matrix_;
};

}  // namespace sprekk::solve
