#include "solve/balance_check.hpp"

#include <cmath>

#include "base/host_table.hpp"
#include "base/over_ranks.hpp"

namespace sprekk::solve {
namespace {

constexpr Real allowed = 1e-7;

/// Calls visit(kind, row) for the rows of balances of this rank, constrained or not.
template <class Visit>
void for_each_row(const fields::BlockProblem& problem, const fields::BlockVector& r, bool constrained,
                  const Visit& visit) {
  for (std::size_t b = 0; b < r.size(); ++b) {
    const auto& block = problem.blocks()[b];
    if (!block.balance) continue;
    const auto rows = r[b]->getLocalViewHost(Tpetra::Access::ReadOnly);
    const auto flags = base::to_host(problem.constrained(b));
    for (std::size_t i = 0; i < rows.extent(0); ++i)
      if ((i < flags.extent(0) && flags(i) != 0) == constrained) visit(block.advected ? 1 : 0, rows(i, 0));
  }
}

}  // namespace

void BalanceCheck::start(const std::vector<fields::Measure>& measures, Real tolerance) {
  for (const auto& block : problem_.blocks())
    for (const auto& measure : measures)
      if (block.balance && block.name == measure.name && !(measure.value <= tolerance))
        changes_[block.advected ? 1 : 0] = true;
}

void BalanceCheck::note(const fields::BlockVector& r) {
  if (!changes_[0] && !changes_[1]) return;
  std::array<Real, 4> sums{};
  for_each_row(problem_, r, false, [&](int kind, Real row) {
    sums[kind] += row;
    sums[2 + kind] += std::abs(row);
  });
  sums = base::sum_over_ranks(*problem_.comm(), sums);
  for (int kind = 0; kind < 2; ++kind) {
    surplus_[kind] = std::abs(sums[kind]);
    if (!started_) flows_[kind] = sums[2 + kind];
  }
  started_ = true;
}

bool BalanceCheck::closes(const fields::Evaluation& x) const {
  if (!changes_[0] && !changes_[1]) return true;
  const auto within = [&](const Sums& flows) {
    const auto is_small = [&](int kind) { return !changes_[kind] || surplus_[kind] <= allowed * flows[kind]; };
    return is_small(0) && is_small(1);
  };
  if (within(flows_)) return true;
  auto r = fields::create_like(x.x());
  problem_.raw_residual(x, r);
  Sums through{};
  for_each_row(problem_, r, true, [&](int kind, Real row) { through[kind] += std::abs(row); });
  through = base::sum_over_ranks(*problem_.comm(), through);
  return within({flows_[0] + through[0], flows_[1] + through[1]});
}

}  // namespace sprekk::solve
