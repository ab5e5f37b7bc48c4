#include "solve/fine_level.hpp"

#include <Ifpack2_Factory.hpp>
#include <TpetraExt_TripleMatrixMultiply.hpp>

#include <algorithm>

#include "base/check.hpp"

namespace sprekk::solve {
namespace {

using fields::Map;
using fields::MultiVector;
using fields::Operator;
using Teuchos::ParameterList;

/// P^T A P. Its graph leaves out what is zero in A.
RCP<CrsMatrix> at_order_one(const RCP<CrsMatrix>& A, const RCP<const CrsMatrix>& P) {
  const auto product = rcp(new CrsMatrix(P->getDomainMap(), 0));
  Tpetra::TripleMatrixMultiply::MultiplyRAP(*P, true, *A, false, *P, false, *product);
  return product;
}

/// A itself without P.
RCP<const Matrix> at_order_one(const RCP<const Matrix>& A, const RCP<const CrsMatrix>& P) {
  return P.is_null() ? A : fields::wrapped(at_order_one(A->crs(), P));
}

/// P^T A P with a graph for any values of A, once; and its present values.
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

/// Flags also the unknowns whose rows have a column that is flagged. Collective.
void add_neighbours(const Matrix& A, Vector& flags) {
  Vector of_columns(A.column_map());
  A.spread(flags, of_columns);
  const auto numbers = A.numbers();
  const auto column_flag = of_columns.getLocalViewHost(Tpetra::Access::ReadOnly);
  const auto flag = flags.getLocalViewHost(Tpetra::Access::ReadWrite);
  for (LocalIndex row = 0, n = numbers.n_rows(); row < n; ++row)
    numbers.for_row(row, [&](LocalIndex column, std::size_t) {
      if (column_flag(column, 0) != 0) flag(row, 0) = 1;
    });
}

/// Flags of the unknowns of blocks that enrich the first, and of those that couple to them [r]; in flat cells, where
/// the rows around them are hard for multigrid, of their neighbours, too. Empty, for all, of a block of order 2.
std::vector<RCP<Vector>> smoothed_unknowns(const LinearSystem& system, bool flat) {
  if (!system.diagonal.front().block.interpolation.is_null()) return {};
  const int n = system.joined->n_blocks();
  std::vector<RCP<Vector>> chosen;
  for (int r = 0; r < n; ++r) {
    chosen.push_back(rcp(new Vector(system.joined->map(r))));
    chosen[r]->putScalar(r > 0 ? 1 : 0);
  }
  for (int s = 1; s < n; ++s) {
    if (system.blocks[s].is_null()) continue;  // the first block's rows, the enriching one's columns
    const auto numbers = system.blocks[s]->numbers();
    const auto flags = chosen[0]->getLocalViewHost(Tpetra::Access::ReadWrite);
    for (std::size_t i = 0; i < flags.extent(0); ++i)
      if (numbers.length(static_cast<LocalIndex>(i)) > 0) flags(i, 0) = 1;
  }
  if (flat) add_neighbours(*system.blocks[0], *chosen[0]);
  return chosen;
}

}  // namespace

class Cycle : public Operator {
 public:
  Cycle(const LinearSystem& system, std::shared_ptr<const JoinedRows> rows, RCP<const Operator> smoother, bool exact,
        RCP<const Operator> order_one)
      : A_(system.joined_operator()),
        rows_of_A_(std::move(rows)),
        smoother_(smoother),
        exact_(exact),
        order_one_(order_one),
        P_(system.diagonal.front().block.interpolation),
        map_(system.joined->map(0)),
        scale_(system.joined->scale(0)) {}
  RCP<const Map> getDomainMap() const override { return A_->getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return A_->getRangeMap(); }

  void apply(const MultiVector& b, MultiVector& y, Teuchos::ETransp, Real alpha, Real beta) const override {
    if (alpha == 1 && beta == 0) return cycle(b, y);
    MultiVector x(b.getMap(), b.getNumVectors());
    cycle(b, x);
    y.update(alpha, x, beta);
  }

  /// x <- S b where that is exact, else 0.
  void start(const Vector& b, Vector& x) const {
    x.putScalar(0);
    if (exact_) smooth(b, x);
  }

 private:
  void cycle(const MultiVector& b, MultiVector& x) const {
    x.putScalar(0);
    if (exact_) {
      correct(b, x);
    } else {
      MultiVector r(b, Teuchos::Copy);
      smooth(b, x);
      A_->apply(x, r, Teuchos::NO_TRANS, -1, 1);
      correct(r, x);
    }
    smooth(b, x, true);
  }

  /// x += S (b - A x), of which S reads its rows only; `moved`: x is not zero.
  void smooth(const MultiVector& b, MultiVector& x, bool moved = false) const {
    using Policy = Kokkos::MDRangePolicy<Execution, Kokkos::Rank<2>>;
    const auto rows = rows_of_A_->rows();
    const auto n = static_cast<LocalIndex>(rows.extent(0)), n_vectors = static_cast<LocalIndex>(b.getNumVectors());
    MultiVector r(smoother_->getDomainMap(), n_vectors), z(smoother_->getRangeMap(), n_vectors);
    {
      const auto all = b.getLocalViewDevice(Tpetra::Access::ReadOnly);
      const auto some = r.getLocalViewDevice(Tpetra::Access::OverwriteAll);
      Kokkos::parallel_for(
          "restrict", Policy({0, 0}, {n, n_vectors}),
          KOKKOS_LAMBDA(LocalIndex i, LocalIndex v) { some(i, v) = all(rows(i), v); });
    }
    if (moved) rows_of_A_->subtract_product(x, r);
    smoother_->apply(r, z);
    const auto some = z.getLocalViewDevice(Tpetra::Access::ReadOnly);
    const auto all = x.getLocalViewDevice(Tpetra::Access::ReadWrite);
    Kokkos::parallel_for(
        "add", Policy({0, 0}, {n, n_vectors}),
        KOKKOS_LAMBDA(LocalIndex i, LocalIndex v) { all(rows(i), v) += some(i, v); });
  }

  /// x += P K P^T r in the first block; the system has scale^2 times the matrix that K is about the inverse of.
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
  std::shared_ptr<const JoinedRows> rows_of_A_;  // those of S
  RCP<const Operator> smoother_;
  bool exact_;  // the smoother leaves no residual in its rows
  RCP<const Operator> order_one_;
  RCP<const CrsMatrix> P_;
  RCP<const Map> map_;
  Real scale_;
};

bool have_fine_level(const std::vector<Block>& blocks) {
  const auto& first = blocks.front();
  const bool enriched =
      std::all_of(blocks.begin() + 1, blocks.end(), [&](const Block& block) { return block.enriches == first.name; });
  return !first.coordinates.is_null() && enriched && (blocks.size() > 1 || !first.interpolation.is_null());
}

FineLevel::FineLevel(const BlockOptions& options, const std::vector<Block>& blocks)
    : Preconditioner("fine level", blocks.front().name), order_one_(make_multigrid(options, blocks.front())) {
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
  if (!smoothed_) {
    const auto chosen = smoothed_unknowns(system, order_one_->is_flat());
    smoothed_ = std::make_shared<JoinedMatrix>(system.joined, system.blocks, chosen);
    rows_ = std::make_shared<JoinedRows>(system.joined, system.blocks, smoothed_->rows());
  }
  smoothed_->update();
  const auto& P = system.diagonal.front().block.interpolation;
  RCP<const Operator> smoother;
  if (P.is_null()) {
    const int most_ranks = system.reproducible ? 1 : system.joined->map()->getComm()->getSize();
    if (direct_.is_null())
      direct_ = rcp(new multigrid::DirectInverse(smoothed_->matrix(), "around crack tips", most_ranks));
    direct_->setup(system.symmetric);
    smoother = direct_;
  } else {
    smoother = gauss_seidel(smoothed_->matrix());
  }
  cycle_ = rcp(new Cycle(system, rows_, smoother, P.is_null(), order_one_->inverse()));
  return true;
}

RCP<const Operator> FineLevel::made() const { return cycle_; }

bool FineLevel::start(const Vector& b, Vector& x) const {
  cycle_->start(b, x);
  return true;
}

}  // namespace sprekk::solve
