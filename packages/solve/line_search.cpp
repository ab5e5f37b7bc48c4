#include "solve/line_search.hpp"

#include <NOX_Abstract_Group.H>
#include <NOX_Solver_Generic.H>
#include <NOX_Thyra_Vector.H>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace sprekk::solve {
namespace {

constexpr Real smallest_step = 1.0 / 64, least_damping = 0.1, most_damping = 10;
constexpr std::size_t memory = 3, patience = 5, trial_period = 10, short_steps = 4;
constexpr Real least_way = 0.5;
constexpr Real swing_damping = 0.3;
constexpr Real solved_part = 0.1;  // of the merit of the lagged f
constexpr int most_held = 4;
constexpr int most_unbalanced = 3, most_begun = 3;

BlockVector nox_blocks(const NOX::Abstract::Vector& v) {
  return solve::blocks_of(dynamic_cast<const NOX::Thyra::Vector&>(v).getThyraVector());
}

}  // namespace

BlockVector solution_of(const NOX::Abstract::Group& group) { return nox_blocks(group.getX()); }
BlockVector residual_of(const NOX::Abstract::Group& group) { return nox_blocks(group.getF()); }

bool LineSearch::compute(NOX::Abstract::Group& group, double& step, const NOX::Abstract::Vector& direction,
                         const NOX::Solver::Generic& solver) {
  step = 0;
  const auto& from = solver.getPreviousSolutionGroup();
  const auto dx = direction.clone();
  auto blocks = nox_blocks(*dx);
  bool solved = model_.linear_history().back().converged;
  report_.damped =
      picard_.lags() || damping_ > 0 || std::any_of(swinging_.begin(), swinging_.end(), [](Real d) { return d > 0; });
  const auto unresisted = solved ? globalisation_.balance(solution_of(from), blocks) : "";
  if (const auto loose = globalisation_.loose(); !loose.empty()) report_.loose = loose;
  if (!unresisted.empty() && ++n_unbalanced_ > most_unbalanced) {
    report_.failure = "no resistance to the loads found: " + unresisted + ", and meets none";
    return false;
  }
  if (picard_.possible() && merits_.empty()) weakens_ = globalisation_.weakens(solution_of(from));
  const auto first = dx->clone();
  const bool first_solved = solved;
  std::optional<Trial> found;
  const auto attempt = [&] { return searches() ? search(group, from, *dx) : full(group, from, *dx); };
  if (solved) found = attempt();
  if (found && begins_to_struggle(*found)) found = attempt();
  while (!found && damping_ < most_damping) {
    globalisation_.damp(damping_ = std::max(10 * damping_, least_damping), swinging_);
    report_.damped = true;
    solved = model_.direction(solution_of(from), residual_of(from), blocks);
    if (solved) found = attempt();
  }
  if (!found && first_solved && struggles_ && picard_.lags() && n_held_ == 0) {
    damping_ = 0;
    found = full(group, from, *first);
  }
  if (!found && solved && goes_back(group, from)) return true;
  if (!found && first_solved) found = begin_anew(group, from, *first);
  if (!found) {
    if (solved) report_.failure = "no step along Newton's direction brings the iterate nearer to a solution";
    group = from;
    return false;
  }
  if (picard_.possible() && takes_back(group, from, *found)) return true;
  step = found->a;
  if (step == 1 && damping_ > 0) damping_ = damping_ > least_damping ? damping_ / 10 : 0;
  accept(group, step, found->merit);
  return true;
}

std::optional<LineSearch::Trial> LineSearch::full(NOX::Abstract::Group& group, const NOX::Abstract::Group& from,
                                                  const NOX::Abstract::Vector& dx) const {
  group.computeX(from, dx, 1);
  group.computeF();
  const Real merit = problem_.merit(solution_of(group), residual_of(group));
  if (!std::isfinite(merit)) return {};
  return Trial{1, merit};
}

/// Takes the full step if it leads to other states. The merits of distant states may differ by many orders of
/// magnitude.
std::optional<LineSearch::Trial> LineSearch::begin_anew(NOX::Abstract::Group& group, const NOX::Abstract::Group& from,
                                                        const NOX::Abstract::Vector& dx) {
  if (picard_.possible() || n_begun_ == most_begun) return {};
  const auto taken = full(group, from, dx);
  if (!taken || globalisation_.state_hash(globalisation_.states(solution_of(group))) == pattern_) return {};
  ++n_begun_;
  damping_ = 0;
  begin_search();
  return taken;
}

/// Restarts the search: the next step is full. Earlier merits are not comparable, since f was different or the iterate
/// is distant from the others.
void LineSearch::begin_search() {
  since_ = merits_.size();
  monotone_ = false;
  visited_.clear();
}

/// Returns to the lagged f if no step of f itself was found. Returns false if this is not possible.
bool LineSearch::goes_back(NOX::Abstract::Group& group, const NOX::Abstract::Group& from) {
  if (!picard_.possible() || picard_.lags() || merits_.empty()) return false;
  group = from;
  picard_.resume(solution_of(group), 0, 0, 0);
  globalisation_.damp(damping_ = 0, swinging_);
  group.setX(group.getX());
  group.computeF();
  return true;
}

/// Lets Picard check a step, and returns whether the step is rejected. If f has changed, evaluates f and the merit
/// again.
bool LineSearch::takes_back(NOX::Abstract::Group& group, const NOX::Abstract::Group& from, Trial& taken) {
  const bool lagged = picard_.lags();
  bool back = false;
  if (lagged) {
    if (holds(taken)) return false;
    back = picard_.follow(solution_of(group));
    if (!picard_.lags()) begin_search();
  } else if (!merits_.empty() && !(weakens_ && picard_.agrees())) {
    back = picard_.resume(solution_of(from), taken.a, taken.merit, merits_.back());
  }
  if (back) group = from;
  if (!back && !lagged) return false;
  group.setX(group.getX());
  group.computeF();
  taken.merit = problem_.merit(solution_of(group), residual_of(group));
  return back;
}

/// Detects an increase of the merit with lagged coefficients. Excludes the first step of a Picard phase, in which flow
/// residuals necessarily increase.
bool LineSearch::begins_to_struggle(const Trial& taken) {
  if (struggles_ || !weakens_ || !picard_.lags() || picard_.fresh() || merits_.empty()) return false;
  return struggles_ = taken.merit > merits_.back();
}

/// Freezes the coefficients while the iterate is far from a solution of the lagged f. Its coefficients would be
/// arbitrary.
bool LineSearch::holds(const Trial& taken) {
  const bool hold = struggles_ && !merits_.empty() && taken.merit > solved_part * merits_.back();
  n_held_ = hold ? n_held_ + 1 : 0;
  if (hold) picard_.hold();
  return hold;
}

std::optional<LineSearch::Trial> LineSearch::search(NOX::Abstract::Group& group, const NOX::Abstract::Group& from,
                                                    const NOX::Abstract::Vector& dx) const {
  for (Real a = 1; a >= smallest_step; a /= 2) {
    group.computeX(from, dx, a);
    group.computeF();
    const Real merit = problem_.merit(solution_of(group), residual_of(group));
    if (std::isfinite(merit) && merit <= (1 - 1e-3 * a) * limit()) return Trial{a, merit};
  }
  return {};
}

Real LineSearch::limit() const {
  if (merits_.size() <= since_) return std::numeric_limits<Real>::infinity();
  if (monotone_ || picard_.lags()) return merits_.back();
  return *std::max_element(merits_.end() - std::min(memory, merits_.size() - since_), merits_.end());
}

/// Accepts a step. Before the first full step, the linear part is not balanced, so calibration starts with its result.
void LineSearch::accept(NOX::Abstract::Group& group, Real step, Real merit) {
  const auto x = solution_of(group);
  if (globalisation_.calibrate(x, merits_.empty())) {
    group.setX(group.getX());
    group.computeF();
    merit = problem_.merit(x, residual_of(group));
    merits_.assign(1, merit);
    begin_search();
  } else {
    merits_.push_back(merit);
  }
  compare(globalisation_.states(x), merit);
  globalisation_.damp(damping_, swinging_);
  steps_.push_back(step);
  report_.stagnant = is_stagnant();
}

bool LineSearch::is_stagnant() {
  const int now = static_cast<int>(merits_.size()) - 1;
  if (n_held_ > most_held && merits_.back() > 0.5 * merits_[now - most_held]) return true;
  if (picard_.possible()) {
    const bool first = now == static_cast<int>(since_);
    if (first || changed_ || picard_.lags() || merits_.back() < 0.5 * least_) progress_ = merits_.size();
    least_ = first ? merits_.back() : std::min(least_, merits_.back());
    return merits_.size() > progress_ + trial_period;
  }
  if (problem_.stores() && steps_.size() >= short_steps &&
      std::accumulate(steps_.end() - short_steps, steps_.end(), 0.0) < least_way)
    return true;
  if (merits_.size() < trial_period) return false;
  const auto recent = merits_.end() - patience;
  return *std::min_element(recent, merits_.end()) > 0.5 * *std::min_element(merits_.begin(), recent);
}

void LineSearch::compare(const std::vector<char>& states, Real merit) {
  const int now = static_cast<int>(merits_.size()) - 1;
  report_.n_accepted = now + 1;
  report_.last_change.resize(states.size(), 0);
  swinging_.assign(states.size(), 0);
  for (std::size_t k = 0; k < states.size() && now > 0; ++k) {
    if (states[k] == states_[k]) continue;
    int& last = report_.last_change[k];
    if (last > 0 && last >= now - 2) swinging_[k] = swing_damping;
    last = now;
  }
  states_ = states;
  const auto before = pattern_;
  pattern_ = globalisation_.state_hash(states);
  changed_ = pattern_ != before;
  const auto seen = visited_.find(pattern_);
  if (seen != visited_.end() && merit >= seen->second && !picard_.lags()) monotone_ = true;
  visited_[pattern_] = merit;
}

}  // namespace sprekk::solve
