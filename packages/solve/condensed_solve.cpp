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
      forcing_(options.forcing && !solver().solver->reads_matrix()) {
  if (!solver().solver->reads_matrix() || options.reproducible.value_or(false)) return;
  if (auto* change = elimination_.watch_change(problem))
    updated_ = std::make_unique<UpdatedFactors>(problem, *change, elimination_.condensed(0, 0));
}

/// Returns the blocks of a part as indices of LocalElimination::remaining().
std::vector<int> CondensedSolve::blocks_of(Part part) const {
  auto blocks = numbers_up_to(elimination_.remaining().size());
  std::erase_if(blocks, [&](int r) {
    return problem_.blocks()[elimination_.remaining()[r]].advected != (part == Part::advected);
  });
  return blocks;
}

LocalElimination::Status CondensedSolve::eliminate() {
  const auto scope = timers_->scope("local elimination");
  auto status = elimination_.update(problem_);
  status.changed = status.changed || !failure_.empty();
  failure_ = status.failure;
  return status;
}

void CondensedSolve::update() {
  const auto status = eliminate();
  if (!failure_.empty() || !(status.changed || outdated_ || problem_.symmetric() != symmetric_)) return;
  if (updated_ && status.by_groups && !outdated_) {
    const auto scope = timers_->scope("update of factors");
    follows_ = updated_->follow();
    if (follows_) return;
  }
  set_up();
}

void CondensedSolve::set_up() {
  const auto scope = timers_->scope("set-up of linear solver");
  symmetric_ = problem_.symmetric();
  outdated_ = follows_ = false;
  failure_ = whole_.setup(symmetric_);
  if (updated_ && failure_.empty()) updated_->restart(*solver().solver);
  ++n_setups_;
}

LinearReport CondensedSolve::solve_by(const Solve& solve, const BlockVector& b, BlockVector& dx) {
  LinearReport report;
  report.reason = failure_;
  if (!failure_.empty()) return report;
  const auto scope = timers_->scope("linear solve");
  BlockVector y;
  report = solve(elimination_.reduce(b), y);
  if (report.converged) elimination_.expand(b, y, dx);
  return report;
}

/// Solves with updated factors or, if they are not accurate, with new ones.
LinearReport CondensedSolve::solve_whole(const BlockVector& c, BlockVector& y, Real tolerance, Real accuracy) {
  if (follows_) {
    y = {rcp(new Vector(c.front()->getMap()))};
    const auto report = updated_->solve(*c.front(), *y.front(), accuracy);
    if (report.converged) return report;
    updated_->give_up();
    set_up();
  }
  return whole_.solve(c, y, tolerance);
}

LinearReport CondensedSolve::solve(const BlockVector& b, BlockVector& dx, Real tolerance, Real accuracy) {
  return solve_by([&](const BlockVector& c, BlockVector& y) { return solve_whole(c, y, tolerance, accuracy); }, b, dx);
}

LinearReport CondensedSolve::solve_part(Part part, const BlockVector& b, BlockVector& dx, Real tolerance) {
  auto& solver = parts_.try_emplace(part, problem_, elimination_, blocks_of(part), options_).first->second;
  eliminate();
  outdated_ = true;
  if (failure_.empty()) {
    const auto scope = timers_->scope("set-up of linear solver");
    failure_ = solver.setup(part == Part::others && problem_.symmetric_blocks());
  }
  return solve_by([&](const BlockVector& c, BlockVector& y) { return solver.solve(c, y, tolerance); }, b, dx);
}

}  // namespace sprekk::solve
