#include "solve/thyra_model.hpp"

#include <Thyra_DefaultProductVector.hpp>
#include <Thyra_DefaultProductVectorSpace.hpp>
#include <Thyra_LinearOpWithSolveFactoryBase.hpp>
#include <Thyra_TpetraThyraWrappers.hpp>

namespace sprekk::solve {
namespace {

using Space = ThyraModel::Space;
using MultiVectorBase = Thyra::MultiVectorBase<Real>;
using ProductVector = Thyra::ProductVectorBase<Real>;
using Extract = Thyra::TpetraOperatorVectorExtraction<Real, LocalIndex, GlobalIndex>;

/// Jacobian evaluated by NOX, for products and solves.
class JacobianOperator : public Thyra::LinearOpWithSolveBase<Real> {
 public:
  JacobianOperator(ForcedSolve& solve, RCP<const Space> space, RCP<ThyraModel::LinearHistory> history)
      : solve_(solve), space_(std::move(space)), history_(std::move(history)) {}

  RCP<const Space> range() const override { return space_; }
  RCP<const Space> domain() const override { return space_; }
  void update() { solve_.update(); }

 private:
  bool opSupportedImpl(Thyra::EOpTransp transpose) const override { return transpose == Thyra::NOTRANS; }
  bool solveSupportsImpl(Thyra::EOpTransp transpose) const override { return transpose == Thyra::NOTRANS; }

  void applyImpl(const Thyra::EOpTransp, const MultiVectorBase& x, const Thyra::Ptr<MultiVectorBase>& y,
                 const Real alpha, const Real beta) const override {
    for (Thyra::Ordinal column = 0; column < x.domain()->dim(); ++column) {
      const auto from = blocks_of(*x.col(column)), to = blocks_of(*y->col(column));
      auto product = fields::create_like(from);
      solve_.apply(from, product);
      for (std::size_t b = 0; b < to.size(); ++b) to[b]->update(alpha, *product[b], beta);
    }
  }

  Thyra::SolveStatus<Real> solveImpl(const Thyra::EOpTransp, const MultiVectorBase& b,
                                     const Thyra::Ptr<MultiVectorBase>& x,
                                     const Thyra::Ptr<const Thyra::SolveCriteria<Real>> criteria) const override {
    Thyra::SolveStatus<Real> status;
    status.solveStatus = Thyra::SOLVE_STATUS_CONVERGED;
    const bool asked = !criteria.is_null() && criteria->requestedTol > 0;
    const Real tolerance = asked ? criteria->requestedTol : solve_.tolerance();
    for (Thyra::Ordinal column = 0; column < b.domain()->dim(); ++column) {
      auto dx = blocks_of(*x->col(column));
      history_->push_back(solve_.solve(blocks_of(*b.col(column)), dx, tolerance));
      status.achievedTol = history_->back().residual;
      if (history_->back().converged) continue;
      Thyra::assign(x->col(column).ptr(), 0.0);
      status.solveStatus = Thyra::SOLVE_STATUS_UNCONVERGED;
    }
    return status;
  }

  ForcedSolve& solve_;
  RCP<const Space> space_;
  RCP<ThyraModel::LinearHistory> history_;
};

/// Factory of JacobianOperators. It updates them after an evaluation of the Jacobian.
class JacobianFactory : public Thyra::LinearOpWithSolveFactoryBase<Real> {
 public:
  explicit JacobianFactory(RCP<Thyra::LinearOpBase<Real>> jacobian) : jacobian_(std::move(jacobian)) {}

  bool isCompatible(const Thyra::LinearOpSourceBase<Real>&) const override { return true; }
  RCP<Thyra::LinearOpWithSolveBase<Real>> createOp() const override {
    return Teuchos::rcp_dynamic_cast<Thyra::LinearOpWithSolveBase<Real>>(jacobian_, true);
  }
  void initializeOp(const RCP<const Thyra::LinearOpSourceBase<Real>>&, Thyra::LinearOpWithSolveBase<Real>* op,
                    const Thyra::ESupportSolveUse) const override {
    dynamic_cast<JacobianOperator&>(*op).update();
  }
  void uninitializeOp(Thyra::LinearOpWithSolveBase<Real>*, RCP<const Thyra::LinearOpSourceBase<Real>>*,
                      RCP<const Thyra::PreconditionerBase<Real>>*, RCP<const Thyra::LinearOpSourceBase<Real>>*,
                      Thyra::ESupportSolveUse*) const override {}

  void setParameterList(const RCP<Teuchos::ParameterList>&) override {}
  RCP<Teuchos::ParameterList> getNonconstParameterList() override { return Teuchos::null; }
  RCP<Teuchos::ParameterList> unsetParameterList() override { return Teuchos::null; }

 private:
  RCP<Thyra::LinearOpBase<Real>> jacobian_;
};

}  // namespace

BlockVector blocks_of(const Thyra::VectorBase<Real>& v) {
  const auto& product = dynamic_cast<const ProductVector&>(v);
  BlockVector blocks;
  for (int b = 0; b < product.productSpace()->numBlocks(); ++b)
    blocks.push_back(Teuchos::rcp_const_cast<Vector>(Extract::getConstTpetraVector(product.getVectorBlock(b))));
  return blocks;
}

ThyraModel::ThyraModel(BlockProblem& problem, CondensedSolve& solve)
    : problem_(problem), solve_(problem, solve), history_(rcp(new LinearHistory)) {
  Teuchos::Array<RCP<const Space>> spaces;
  for (const auto& block : problem.blocks())
    spaces.push_back(Thyra::tpetraVectorSpace<Real, LocalIndex, GlobalIndex, Map::node_type>(block.map));
  space_ = Thyra::productVectorSpace<Real>(spaces());
}

bool ThyraModel::direction(const BlockVector& x, const BlockVector& f, BlockVector& dx) const {
  solve_.jacobian(x);
  solve_.update();
  history_->push_back(solve_.solve(f, dx, solve_.tolerance()));
  for (const auto& block : dx) block->scale(-1);
  return history_->back().converged;
}

RCP<Thyra::VectorBase<Real>> ThyraModel::make_vector(const BlockVector& x) const {
  const auto v = Thyra::createMember(space_);
  auto blocks = blocks_of(*v);
  fields::copy(x, blocks);
  return v;
}

ThyraModel::InArgs ThyraModel::createInArgs() const {
  Thyra::ModelEvaluatorBase::InArgsSetup<Real> in;
  in.setModelEvalDescription("sprekk");
  in.setSupports(Thyra::ModelEvaluatorBase::IN_ARG_x);
  return in;
}

ThyraModel::OutArgs ThyraModel::createOutArgsImpl() const {
  Thyra::ModelEvaluatorBase::OutArgsSetup<Real> out;
  out.setModelEvalDescription("sprekk");
  out.setSupports(Thyra::ModelEvaluatorBase::OUT_ARG_f);
  out.setSupports(Thyra::ModelEvaluatorBase::OUT_ARG_W_op);
  return out;
}

RCP<Thyra::LinearOpBase<Real>> ThyraModel::create_W_op() const {
  return rcp(new JacobianOperator(solve_, space_, history_));
}

RCP<const Thyra::LinearOpWithSolveFactoryBase<Real>> ThyraModel::get_W_factory() const {
  return rcp(new JacobianFactory(create_W_op()));
}

void ThyraModel::evalModelImpl(const InArgs& in, const OutArgs& out) const {
  const auto x = blocks_of(*in.get_x());
  if (!out.get_f().is_null()) {
    auto f = blocks_of(*out.get_f());
    problem_.residual(x, f);
  }
  if (!out.get_W_op().is_null()) solve_.jacobian(x);
}

}  // namespace sprekk::solve
