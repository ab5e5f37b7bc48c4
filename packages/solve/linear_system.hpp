// Linear system of blocks, as input of solvers and preconditioners.
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

/// Function that calls work(A) with the matrix of a block without couplings across interfaces. Multigrid aggregates by
/// its values. During the call, the matrix of the block may have these values, too.
using Bulk = std::function<void(const std::function<void(const RCP<const Matrix>& A)>& work)>;

/// Diagonal block of a linear system.
struct DiagonalBlock {
  Block block;
  RCP<const Matrix> matrix;  ///< of the block alone; null if absent
  Bulk bulk;                 ///< empty: absent
  bool symmetric = true;
  RCP<const Vector> schur = {};  ///< see BlockProblem::schur()
  bool is_other_graph = false;   ///< the graph differs from that of the last set-up
  bool careful = true;           ///< if not symmetric, a multigrid cycle is tried at set-up and corrected if necessary
};

/// Linear system of one or several blocks, joined. Graphs must be the same in each set-up,
/// except those of a DiagonalBlock that declares another graph.
struct LinearSystem {
  std::shared_ptr<const Joined> joined;
  Blocks blocks;  ///< [r * n + s], not scaled
  bool symmetric = false;
  std::vector<DiagonalBlock> diagonal;
  RCP<const CrsMatrix> matrix;  ///< of all blocks, scaled; null unless the solver reads it
  bool reproducible = false;    ///< set-ups must be bitwise reproducible

  /// Returns S A S with the scales S, without a stored matrix.
  RCP<const fields::Operator> joined_operator() const { return solve::joined_operator(joined, blocks); }
};

/// Returns the system of a single block.
LinearSystem alone(const DiagonalBlock& block);

}  // namespace sprekk::solve
