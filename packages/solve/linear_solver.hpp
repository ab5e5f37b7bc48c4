// Solves the linear system that local elimination leaves: directly, or by multigrid and Krylov.
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fields/block_problem.hpp"

namespace sprekk::base {
class Section;
}

namespace sprekk::solve {

using fields::Block;
using fields::CrsMatrix;
using fields::Vector;

/// What is wanted of a linear solver. The lists are handed to the libraries untouched, over the defaults.
struct LinearSolverOptions {
  std::string type = "auto";           ///< auto | direct | iterative
  Real tolerance = 1e-12;              ///< relative residual that is asked for
  long long direct_limit_2d = 150000;  ///< auto: most unknowns for direct in 2D (and 1D)
  long long direct_limit_3d = 20000;   ///< auto: the same in 3D
  std::optional<bool> reproducible;    ///< the direct solver factors on one rank; absent: no
  Teuchos::ParameterList mumps, belos, muelu;

  void describe(base::Section& section);
};

/// How a solve went. Converged means that the true relative residual is at most acceptable_linear_residual, or ten
/// times the tolerance if that is more: what is then missing of the tolerance is for the next Newton iteration.
struct LinearReport {
  bool converged = false;
  int iterations = 0;
  Real residual = 0;   ///< |b - A x| / |b|, computed from A, b and x
  std::string reason;  ///< of a failure
};

inline constexpr Real acceptable_linear_residual = 1e-8;

/// A block on the diagonal of a linear system.
struct DiagonalBlock {
  Block block;
  RCP<const CrsMatrix> matrix;  ///< of the block alone; null if it has none
  RCP<const CrsMatrix> bulk;    ///< it without what crosses interfaces, by whose graph multigrid aggregates, or null
  Real scale = 1;               ///< the system has scale^2 times the matrix
};

/// A linear system in one or more blocks. The unknowns must be numbered 0, 1, ... over all ranks in any distribution,
/// those of the blocks one after another.
struct LinearSystem {
  RCP<const CrsMatrix> matrix;  ///< its graph must be the same at every set-up
  bool symmetric = false;
  std::vector<DiagonalBlock> diagonal;
};

/// All members are collective on the matrix' communicator, and answer the same on every rank.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;

  /// Whether the next setup reads `bulk`.
  virtual bool reads_bulk() const { return false; }

  /// Makes ready to solve with this system. Empty, or what failed.
  virtual std::string setup(const LinearSystem& system) = 0;

  /// x <- A^-1 b.
  virtual LinearReport solve(const Vector& b, Vector& x, Real tolerance) = 0;

  /// Everything that is handed to the library, defaults included.
  virtual const Teuchos::ParameterList& parameters() const = 0;
};

/// A solver, and why it is this one.
struct ChosenSolver {
  std::unique_ptr<LinearSolver> solver;
  std::string reason;  ///< "direct: 2D with 1234 unknowns; direct up to 150000"

  /// The reason and all parameters, for the log.
  std::string describe() const;
};

/// The solver for systems of these blocks. Stored data only.
ChosenSolver make_linear_solver(const LinearSolverOptions& options, const std::vector<Block>& blocks);

std::unique_ptr<LinearSolver> make_direct_solver(const Teuchos::ParameterList& mumps, bool on_one_rank = false);
std::unique_ptr<LinearSolver> make_iterative_solver(const LinearSolverOptions& options,
                                                    const std::vector<Block>& blocks);

/// |b - A x| / |b| with r <- b - A x; 0 for b = 0 = x.
Real relative_residual(const CrsMatrix& matrix, const Vector& b, const Vector& x, Vector& r);

}  // namespace sprekk::solve
