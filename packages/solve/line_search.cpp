#include "solve/line_search.hpp"

#include <NOX_Abstract_Group.H>
#include <NOX_Solver_Generic.H>
#include <NOX_Thyra_Vector.H>

#include <algorithm>
#include <cmath>
#include <limits>

namespace sprekk::solve {
namespace {

constexpr Real smallest_step = 1.0 / 64;
constexpr std::size_t memory = 3;

BlockVector blocks_of(const NOX::Abstract::Vector& v) {
  return solve::blocks_of(dynamic_cast<const NOX::Thyra::Vector&>(v).getThyraVector());
}

}  // namespace

BlockVector solution_of(const NOX::Abstract::Group& group) { return blocks_of(group.getX()); }
BlockVector residual_of(const NOX::Abstract::Group& group) { return blocks_of(group.getF()); }

bool LineSearch::compute(NOX::Abstract::Group& group, double& step, const NOX::Abstract::Vector& direction,
                         const NOX::Solver::Generic& solver) {
  step = 0;
  if (!model_.linear_history().last.converged) return false;
  const auto& from = solver.getPreviousSolutionGroup();
  const auto try_step = [&](Real a) {
    group.computeX(from, direction, a);
    group.computeF();
    const Real merit = problem_.merit(solution_of(group), residual_of(group));
    return std::isfinite(merit) ? merit : std::numeric_limits<Real>::infinity();
  };
  Real a = 1, merit = try_step(a), best = a, best_merit = merit;
  while (!(merit <= (1 - 1e-3 * a) * limit()) && a > smallest_step) {
    a /= 2;
    merit = try_step(a);
    if (merit < best_merit) {
      best = a;
      best_merit = merit;
    }
  }
  if (!(merit <= (1 - 1e-3 * a) * limit()) && best != a) merit = try_step(a = best);
  step = a;
  accept(solution_of(group), merit);
  return true;
}

Real LineSearch::limit() const {
  if (merits_.empty()) return std::numeric_limits<Real>::infinity();
  return monotone_ ? merits_.back() : *std::max_element(merits_.begin(), merits_.end());
}

void LineSearch::accept(const BlockVector& x, Real merit) {
  merits_.push_back(merit);
  if (merits_.size() > memory) merits_.pop_front();
  const auto state = problem_.state_hash(x);
  const auto seen = visited_.find(state);
  if (seen != visited_.end() && merit >= seen->second) monotone_ = true;
  visited_[state] = merit;
}

}  // namespace sprekk::solve
