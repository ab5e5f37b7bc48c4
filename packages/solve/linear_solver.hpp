// Solves the linear system that local elimination leaves: directly, or by multigrid and Krylov.
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

/// What is wanted of a linear solver. The lists are handed to the libraries untouched, over the defaults.
struct LinearSolverOptions {
  std::string type = "auto";           ///< auto | direct | iterative
  Real tolerance = 1e-12;              ///< relative residual that is asked for
  bool forcing = true;                 ///< less is asked for while faces still change state
  long long direct_limit_2d = 150000;  ///< auto: most unknowns for direct in 2D (and 1D)
  long long direct_limit_3d = 3000;    ///< auto: the same in 3D
  std::optional<bool> reproducible;    ///< ranks do not share the factors of a matrix; absent: they may
  Teuchos::ParameterList mumps, belos;
  PreconditionerOptions preconditioner;
  /// No entry. If it is not empty: asked on every rank every few iterations; true on any ends the solve by Stopped.
  std::function<bool()> should_stop;

  void describe(base::Section& section);
};

/// Thrown out of a solve that is to stop, on every rank at once. No std::exception, so that no library reports it.
struct Stopped {};

/// How a solve went. Converged means that the true relative residual is at most acceptable_linear_residual, or ten
/// times the tolerance if that is more: what is then missing of the tolerance is for the next Newton iteration.
struct LinearReport {
  bool converged = false;
  int iterations = 0;
  Real residual = 0;   ///< |b - A x| / |b|, computed from A, b and x
  bool used = true;    ///< Newton's solve that it is part of converged
  std::string reason;  ///< of a failure
};

/// The iterations of all these solves.
int iterations(const std::vector<LinearReport>& solves);

inline constexpr Real acceptable_linear_residual = 1e-8;

/// All members are collective on the matrix' communicator, and answer the same on every rank.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;

  /// Whether set-ups read `matrix`.
  virtual bool reads_matrix() const { return false; }

  /// Makes ready to solve with this system. Empty, or what failed.
  virtual std::string setup(const LinearSystem& system) = 0;

  /// x <- A^-1 b to a relative residual of the tolerance, or as near as rounding allows.
  virtual LinearReport solve(const Vector& b, Vector& x, Real tolerance) = 0;

  /// About the inverse of the system of the last set-up, as Krylov's method uses it; null if there is none.
  virtual RCP<const fields::Operator> preconditioner() const { return Teuchos::null; }

  /// What the preconditioner's parts have cost. Stored data.
  virtual std::vector<SolverCost> costs() const { return {}; }

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

/// Ranks 0 to most_ranks - 1 share the factors; one alone adds in the same order every time.
std::unique_ptr<LinearSolver> make_direct_solver(const Teuchos::ParameterList& mumps,
                                                 int most_ranks = std::numeric_limits<int>::max());
std::unique_ptr<LinearSolver> make_iterative_solver(const LinearSolverOptions& options,
                                                    const std::vector<Block>& blocks);

/// |b - A x| / |b| with r <- b - A x; 0 for b = 0 = x.
Real relative_residual(const fields::Operator& matrix, const Vector& b, const Vector& x, Vector& r);

}  // namespace sprekk::solve
