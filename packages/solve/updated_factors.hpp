// Inverse of a matrix that differs from a factorised one by rows of a local group.
#pragma once

#include <vector>

#include "solve/group_change.hpp"
#include "solve/linear_solver.hpp"

namespace sprekk::solve {

/// Solves with J = J_0 - U Q, see GroupChange, and the factors of J_0 (Woodbury's formula):
///   J^-1 = J_0^-1 + J_0^-1 U (I - Q G)^-1 Q J_0^-1,  G = J_0^-1 U
/// G is dense and computed once, when the factorisations saved by it are expected to exceed its cost: after as many
/// factorisations as cost as much. The decision depends on counts of operations only. All members are collective.
class UpdatedFactors {
 public:
  /// `change` belongs to the elimination of `problem`; J is the condensed matrix.
  UpdatedFactors(const BlockProblem& problem, GroupChange& change, RCP<const Matrix> J)
      : comm_(problem.comm()), change_(change), J_(std::move(J)) {}

  /// Starts from new factors of the present J. The solver must outlive the next calls.
  void restart(const LinearSolver& solver);
  /// Follows a change of J by its group. Returns whether solves are possible without new factors.
  bool follow();
  /// Computes x = J^-1 b for the last b that the elimination has reduced, to the relative residual `accuracy`, between
  /// 1e-9 and 1e-4. Each refinement is an iteration. Not converged: new factors are necessary.
  LinearReport solve(const Vector& b, Vector& x, Real accuracy);
  /// Discards G, for example after a solve that has not converged.
  void give_up();

 private:
  bool pays() const;
  void compute_responses();
  bool factor();
  std::vector<Real> solve_rows(std::vector<Real> Qy) const;
  void apply_inverse(const Vector& b, Vector& x) const;
  bool apply_to_rows(const Vector& b, Vector& x, Real accuracy) const;

  RCP<const Comm> comm_;
  GroupChange& change_;
  RCP<const Matrix> J_;
  const LinearSolver* solver_ = nullptr;  // of J_0
  RCP<fields::Import> import_;            // to the columns of Q
  bool active_ = false;
  int n_factorisations_ = 0;  // since G was discarded
  int n_failures_ = 0;
  std::vector<Real> G_;   // [column of Q here, chosen row]
  std::vector<Real> lu_;  // of the transpose of I - Q G, on each rank
  std::vector<int> pivot_;
};

}  // namespace sprekk::solve
