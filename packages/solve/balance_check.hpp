// Check of the sums of balance rows at the end of Newton's method.
#pragma once

#include "fields/block_problem.hpp"

#include <vector>

namespace sprekk::solve {

/// Sums of the rows of balances (Block::balance) in one solve. Round-off of large levels may hide the residuals of
/// single rows, but fluxes cancel in the sum of all rows: stored quantity minus inflow. It is compared with the sum of
/// |row| in the first iterate, which is the change of the flows in the step, plus the flows through constrained
/// unknowns. Each quantity (Block::quantity) has a sum of its own.
class BalanceCheck {
 public:
  explicit BalanceCheck(fields::BlockProblem& problem);

  /// Takes the measures of the first iterate. If those of a quantity are at most the tolerance, the solve does not
  /// change its balances, and their sum has no scale: it is not checked. Local.
  void start(const std::vector<fields::Measure>& measures, Real tolerance);

  /// Includes an iterate with the residual r. Collective.
  void note(const fields::BlockVector& r);
  /// Returns the largest sum of the last iterate x over these flows; 0 if no balance changes. If the sum is larger than
  /// `allowed` of the flows in the first iterate, those through constrained unknowns are included. Collective.
  Real imbalance(const fields::Evaluation& x) const;

  static constexpr Real allowed = 1e-8;      ///< imbalance of a solution
  static constexpr Real largest_hidden = 1;  ///< imbalance that round-off of small flows may hide

 private:
  bool any_changes() const;
  template <class Visit>
  void for_each_row(const fields::BlockVector& r, bool constrained, const Visit& visit) const;

  fields::BlockProblem& problem_;
  std::vector<int> quantity_;          // [block] number of its quantity; -1: its rows are no balances
  std::vector<Real> flows_, surplus_;  // [quantity]
  std::vector<char> changes_;          // [quantity]
  bool started_ = false;
};

}  // namespace sprekk::solve
