#include "solve/condensed_solve.hpp"

#include "base/check.hpp"

namespace sprekk::solve {

CondensedSolve::CondensedSolve(BlockProblem& problem, const LinearSolverOptions& options, RCP<base::Timers> timers)
    : problem_(problem), timers_(timers), elimination_(problem), tolerance_(options.tolerance) {
  SPREKK_CHECK(elimination_.remaining().size() == 1,
               "linear solve: {} blocks remain after the local groups, but exactly one can be solved for",
               elimination_.remaining().size());
  chosen_ = make_linear_solver(options, remaining());
}

void CondensedSolve::update() {
  const auto status = [&] {
    const auto scope = timers_->scope("local elimination");
    return elimination_.update(problem_);
  }();
  const bool symmetric = problem_.symmetric();
  if (!status.failure.empty()) {
    failure_ = status.failure;
  } else if (status.changed || symmetric != symmetric_ || !failure_.empty()) {
    const auto scope = timers_->scope("set-up of linear solver");
    const bool with_bulk = chosen_.solver->reads_bulk() && !problem_.local_groups().empty();
    failure_ = chosen_.solver->setup(elimination_.condensed(0, 0), remaining(), symmetric,
                                     with_bulk ? elimination_.bulk(0) : Teuchos::null);
    symmetric_ = symmetric;
    ++n_setups_;
  }
}

LinearReport CondensedSolve::solve(const BlockVector& b, BlockVector& dx, Real tolerance) {
  LinearReport report;
  report.reason = failure_;
  if (!failure_.empty()) return report;
  const auto scope = timers_->scope("linear solve");
  const auto c = elimination_.reduce(b);
  const auto y = fields::create_like(c);
  report = chosen_.solver->solve(*c[0], *y[0], tolerance);
  if (report.converged) elimination_.expand(b, y, dx);
  return report;
}

}  // namespace sprekk::solve
