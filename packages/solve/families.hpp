// Approximate inverses of systems of several fields: each family of blocks has its own, and a sweep joins them.
#pragma once

#include "solve/block_solver.hpp"

namespace sprekk::solve {

/// About the inverse of the part of a system that a family makes. A block, and those that enrich it, are left to
/// BlockSolver or FineLevel. Of blocks F and K, K condensed into F and its own matrix about diagonal, K is eliminated:
///   y_F = S^-1 (x_F - A_FK D^-1 x_K),   y_K = D^-1 (x_K - A_KF y_F),   S about A_FF - A_FK D^-1 A_KF by multigrid,
/// D the diagonal of A_KK. To D and A_FF comes what BlockProblem::schur() says of other families.
class Family {
 public:
  virtual ~Family() = default;
  /// Makes ready for these values, whose graphs must stay as they are. Throws where a library does. Collective.
  virtual void setup(const LinearSystem& family) = 0;
  /// Of one block: without the system's scale.
  virtual RCP<const fields::Operator> inverse() const = 0;
  virtual std::vector<SolverCost> costs() const = 0;
};

/// All families of a system, each a block with those that enrich it or are condensed into it, in the order of their
/// first blocks.
class Families {
 public:
  Families(const Teuchos::ParameterList& muelu, const std::vector<Block>& blocks);

  int n() const { return static_cast<int>(members_.size()); }
  const std::string& name(int family) const { return names_[family]; }
  /// Throws where a library does. Collective.
  void setup(int family, const LinearSystem& system);
  /// Once all are set up: one sweep of block Gauss-Seidel over the families, in their order,
  ///   y = sum_f of y_f,   y_f about A_ff^-1 (x - A (y_1 + ... + y_(f-1)))_f.
  RCP<const fields::Operator> sweep(const LinearSystem& system) const;
  std::vector<SolverCost> costs() const;

 private:
  std::vector<std::string> names_;               // [family] of its first block
  std::vector<std::vector<int>> members_;        // [family] blocks
  std::vector<std::shared_ptr<Joined>> joined_;  // [family]
  std::vector<std::unique_ptr<Family>> solvers_;
};

}  // namespace sprekk::solve
