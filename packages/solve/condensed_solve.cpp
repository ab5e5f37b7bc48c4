#include "solve/condensed_solve.hpp"

#include <cmath>

namespace sprekk::solve {

CondensedSolve::CondensedSolve(BlockProblem& problem, const LinearSolverOptions& options, RCP<base::Timers> timers)
    : problem_(problem),
      timers_(timers),
      elimination_(problem),
      chosen_(make_linear_solver(options, remaining())),
      tolerance_(options.tolerance),
      forcing_(options.forcing && !chosen_.solver->reads_matrix()) {
  std::vector<RCP<const Map>> maps;
  const int n = static_cast<int>(elimination_.remaining().size());
  for (int r = 0; r < n; ++r) {
    maps.push_back(problem_.blocks()[elimination_.remaining()[r]].map);
    for (int s = 0; s < n; ++s) blocks_.push_back(elimination_.condensed(r, s));
  }
  joined_ = std::make_shared<Joined>(maps);
}

std::vector<Block> CondensedSolve::remaining() const {
  std::vector<Block> blocks;
  for (int b : elimination_.remaining()) blocks.push_back(problem_.blocks()[b]);
  return blocks;
}

/// Returns powers of two that scale the entries of all blocks to similar magnitude and preserve symmetry.
std::vector<Real> CondensedSolve::scales() const {
  std::vector<Real> scales;
  for (const auto& block : remaining())
    scales.push_back(std::exp2(std::round(0.5 * std::log2(block.kinematic_scale / block.residual_scale))));
  return scales;
}

RCP<const CrsMatrix> CondensedSolve::joined_matrix() {
  if (!matrix_) matrix_ = std::make_unique<JoinedMatrix>(joined_, blocks_);
  matrix_->update();
  return matrix_->matrix()->crs();
}

LinearSystem CondensedSolve::system() {
  joined_->set_scales(scales());
  LinearSystem system{joined_, blocks_, symmetric_, {}, {}};
  if (chosen_.solver->reads_matrix()) system.matrix = joined_matrix();
  const bool with_bulk = !problem_.local_groups().empty();
  const auto blocks = remaining();
  for (int r = 0; r < static_cast<int>(blocks.size()); ++r) {
    system.diagonal.push_back({blocks[r],
                               elimination_.condensed(r, r),
                               {},
                               problem_.symmetric_blocks(),
                               problem_.schur(elimination_.remaining()[r])});
    // only fields with rigid motions: their aggregates must not cross fractures; other fields couple through eliminated
    // unknowns
    if (with_bulk && blocks[r].near_null_space.n() > 0)
      system.diagonal.back().bulk = [this, r](const auto& work) { elimination_.with_bulk(r, work); };
  }
  return system;
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
    symmetric_ = symmetric;
    failure_ = chosen_.solver->setup(system());
    ++n_setups_;
  }
}

LinearReport CondensedSolve::solve(const BlockVector& b, BlockVector& dx, Real tolerance) {
  LinearReport report;
  report.reason = failure_;
  if (!failure_.empty()) return report;
  const auto scope = timers_->scope("linear solve");
  const auto rhs = joined_->gather(elimination_.reduce(b)), solution = rcp(new Vector(joined_->map()));
  report = chosen_.solver->solve(*rhs, *solution, tolerance);
  if (!report.converged) return report;
  elimination_.expand(b, joined_->scatter(solution), dx);
  return report;
}

}  // namespace sprekk::solve
