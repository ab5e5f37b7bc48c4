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

/// Some rows of S A S, read where they are stored. All members are collective.
class JoinedRows {
 public:
  /// `rows`: places of owned unknowns in joined vectors, ascending.
  JoinedRows(std::shared_ptr<const Joined> joined, Blocks blocks, const View<LocalIndex*>& rows);

  const View<LocalIndex*>& rows() const { return rows_; }

  /// y -= (S A S x) in these rows; y [row].
  void subtract_product(const fields::MultiVector& x, fields::MultiVector& y) const;

 private:
  std::shared_ptr<const Joined> joined_;
  Blocks blocks_;
  View<LocalIndex*> rows_;
  std::vector<LocalIndex> first_row_;                      // [r], and one more: which rows are those of a block
  mutable std::vector<RCP<fields::MultiVector>> columns_;  // [r * n + s] x with ghosts; null: there are none
};

/// S A S as one matrix, or the part of it that rows and columns of chosen unknowns make; of a single block, all chosen,
/// A itself. Collective.
class JoinedMatrix {
 public:
  /// `chosen` [r](owned unknown of the block): 1 for those to take, else 0; empty: all.
  JoinedMatrix(std::shared_ptr<const Joined> joined, Blocks blocks, std::vector<RCP<fields::Vector>> chosen = {});

  /// Takes over the present values of the blocks, and the scales.
  void update();

  const RCP<const fields::CrsMatrix>& matrix() const { return matrix_; }
  /// The place of each row in joined vectors on this rank. [owned row]
  const View<LocalIndex*>& rows() const { return rows_; }

 private:
  void create(const std::vector<RCP<fields::Vector>>& chosen);
  using Places = std::vector<std::vector<LocalIndex>>;  // [r * n + s][column of the block]
  Places number_columns(const std::vector<RCP<fields::Vector>>& chosen, const fields::Map& domain,
                        RCP<const fields::Map>& columns) const;
  std::vector<LocalIndex> find_runs(const std::vector<LocalIndex>& rows, const Places& places,
                                    std::vector<std::size_t>& start);

  std::shared_ptr<const Joined> joined_;
  Blocks blocks_;
  struct Runs {  // of numbers that follow one another in the block and in the matrix
    View<LocalIndex*> from, to, length;
  };
  std::vector<Runs> runs_;  // [r * n + s]
  View<LocalIndex*> rows_;
  RCP<fields::CrsMatrix> own_;  // null for A itself
  RCP<const fields::CrsMatrix> matrix_;
};

}  // namespace sprekk::solve
