#include "solve/fine_level.hpp"

#include <Ifpack2_Factory.hpp>
#include <TpetraExt_TripleMatrixMultiply.hpp>

#include <cmath>

#include "multigrid/patched_smoother.hpp"
#include "solve/flow_factors.hpp"
#include "solve/minimal_residual.hpp"
#include "solve/reuse.hpp"
#include "solve/split_interpolation.hpp"

namespace sprekk::solve {
namespace {

using fields::Map;
using fields::MultiVector;
using fields::Operator;
using Teuchos::ParameterList;

/// Steps of minimal residual on the coarse space of an advected block. Cycles of multigrid may be inaccurate in a flow.
constexpr int n_coarse_steps = 2;

/// Returns P^T A P. Its graph omits zeros of A. Collective.
RCP<CrsMatrix> coarse_product(const RCP<CrsMatrix>& A, const RCP<const CrsMatrix>& P) {
  const auto product = rcp(new CrsMatrix(P->getDomainMap(), 0));
  Tpetra::TripleMatrixMultiply::MultiplyRAP(*P, true, *A, false, *P, false, *product);
  return product;
}

/// Returns P^T A P, or A itself if P is null. Collective.
RCP<const Matrix> coarse_product(const RCP<const Matrix>& A, const RCP<const CrsMatrix>& P) {
  return P.is_null() ? A : fields::wrapped(coarse_product(A->crs(), P));
}

/// coarse_matrix: P^T A P with a graph valid for any values of A, called once. fill_coarse: sets its present values.
/// Both are collective.
RCP<CrsMatrix> coarse_matrix(const CrsMatrix& A, const RCP<const CrsMatrix>& P) {
  const auto ones = rcp(new CrsMatrix(A, Teuchos::Copy));
  ones->resumeFill();
  ones->setAllToScalar(1);
  ones->fillComplete(A.getDomainMap(), A.getRangeMap());
  return coarse_product(ones, P);
}

void fill_coarse(const RCP<CrsMatrix>& A, const RCP<const CrsMatrix>& P, CrsMatrix& product) {
  const auto present = coarse_product(A, P);
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

/// Returns P with zero rows for prescribed unknowns, which couple to no others in A. Otherwise A would resist means of
/// corners that differ from the prescribed values, by sums that aggregates do not represent. Local.
RCP<const CrsMatrix> without_prescribed(const CrsMatrix& A, const CrsMatrix& P) {
  const auto result = rcp(new CrsMatrix(P, Teuchos::Copy));
  const auto from = A.getLocalMatrixHost(), to = result->getLocalMatrixHost();
  const auto rows = A.getRowMap()->getLocalMap(), columns = A.getColMap()->getLocalMap();
  for (LocalIndex row = 0, n = from.numRows(); row < n; ++row) {
    bool couples = false;
    for (auto k = from.graph.row_map(row); k < from.graph.row_map(row + 1) && !couples; ++k)
      couples = from.values(k) != 0 && columns.getGlobalElement(from.graph.entries(k)) != rows.getGlobalElement(row);
    for (auto k = to.graph.row_map(row); k < to.graph.row_map(row + 1) && !couples; ++k) to.values(k) = 0;
  }
  return result;
}

/// Sets the diagonal of empty rows to 1. Local.
void fill_empty_rows(const CrsMatrix& A) {
  const auto local = A.getLocalMatrixHost();
  const auto rows = A.getRowMap()->getLocalMap(), columns = A.getColMap()->getLocalMap();
  for (LocalIndex row = 0, n = local.numRows(); row < n; ++row)
    for (auto k = local.graph.row_map(row); k < local.graph.row_map(row + 1); ++k)
      if (local.values(k) == 0 && columns.getGlobalElement(local.graph.entries(k)) == rows.getGlobalElement(row))
        local.values(k) = 1;
}

/// Returns |b - A M b| / |b| for a vector b that does not depend on the number of ranks, see Multigrid. Collective.
Real growth(const Operator& A, const Operator& M) {
  const auto& map = A.getDomainMap();
  MultiVector b(map, 1), Mb(map, 1), r(map, 1);
  for (std::size_t i = 0; i < b.getLocalLength(); ++i)
    b.replaceLocalValue(static_cast<LocalIndex>(i), 0,
                        std::cos(static_cast<Real>(map->getGlobalElement(static_cast<LocalIndex>(i)))));
  M.apply(b, Mb);
  A.apply(Mb, r);
  r.update(1, b, -1);
  return r.getVector(0)->norm2() / b.getVector(0)->norm2();
}

}  // namespace

/// Smoother of the fine level. Vectors have one column.
class LevelSmoother {
 public:
  virtual ~LevelSmoother() = default;
  /// Prepares the values of a matrix with the same graph. Collective.
  virtual void update(const WholeMatrix& A) = 0;
  virtual void before(const MultiVector& b, MultiVector& x) const = 0;  ///< x = S b
  virtual void after(const MultiVector& b, MultiVector& x) const = 0;   ///< x += S^T (b - A x)
  /// Reduces the smoothing of a nonsymmetric matrix, if this is possible. Local.
  virtual bool widen() { return false; }
};

namespace {

class GaussSeidelSmoother : public LevelSmoother {
 public:
  void update(const WholeMatrix& A) override {
    using RowMatrix = Tpetra::RowMatrix<Real, LocalIndex, GlobalIndex>;
    A_ = A.crs();
    const RCP<const RowMatrix> rows = A_;
    sweep_ = Ifpack2::Factory::create<RowMatrix>("RELAXATION", rows);
    ParameterList list;
    list.set("relaxation: type", "Symmetric Gauss-Seidel");
    list.set("relaxation: use l1", true);  // converges on any number of ranks
    sweep_->setParameters(list);
    sweep_->initialize();
    sweep_->compute();
  }
  void before(const MultiVector& b, MultiVector& x) const override { sweep_->apply(b, x); }
  void after(const MultiVector& b, MultiVector& x) const override {
    MultiVector r(b, Teuchos::Copy), z(b.getMap(), 1);
    A_->apply(x, r, Teuchos::NO_TRANS, -1, 1);
    sweep_->apply(r, z);  // Ifpack2 cannot add to x
    x.update(1, z, 1);
  }

 private:
  RCP<const CrsMatrix> A_;
  RCP<Ifpack2::Preconditioner<Real, LocalIndex, GlobalIndex>> sweep_;
};

class ChebyshevSmoother : public LevelSmoother {
 public:
  ChebyshevSmoother(const WholeMatrix& A, const multigrid::RowSets& patches, int degree)
      : degree_(degree), smoother_(A.matrix(), patches) {}
  void update(const WholeMatrix& A) override { smoother_.update(A.matrix(), degree_); }
  void before(const MultiVector& b, MultiVector& x) const override { smoother_.before(b, x); }
  void after(const MultiVector& b, MultiVector& x) const override { smoother_.after(b, x); }
  bool widen() override {
    smoother_.widen();
    return true;
  }

 private:
  int degree_;
  multigrid::PatchedSmoother smoother_;
};

/// Incomplete factors in the order of a flow, equal before and after the coarse correction.
class FlowSmoother : public LevelSmoother {
 public:
  void update(const WholeMatrix& A) override {
    A_ = A.matrix();
    factors_ = std::make_unique<FlowFactors>(*A.crs());
  }
  void before(const MultiVector& b, MultiVector& x) const override { factors_->apply(b, x, Teuchos::NO_TRANS, 1, 0); }
  void after(const MultiVector& b, MultiVector& x) const override {
    MultiVector r(b, Teuchos::Copy);
    A_->apply(x, r, Teuchos::NO_TRANS, -1, 1);
    factors_->apply(r, x, Teuchos::NO_TRANS, 1, 1);
  }

 private:
  RCP<const Matrix> A_;
  std::unique_ptr<FlowFactors> factors_;
};

class Cycle : public Operator {
 public:
  Cycle(const LinearSystem& system, std::shared_ptr<const LevelSmoother> smoother, RCP<const CrsMatrix> P,
        RCP<const Operator> coarse)
      : A_(system.joined_operator()),
        smoother_(smoother),
        coarse_(coarse),
        P_(P),
        map_(system.joined->map(0)),
        scale_(system.joined->scale(0)) {}
  RCP<const Map> getDomainMap() const override { return A_->getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return A_->getRangeMap(); }

  void apply(const MultiVector& b, MultiVector& y, Teuchos::ETransp, Real alpha, Real beta) const override {
    MultiVector x(b.getMap(), 1);
    for (std::size_t v = 0; v < b.getNumVectors(); ++v) {
      const auto from = b.getVector(v);
      MultiVector r(*from, Teuchos::Copy);
      smoother_->before(*from, x);
      A_->apply(x, r, Teuchos::NO_TRANS, -1, 1);
      correct(r, x);
      smoother_->after(*from, x);
      y.getVectorNonConst(v)->update(alpha, *x.getVector(0), beta);
    }
  }

 private:
  /// Adds P K P^T r to x in the first block. The system is scale^2 times the matrix whose inverse K approximates.
  void correct(const MultiVector& r, MultiVector& x) const {
    const auto from = r.offsetView(map_, 0);
    const auto to = x.offsetViewNonConst(map_, 0);
    const Real factor = 1 / (scale_ * scale_);
    if (P_.is_null()) {
      coarse_->apply(*from, *to, Teuchos::NO_TRANS, factor, 1);
      return;
    }
    MultiVector b(P_->getDomainMap(), 1), z(P_->getDomainMap(), 1);
    P_->apply(*from, b, Teuchos::TRANS);
    coarse_->apply(b, z);
    P_->apply(z, *to, Teuchos::NO_TRANS, factor, 1);
  }

  RCP<const Operator> A_;
  std::shared_ptr<const LevelSmoother> smoother_;
  RCP<const Operator> coarse_;
  RCP<const CrsMatrix> P_;
  RCP<const Map> map_;
  Real scale_;
};

}  // namespace

bool needs_fine_level(const BlockOptions& options, const std::vector<Block>& blocks) {
  const auto& first = blocks.front();
  return !first.interpolation.is_null() || takes_flow_order(options, first) ||
         (blocks.size() > 1 && takes_muelu(options, first));
}

FineLevel::FineLevel(const BlockOptions& options, const std::vector<Block>& blocks)
    : Preconditioner("fine level", blocks.front().name),
      degree_(options.multigrid.value_or(MultigridOptions()).of_corners(dimension(blocks.front())).degree),
      in_flow_(takes_flow_order(options, blocks.front())),
      is_scalar_(blocks.size() == 1 && blocks.front().n_components == 1),
      coarse_(make_multigrid(options, {blocks.front()})) {
  for (std::size_t b = 1; b < blocks.size(); ++b) enriching_.push_back(blocks[b].name);
}

void FineLevel::describe(ParameterList& blocks) const {
  coarse_->describe(blocks);
  if (in_flow_) blocks.sublist(block()) = ParameterList(block()).set("type", "auto");
  for (const auto& name : enriching_) blocks.sublist(name).set("with", block());
}

std::vector<SolverCost> FineLevel::costs() const {
  auto all = Preconditioner::costs();
  all.push_back(coarse_->costs().front());
  return all;
}

/// Sets the interpolation. That of scalars is split again if weak couplings have changed: conductivities may change by
/// orders of magnitude from iterate to iterate. Returns whether it was split again after the first set-up. Collective.
bool FineLevel::set_interpolation(const DiagonalBlock& first) {
  constexpr GlobalIndex few = 10000;
  const auto& given = first.block.interpolation;
  if (!is_scalar_ || given.is_null()) {
    P_ = interpolation_ = given;
    return false;
  }
  const auto& A = *first.matrix->crs();
  if (interpolation_.is_null()) interpolation_ = given;
  bool splits = false;
  if (!in_flow_) {
    auto weak = weak_couplings(A);
    splits = differ(*A.getComm(), weak_, weak, few);
    if (splits) {
      weak_ = std::move(weak);
      const auto P = without_prescribed(A, *given), split = split_interpolation(A, P);
      interpolation_ = split == P ? given : split;
    }
  }
  P_ = without_prescribed(A, *interpolation_);
  return splits && !product_.is_null();
}

void FineLevel::set_up_coarse(const LinearSystem& system) {
  const auto& first = system.diagonal.front();
  const bool splits = set_interpolation(first);
  if (splits) product_ = Teuchos::null;
  const auto P = P_;
  Bulk bulk;
  if (first.bulk)
    bulk = [&](const auto& work) { first.bulk([&](const RCP<const Matrix>& A) { work(coarse_product(A, P)); }); };
  RCP<const Matrix> matrix = first.matrix;
  if (!P.is_null()) {
    const auto A = first.matrix->crs();
    if (product_.is_null()) product_ = fields::wrapped(coarse_matrix(*A, interpolation_));
    fill_coarse(A, P, *product_->crs());
    if (is_scalar_) fill_empty_rows(*product_->crs());
    matrix = product_;
  }
  auto block = first.block;
  // unknowns at one point, of both sides and the fracture, would be near each other and far from all others
  if (is_scalar_ && coarse_->has_cycles()) block.coordinates = Teuchos::null;
  coarse_->setup(alone({.block = block,
                        .matrix = matrix,
                        .bulk = bulk,
                        .symmetric = system.symmetric,
                        .is_other_graph = splits,
                        .careful = first.careful}));
}

void FineLevel::prepare(const LinearSystem& system, SolverCost&) {
  set_up_coarse(system);
  renew(system);
}

/// For nonsymmetric matrices, the interval of the smoother is widened as long as a cycle increases a residual strongly.
bool FineLevel::renew(const LinearSystem& system) {
  constexpr Real max_growth = 5;
  constexpr int max_widenings = 4;
  const auto& first = system.diagonal.front();
  matrix_.update(system);
  if (!smoother_ && in_flow_)
    smoother_ = std::make_shared<FlowSmoother>();
  else if (!smoother_ && is_scalar_)
    smoother_ = std::make_shared<ChebyshevSmoother>(matrix_, first.block.patches, degree_);
  else if (!smoother_)
    smoother_ = std::make_shared<GaussSeidelSmoother>();
  smoother_->update(matrix_);
  RCP<const Operator> coarse = coarse_->inverse();
  if (in_flow_) coarse = minimal_residual(P_.is_null() ? first.matrix : product_, coarse, n_coarse_steps);
  cycle_ = rcp(new Cycle(system, smoother_, P_, coarse));
  const bool tries = first.careful && !first.symmetric && !in_flow_;
  for (int widenings = 0; tries && widenings < max_widenings; ++widenings)
    if (growth(*matrix_.matrix(), *cycle_) <= max_growth || !smoother_->widen()) break;
  return true;
}

}  // namespace sprekk::solve
