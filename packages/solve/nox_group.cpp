#include "solve/nox_group.hpp"

#include <NOX_Thyra_Vector.H>

#include <Thyra_DefaultProductVector.hpp>
#include <Thyra_TpetraThyraWrappers.hpp>

namespace sprekk::solve {

using fields::Map;
using Extract = Thyra::TpetraOperatorVectorExtraction<Real, LocalIndex, GlobalIndex>;

BlockVector blocks_of(const NOX::Abstract::Vector& v) {
  const auto& product =
      dynamic_cast<const Thyra::ProductVectorBase<Real>&>(dynamic_cast<const NOX::Thyra::Vector&>(v).getThyraVector());
  BlockVector blocks;
  for (int b = 0; b < product.productSpace()->numBlocks(); ++b)
    blocks.push_back(Teuchos::rcp_const_cast<fields::Vector>(Extract::getConstTpetraVector(product.getVectorBlock(b))));
  return blocks;
}

NoxGroup::NoxGroup(BlockProblem& problem, const Evaluation& x) : problem_(problem) {
  Teuchos::Array<RCP<const Thyra::VectorSpaceBase<Real>>> spaces;
  for (const auto& block : problem.blocks())
    spaces.push_back(Thyra::tpetraVectorSpace<Real, LocalIndex, GlobalIndex, Map::node_type>(block.map));
  space_ = Thyra::productVectorSpace<Real>(spaces());
  move_to(x);
}

void NoxGroup::move_to(const Evaluation& x) {
  Teuchos::Array<RCP<Thyra::VectorBase<Real>>> blocks;
  for (std::size_t b = 0; b < x.x().size(); ++b)
    blocks.push_back(Thyra::createVector(x.x()[b], space_->getBlock(static_cast<int>(b))));
  const RCP<Thyra::VectorBase<Real>> product = Thyra::defaultProductVector<Real>(space_, blocks());
  set(rcp(new NOX::Thyra::Vector(product)));
  at_ = x;
}

/// Takes x, which must not change afterwards.
void NoxGroup::set(const RCP<const Vector>& x) {
  x_ = x;
  f_ = Teuchos::null;
  at_ = Evaluation(blocks_of(*x));
}

void NoxGroup::computeX(const NOX::Abstract::Group& from, const Vector& dx, double length) {
  const auto x = dx.clone(NOX::ShapeCopy);
  x->update(1, from.getX(), length, dx);
  set(x);
}

NoxGroup::ReturnType NoxGroup::computeF() {
  if (isF()) return Ok;
  const auto f = x_->clone(NOX::ShapeCopy);
  auto blocks = blocks_of(*f);
  problem_.residual(at_, blocks);
  f_ = f;
  return Ok;
}

}  // namespace sprekk::solve
