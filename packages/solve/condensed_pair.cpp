#include "solve/condensed_pair.hpp"

#include <Tpetra_CrsMatrix.hpp>

namespace sprekk::solve {
namespace {

using fields::Map;
using fields::MultiVector;
using fields::Operator;

/// Inverse of a pair of blocks, F then K, see CondensedPair; one or two cycles for S^-1.
class PairInverse : public Operator {
 public:
  PairInverse(const LinearSystem& pair, RCP<const Vector> D_inverse, RCP<const Operator> S, RCP<const Operator> cycle,
              int n_cycles)
      : joined_(pair.joined),
        FK_(pair.blocks[1]),
        KF_(pair.blocks[2]),
        D_inverse_(D_inverse),
        S_(S),
        cycle_(cycle),
        n_cycles_(n_cycles) {}
  RCP<const Map> getDomainMap() const override { return joined_->map(); }
  RCP<const Map> getRangeMap() const override { return joined_->map(); }

  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, Real alpha, Real beta) const override {
    MultiVector rest_K(joined_->map(1), x.getNumVectors()), rest_F(*part(x, 0), Teuchos::Copy),
        y_F(joined_->map(0), x.getNumVectors());
    const Real scale_F = joined_->scale(0), scale_K = joined_->scale(1);
    rest_K.elementWiseMultiply(1 / scale_K, *D_inverse_, *part(x, 1), 0);
    FK_->apply(rest_K, rest_F, Teuchos::NO_TRANS, -1, 1 / scale_F);
    cycle_->apply(rest_F, y_F);
    if (n_cycles_ > 1) {
      S_->apply(y_F, rest_F, Teuchos::NO_TRANS, -1, 1);
      cycle_->apply(rest_F, y_F, Teuchos::NO_TRANS, 1, 1);
    }
    MultiVector of_K(*part(x, 1), Teuchos::Copy);
    KF_->apply(y_F, of_K, Teuchos::NO_TRANS, -1, 1 / scale_K);
    y.offsetViewNonConst(joined_->map(0), joined_->first(0))->update(alpha / scale_F, y_F, beta);
    y.offsetViewNonConst(joined_->map(1), joined_->first(1))
        ->elementWiseMultiply(alpha / scale_K, *D_inverse_, of_K, beta);
  }

 private:
  RCP<const MultiVector> part(const MultiVector& x, int r) const {
    return x.offsetView(joined_->map(r), joined_->first(r));
  }

  std::shared_ptr<const Joined> joined_;
  RCP<const Matrix> FK_, KF_;
  RCP<const Vector> D_inverse_;
  RCP<const Operator> S_, cycle_;
  int n_cycles_;
};

/// Returns D^-1 A_KF with a row for each column of A_FK. Collective.
RCP<const CrsMatrix> with_ghost_rows(const CrsMatrix& FK, const CrsMatrix& KF, const Vector& D_inverse) {
  const auto scaled = rcp(new CrsMatrix(KF, Teuchos::Copy));
  scaled->leftScale(D_inverse);
  const auto import = FK.getGraph()->getImporter();
  if (import.is_null()) return scaled;
  return Tpetra::importAndFillCompleteCrsMatrix<CrsMatrix>(scaled, *import, KF.getDomainMap(), FK.getColMap());
}

}  // namespace

CondensedPair::CondensedPair(const BlockOptions& options, const std::vector<Block>& pair)
    : Preconditioner("condensation", pair[0].name),
      first_(pair[0]),
      second_(pair[1].name),
      n_cycles_(options.type == "direct" || takes_flow_order(options, pair[0]) ? 1 : 2),
      multigrid_(make_cycle(options, {pair[0]})) {}

void CondensedPair::describe(Teuchos::ParameterList& blocks) const {
  multigrid_->describe(blocks);
  blocks.sublist(second_).set("with", block());
}

void CondensedPair::prepare(const LinearSystem& pair, SolverCost&) {
  const auto D_inverse = rcp(new Vector(pair.joined->map(1)));
  pair.diagonal[1].matrix->copy_diagonal(*D_inverse);
  if (const auto& schur = pair.diagonal[1].schur; !schur.is_null()) D_inverse->update(1, *schur, 1);
  D_inverse->reciprocal(*D_inverse);
  fill_S(pair, *D_inverse);
  // local elimination may make it nonsymmetric
  multigrid_->setup(alone({.block = first_, .matrix = rows_of_S_, .bulk = {}, .symmetric = false}));
  inverse_ = rcp(new PairInverse(pair, D_inverse, S_, multigrid_->inverse(), n_cycles_));
}

/// Fills S on the graph of A_FF. Small entries of the product outside this graph are omitted.
void CondensedPair::fill_S(const LinearSystem& pair, const Vector& D_inverse) {
  const auto& FF = *pair.diagonal[0].matrix->crs();
  if (S_.is_null()) {
    S_ = rcp(new CrsMatrix(FF.getCrsGraph()));
    S_->fillComplete(FF.getDomainMap(), FF.getRangeMap());
    rows_of_S_ = fields::wrapped(S_);
  }
  S_->resumeFill();
  Kokkos::deep_copy(S_->getLocalMatrixDevice().values, FF.getLocalMatrixDevice().values);
  if (const auto& schur = pair.diagonal[0].schur; !schur.is_null()) add_to_diagonal(*S_, *schur);
  const auto &FK = *pair.blocks[1]->crs(), &KF = *pair.blocks[2]->crs();
  subtract_product(FK, *with_ghost_rows(FK, KF, D_inverse));
  S_->fillComplete(FF.getDomainMap(), FF.getRangeMap());
}

void CondensedPair::subtract_product(const CrsMatrix& FK, const CrsMatrix& KF) {
  const auto S = S_->getLocalMatrixHost(), left = FK.getLocalMatrixHost(), right = KF.getLocalMatrixHost();
  std::vector<LocalIndex> column;  // [column of KF] column of S, or -1
  for (LocalIndex c = 0, n = base::n_local_elements(*KF.getColMap()); c < n; ++c)
    column.push_back(S_->getColMap()->getLocalElement(KF.getColMap()->getGlobalElement(c)));
  std::vector<std::size_t> place(base::n_local_elements(*S_->getColMap()), 0);  // [column] position in the row plus 1
  for (LocalIndex row = 0; row < S.numRows(); ++row) {
    const auto begin = S.graph.row_map(row), end = S.graph.row_map(row + 1);
    for (auto k = begin; k < end; ++k) place[S.graph.entries(k)] = k + 1;
    for (auto k = left.graph.row_map(row); k < left.graph.row_map(row + 1); ++k) {
      const LocalIndex cell = left.graph.entries(k);
      for (auto l = right.graph.row_map(cell); l < right.graph.row_map(cell + 1); ++l) {
        const LocalIndex to = column[right.graph.entries(l)];
        if (to >= 0 && place[to] > 0) S.values(place[to] - 1) -= left.values(k) * right.values(l);
      }
    }
    for (auto k = begin; k < end; ++k) place[S.graph.entries(k)] = 0;
  }
}

}  // namespace sprekk::solve
