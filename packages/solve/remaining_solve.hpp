// Linear solver for some of the blocks that remain after local elimination.
#pragma once

#include "solve/linear_solver.hpp"
#include "solve/local_elimination.hpp"

namespace sprekk::solve {

/// Solver for chosen blocks r, with the couplings J_rs among them. All members are collective unless they return stored
/// data. Refers to the problem and its elimination.
class RemainingSolve {
 public:
  /// `chosen`: indices of LocalElimination::remaining(), ascending. Options of other blocks are ignored.
  RemainingSolve(BlockProblem& problem, const LocalElimination& elimination, std::vector<int> chosen,
                 const LinearSolverOptions& options);

  /// Prepares solves with the present J. Returns an error message, or an empty string.
  std::string setup(bool symmetric);
  /// Computes y = J^-1 c, both [r] for all remaining blocks; y is zero in the others. After a failure, y is empty.
  LinearReport solve(const BlockVector& c, BlockVector& y, Real tolerance);

  const ChosenSolver& solver() const { return chosen_solver_; }

 private:
  std::vector<Block> blocks() const;
  std::vector<Real> scales() const;
  LinearSystem system(bool symmetric);

  BlockProblem& problem_;
  const LocalElimination& elimination_;
  std::vector<int> chosen_;
  std::shared_ptr<Joined> joined_;
  Blocks blocks_;  // [r * n + s]
  ChosenSolver chosen_solver_;
  std::unique_ptr<JoinedMatrix> matrix_;  // for solvers that read a matrix
};

}  // namespace sprekk::solve
