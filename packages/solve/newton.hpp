// Newton's method for a BlockProblem, by NOX.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "base/timer.hpp"
#include "solve/linear_solver.hpp"

namespace sprekk::solve {

using fields::BlockProblem;
using fields::BlockVector;
using fields::Evaluation;
using fields::Measure;

class CondensedSolve;
class ForcedSolve;

struct NewtonOptions {
  Real tolerance = 1e-11;  ///< for each measure of the problem
  int max_iterations = 30;
  bool print = false;  ///< NOX prints every iteration
  LinearSolverOptions linear_solver;
  Teuchos::ParameterList nox;  ///< overrides the defaults
  /// Stop request; not an entry of scenes. If set, it is called on all ranks in each iteration. True on any rank ends
  /// the solve.
  std::function<bool()> should_stop;

  void describe(base::Section& section);
};

struct NewtonReport {
  bool converged = false;
  bool stopped = false;                       ///< stopped by should_stop
  int iterations = 0;                         ///< linear solves: Newton steps, including repetitions with damping
  std::vector<LinearReport> linear_solves;    ///< one per iteration
  std::vector<LinearReport> advected_solves;  ///< solves of advected blocks alone, after strong changes of a flow
  std::string reason;                         ///< reason of a failure
  std::string floating;                       ///< floating bodies in the last iterate that had some, as text
  std::vector<char> oscillating;              ///< [as Globalisation::states()] state changed in the last five iterates
  std::vector<Measure> measures;              ///< at the end
  std::vector<std::vector<Measure>> history;  ///< [iteration, 0: start]
};

/// Newton's method. Saves factors or the hierarchy from solve to solve. Refers to the problem.
class Newton {
 public:
  Newton(BlockProblem& problem, const NewtonOptions& options, RCP<base::Timers> timers = rcp(new base::Timers));
  ~Newton();

  /// Solves f(x) = 0, starting from x. The first step is full. Later steps use a non-monotone line search: the merit
  /// may exceed the last one, but not the largest of three iterates. If this fails, steps are damped. Failures are
  /// reported; x is then the last iterate. Errors in evaluations of the problem pass through. Collective; the report is
  /// the same on all ranks.
  NewtonReport solve(BlockVector& x);
  /// Likewise. Fails once the discrete state of an entity has changed more than max_changes times.
  NewtonReport solve(Evaluation& x, int max_changes = std::numeric_limits<int>::max());

  /// Computes the Jacobian at x, for the next calls of solve_linearized(). Collective.
  void linearize(const Evaluation& x);
  /// Computes dx = A^-1 b, [block], the linear response of x to small forces b. Rows of constrained unknowns are dx_i =
  /// b_i. A is the last Jacobian of a linear solve. If that was damped, A is the Jacobian at convergence, or at x after
  /// a failure. If there was none, A is the Jacobian at x. Collective.
  LinearReport solve_linearized(const Evaluation& x, const BlockVector& b, BlockVector& dx, Real tolerance);

  const CondensedSolve& linear() const { return *linear_; }

 private:
  BlockProblem& problem_;
  NewtonOptions options_;
  bool solving_ = false;  // linear solves may be stopped
  std::unique_ptr<CondensedSolve> linear_;
  std::unique_ptr<ForcedSolve> forced_;
  /// Factors for solve_linearized(): of the last Jacobian, older than the matrix, or damped.
  enum class Factors { good, old, damped } factors_ = Factors::good;
};

}  // namespace sprekk::solve
