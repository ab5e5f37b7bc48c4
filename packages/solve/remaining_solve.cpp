#include "solve/remaining_solve.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sprekk::solve {
namespace {

/// Removes options of absent blocks.
LinearSolverOptions restricted(LinearSolverOptions options, const std::vector<Block>& blocks) {
  const auto is_absent = [&](const std::string& name) {
    return std::none_of(blocks.begin(), blocks.end(), [&](const Block& block) { return block.name == name; });
  };
  auto& of_blocks = options.preconditioner.blocks;
  std::erase_if(of_blocks, [&](const auto& named) { return is_absent(named.first); });
  for (auto& [name, of_block] : of_blocks)
    if (is_absent(of_block.with)) of_block.with.clear();
  std::erase_if(options.preconditioner.sweep.order, is_absent);
  return options;
}

}  // namespace

RemainingSolve::RemainingSolve(BlockProblem& problem, const LocalElimination& elimination, std::vector<int> chosen,
                               const LinearSolverOptions& options)
    : problem_(problem),
      elimination_(elimination),
      chosen_(std::move(chosen)),
      chosen_solver_(make_linear_solver(
          chosen_.size() == elimination.remaining().size() ? options : restricted(options, blocks()), blocks())) {
  std::vector<RCP<const Map>> maps;
  for (const auto& block : blocks()) maps.push_back(block.map);
  for (const int r : chosen_)
    for (const int s : chosen_) blocks_.push_back(elimination_.condensed(r, s));
  joined_ = std::make_shared<Joined>(maps);
}

std::vector<Block> RemainingSolve::blocks() const {
  std::vector<Block> blocks;
  for (const int r : chosen_) blocks.push_back(problem_.blocks()[elimination_.remaining()[r]]);
  return blocks;
}

/// Returns powers of two that scale the entries of all blocks to similar magnitude and preserve symmetry.
std::vector<Real> RemainingSolve::scales() const {
  std::vector<Real> scales;
  for (const auto& block : blocks())
    scales.push_back(std::exp2(std::round(0.5 * std::log2(block.kinematic_scale / block.residual_scale))));
  return scales;
}

LinearSystem RemainingSolve::system(bool symmetric) {
  joined_->set_scales(scales());
  LinearSystem system{joined_, blocks_, symmetric, {}, {}};
  if (solver().solver->reads_matrix()) {
    if (!matrix_) matrix_ = std::make_unique<JoinedMatrix>(joined_, blocks_);
    matrix_->update();
    system.matrix = matrix_->matrix()->crs();
  }
  const bool with_bulk = !problem_.local_groups().empty();
  const auto blocks = this->blocks();
  for (std::size_t k = 0; k < chosen_.size(); ++k) {
    const int r = chosen_[k];
    system.diagonal.push_back({blocks[k],
                               elimination_.condensed(r, r),
                               {},
                               problem_.symmetric_blocks(),
                               problem_.schur(elimination_.remaining()[r])});
    // only fields with rigid motions: their aggregates must not cross fractures; other fields couple through eliminated
    // unknowns
    if (with_bulk && blocks[k].near_null_space.n() > 0)
      system.diagonal.back().bulk = [this, r](const auto& work) { elimination_.with_bulk(r, work); };
  }
  return system;
}

std::string RemainingSolve::setup(bool symmetric) { return solver().solver->setup(system(symmetric)); }

LinearReport RemainingSolve::solve(const BlockVector& c, BlockVector& y, Real tolerance) {
  BlockVector of_chosen;
  for (const int r : chosen_) of_chosen.push_back(c[r]);
  const auto rhs = joined_->gather(of_chosen), solution = rcp(new Vector(joined_->map()));
  const auto report = solver().solver->solve(*rhs, *solution, tolerance);
  y.clear();
  if (!report.converged) return report;
  const auto found = joined_->scatter(solution);
  if (chosen_.size() < c.size()) y = fields::create_like(c);
  y.resize(c.size());
  for (std::size_t k = 0; k < chosen_.size(); ++k) y[chosen_[k]] = found[k];
  return report;
}

}  // namespace sprekk::solve
