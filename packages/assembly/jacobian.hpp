// Jacobian of an equation system, with the constant part of its linear modules.
#pragma once

#include "assembly/structure.hpp"

#include <memory>

namespace sprekk::assembly {

/// Block matrix df/dx. Linear modules are assembled once. Blocks of linear modules alone are not copied.
class Jacobian {
 public:
  /// Creates the matrices. Collective.
  explicit Jacobian(const Structure& structure);

  /// Assembles the linear modules and removes zeros. Called once. Collective.
  void assemble_linear(const State& state);
  /// Assembles all modules at a state. Collective.
  void assemble(const State& state);
  /// Assembles balances without storage. Their diagonals are the conductances of the rows, also for balances without
  /// linear modules.
  void assemble_balances(State state);
  /// Computes r += K x with the linear part K and the ghosts of x.
  void add_linear(const fields::BlockVector& ghosted, fields::BlockVector& r) const;
  /// Stores a constant diagonal block in J, see fields::BlockProblem::share(). Blocks of balances are excluded: they
  /// depend on the step and are measured again in each step.
  std::shared_ptr<fields::SavedRows> share(int block, const RCP<const fields::Matrix>& J);

  const fields::BlockMatrix& matrix() const { return matrix_; }
  const fields::BlockMatrix& linear() const { return linear_; }
  /// Returns whether the diagonal blocks are symmetric after local elimination.
  bool symmetric() const { return symmetric_; }

 private:
  void start();

  const Structure& structure_;
  fields::BlockMatrix linear_;
  fields::BlockMatrix matrix_;  // shares the blocks of linear modules alone
  bool symmetric_ = true;
};

}  // namespace sprekk::assembly
