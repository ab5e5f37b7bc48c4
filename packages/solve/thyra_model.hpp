// Adapter of a BlockProblem for Thyra.
#pragma once

#include <Thyra_StateFuncModelEvaluatorBase.hpp>

#include "solve/forced_solve.hpp"

namespace sprekk::solve {

/// Returns the Tpetra vectors of a product vector without copying. Do not write to the result if the argument is const.
BlockVector blocks_of(const Thyra::VectorBase<Real>& v);

/// Model f(x) = problem.residual and W = df/dx, with product vectors of all blocks. `solve` solves with W. The product
/// with W is that with problem.matrix(), except for rows of constrained unknowns, which are identity. Refers to both
/// arguments.
class ThyraModel : public Thyra::StateFuncModelEvaluatorBase<Real> {
 public:
  using Space = Thyra::VectorSpaceBase<Real>;
  using InArgs = Thyra::ModelEvaluatorBase::InArgs<Real>;
  using OutArgs = Thyra::ModelEvaluatorBase::OutArgs<Real>;

  ThyraModel(BlockProblem& problem, CondensedSolve& solve);

  /// Starts Newton's method, which ends when no measure exceeds the tolerance.
  void start(Real tolerance) {
    history_->clear();
    solve_.start(tolerance);
  }
  /// Reports of the linear solves since start().
  using LinearHistory = std::vector<LinearReport>;
  const LinearHistory& linear_history() const { return *history_; }

  /// Computes dx = -W^-1 f with the Jacobian at x, which is evaluated again. Returns false if the solve failed; the
  /// history contains the reason.
  bool direction(const BlockVector& x, const BlockVector& f, BlockVector& dx) const;

  /// Returns a product vector that is a copy of x. [block]
  RCP<Thyra::VectorBase<Real>> make_vector(const BlockVector& x) const;

  RCP<const Space> get_x_space() const override { return space_; }
  RCP<const Space> get_f_space() const override { return space_; }
  InArgs createInArgs() const override;
  InArgs getNominalValues() const override { return createInArgs(); }
  RCP<Thyra::LinearOpBase<Real>> create_W_op() const override;
  RCP<const Thyra::LinearOpWithSolveFactoryBase<Real>> get_W_factory() const override;

 private:
  OutArgs createOutArgsImpl() const override;
  void evalModelImpl(const InArgs& in, const OutArgs& out) const override;

  BlockProblem& problem_;
  mutable ForcedSolve solve_;  // evaluations of the model are const
  RCP<const Space> space_;
  RCP<LinearHistory> history_;
};

}  // namespace sprekk::solve
