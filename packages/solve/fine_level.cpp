#include "solve/fine_level.hpp"

#include <Ifpack2_Factory.hpp>
#include <TpetraExt_TripleMatrixMultiply.hpp>

#include <algorithm>

namespace sprekk::solve {
namespace {

using fields::Map;
using fields::MultiVector;
using fields::Operator;
using Teuchos::ParameterList;

/// P^T A P, or A itself without P.
RCP<const CrsMatrix> at_order_one(const RCP<const CrsMatrix>& A, const RCP<const CrsMatrix>& P) {
  if (A.is_null() || P.is_null()) return A;
  const auto product = rcp(new CrsMatrix(P->getDomainMap(), 0));
  Tpetra::TripleMatrixMultiply::MultiplyRAP(*P, true, *A, false, *P, false, *product);
  return product;
}

RCP<const Operator> smoother(const RCP<const CrsMatrix>& A) {
  using RowMatrix = Tpetra::RowMatrix<Real, LocalIndex, GlobalIndex>;
  const auto S = Ifpack2::Factory::create<RowMatrix>("RELAXATION", A);
  ParameterList list;
  list.set("relaxation: type", "Symmetric Gauss-Seidel");
  list.set("relaxation: use l1", true);  // converges on any number of ranks
  S->setParameters(list);
  S->initialize();
  S->compute();
  return S;
}

class Cycle : public Operator {
 public:
  Cycle(const LinearSystem& system, RCP<const Operator> smoother, RCP<const Operator> order_one)
      : A_(system.matrix),
        smoother_(smoother),
        order_one_(order_one),
        P_(system.diagonal.front().block.interpolation),
        map_(system.diagonal.front().block.map),
        scale_(system.diagonal.front().scale) {}
  RCP<const Map> getDomainMap() const override { return A_->getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return A_->getRangeMap(); }

  void apply(const MultiVector& b, MultiVector& y, Teuchos::ETransp, Real alpha, Real beta) const override {
    MultiVector x(b.getMap(), b.getNumVectors()), r(b, Teuchos::Copy), dx(b.getMap(), b.getNumVectors());
    smoother_->apply(b, x);
    residual(b, x, r);
    correct(r, x);
    residual(b, x, r);
    smoother_->apply(r, dx);
    x.update(1, dx, 1);
    y.update(alpha, x, beta);
  }

 private:
  void residual(const MultiVector& b, const MultiVector& x, MultiVector& r) const {
    A_->apply(x, r);
    r.update(1, b, -1);
  }

  /// x += P K P^T r in the first block; the system has scale^2 times the matrix that K is about the inverse of.
  void correct(const MultiVector& r, MultiVector& x) const {
    const auto from = r.offsetView(map_, 0);
    const auto to = x.offsetViewNonConst(map_, 0);
    const Real factor = 1 / (scale_ * scale_);
    if (P_.is_null()) {
      MultiVector z(map_, r.getNumVectors());
      order_one_->apply(*from, z);
      to->update(factor, z, 1);
      return;
    }
    MultiVector b(P_->getDomainMap(), r.getNumVectors()), z(P_->getDomainMap(), r.getNumVectors());
    P_->apply(*from, b, Teuchos::TRANS);
    order_one_->apply(b, z);
    P_->apply(z, *to, Teuchos::NO_TRANS, factor, 1);
  }

  RCP<const CrsMatrix> A_;
  RCP<const Operator> smoother_, order_one_;
  RCP<const CrsMatrix> P_;
  RCP<const Map> map_;
  Real scale_;
};

}  // namespace

bool have_fine_level(const std::vector<Block>& blocks) {
  const auto& first = blocks.front();
  const bool enriched =
      std::all_of(blocks.begin() + 1, blocks.end(), [&](const Block& block) { return block.enriches == first.name; });
  return !first.coordinates.is_null() && enriched && (blocks.size() > 1 || !first.interpolation.is_null());
}

FineLevel::FineLevel(const ParameterList& muelu, const std::vector<Block>& blocks)
    : order_one_(make_multigrid(muelu, blocks.front())) {}

void FineLevel::setup(const LinearSystem& system) {
  const auto& first = system.diagonal.front();
  const auto& P = first.block.interpolation;
  order_one_->setup({first.block, at_order_one(first.matrix, P), at_order_one(first.bulk, P), first.scale});
  cycle_ = rcp(new Cycle(system, smoother(system.matrix), order_one_->inverse()));
}

}  // namespace sprekk::solve
