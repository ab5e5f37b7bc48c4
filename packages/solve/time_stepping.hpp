// From one time to the next, in as many substeps as Newton needs.
#pragma once

#include "solve/newton.hpp"

namespace sprekk::solve {

struct TimeSteppingOptions {
  int max_halvings = 6;  ///< the smallest substep is the step / 2^max_halvings
  bool tethers = true;   ///< before the first halving, see TimeStepper::relax()

  void describe(base::Section& section);
};

struct StepReport {
  bool converged = false;
  bool stopped = false;                     ///< by NewtonOptions::should_stop
  Real time = 0;                            ///< that x now belongs to
  int newton_iterations = 0;                ///< rejected substeps included
  std::vector<LinearReport> linear_solves;  ///< likewise, [Newton iteration]
  int substeps = 0;                         ///< committed
  int cuts = 0;
  std::string reason;             ///< of the last failure, if there was one
  std::vector<char> unsettled;    ///< [as Globalisation::states()] in the last failure, those that found no state
  std::string loose;              ///< what nothing holds in the state at `time`, in words
  std::vector<Measure> measures;  ///< of the last Newton solve
};

/// Refers to the problem and to Newton.
class TimeStepper {
 public:
  TimeStepper(BlockProblem& problem, Newton& newton, const TimeSteppingOptions& options)
      : problem_(problem), newton_(newton), options_(options) {}

  /// Takes x, the committed state at t, to t_to. Where Newton fails and there is contact the bodies are let go step by
  /// step, see relax(), of a problem that stores from the third halving on; where that fails too the substep is halved
  /// and x restored; after one that converged it doubles.
  /// Each is committed, and t goes with x: they belong together also where the smallest substep fails, or an evaluation
  /// throws. Collective.
  StepReport advance(BlockVector& x, Real& t, Real t_to);

 private:
  NewtonReport solve(BlockVector& x, StepReport& report);
  NewtonReport settle(BlockVector& x, NewtonReport newton, int& settlings, StepReport& report);
  NewtonReport relax(BlockVector& x, StepReport& report);

  BlockProblem& problem_;
  Newton& newton_;
  TimeSteppingOptions options_;
  Real committed_dt_ = 0;  // length of the last committed substep; 0 before the first
};

}  // namespace sprekk::solve
