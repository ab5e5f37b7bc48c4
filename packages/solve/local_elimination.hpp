// Eliminates local groups entity by entity and prescribed unknowns one by one, exactly; what remains goes to a solver.
#pragma once

#include <cstdint>
#include <functional>

#include "solve/elimination_plan.hpp"
#include "solve/small_lu.hpp"

namespace sprekk::solve {

/// For A dx = b with A = problem.matrix(), where the rows of constrained unknowns read dx_i = b_i. With z the unknowns
/// of the local groups, D the constrained ones and a, b the remaining blocks:
///     J_ab = A_ab - A_az A_zz^-1 A_zb, rows and columns of D zero but for a positive diagonal
///     c_a  = s_a - A_az A_zz^-1 s_z, 0 in D, with s = b - A (0, b_D)
///     dx_b = (0, b_D) + J^-1 c,  dx_z = A_zz^-1 (b_z - A_zb dx_b)
/// Blocks and their graphs must stay as they are at construction; so must the local groups. All members are collective
/// unless they return stored data.
class LocalElimination {
 public:
  struct Status {
    bool changed;         ///< the values of some J_ab differ from those after the update before
    std::string failure;  ///< empty, or which entity of which group is singular; J is then not usable
  };

  /// J takes the place of blocks that the problem shares: see BlockProblem::share().
  explicit LocalElimination(BlockProblem& problem);

  /// Forms J from the present values of problem.matrix(). The same answer on every rank.
  Status update(BlockProblem& problem);

  /// The blocks that remain, as indices into problem.blocks(). [r]
  const std::vector<int>& remaining() const { return plan_.remaining; }
  /// J between the r-th and the s-th remaining block; null where they do not couple. The object stays the same for
  /// good.
  RCP<const Matrix> condensed(int r, int s) const;
  /// Calls work(A) while J of the r-th remaining block is A_aa, constrained like J, without what the local groups add.
  void with_bulk(int r, const std::function<void(const RCP<const Matrix>& A)>& work) const;

  /// c [r] for b [block].
  BlockVector reduce(const BlockVector& b) const;
  /// Fills dx [block] from b [block] and y = J^-1 c [r].
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
  const fields::BlockMatrix* matrix_;  ///< the problem's own
  EliminationPlan plan_;
  std::vector<RCP<Vector>> constrained_;  ///< [r] owned unknown: 1 where prescribed
  std::uint64_t checksum_ = 0;
  bool fresh_ = true;
};

}  // namespace sprekk::solve
