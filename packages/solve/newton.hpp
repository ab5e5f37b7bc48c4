// Newton's method on a BlockProblem, driven by NOX.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/timer.hpp"
#include "solve/linear_solver.hpp"

namespace sprekk::solve {

using fields::BlockProblem;
using fields::BlockVector;
using fields::Measure;

class CondensedSolve;
class ThyraModel;

struct NewtonOptions {
  Real tolerance = 1e-11;  ///< of every measure of the problem
  int max_iterations = 30;
  bool print = false;  ///< let NOX report every iteration
  LinearSolverOptions linear_solver;
  Teuchos::ParameterList nox;  ///< over the defaults
  /// No entry. If it is not empty: asked on every rank in every iteration; true on any ends the solve.
  std::function<bool()> should_stop;

  void describe(base::Section& section);
};

struct NewtonReport {
  bool converged = false;
  bool stopped = false;                       ///< should_stop said so
  int iterations = 0;                         ///< linear solves: Newton steps, those that damping took anew included
  std::vector<LinearReport> linear_solves;    ///< one for each iteration
  std::string reason;                         ///< of a failure
  std::string loose;                          ///< what nothing held in an iterate, in words, the last such
  std::vector<char> unsettled;                ///< [as Globalisation::states()] changed in the last five iterates
  std::vector<Measure> measures;              ///< at the end
  std::vector<std::vector<Measure>> history;  ///< [iteration, from 0 for the start]
};

/// Keeps factors or the hierarchy from one solve to the next. Refers to the problem.
class Newton {
 public:
  Newton(BlockProblem& problem, const NewtonOptions& options, RCP<base::Timers> timers = rcp(new base::Timers));
  ~Newton();

  /// Solves f(x) = 0 from x: full first step; after that backtracking that lets the merit rise above the last but not
  /// above the worst of three iterates; where that finds nothing, steps with damping. A failure is reported, and x is
  /// the last iterate then; Errors of the problem's own evaluations pass through. Collective; the same report on every
  /// rank.
  NewtonReport solve(BlockVector& x);

  /// dx <- A^-1 b, [block], with the last Jacobian that was solved with: how x answers to small forces b. If that was
  /// damped, with the one where the solve converged, or at x if it did not; if there was none, with that at x. Rows of
  /// constrained unknowns are dx_i = b_i. Collective.
  LinearReport answer(const BlockVector& x, const BlockVector& b, BlockVector& dx, Real tolerance);

  const CondensedSolve& linear() const { return *linear_; }

 private:
  BlockProblem& problem_;
  NewtonOptions options_;
  bool solving_ = false;  // where a linear solve may be stopped
  std::unique_ptr<CondensedSolve> linear_;
  std::unique_ptr<ThyraModel> model_;
  /// What answer() finds: the last Jacobian, an older one than the matrix holds, one with damping.
  enum class Factors { good, old, damped } factors_ = Factors::good;
};

}  // namespace sprekk::solve
