#include "solve/thyra_model.hpp"

#include <Thyra_DefaultProductVector.hpp>
#include <Thyra_DefaultProductVectorSpace.hpp>
#include <Thyra_TpetraThyraWrappers.hpp>

namespace sprekk::solve {

using fields::Map;
using fields::Vector;
using Extract = Thyra::TpetraOperatorVectorExtraction<Real, LocalIndex, GlobalIndex>;

BlockVector blocks_of(const Thyra::VectorBase<Real>& v) {
  const auto& product = dynamic_cast<const Thyra::ProductVectorBase<Real>&>(v);
  BlockVector blocks;
  for (int b = 0; b < product.productSpace()->numBlocks(); ++b)
    blocks.push_back(Teuchos::rcp_const_cast<Vector>(Extract::getConstTpetraVector(product.getVectorBlock(b))));
  return blocks;
}

ThyraModel::ThyraModel(BlockProblem& problem) : problem_(problem) {
  Teuchos::Array<RCP<const Space>> spaces;
  for (const auto& block : problem.blocks())
    spaces.push_back(Thyra::tpetraVectorSpace<Real, LocalIndex, GlobalIndex, Map::node_type>(block.map));
  space_ = Thyra::productVectorSpace<Real>(spaces());
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
  return out;
}

void ThyraModel::evalModelImpl(const InArgs& in, const OutArgs& out) const {
  auto f = blocks_of(*out.get_f());
  problem_.residual(blocks_of(*in.get_x()), f);
}

}  // namespace sprekk::solve
