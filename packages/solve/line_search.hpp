// Line search of Newton's method. It is non-monotone, since kinks in f may raise the merit on the way to a solution.
#pragma once

#include <NOX_LineSearch_Generic.H>
#include <NOX_LineSearch_UserDefinedFactory.H>

#include <map>
#include <optional>
#include <vector>

#include "solve/picard.hpp"
#include "solve/thyra_model.hpp"

namespace sprekk::solve {

struct SearchReport {
  std::string failure;  ///< reason for a missing step
  std::string loose;    ///< floating bodies in the last iterate that had some, as text
  /// Stagnation of the iteration:
  /// - None of the last five merits is below half of the best earlier merit, from the tenth iterate on.
  /// - Problems with storage, also: the last four step lengths sum to less than 0.5.
  /// - Coefficients of fluxes that depend on x, instead of these: in ten iterates without lag, no state changed, and no
  ///   merit was below half of the best earlier merit. With frozen coefficients: four steps did not halve the merit.
  bool stagnant = false;
  bool damped = false;           ///< the last Jacobian of a linear solve was damped or lagged, on this rank
  int n_accepted = 0;            ///< number of iterates without the start
  std::vector<int> last_change;  ///< [as states()] number of the last iterate with a change of state
};

/// Non-monotone line search.
/// - The first step is full. Later steps take the first a = 1, 1/2, ..., 1/64 with merit <= (1 - 1e-3 a) max(last 3
///   merits).
/// - If no a is accepted, the direction is computed again with damping 0.1, 1, 10.
/// - If damping fails, but the full first step leads to other contact states, this step is taken and the search
///   restarts. There are at most three such restarts per solve. The search also restarts after calibrate() changed f.
/// - Before a step is tried, its share of free motions is balanced, see Globalisation::balance().
/// - If a state pattern recurs without a better merit, the iteration is in a cycle. From then on only the last merit
///   counts.
/// - Entities with a change of state that also changed in one of the two previous iterates are damped by 0.3 in the
///   next step.
/// - Coefficients of fluxes that depend on x: Picard decides when steps are searched and which are rejected.
/// - Joints that weaken with slip: once a full step with lagged coefficients increases the merit of the lagged problem,
///   later steps are searched for a decrease of this merit. The first step of a Picard phase is not searched. The
///   coefficients remain frozen until the merit has decreased to a tenth.
class LineSearch : public NOX::LineSearch::Generic {
 public:
  LineSearch(BlockProblem& problem, const ThyraModel& model, Picard& picard, SearchReport& report)
      : problem_(problem), globalisation_(problem.globalisation()), model_(model), picard_(picard), report_(report) {}

  /// Finds the step. Fails with step 0 if the linear solve failed, if no step is acceptable, or if a body has met no
  /// resistance in four steps of a solve. The report contains the reason, except for a failed linear solve.
  bool compute(NOX::Abstract::Group& group, double& step, const NOX::Abstract::Vector& direction,
               const NOX::Solver::Generic& solver) override;

 private:
  struct Trial {
    Real a, merit;
  };
  std::optional<Trial> search(NOX::Abstract::Group& group, const NOX::Abstract::Group& from,
                              const NOX::Abstract::Vector& dx) const;
  std::optional<Trial> full(NOX::Abstract::Group& group, const NOX::Abstract::Group& from,
                            const NOX::Abstract::Vector& dx) const;
  bool searches() const { return !picard_.lags() || (struggles_ && !picard_.fresh()); }
  bool begins_to_struggle(const Trial& taken);
  bool holds(const Trial& taken);
  void begin_search();
  std::optional<Trial> begin_anew(NOX::Abstract::Group& group, const NOX::Abstract::Group& from,
                                  const NOX::Abstract::Vector& dx);
  bool goes_back(NOX::Abstract::Group& group, const NOX::Abstract::Group& from);
  bool takes_back(NOX::Abstract::Group& group, const NOX::Abstract::Group& from, Trial& taken);
  Real limit() const;
  void accept(NOX::Abstract::Group& group, Real step, Real merit);
  void compare(const std::vector<char>& states, Real merit);
  bool is_stagnant();

  BlockProblem& problem_;
  fields::Globalisation& globalisation_;
  const ThyraModel& model_;
  Picard& picard_;
  SearchReport& report_;
  int n_unbalanced_ = 0;
  int n_begun_ = 0;  // restarts of the search without an acceptable step
  Real damping_ = 0;
  std::vector<char> states_;             // of the last iterate
  std::vector<Real> swinging_;           // [as states()] damping of oscillating entities
  std::vector<Real> merits_;             // of all iterates
  std::vector<Real> steps_;              // step lengths to the iterates
  std::size_t since_ = 0;                // index of the first of merits_ that belongs to the present f
  std::size_t progress_ = 0;             // number of merits at the last change of state, or reduction by half
  Real least_ = 0;                       // smallest merit so far
  std::size_t pattern_ = 0;              // hash of states_
  bool changed_ = false;                 // pattern_ changed in the last iterate
  std::map<std::size_t, Real> visited_;  // merit at the last visit of a state pattern
  bool monotone_ = false;
  bool weakens_ = false;    // see Globalisation::weakens()
  bool struggles_ = false;  // a full step with lagged coefficients increased the merit
  int n_held_ = 0;          // steps with frozen coefficients
};

/// Factory that provides the line search to NOX.
class LineSearchFactory : public NOX::LineSearch::UserDefinedFactory {
 public:
  LineSearchFactory(BlockProblem& problem, const ThyraModel& model, Picard& picard, SearchReport& report)
      : problem_(problem), model_(model), picard_(picard), report_(report) {}
  RCP<NOX::LineSearch::Generic> buildLineSearch(const RCP<NOX::GlobalData>&, Teuchos::ParameterList&) const override {
    return rcp(new LineSearch(problem_, model_, picard_, report_));
  }

 private:
  BlockProblem& problem_;
  const ThyraModel& model_;
  Picard& picard_;
  SearchReport& report_;
};

/// Return the unknowns or the residual of a NOX group over Thyra, without copying. The result is read-only.
BlockVector solution_of(const NOX::Abstract::Group& group);
BlockVector residual_of(const NOX::Abstract::Group& group);

}  // namespace sprekk::solve
