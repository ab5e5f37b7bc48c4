// Exact elimination of local groups, entity by entity, and of prescribed unknowns. A linear solver treats the rest.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>

#include "solve/elimination_plan.hpp"
#include "solve/group_change.hpp"
#include "solve/small_lu.hpp"

namespace sprekk::solve {

/// Elimination for A dx = b with A = problem.matrix(). Rows of constrained unknowns are dx_i = b_i. The unknowns of the
/// local groups are z, the constrained ones D. The remaining blocks are a and b:
///   J_ab = A_ab - A_az A_zz^-1 A_zb, rows and columns of D zero except for a positive diagonal
///   c_a  = s_a - A_az A_zz^-1 s_z, 0 in D, with s = b - A (0, b_D)
///   dx_b = (0, b_D) + J^-1 c,  dx_z = A_zz^-1 (b_z - A_zb dx_b)
/// Blocks, their graphs and the local groups must not change after construction. All members are collective unless they
/// return stored data.
class LocalElimination {
 public:
  struct Status {
    bool changed;         ///< values of some J_ab differ from those after the previous update
    bool by_groups;       ///< only local groups have changed them
    std::string failure;  ///< empty, or the group and entity that are singular; J is then unusable
  };

  /// Plans the elimination. J stores blocks that the problem shares, see BlockProblem::share(). Throws an Error on all
  /// ranks for invalid groups.
  explicit LocalElimination(BlockProblem& problem);

  /// Forms J from the present values of problem.matrix(). The result is the same on all ranks.
  Status update(BlockProblem& problem);

  /// Returns the remaining blocks as indices into problem.blocks(). [r]
  const std::vector<int>& remaining() const { return plan_.remaining; }
  /// Returns J between the r-th and the s-th remaining block; null if they do not couple. The object remains the same.
  RCP<const Matrix> condensed(int r, int s) const;
  /// Calls work(A) while J of the r-th remaining block is A_aa with the constraints, but without the local groups.
  void with_bulk(int r, const std::function<void(const RCP<const Matrix>& A)>& work) const;

  /// Returns the change of J by its local group, which then follows each update(); null if there are several groups or
  /// remaining blocks, or if A_aa is not constant. Before the first update(). The object belongs to the elimination.
  /// Collective.
  GroupChange* watch_change(const BlockProblem& problem);

  /// Returns c [r] for b [block].
  BlockVector reduce(const BlockVector& b) const;
  /// Computes dx [block] from b [block] and y = J^-1 c [r].
  void expand(const BlockVector& b, const BlockVector& y, BlockVector& dx) const;

 private:
  bool take_constraints(const BlockProblem& problem);
  static void set_scales(const BlockProblem& problem, GroupPlan& group);
  bool factor(GroupPlan& group, std::string& failure) const;
  void condense(GroupPlan& group, int r, int s) const;
  Kokkos::Array<const Real*, max_small_size> values_of_components(const GroupPlan& group, int r) const;
  void apply_inverse(const GroupPlan& group, BlockVector& z) const;
  int n_remaining() const { return static_cast<int>(plan_.remaining.size()); }
  CondensedBlock& block(int r, int s) { return plan_.condensed[r * n_remaining() + s]; }
  const CondensedBlock& block(int r, int s) const { return plan_.condensed[r * n_remaining() + s]; }

  RCP<const Comm> comm_;
  const fields::BlockMatrix* matrix_;  ///< matrix of the problem
  EliminationPlan plan_;
  std::vector<RCP<Vector>> constrained_;  ///< [r] owned unknown: 1 if prescribed
  std::unique_ptr<GroupChange> change_;   ///< null before watch_change()
  bool proximal_ = false;                 ///< the last update had proximal terms
  std::uint64_t checksum_ = 0;
  bool fresh_ = true;
};

}  // namespace sprekk::solve
