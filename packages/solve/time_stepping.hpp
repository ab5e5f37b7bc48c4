// Time stepping with as many substeps as Newton's method requires.
#pragma once

#include "solve/newton.hpp"
#include "solve/predictor.hpp"

namespace sprekk::solve {

struct TimeSteppingOptions {
  int max_halvings = 6;               ///< smallest substep: step / 2^max_halvings
  bool proximal_continuation = true;  ///< proximal continuation before the first halving, see TimeStepper::relax()
  bool predicts = false;              ///< Newton's method starts from extrapolated states; not an entry of scenes

  void describe(base::Section& section);
};

struct StepReport {
  bool converged = false;
  bool stopped = false;                       ///< by NewtonOptions::should_stop
  Real time = 0;                              ///< time of the state x
  int newton_iterations = 0;                  ///< including rejected substeps
  fields::Exchanges exchanges;                ///< likewise, set by the owner of the problem
  std::vector<LinearReport> linear_solves;    ///< likewise, [Newton iteration]
  std::vector<LinearReport> advected_solves;  ///< likewise, see NewtonReport
  int substeps = 0;                           ///< committed substeps
  int cuts = 0;
  std::string reason;             ///< of the last failure, if any
  std::vector<char> oscillating;  ///< [as Globalisation::states()] oscillating states in the last failure
  std::string floating;           ///< floating bodies in the state at `time`, as text
  std::vector<Measure> measures;  ///< of the last Newton solve
};

/// Time stepper. Refers to the problem and to Newton.
class TimeStepper {
 public:
  TimeStepper(BlockProblem& problem, Newton& newton, const TimeSteppingOptions& options)
      : problem_(problem), newton_(newton), options_(options) {}

  /// Advances x, the committed state at t, to t_to. With predictions, Newton's method starts from the extrapolated
  /// state, and again from x if it fails. If Newton's method fails and there is contact, proximal continuation follows,
  /// see relax(); with storage, only from the third halving on. If this fails, x is restored and the substep halved.
  /// After a converged substep, the length is doubled. Each converged substep is committed, and t is the time of x,
  /// even if the smallest substep fails or an evaluation throws. Collective.
  StepReport advance(BlockVector& x, Real& t, Real t_to);

 private:
  /// Returns whether more than 100 linear solves have failed since Newton's method last converged.
  bool is_hopeless(const StepReport& report) const;
  NewtonReport solve(Evaluation& x, StepReport& report, int max_changes = std::numeric_limits<int>::max());
  NewtonReport solve_from_prediction(Evaluation& x, Real t, Real dt, bool shortens, StepReport& report);
  NewtonReport place_at_minimum_norm(Evaluation& x, NewtonReport newton, int& placements, StepReport& report);
  NewtonReport relax(Evaluation& x, StepReport& report);

  BlockProblem& problem_;
  Newton& newton_;
  TimeSteppingOptions options_;
  Predictor predictor_;
  Real committed_dt_ = 0;             // length of the last committed substep; 0 before the first
  std::ptrdiff_t first_counted_ = 0;  // number of the step's linear solves when Newton's method last converged
};

}  // namespace sprekk::solve
