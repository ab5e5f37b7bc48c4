#include "solve/fine_level.hpp"

#include <Ifpack2_Factory.hpp>
#include <TpetraExt_TripleMatrixMultiply.hpp>

namespace sprekk::solve {
namespace {

using fields::Map;
using fields::MultiVector;
using fields::Operator;
using Teuchos::ParameterList;

/// Returns P^T A P. Its graph omits zeros of A. Collective.
RCP<CrsMatrix> at_order_one(const RCP<CrsMatrix>& A, const RCP<const CrsMatrix>& P) {
  const auto product = rcp(new CrsMatrix(P->getDomainMap(), 0));
  Tpetra::TripleMatrixMultiply::MultiplyRAP(*P, true, *A, false, *P, false, *product);
  return product;
}

/// Returns P^T A P, or A itself if P is null. Collective.
RCP<const Matrix> at_order_one(const RCP<const Matrix>& A, const RCP<const CrsMatrix>& P) {
  return P.is_null() ? A : fields::wrapped(at_order_one(A->crs(), P));
}

/// order_one_matrix: P^T A P with a graph valid for any values of A, called once. fill_order_one: sets its present
/// values. Both are collective.
RCP<CrsMatrix> order_one_matrix(const CrsMatrix& A, const RCP<const CrsMatrix>& P) {
  const auto ones = rcp(new CrsMatrix(A, Teuchos::Copy));
  ones->resumeFill();
  ones->setAllToScalar(1);
  ones->fillComplete(A.getDomainMap(), A.getRangeMap());
  return at_order_one(ones, P);
}

void fill_order_one(const RCP<CrsMatrix>& A, const RCP<const CrsMatrix>& P, CrsMatrix& product) {
  const auto present = at_order_one(A, P);
  const auto local = present->getLocalMatrixHost();
  const auto &rows = *present->getRowMap(), &columns = *present->getColMap();
  product.resumeFill();
  product.setAllToScalar(0);
  std::vector<GlobalIndex> global;
  for (LocalIndex row = 0, n = local.numRows(); row < n; ++row) {
    global.clear();
    const auto begin = local.graph.row_map(row);
    for (auto k = begin; k < local.graph.row_map(row + 1); ++k)
      global.push_back(columns.getGlobalElement(local.graph.entries(k)));
    if (!global.empty())
      product.sumIntoGlobalValues(rows.getGlobalElement(row), static_cast<LocalIndex>(global.size()),
                                  &local.values(begin), global.data());
  }
  product.fillComplete(product.getDomainMap(), product.getRangeMap());
}

RCP<const Operator> gauss_seidel(const RCP<const CrsMatrix>& A) {
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

}  // namespace

class Cycle : public Operator {
 public:
  Cycle(const LinearSystem& system, RCP<const Operator> smoother, RCP<const Operator> order_one)
      : A_(system.joined_operator()),
        smoother_(smoother),
        order_one_(order_one),
        P_(system.diagonal.front().block.interpolation),
        map_(system.joined->map(0)),
        scale_(system.joined->scale(0)) {}
  RCP<const Map> getDomainMap() const override { return A_->getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return A_->getRangeMap(); }

  void apply(const MultiVector& b, MultiVector& y, Teuchos::ETransp, Real alpha, Real beta) const override {
    MultiVector x(b.getMap(), b.getNumVectors()), z(b.getMap(), b.getNumVectors()), r(b, Teuchos::Copy);
    smoother_->apply(b, x);
    A_->apply(x, r, Teuchos::NO_TRANS, -1, 1);
    correct(r, x);
    Tpetra::deep_copy(r, b);
    A_->apply(x, r, Teuchos::NO_TRANS, -1, 1);
    smoother_->apply(r, z);  // Ifpack2 cannot add to x
    y.update(alpha, x, alpha, z, beta);
  }

 private:
  /// Adds P K P^T r to x in the first block. The system is scale^2 times the matrix whose inverse K approximates.
  void correct(const MultiVector& r, MultiVector& x) const {
    const auto from = r.offsetView(map_, 0);
    const auto to = x.offsetViewNonConst(map_, 0);
    const Real factor = 1 / (scale_ * scale_);
    if (P_.is_null()) {
      order_one_->apply(*from, *to, Teuchos::NO_TRANS, factor, 1);
      return;
    }
    MultiVector b(P_->getDomainMap(), r.getNumVectors()), z(P_->getDomainMap(), r.getNumVectors());
    P_->apply(*from, b, Teuchos::TRANS);
    order_one_->apply(b, z);
    P_->apply(z, *to, Teuchos::NO_TRANS, factor, 1);
  }

  RCP<const Operator> A_;
  RCP<const Operator> smoother_;
  RCP<const Operator> order_one_;
  RCP<const CrsMatrix> P_;
  RCP<const Map> map_;
  Real scale_;
};

bool needs_fine_level(const BlockOptions& options, const std::vector<Block>& blocks) {
  const auto& first = blocks.front();
  return !first.interpolation.is_null() || (blocks.size() > 1 && takes_muelu(options, first));
}

FineLevel::FineLevel(const BlockOptions& options, const std::vector<Block>& blocks)
    : Preconditioner("fine level", blocks.front().name), order_one_(make_multigrid(options, {blocks.front()})) {
  for (std::size_t b = 1; b < blocks.size(); ++b) enriching_.push_back(blocks[b].name);
}

void FineLevel::describe(ParameterList& blocks) const {
  order_one_->describe(blocks);
  for (const auto& name : enriching_) blocks.sublist(name).set("with", block());
}

std::vector<SolverCost> FineLevel::costs() const {
  auto all = Preconditioner::costs();
  all.push_back(order_one_->costs().front());
  return all;
}

void FineLevel::set_up_order_one(const LinearSystem& system) {
  const auto& first = system.diagonal.front();
  const auto& P = first.block.interpolation;
  Bulk bulk;
  if (first.bulk)
    bulk = [&](const auto& work) { first.bulk([&](const RCP<const Matrix>& A) { work(at_order_one(A, P)); }); };
  RCP<const Matrix> matrix = first.matrix;
  if (!P.is_null()) {
    const auto A = first.matrix->crs();
    if (product_.is_null()) product_ = fields::wrapped(order_one_matrix(*A, P));
    fill_order_one(A, P, *product_->crs());
    matrix = product_;
  }
  order_one_->setup(alone(
      {.block = first.block, .matrix = matrix, .bulk = bulk, .symmetric = system.symmetric, .careful = first.careful}));
}

void FineLevel::prepare(const LinearSystem& system, SolverCost&) {
  set_up_order_one(system);
  renew(system);
}

bool FineLevel::renew(const LinearSystem& system) {
  matrix_.update(system);
  cycle_ = rcp(new Cycle(system, gauss_seidel(matrix_.crs()), order_one_->inverse()));
  return true;
}

RCP<const Operator> FineLevel::made() const { return cycle_; }

}  // namespace sprekk::solve
