// Level above multigrid for blocks with a first coarse space or a smoother of their own: node fields of order 2, fields
// on facets, and quantities that a flow carries.
#pragma once

#include "solve/preconditioner.hpp"

namespace sprekk::solve {

/// Returns whether multigrid needs a finer level for these blocks, of which all except the first enrich the first.
/// Reasons: an interpolation, enriching functions with MueLu, or a flow.
bool needs_fine_level(const BlockOptions& options, const std::vector<Block>& blocks);

class LevelSmoother;

/// Symmetric two-level cycle for a system of such blocks,
///   x = S b,  x += P K P^T (b - A x),  x += S^T (b - A x).
/// K is multigrid on P^T A P. P is the interpolation of the first block, zero in enriching blocks. S is a symmetric
/// Gauss-Seidel sweep. For a single block with one unknown per entity, it is multigrid::PatchedSmoother with the
/// patches of the block. If takes_flow_order(), S and S^T are FlowFactors, K is two steps of MinimalResidual with this
/// multigrid, and the cycle is not symmetric.
class FineLevel : public Preconditioner {
 public:
  FineLevel(const BlockOptions& options, const std::vector<Block>& blocks);

  bool is_symmetric() const override { return !in_flow_; }
  bool can_be_reused() const override { return !in_flow_; }
  bool has_cycles() const override { return !in_flow_ && coarse_->has_cycles(); }
  int coarse_size() const override { return is_scalar_ ? multigrid::Options().coarse_size : coarse_->coarse_size(); }
  std::vector<SolverCost> costs() const override;
  void describe(Teuchos::ParameterList& blocks) const override;

 private:
  void prepare(const LinearSystem& system, SolverCost& cost) override;
  bool renew(const LinearSystem& system) override;
  RCP<const fields::Operator> made() const override { return cycle_; }
  void set_up_coarse(const LinearSystem& system);
  bool set_interpolation(const DiagonalBlock& first);

  std::vector<std::string> enriching_;  // names of the enriching blocks
  int degree_;                          // of Chebyshev's polynomial
  bool in_flow_;                        // advected: incomplete factors in the order of the flow
  bool is_scalar_;                      // a single block with one unknown per entity
  std::unique_ptr<Preconditioner> coarse_;
  std::vector<bool> weak_;              // couplings of scalars when the interpolation was split
  RCP<const CrsMatrix> interpolation_;  // that of the first block, for scalars of split_interpolation(); null: none
  RCP<const CrsMatrix> P_;              // the same with zero rows for prescribed unknowns
  RCP<const Matrix> product_;           // P^T A P
  WholeMatrix matrix_;
  std::shared_ptr<LevelSmoother> smoother_;
  RCP<const fields::Operator> cycle_;
};

}  // namespace sprekk::solve
