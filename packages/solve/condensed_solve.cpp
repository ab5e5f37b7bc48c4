#include "solve/condensed_solve.hpp"

#include <numeric>
#include <utility>

namespace sprekk::solve {
namespace {

std::vector<int> numbers_up_to(std::size_t n) {
  std::vector<int> numbers(n);
  std::iota(numbers.begin(), numbers.end(), 0);
  return numbers;
}

}  // namespace

CondensedSolve::CondensedSolve(BlockProblem& problem, const LinearSolverOptions& options, RCP<base::Timers> timers)
    : problem_(problem),
      timers_(timers),
      options_(options),
      elimination_(problem),
      whole_(problem, elimination_, numbers_up_to(elimination_.remaining().size()), options),
      forcing_(options.forcing && !solver().solver->reads_matrix()) {}

/// Returns the blocks of a part as indices of LocalElimination::remaining().
std::vector<int> CondensedSolve::blocks_of(Part part) const {
  auto blocks = numbers_up_to(elimination_.remaining().size());
  std::erase_if(blocks, [&](int r) {
    return problem_.blocks()[elimination_.remaining()[r]].advected != (part == Part::advected);
  });
  return blocks;
}

bool CondensedSolve::eliminate() {
  const auto scope = timers_->scope("local elimination");
  auto status = elimination_.update(problem_);
  const bool changed = status.changed || !failure_.empty();
  failure_ = std::move(status.failure);
  return changed;
}

void CondensedSolve::update() {
  const bool changed = eliminate(), symmetric = problem_.symmetric();
  if (!failure_.empty() || !(changed || outdated_ || symmetric != symmetric_)) return;
  const auto scope = timers_->scope("set-up of linear solver");
  symmetric_ = symmetric;
  outdated_ = false;
  failure_ = whole_.setup(symmetric_);
  ++n_setups_;
}

LinearReport CondensedSolve::solve_by(RemainingSolve& solver, const BlockVector& b, BlockVector& dx, Real tolerance) {
  LinearReport report;
  report.reason = failure_;
  if (!failure_.empty()) return report;
  const auto scope = timers_->scope("linear solve");
  BlockVector y;
  report = solver.solve(elimination_.reduce(b), y, tolerance);
  if (report.converged) elimination_.expand(b, y, dx);
  return report;
}

LinearReport CondensedSolve::solve(const BlockVector& b, BlockVector& dx, Real tolerance) {
  return solve_by(whole_, b, dx, tolerance);
}

LinearReport CondensedSolve::solve_part(Part part, const BlockVector& b, BlockVector& dx, Real tolerance) {
  auto& solver = parts_.try_emplace(part, problem_, elimination_, blocks_of(part), options_).first->second;
  eliminate();
  outdated_ = true;
  if (failure_.empty()) {
    const auto scope = timers_->scope("set-up of linear solver");
    failure_ = solver.setup(part == Part::others && problem_.symmetric_blocks());
  }
  return solve_by(solver, b, dx, tolerance);
}

}  // namespace sprekk::solve
