// Adapter of a BlockProblem for Thyra.
#pragma once

#include <Thyra_StateFuncModelEvaluatorBase.hpp>

#include "fields/block_problem.hpp"

namespace sprekk::solve {

using fields::BlockProblem;
using fields::BlockVector;

/// Returns the Tpetra vectors of a product vector without copying. Do not write to the result if the argument is const.
BlockVector blocks_of(const Thyra::VectorBase<Real>& v);

/// Model f(x) = problem.residual(x) with product vectors of all blocks. It has no Jacobian: NewtonStep computes the
/// direction. Refers to the problem.
class ThyraModel : public Thyra::StateFuncModelEvaluatorBase<Real> {
 public:
  using Space = Thyra::VectorSpaceBase<Real>;
  using InArgs = Thyra::ModelEvaluatorBase::InArgs<Real>;
  using OutArgs = Thyra::ModelEvaluatorBase::OutArgs<Real>;

  explicit ThyraModel(BlockProblem& problem);

  /// Returns a product vector that is a copy of x. [block]
  RCP<Thyra::VectorBase<Real>> make_vector(const BlockVector& x) const;

  RCP<const Space> get_x_space() const override { return space_; }
  RCP<const Space> get_f_space() const override { return space_; }
  InArgs createInArgs() const override;
  InArgs getNominalValues() const override { return createInArgs(); }

 private:
  OutArgs createOutArgsImpl() const override;
  void evalModelImpl(const InArgs& in, const OutArgs& out) const override;

  BlockProblem& problem_;
  RCP<const Space> space_;
};

}  // namespace sprekk::solve
