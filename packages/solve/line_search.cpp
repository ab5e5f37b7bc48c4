#include "solve/line_search.hpp"

#include <NOX_Abstract_Group.H>
#include <NOX_Solver_Generic.H>
#include <NOX_Thyra_Vector.H>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprekk::solve {
namespace {

constexpr Real smallest_step = 1.0 / 64, least_damping = 0.1, most_damping = 10;
constexpr std::size_t memory = 3;
constexpr int most_unbalanced = 3;

BlockVector blocks_of(const NOX::Abstract::Vector& v) {
  return solve::blocks_of(dynamic_cast<const NOX::Thyra::Vector&>(v).getThyraVector());
}

}  // namespace

BlockVector solution_of(const NOX::Abstract::Group& group) { return blocks_of(group.getX()); }
BlockVector residual_of(const NOX::Abstract::Group& group) { return blocks_of(group.getF()); }

bool LineSearch::compute(NOX::Abstract::Group& group, double& step, const NOX::Abstract::Vector& direction,
                         const NOX::Solver::Generic& solver) {
  step = 0;
  const auto& from = solver.getPreviousSolutionGroup();
  const auto dx = direction.clone();
  auto blocks = blocks_of(*dx);
  bool solved = model_.linear_history().last.converged;
  if (const auto loose = problem_.loose(); !loose.empty()) report_.loose = loose;
  const auto unresisted = solved ? problem_.balance(solution_of(from), blocks) : "";
  if (!unresisted.empty() && ++n_unbalanced_ > most_unbalanced) {
    report_.failure = "no equilibrium: " + unresisted + ", and meets no resistance";
    return false;
  }
  Trial best{0, 0, false};
  if (solved) best = search(group, from, *dx);
  while (!best.good && damping_ < most_damping) {
    problem_.damp(damping_ = std::max(10 * damping_, least_damping));
    solved = model_.direction(solution_of(from), residual_of(from), blocks);
    if (solved) best = search(group, from, *dx);
  }
  if (!solved) return false;
  if (!best.good) {
    report_.failure = "no step along Newton's direction brings the iterate nearer to a solution";
    return false;
  }
  step = best.a;
  if (best.a == 1 && damping_ > 0) problem_.damp(damping_ = damping_ > least_damping ? damping_ / 10 : 0);
  accept(solution_of(group), best.merit);
  return true;
}

LineSearch::Trial LineSearch::search(NOX::Abstract::Group& group, const NOX::Abstract::Group& from,
                                     const NOX::Abstract::Vector& dx) const {
  const auto try_step = [&](Real a) {
    group.computeX(from, dx, a);
    group.computeF();
    const Real merit = problem_.merit(solution_of(group), residual_of(group));
    return std::isfinite(merit) ? merit : std::numeric_limits<Real>::infinity();
  };
  Trial best{1, try_step(1), false};
  for (Real a = 1, merit = best.merit;; merit = try_step(a /= 2)) {
    if (merit < best.merit) best = {a, merit, false};
    if (merit <= (1 - 1e-3 * a) * limit()) return {a, merit, true};
    if (a <= smallest_step) {
      if (best.a != a) try_step(best.a);
      return best;
    }
  }
}

Real LineSearch::limit() const {
  if (merits_.empty()) return std::numeric_limits<Real>::infinity();
  return monotone_ ? merits_.back() : *std::max_element(merits_.begin(), merits_.end());
}

void LineSearch::accept(const BlockVector& x, Real merit) {
  merits_.push_back(merit);
  if (merits_.size() > memory) merits_.pop_front();
  const auto states = problem_.states(x);
  report_.last_change.resize(states.size(), 0);
  for (std::size_t k = 0; k < states.size() && report_.n_accepted > 0; ++k)
    if (states[k] != states_[k]) report_.last_change[k] = report_.n_accepted;
  states_ = states;
  ++report_.n_accepted;
  const auto state = problem_.state_hash(x);
  const auto seen = visited_.find(state);
  if (seen != visited_.end() && merit >= seen->second) monotone_ = true;
  visited_[state] = merit;
}

}  // namespace sprekk::solve
