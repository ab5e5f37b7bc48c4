#include "solve/balance_check.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/host_table.hpp"
#include "base/over_ranks.hpp"

namespace sprekk::solve {

BalanceCheck::BalanceCheck(fields::BlockProblem& problem) : problem_(problem) {
  std::vector<std::string> quantities;
  for (const auto& block : problem.blocks()) {
    const auto found = std::find(quantities.begin(), quantities.end(), block.quantity);
    quantity_.push_back(block.balance ? static_cast<int>(found - quantities.begin()) : -1);
    if (block.balance && found == quantities.end()) quantities.push_back(block.quantity);
  }
  flows_.assign(quantities.size(), 0);
  surplus_ = flows_;
  changes_.assign(quantities.size(), 0);
}

bool BalanceCheck::any_changes() const { return std::count(changes_.begin(), changes_.end(), 1) > 0; }

/// Calls visit(quantity, row) for the rows of balances of this rank, constrained or not.
template <class Visit>
void BalanceCheck::for_each_row(const fields::BlockVector& r, bool constrained, const Visit& visit) const {
  for (std::size_t b = 0; b < r.size(); ++b) {
    if (quantity_[b] < 0) continue;
    const auto rows = r[b]->getLocalViewHost(Tpetra::Access::ReadOnly);
    const auto flags = base::to_host(problem_.constrained(static_cast<int>(b)));
    for (std::size_t i = 0; i < rows.extent(0); ++i)
      if ((i < flags.extent(0) && flags(i) != 0) == constrained) visit(quantity_[b], rows(i, 0));
  }
}

void BalanceCheck::start(const std::vector<fields::Measure>& measures, Real tolerance) {
  for (std::size_t b = 0; b < quantity_.size(); ++b)
    for (const auto& measure : measures)
      if (quantity_[b] >= 0 && problem_.blocks()[b].name == measure.name && !(measure.value <= tolerance))
        changes_[quantity_[b]] = 1;
}

void BalanceCheck::note(const fields::BlockVector& r) {
  if (!any_changes()) return;
  const std::size_t n = flows_.size();
  std::vector<Real> sums(2 * n, 0);
  for_each_row(r, false, [&](int quantity, Real row) {
    sums[quantity] += row;
    sums[n + quantity] += std::abs(row);
  });
  sums = base::sum_over_ranks(*problem_.comm(), sums);
  for (std::size_t k = 0; k < n; ++k) {
    surplus_[k] = std::abs(sums[k]);
    if (!started_) flows_[k] = sums[n + k];
  }
  started_ = true;
}

Real BalanceCheck::imbalance(const fields::Evaluation& x) const {
  if (!any_changes()) return 0;
  const auto over = [&](const std::vector<Real>& flows) {
    Real largest = 0;
    for (std::size_t k = 0; k < flows.size(); ++k)
      if (changes_[k] && surplus_[k] > 0) largest = std::max(largest, surplus_[k] / flows[k]);
    return largest;
  };
  if (const Real found = over(flows_); found <= allowed) return found;
  auto r = fields::create_like(x.x());
  problem_.raw_residual(x, r);
  auto flows = std::vector<Real>(flows_.size(), 0);
  for_each_row(r, true, [&](int quantity, Real row) { flows[quantity] += std::abs(row); });
  flows = base::sum_over_ranks(*problem_.comm(), flows);
  for (std::size_t k = 0; k < flows.size(); ++k) flows[k] += flows_[k];
  return over(flows);
}

}  // namespace sprekk::solve
