// Sweep over groups of blocks with one preconditioner each.
#pragma once

#include "solve/preconditioner.hpp"

namespace sprekk::solve {

/// Block Jacobi, block Gauss-Seidel or symmetric block Gauss-Seidel, see SweepOptions.
class Sweep : public Preconditioner {
 public:
  /// groups: [group][member] block numbers, in the order of the sweep. parts: [group].
  Sweep(const SweepOptions& options, const std::vector<Block>& blocks, const std::vector<std::vector<int>>& groups,
        std::vector<std::unique_ptr<Preconditioner>> parts);

  bool is_symmetric() const override { return false; }
  bool can_be_reused() const override { return false; }
  int coarse_size() const override;  ///< the smallest of the parts that have one
  std::vector<SolverCost> costs() const override;
  void describe(Teuchos::ParameterList& blocks) const override;

 private:
  void prepare(const LinearSystem& system, SolverCost& cost) override;
  RCP<const fields::Operator> made() const override { return inverse_; }
  LinearSystem part(int group, const LinearSystem& system) const;

  std::string type_;
  std::vector<std::vector<int>> groups_;         // [group][member]
  std::vector<std::shared_ptr<Joined>> joined_;  // [group]
  std::vector<std::unique_ptr<Preconditioner>> parts_;
  RCP<const fields::Operator> inverse_;
};

}  // namespace sprekk::solve
