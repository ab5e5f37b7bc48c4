#include "solve/condensed_solve.hpp"

#include <cmath>

namespace sprekk::solve {

CondensedSolve::CondensedSolve(BlockProblem& problem, const LinearSolverOptions& options, RCP<base::Timers> timers)
    : problem_(problem),
      timers_(timers),
      elimination_(problem),
      merged_(merge()),
      chosen_(make_linear_solver(options, remaining())),
      tolerance_(options.tolerance) {}

std::vector<Block> CondensedSolve::remaining() const {
  std::vector<Block> blocks;
  for (int b : elimination_.remaining()) blocks.push_back(problem_.blocks()[b]);
  return blocks;
}

Merged CondensedSolve::merge() const {
  std::vector<RCP<const Map>> maps;
  std::vector<RCP<const CrsMatrix>> blocks;
  const int n = static_cast<int>(elimination_.remaining().size());
  for (int r = 0; r < n; ++r) {
    maps.push_back(problem_.blocks()[elimination_.remaining()[r]].map);
    for (int s = 0; s < n; ++s) blocks.push_back(elimination_.condensed(r, s));
  }
  return Merged(maps, blocks);
}

/// Powers of two that bring the entries of all blocks to about the same size and keep symmetry.
std::vector<Real> CondensedSolve::scales() const {
  std::vector<Real> scales;
  for (const auto& block : remaining())
    scales.push_back(std::exp2(std::round(0.5 * std::log2(block.kinematic_scale / block.residual_scale))));
  return scales;
}

LinearSystem CondensedSolve::system() const {
  const bool with_bulk = chosen_.solver->reads_bulk() && !problem_.local_groups().empty();
  LinearSystem system{merged_.matrix(), symmetric_, {}};
  const auto blocks = remaining();
  for (int r = 0; r < static_cast<int>(blocks.size()); ++r) {
    const bool aggregates = with_bulk && !blocks[r].coordinates.is_null();
    system.diagonal.push_back(
        {blocks[r], elimination_.condensed(r, r), aggregates ? elimination_.bulk(r) : Teuchos::null, merged_.scale(r)});
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
    merged_.update(scales());
    failure_ = chosen_.solver->setup(system());
    ++n_setups_;
  }
}

LinearReport CondensedSolve::solve(const BlockVector& b, BlockVector& dx, Real tolerance) {
  LinearReport report;
  report.reason = failure_;
  if (!failure_.empty()) return report;
  const auto scope = timers_->scope("linear solve");
  const auto c = elimination_.reduce(b);
  auto y = fields::create_like(c);
  const auto rhs = merged_.gather(c), solution = merged_.gather(y);
  report = chosen_.solver->solve(*rhs, *solution, tolerance);
  if (!report.converged) return report;
  merged_.scatter(*solution, y);
  elimination_.expand(b, y, dx);
  return report;
}

}  // namespace sprekk::solve
