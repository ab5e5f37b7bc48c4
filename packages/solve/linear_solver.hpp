// Linear solvers for the system after local elimination: direct, or Krylov methods with multigrid.
#pragma once

#include <Teuchos_ParameterList.hpp>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "solve/linear_system.hpp"
#include "solve/preconditioner_options.hpp"
#include "solve/solver_cost.hpp"

namespace sprekk::base {
class Section;
}

namespace sprekk::solve {

/// Options of a linear solver. The lists are passed to the libraries unchanged, on top of the defaults.
struct LinearSolverOptions {
  std::string type = "auto";           ///< auto | direct | iterative
  Real tolerance = 1e-12;              ///< required relative residual
  bool forcing = true;                 ///< lower accuracy while faces change state, see ForcedSolve
  long long direct_limit_2d = 150000;  ///< auto: largest number of unknowns for direct in 2D (and 1D)
  long long direct_limit_3d = 3000;    ///< auto: the same limit in 3D
  std::optional<bool> reproducible;    ///< factors of a matrix on one rank only; absent: on all ranks
  Teuchos::ParameterList mumps, belos;
  PreconditionerOptions preconditioner;
  /// Stop request; not an entry of scenes. If set, it is called on all ranks every few iterations. True on any rank
  /// ends the solve with Stopped.
  std::function<bool()> should_stop;

  void describe(base::Section& section);
};

/// Exception that ends a solve on all ranks at once. It does not derive from std::exception, so that libraries do not
/// catch it.
struct Stopped {};

/// Result of a solve. Converged: the true relative residual is at most the larger of acceptable_linear_residual and ten
/// times the tolerance. The next Newton iteration corrects the remaining error.
struct LinearReport {
  bool converged = false;
  int iterations = 0;
  Real residual = 0;   ///< |b - A x| / |b|, computed from A, b and x
  bool used = true;    ///< the Newton solve that contains it has converged
  std::string reason;  ///< reason of a failure
};

/// Returns the sum of the iterations of these solves.
int iterations(const std::vector<LinearReport>& solves);

inline constexpr Real acceptable_linear_residual = 1e-8;

/// Number of floating-point operations.
struct Work {
  Real setup = 0, solve = 0;
};

/// Linear solver. All members are collective on the communicator of the matrix and return the same on all ranks.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;

  /// Returns whether setup() reads LinearSystem::matrix.
  virtual bool reads_matrix() const { return false; }

  /// Prepares solves with this system. Returns an error message, or an empty string.
  virtual std::string setup(const LinearSystem& system) = 0;

  /// Computes x = A^-1 b to the relative residual `tolerance`, or as accurately as round-off permits.
  virtual LinearReport solve(const Vector& b, Vector& x, Real tolerance) = 0;

  /// Returns the approximate inverse of the last system, as used by the Krylov method, or the factors of a direct
  /// solver; null if there is none.
  virtual RCP<const fields::Operator> preconditioner() const { return Teuchos::null; }

  /// Returns the floating-point operations of the last set-up and of an application of preconditioner(); 0: unknown, or
  /// the set-up is not exact. Stored data.
  virtual Work work() const { return {}; }

  /// Returns the costs of the parts of the preconditioner. Stored data.
  virtual std::vector<SolverCost> costs() const { return {}; }

  /// Returns all parameters of the libraries, including defaults.
  virtual const Teuchos::ParameterList& parameters() const = 0;
};

/// Solver with the reason of its selection.
struct ChosenSolver {
  std::unique_ptr<LinearSolver> solver;
  std::string reason;  ///< e.g. "direct: 2D with 1234 unknowns; direct up to 150000"

  /// Returns the reason and all parameters, for the log.
  std::string describe() const;
};

/// Returns the solver for systems of these blocks. Throws an Error for invalid options, also of the solver that is not
/// selected. Collective.
ChosenSolver make_linear_solver(const LinearSolverOptions& options, const std::vector<Block>& blocks);

/// Return a direct or an iterative solver. Ranks 0 to max_ranks - 1 share the factors. One rank adds in the same order
/// every time.
std::unique_ptr<LinearSolver> make_direct_solver(const Teuchos::ParameterList& mumps,
                                                 int max_ranks = std::numeric_limits<int>::max());
std::unique_ptr<LinearSolver> make_iterative_solver(const LinearSolverOptions& options,
                                                    const std::vector<Block>& blocks);

/// Returns |b - A x| / |b| and sets r = b - A x; 0 for b = 0 = x. Collective.
Real relative_residual(const fields::Operator& matrix, const Vector& b, const Vector& x, Vector& r);

}  // namespace sprekk::solve
