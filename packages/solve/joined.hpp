// Several blocks as one: vectors, an operator and matrices whose unknowns are those of all blocks, one block after
// another.
#pragma once

#include <memory>
#include <vector>

#include "fields/block_problem.hpp"

namespace sprekk::solve {

/// Numbers the unknowns of blocks in one sequence and scales each block by a number s_r, S in matrix form. Unknowns of
/// each block must be numbered 0, 1, ... over all ranks; so are the joined ones. A single block stays as it is, and is
/// not scaled. Stored data.
class Joined {
 public:
  explicit Joined(std::vector<RCP<const fields::Map>> maps);

  int n_blocks() const { return static_cast<int>(maps_.size()); }
  const RCP<const fields::Map>& map() const { return map_; }
  const RCP<const fields::Map>& map(int r) const { return maps_[r]; }
  GlobalIndex offset(int r) const { return offsets_[r]; }  ///< the joined number of a block's unknown 0
  LocalIndex first(int r) const { return firsts_[r]; }     ///< the place of its first owned unknown on this rank

  void set_scales(const std::vector<Real>& scales) {
    if (n_blocks() > 1) scales_ = scales;
  }
  Real scale(int r) const { return scales_[r]; }

  /// S b; of a single block, b itself.
  RCP<fields::Vector> gather(const fields::BlockVector& b) const;
  /// S y; of a single block, y itself.
  fields::BlockVector scatter(const RCP<fields::Vector>& y) const;

 private:
  std::vector<RCP<const fields::Map>> maps_;  // [r]
  std::vector<GlobalIndex> offsets_;          // [r]
  std::vector<LocalIndex> firsts_;            // [r]
  std::vector<Real> scales_;                  // [r]
  RCP<const fields::Map> map_;
};

/// Matrices of blocks, [r * n + s], null where they do not couple. Their graphs stay as they are.
using Blocks = std::vector<RCP<const fields::Matrix>>;

/// S A S without storing it; of a single block, A itself.
RCP<const fields::Operator> joined_operator(std::shared_ptr<const Joined> joined, Blocks blocks);

/// S A S as one matrix, of nodes where all blocks have nodes of one size; of a single block, A itself. Collective.
class JoinedMatrix {
 public:
  JoinedMatrix(std::shared_ptr<const Joined> joined, Blocks blocks);

  /// Takes over the present values of the blocks, and the scales.
  void update();

  const RCP<const fields::Matrix>& matrix() const { return matrix_; }

 private:
  using Nodes = std::vector<std::vector<LocalIndex>>;  // [r * n + s][column node of the block] that of the matrix
  Nodes number_columns(RCP<const fields::Map>& columns) const;
  void find_runs(const Nodes& nodes);

  std::shared_ptr<const Joined> joined_;
  Blocks blocks_;
  int size_ = 1;  // of nodes
  struct Runs {   // of entries that follow one another in a row node of the block and of the matrix
    View<LocalIndex*> row, from, to, length;
  };
  std::vector<Runs> runs_;    // [r * n + s]
  fields::NodeRows numbers_;  // of the matrix
  RCP<const fields::Matrix> matrix_;
};

}  // namespace sprekk::solve
