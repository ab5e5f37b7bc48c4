// Several blocks as one: vectors, an operator and matrices with the unknowns of all blocks, block after block.
#pragma once

#include <memory>
#include <vector>

#include "fields/block_problem.hpp"

namespace sprekk::solve {

/// Joint numbering of the unknowns of blocks, with a scale s_r per block (S: diagonal matrix of the scales). The
/// unknowns of each block must be numbered 0, 1, ... over all ranks; the joint unknowns are so as well. A single block
/// is neither renumbered nor scaled. Stored data.
class Joined {
 public:
  explicit Joined(std::vector<RCP<const fields::Map>> maps);

  int n_blocks() const { return static_cast<int>(maps_.size()); }
  const RCP<const fields::Map>& map() const { return map_; }
  const RCP<const fields::Map>& map(int r) const { return maps_[r]; }
  GlobalIndex offset(int r) const { return offsets_[r]; }  ///< joint number of the block's unknown 0
  LocalIndex first(int r) const { return firsts_[r]; }     ///< local position of the block's first owned unknown

  void set_scales(const std::vector<Real>& scales) {
    if (n_blocks() > 1) scales_ = scales;
  }
  Real scale(int r) const { return scales_[r]; }

  /// Returns S b; for a single block, b itself.
  RCP<fields::Vector> gather(const fields::BlockVector& b) const;
  /// Returns S y, block by block; for a single block, y itself.
  fields::BlockVector scatter(const RCP<fields::Vector>& y) const;

 private:
  std::vector<RCP<const fields::Map>> maps_;  // [r]
  std::vector<GlobalIndex> offsets_;          // [r]
  std::vector<LocalIndex> firsts_;            // [r]
  std::vector<Real> scales_;                  // [r]
  RCP<const fields::Map> map_;
};

/// Matrices of blocks, [r * n + s]; null if blocks do not couple. The graphs must not change.
using Blocks = std::vector<RCP<const fields::Matrix>>;

/// Returns S A S as an operator without a stored matrix; for a single block, A itself.
RCP<const fields::Operator> joined_operator(std::shared_ptr<const Joined> joined, Blocks blocks);

/// Matrix S A S. It is a matrix of nodes if all blocks have nodes of equal size. For a single block, it is A itself.
/// Collective.
class JoinedMatrix {
 public:
  JoinedMatrix(std::shared_ptr<const Joined> joined, Blocks blocks);

  /// Copies the present values of the blocks, with the present scales. Local.
  void update();

  const RCP<const fields::Matrix>& matrix() const { return matrix_; }

 private:
  using Nodes = std::vector<std::vector<LocalIndex>>;  // [r * n + s][column node of the block] that of the matrix
  Nodes number_columns(RCP<const fields::Map>& columns) const;
  void find_runs(const Nodes& nodes);

  std::shared_ptr<const Joined> joined_;
  Blocks blocks_;
  int size_ = 1;  // unknowns of a node
  struct Runs {   // runs of entries adjacent both in a row node of the block and in the matrix
    View<LocalIndex*> row, from, to, length;
  };
  std::vector<Runs> runs_;    // [r * n + s]
  fields::NodeRows numbers_;  // values of the matrix
  RCP<const fields::Matrix> matrix_;
};

}  // namespace sprekk::solve
