// The line search of Newton: non-monotone, for kinks in f make the merit rise on the way to a solution.
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
  std::string failure;  ///< why there was no step
  std::string loose;    ///< what nothing held in one of the iterates, the last such
  /// None of the last five merits is below half the best before; or, where a shorter time step helps, the last four
  /// steps together were below half of one of Newton's. Where coefficients of fluxes depend on x and do not lag: in
  /// ten iterates no state changed, and no merit was below half the best before; where they stay as they are, four
  /// steps did not halve the merit.
  bool stagnant = false;
  bool damped = false;           ///< the last Jacobian that was solved with was, on this rank
  int n_accepted = 0;            ///< iterates but for the start
  std::vector<int> last_change;  ///< [as states()] number of the iterate in which a state was last another one
};

/// The first step is full. After that a = 1, 1/2, .. 1/64 is taken as soon as merit <= (1 - 1e-3 a) max(last 3 merits);
/// if none is, the step is taken anew with damping 0.1, 1, 10. Where that does not help, but the full first step leads
/// to other discrete states, it is taken as it is, and the search begins anew, three times in a solve; so it does after
/// calibrate() has changed f. Before a step is taken its share of motions that nothing resists is balanced. When a
/// discrete state comes back and the merit is no better than then, iterates would go round in circles: from there on
/// only the last merit counts. Entities whose state changes, and did in one of the two iterates before, are damped, by
/// 0.3, in the next step. Where coefficients of fluxes depend on x, Picard says when there is a search, and which steps
/// are taken back. Joints that weaken with slip: once a full step with lagged coefficients increases the merit of the
/// lagged problem, steps are searched for a decrease of that merit, except the first step after Picard begins, and the
/// coefficients are frozen until the merit has fallen to a tenth.
class LineSearch : public NOX::LineSearch::Generic {
 public:
  LineSearch(BlockProblem& problem, const ThyraModel& model, Picard& picard, SearchReport& report)
      : problem_(problem), globalisation_(problem.globalisation()), model_(model), picard_(picard), report_(report) {}

  /// Fails, with step 0, where the direction does: after a linear solve that did; and when a body has found no
  /// resistance in four steps of a solve, which is what the report says then.
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
  int n_begun_ = 0;  // how often the search began anew since no step was found
  Real damping_ = 0;
  std::vector<char> states_;             // of the last iterate
  std::vector<Real> swinging_;           // [as states()] damping of entities that go to and fro
  std::vector<Real> merits_;             // of all iterates
  std::vector<Real> steps_;              // to them
  std::size_t since_ = 0;                // the first of merits_ that is one of f itself
  std::size_t progress_ = 0;             // the last iterate with a state of its own, or half the least merit before
  Real least_ = 0;                       // merit so far
  std::size_t pattern_ = 0;              // hash of states_
  bool changed_ = false;                 // it did in the last iterate
  std::map<std::size_t, Real> visited_;  // merit at the last visit of a discrete state
  bool monotone_ = false;
  bool weakens_ = false;    // see Globalisation
  bool struggles_ = false;  // a full step of the f that lags made its merit rise
  int n_held_ = 0;          // steps since coefficients that lag changed
};

/// Lets NOX make line searches for a problem.
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

/// The unknowns and the residual of a NOX group over Thyra, not copied, to be read only.
BlockVector solution_of(const NOX::Abstract::Group& group);
BlockVector residual_of(const NOX::Abstract::Group& group);

}  // namespace sprekk::solve
