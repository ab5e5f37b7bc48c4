#include "solve/newton_step.hpp"

#include <NOX_Abstract_Group.H>
#include <NOX_Solver_Generic.H>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprekk::solve {
namespace {

constexpr Real smallest_length = 1.0 / 64, min_damping = 0.1, max_damping = 10;
constexpr Real solved_part = 0.1;  // of the merit of the lagged f
constexpr int max_frozen = 4, max_unbalanced = 3, max_restarts = 3;
constexpr Real max_imbalance = 10, max_error_of_advected = 1;   // measures of convergence
constexpr Real solved_by_carrying = 0.1, enough_smaller = 0.5;  // of such measures
constexpr int max_flow_steps = 4;

using Part = ForcedSolve::Part;

}  // namespace

bool NewtonStep::compute(NOX::Abstract::Vector& direction, NOX::Abstract::Group& group, const NOX::Solver::Generic&) {
  if (!group.isF()) group.computeF();
  linearize(dynamic_cast<const NoxGroup&>(group), direction);
  return true;
}

bool NewtonStep::compute(NOX::Abstract::Group& group, double& length, const NOX::Abstract::Vector& direction,
                         const NOX::Solver::Generic& solver) {
  length = 0;
  Attempt attempt{dynamic_cast<NoxGroup&>(group),
                  dynamic_cast<const NoxGroup&>(solver.getPreviousSolutionGroup()),
                  {direction.clone(), linear_.take_end()},
                  report_.linear_solves.back().converged};
  if (!balance(attempt)) return false;
  auto taken = this->attempt(attempt);
  if (!taken) taken = damp(attempt);
  if (!taken) taken = step_with_lag(attempt);
  if (!taken && return_to_lag(attempt)) return true;
  if (!taken) taken = enter_other_states(attempt);
  if (!taken) {
    if (attempt.solved) report_.failure = "no step along Newton's direction brings the iterate nearer to a solution";
    attempt.group = attempt.from;
    return false;
  }
  if (reject(attempt, *taken)) return true;
  carry(attempt, *taken);
  length = taken->length;
  accept(attempt.group, *taken);
  return true;
}

/// Computes dx = -A^-1 f with the Jacobian A at the iterate, including the present damping; flow first if it begins.
bool NewtonStep::linearize(const NoxGroup& group, NOX::Abstract::Vector& dx) {
  report_.damped = picard_.lags() || damping_ > 0 || iterates_.swings();
  linear_.jacobian(group.x());
  auto blocks = blocks_of(dx);
  flow_first_ = begins_flow(group);
  n_flow_steps_ = flow_first_ ? n_flow_steps_ + 1 : 0;
  if (flow_first_) {
    report_.damped = true;
    report_.linear_solves.push_back(linear_.solve_part(Part::others, group.f(), blocks));
  } else {
    linear_.update();
    report_.linear_solves.push_back(linear_.solve(group.f(), blocks, linear_.tolerance()));
  }
  dx.scale(-1);
  return report_.linear_solves.back().converged;
}

/// Balances motions of bodies that no contact resists. Returns false if a body has met no resistance too often.
bool NewtonStep::balance(Attempt& attempt) {
  auto blocks = blocks_of(*attempt.along.dx);
  const auto unresisted = attempt.solved ? globalisation_.balance(attempt.from.x(), blocks, attempt.along.end) : "";
  if (const auto floating = globalisation_.floating(); !floating.empty()) report_.floating = floating;
  if (!unresisted.empty() && ++n_unbalanced_ > max_unbalanced) {
    report_.failure = "no resistance to the loads found: " + unresisted + ", and meets none";
    return false;
  }
  return true;
}

/// Tries the direction, and once more if this shows that the lagged problem must be searched.
NewtonStep::Found NewtonStep::attempt(Attempt& attempt) {
  if (picard_.possible() && iterates_.empty()) weakens_ = globalisation_.weakens(attempt.from.x());
  if (!attempt.solved) return {};
  auto found = try_direction(attempt);
  if (found && begins_to_struggle(*found)) found = try_direction(attempt);
  return found;
}

/// Repeats the linear solve with more damping until a step is found.
NewtonStep::Found NewtonStep::damp(Attempt& attempt) {
  if (attempt.solved) attempt.first = {attempt.along.dx->clone(), attempt.along.end};
  Found found;
  while (!found && damping_ < max_damping) {
    globalisation_.damp(damping_ = std::max(10 * damping_, min_damping), iterates_.swinging());
    attempt.solved = linearize(attempt.from, *attempt.along.dx);
    attempt.along.end = linear_.take_end();
    if (attempt.solved) found = try_direction(attempt);
  }
  return found;
}

/// Takes the full step of the lagged problem, if it was searched in vain and its coefficients may change.
NewtonStep::Found NewtonStep::step_with_lag(Attempt& attempt) {
  if (attempt.first.dx.is_null() || !struggles_ || !picard_.lags() || n_frozen_ > 0) return {};
  damping_ = 0;
  return full(attempt, attempt.first);
}

/// Returns to the lagged f if no step of f itself was found. Returns false if this is not possible.
bool NewtonStep::return_to_lag(const Attempt& attempt) {
  if (!attempt.solved || !picard_.possible() || picard_.lags() || iterates_.empty()) return false;
  attempt.group = attempt.from;
  picard_.resume(attempt.group.x(), 0, 0, 0);
  globalisation_.damp(damping_ = 0, iterates_.swinging());
  attempt.group.forget_f();
  attempt.group.computeF();
  return true;
}

/// Takes the full step if it leads to other states. The merits of distant states may differ by many orders of
/// magnitude.
NewtonStep::Found NewtonStep::enter_other_states(Attempt& attempt) {
  if (attempt.first.dx.is_null() || picard_.possible() || n_restarts_ == max_restarts) return {};
  const auto taken = full(attempt, attempt.first);
  if (!taken || globalisation_.state_hash(globalisation_.states(attempt.group.x())) == iterates_.pattern()) return {};
  ++n_restarts_;
  damping_ = 0;
  iterates_.restart();
  return taken;
}

/// Lets Picard check a step, and returns whether the step is rejected. If f has changed, evaluates f and the merit
/// again.
bool NewtonStep::reject(const Attempt& attempt, Trial& taken) {
  if (!picard_.possible() || !is_searching_) return false;
  const bool lagged = picard_.lags();
  bool back = false;
  if (lagged) {
    if (freeze(taken)) return false;
    back = picard_.follow(attempt.group.x());
    if (!picard_.lags()) iterates_.restart();
  } else if (!iterates_.empty() && !(weakens_ && picard_.agrees())) {
    back = picard_.resume(attempt.from.x(), taken.length, taken.merit, iterates_.last_merit());
  }
  if (back) attempt.group = attempt.from;
  if (back || lagged) taken.merit = merit_of_changed_f(attempt.group);
  return back;
}

/// Returns whether the flow is far from balance at the start of a solve, or after few steps of the flow that advected
/// blocks could not follow. The linearisation of these blocks about this flow is then meaningless.
bool NewtonStep::begins_flow(const NoxGroup& group) const {
  const bool starts =
      iterates_.empty() || (only_balances_ && flow_first_ && !carried_ && n_flow_steps_ < max_flow_steps);
  return starts && damping_ == 0 && linear_.has_advected() && error_of(group, Part::others) > max_imbalance;
}

/// Lets advected blocks follow a strong change of their flow: after a step of the flow alone, or if their errors have
/// grown because they are linearised about another flow. For a given flow, their rows are linear or nearly so. The
/// blocks return to the last iterate, and one solve with the new flow replaces their step if it reduces their errors to
/// a tenth. If the flow depends on them, it would adjust, but here all other unknowns are fixed. Such a solve may then
/// lead to values far outside of their bounds.
void NewtonStep::carry(const Attempt& attempt, Trial& taken) {
  carried_ = false;
  if (!linear_.has_advected()) return;
  auto& group = attempt.group;
  const Real allowed = std::max(max_error_of_advected, error_of(attempt.from, Part::advected));
  if (!flow_first_ && !(error_of(group, Part::advected) > allowed)) return;
  const NoxGroup stepped(group);
  auto start = stepped.x().x();
  for (std::size_t b = 0; b < start.size(); ++b)
    if (problem_.blocks()[b].advected) start[b] = attempt.from.x().x()[b];
  group.move_to(flow_first_ ? stepped.x() : Evaluation(start));
  group.computeF();
  report_.damped = true;
  linear_.jacobian(group.x());
  const auto dx = group.getX().clone(NOX::ShapeCopy);
  auto blocks = blocks_of(*dx);
  report_.advected_solves.push_back(linear_.solve_part(Part::advected, group.f(), blocks));
  if (report_.advected_solves.back().converged) {
    group.computeX(NoxGroup(group), *dx, -1);
    const Real merit = this->merit(group);
    const Real error = error_of(group, Part::advected);
    if (std::isfinite(merit) && error < (only_balances_ ? solved_by_carrying : 1) * error_of(stepped, Part::advected)) {
      taken.merit = merit;
      carried_ = true;
      return;
    }
  }
  group = stepped;
  taken.merit = merit_of_changed_f(group);  // sizes of rows have changed
}

/// Returns the largest measure of convergence of the advected blocks, or of balances that are not advected.
Real NewtonStep::error_of(const NoxGroup& group, Part part) const {
  Real error = 0;
  const auto measures = problem_.measures(group.x(), group.f());
  for (const auto& block : problem_.blocks())
    for (const auto& measure : measures)
      if (block.advected == (part == Part::advected) && block.balance && measure.name == block.name)
        error = std::max(error, measure.value);
  return error;
}

/// Accepts a step. Before the first full step, the linear part is not balanced, so calibration starts with its result.
void NewtonStep::accept(NoxGroup& group, const Trial& taken) {
  if (taken.length == 1 && damping_ > 0) damping_ = damping_ > min_damping ? damping_ / 10 : 0;
  const bool changed = globalisation_.calibrate(group.x(), iterates_.empty());
  const Real merit = changed ? merit_of_changed_f(group) : taken.merit;
  auto states = globalisation_.states(group.x());
  const auto pattern = globalisation_.state_hash(states);
  iterates_.accept({std::move(states), pattern, merit, taken.length, picard_.lags(), changed});
  globalisation_.damp(damping_, iterates_.swinging());
  report_.stagnant = is_stagnant();
}

NewtonStep::Found NewtonStep::try_direction(Attempt& attempt) const {
  if (!searches()) return full(attempt, attempt.along);
  for (Real a = 1; a >= smallest_length; a /= 2) {
    const Real m = merit_after(attempt, attempt.along, a);
    if (!std::isfinite(m)) continue;
    if (m <= (1 - 1e-3 * a) * iterates_.limit(picard_.lags()) || (a == 1 && balances(attempt))) return Trial{a, m};
  }
  return {};
}

/// Returns whether the last trial has halved the largest error of all balances. The merit almost ignores advected
/// blocks, but a step that corrects them may change a flow that depends on them.
bool NewtonStep::balances(const Attempt& attempt) const {
  if (!only_balances_ || !linear_.has_advected()) return false;
  const auto error = [&](const NoxGroup& group) {
    return std::max(error_of(group, Part::advected), error_of(group, Part::others));
  };
  return error(attempt.group) < enough_smaller * error(attempt.from);
}

NewtonStep::Found NewtonStep::full(const Attempt& attempt, Direction& along) const {
  const Real m = merit_after(attempt, along, 1);
  if (!std::isfinite(m)) return {};
  return Trial{1, m};
}

/// Moves to the end of a step. The end of the full step is evaluated once.
Real NewtonStep::merit_after(const Attempt& attempt, Direction& along, Real length) const {
  if (length == 1 && !along.end.empty())
    attempt.group.move_to(along.end);
  else
    attempt.group.computeX(attempt.from, *along.dx, length);
  if (length == 1) along.end = attempt.group.x();
  return merit(attempt.group);
}

Real NewtonStep::merit(NoxGroup& group) const {
  group.computeF();
  return problem_.merit(group.x(), group.f());
}

Real NewtonStep::merit_of_changed_f(NoxGroup& group) const {
  group.forget_f();
  return merit(group);
}

/// Detects an increase of the merit with lagged coefficients. Excludes the first step of a Picard phase, in which flow
/// residuals necessarily increase.
bool NewtonStep::begins_to_struggle(const Trial& taken) {
  if (struggles_ || !weakens_ || !picard_.lags() || picard_.fresh() || iterates_.empty()) return false;
  return struggles_ = taken.merit > iterates_.last_merit();
}

/// Freezes the coefficients while the iterate is far from a solution of the lagged f. Its coefficients would be
/// arbitrary.
bool NewtonStep::freeze(const Trial& taken) {
  const bool freezes = struggles_ && !iterates_.empty() && taken.merit > solved_part * iterates_.last_merit();
  n_frozen_ = freezes ? n_frozen_ + 1 : 0;
  if (freezes) picard_.freeze();
  return freezes;
}

bool NewtonStep::is_stagnant() const {
  if (n_frozen_ > max_frozen && iterates_.not_halved_in(max_frozen)) return true;
  return picard_.possible() ? iterates_.stagnate_without_lag() : iterates_.stagnate(problem_.stores());
}

}  // namespace sprekk::solve
