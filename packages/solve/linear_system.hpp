// A linear system in blocks, as solvers and preconditioners see it.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "solve/joined.hpp"

namespace sprekk::solve {

using fields::Block;
using fields::CrsMatrix;
using fields::Matrix;
using fields::Vector;

/// Calls work(A) with a block's matrix without what crosses interfaces, by whose values multigrid aggregates. Meanwhile
/// the block's matrix may have these values, too.
using Bulk = std::function<void(const std::function<void(const RCP<const Matrix>& A)>& work)>;

/// A block on the diagonal of a linear system.
struct DiagonalBlock {
  Block block;
  RCP<const Matrix> matrix;  ///< of the block alone; null if it has none
  Bulk bulk;                 ///< or empty
  bool symmetric = true;
  RCP<const Vector> schur = {};  ///< see BlockProblem::schur()
  bool careful = true;           ///< where it is not symmetric, a cycle of multigrid is looked at and mended if need be
};

/// A linear system in one or more blocks, joined. Graphs must be the same at every set-up.
struct LinearSystem {
  std::shared_ptr<const Joined> joined;
  Blocks blocks;  ///< [r * n + s], not scaled
  bool symmetric = false;
  std::vector<DiagonalBlock> diagonal;
  RCP<const CrsMatrix> matrix;  ///< of all blocks, scaled; null unless the solver reads it
  bool reproducible = false;    ///< whether a set-up must leave the same bits every time

  RCP<const fields::Operator> joined_operator() const { return solve::joined_operator(joined, blocks); }
};

/// That of a single block.
LinearSystem alone(const DiagonalBlock& block);

}  // namespace sprekk::solve
