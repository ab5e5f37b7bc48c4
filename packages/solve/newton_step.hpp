// Step of Newton's method: direction and length, for NOX. The search is non-monotone, since kinks in f may raise the
// merit on the way to a solution.
#pragma once

#include <NOX_Direction_Generic.H>
#include <NOX_LineSearch_Generic.H>

#include <optional>
#include <string>
#include <vector>

#include "solve/forced_solve.hpp"
#include "solve/iterates.hpp"
#include "solve/nox_group.hpp"
#include "solve/picard.hpp"

namespace sprekk::solve {

/// Step of Newton's method. The direction is the solution of the linear system. The step length is found by these
/// rules:
/// - The first step is full. Later steps take the first a = 1, 1/2, ..., 1/64 with merit <= (1 - 1e-3 a) limit, see
///   Iterates::limit().
/// - If no a is accepted, the direction is computed again with damping 0.1, 1, 10.
/// - If damping fails, but the full first step leads to other contact states, this step is taken and the search
///   restarts. There are at most three such restarts per solve. The search also restarts after calibrate() changed f.
/// - Before a step is tried, its share of free motions is balanced, see Globalisation::balance().
/// - Entities with alternating states are damped by Iterates::swinging() in the next step.
/// - Coefficients of fluxes that depend on x: Picard decides when steps are searched and which are rejected.
/// - If the flow is far from balance at the start of a solve, the first step changes the flow only. Advected blocks
///   follow strong changes of the flow by a solve of their own, see carry(). In problems of balances only (rigid rock),
///   up to three more steps balance the flow first if this does not succeed.
/// - In such problems a full step is also accepted if it halves the largest measure of all balances.
/// - Resistance that decreases with the motion: once a full step with lagged coefficients increases the merit of the
///   lagged problem, later steps are searched for a decrease of this merit. The first step of a Picard phase is not
///   searched. The coefficients remain frozen until the merit has decreased to a tenth.
/// Refers to its arguments. All members are collective.
class NewtonStep : public NOX::Direction::Generic, public NOX::LineSearch::Generic {
 public:
  struct Report {
    std::vector<LinearReport> linear_solves;
    std::string failure;   ///< reason for a missing step
    std::string floating;  ///< floating bodies in the last iterate that had some, as text
    /// Stagnation of the iteration, see Iterates. With frozen coefficients, also: four steps did not halve the merit.
    bool stagnant = false;
    bool damped = false;  ///< the last Jacobian of a linear solve was damped, lagged or of another x, on this rank
    std::vector<LinearReport> advected_solves;  ///< see NewtonStep::carry()
  };

  NewtonStep(BlockProblem& problem, ForcedSolve& linear, Picard& picard)
      : problem_(problem), globalisation_(problem.globalisation()), linear_(linear), picard_(picard) {
    for (const auto& block : problem.blocks()) only_balances_ = only_balances_ && block.balance;
  }

  /// Computes the direction at the iterate of the group. A failed linear solve is in the report; then compute() below
  /// repeats it with damping.
  bool compute(NOX::Abstract::Vector& direction, NOX::Abstract::Group& group,
               const NOX::Solver::Generic& solver) override;
  /// Finds the step. Fails with length 0 if the linear solve failed, if no step is acceptable, or if a body has met no
  /// resistance in four steps of a solve. The report contains the reason, except for a failed linear solve.
  bool compute(NOX::Abstract::Group& group, double& length, const NOX::Abstract::Vector& direction,
               const NOX::Solver::Generic& solver) override;
  bool reset(const RCP<NOX::GlobalData>&, Teuchos::ParameterList&) override { return true; }

  /// Makes all further steps full: all rows have converged, and merits are round-off.
  void end_search() { is_searching_ = false; }

  const Report& report() const { return report_; }
  const Iterates& iterates() const { return iterates_; }

 private:
  struct Direction {
    RCP<NOX::Abstract::Vector> dx;
    Evaluation end;  ///< after the full step; empty: not yet evaluated
  };
  struct Attempt {
    NoxGroup& group;       ///< the last trial
    const NoxGroup& from;  ///< the last iterate
    Direction along;
    bool solved;           ///< the linear system of the direction was solved
    Direction first = {};  ///< the balanced direction without further damping; null: not solved, or it found a step
  };
  struct Trial {
    Real length, merit;
  };
  using Found = std::optional<Trial>;

  // the steps, in this order
  bool linearize(const NoxGroup& group, NOX::Abstract::Vector& dx);
  bool balance(Attempt& attempt);
  Found attempt(Attempt& attempt);
  Found damp(Attempt& attempt);
  Found step_with_lag(Attempt& attempt);
  bool return_to_lag(const Attempt& attempt);
  Found enter_other_states(Attempt& attempt);
  bool reject(const Attempt& attempt, Trial& taken);
  bool begins_flow(const NoxGroup& group) const;
  void carry(const Attempt& attempt, Trial& taken);
  void accept(NoxGroup& group, const Trial& taken);

  Found try_direction(Attempt& attempt) const;
  bool balances(const Attempt& attempt) const;
  Found full(const Attempt& attempt, Direction& along) const;
  Real merit_after(const Attempt& attempt, Direction& along, Real length) const;
  Real merit(NoxGroup& group) const;
  Real merit_of_changed_f(NoxGroup& group) const;
  Real error_of(const NoxGroup& group, ForcedSolve::Part part) const;
  bool searches() const { return is_searching_ && (!picard_.lags() || (struggles_ && !picard_.fresh())); }
  bool begins_to_struggle(const Trial& taken);
  bool freeze(const Trial& taken);
  bool is_stagnant() const;

  BlockProblem& problem_;
  fields::Globalisation& globalisation_;
  ForcedSolve& linear_;
  Picard& picard_;
  Report report_;
  Iterates iterates_;
  Real damping_ = 0;
  int n_unbalanced_ = 0;       // steps in which a body met no resistance
  int n_restarts_ = 0;         // restarts of the search without an acceptable step
  int n_frozen_ = 0;           // successive steps with frozen coefficients
  bool weakens_ = false;       // see Globalisation::weakens()
  bool flow_first_ = false;    // the direction is zero in advected blocks
  bool only_balances_ = true;  // no rock or joint that deforms
  int n_flow_steps_ = 0;       // successive directions of this kind
  bool carried_ = false;       // advected blocks have followed the last step by a solve of their own
  bool is_searching_ = true;   // see end_search()
  bool struggles_ = false;     // a full step with lagged coefficients increased the merit
};

}  // namespace sprekk::solve
