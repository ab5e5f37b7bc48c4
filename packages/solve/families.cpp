#include "solve/families.hpp"

#include <fmt/format.h>

#include <Tpetra_CrsMatrix.hpp>

#include <algorithm>

#include "solve/fine_level.hpp"

namespace sprekk::solve {
namespace {

using fields::Map;
using fields::MultiVector;
using fields::Operator;
using Teuchos::ParameterList;
using Policy = Kokkos::RangePolicy<Execution>;

class OneBlock : public Family {
 public:
  OneBlock(const ParameterList& muelu, const Block& block) : solver_(make_block_solver(muelu, block)) {}
  void setup(const LinearSystem& family) override { solver_->setup(family.diagonal.front()); }
  RCP<const Operator> inverse() const override { return solver_->inverse(); }
  std::vector<SolverCost> costs() const override { return solver_->costs(); }

 private:
  RCP<BlockSolver> solver_;
};

class Enriched : public Family {
 public:
  Enriched(const ParameterList& muelu, const std::vector<Block>& blocks)
      : level_(muelu, blocks), cost_(std::make_shared<SolverCost>()) {
    cost_->name = fmt::format("fine level of '{}'", blocks.front().name);
  }
  void setup(const LinearSystem& family) override {
    timed(cost_->setup_seconds, [&] { level_.setup(family); });
    ++cost_->n_setups;
  }
  RCP<const Operator> inverse() const override { return rcp(new CountedOperator(level_.inverse(), cost_)); }
  std::vector<SolverCost> costs() const override { return {*cost_, level_.order_one_cost()}; }

 private:
  FineLevel level_;
  std::shared_ptr<SolverCost> cost_;
};

/// The inverse of a pair of blocks, F then K, see Family. Multigrid of S makes two cycles: where fractures let through
/// so much more than rock one is not exact enough, and iterations of the whole system cost more than a second cycle.
class PairInverse : public Operator {
 public:
  PairInverse(const LinearSystem& pair, RCP<const Vector> D_inverse, RCP<const Operator> S, RCP<const Operator> cycle)
      : joined_(pair.joined), FK_(pair.blocks[1]), KF_(pair.blocks[2]), D_inverse_(D_inverse), S_(S), cycle_(cycle) {}
  RCP<const Map> getDomainMap() const override { return joined_->map(); }
  RCP<const Map> getRangeMap() const override { return joined_->map(); }

  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, Real alpha, Real beta) const override {
    MultiVector rest_K(joined_->map(1), x.getNumVectors()), rest_F(*part(x, 0), Teuchos::Copy),
        y_F(joined_->map(0), x.getNumVectors());
    const Real scale_F = joined_->scale(0), scale_K = joined_->scale(1);
    rest_K.elementWiseMultiply(1 / scale_K, *D_inverse_, *part(x, 1), 0);
    FK_->apply(rest_K, rest_F, Teuchos::NO_TRANS, -1, 1 / scale_F);
    cycle_->apply(rest_F, y_F);
    S_->apply(y_F, rest_F, Teuchos::NO_TRANS, -1, 1);
    cycle_->apply(rest_F, y_F, Teuchos::NO_TRANS, 1, 1);
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
};

class Pair : public Family {
 public:
  Pair(const ParameterList& muelu, const std::vector<Block>& blocks)
      : block_(blocks.front()), solver_(make_multigrid(muelu, blocks.front())) {}

  void setup(const LinearSystem& family) override {
    const auto D_inverse = rcp(new Vector(family.joined->map(1)));
    family.diagonal[1].matrix->copy_diagonal(*D_inverse);
    if (const auto& schur = family.diagonal[1].schur; !schur.is_null()) D_inverse->update(1, *schur, 1);
    D_inverse->reciprocal(*D_inverse);
    fill_S(family, *D_inverse);
    solver_->setup({.block = block_,
                    .matrix = rows_of_S_,
                    .bulk = {},
                    .symmetric = false});  // what was eliminated locally need not leave it symmetric
    inverse_ = rcp(new PairInverse(family, D_inverse, S_, solver_->inverse()));
  }
  RCP<const Operator> inverse() const override { return inverse_; }
  std::vector<SolverCost> costs() const override { return solver_->costs(); }

 private:
  /// On the graph of A_FF; the little of the product that it has no place for is left out.
  void fill_S(const LinearSystem& family, const Vector& D_inverse) {
    const auto& FF = *family.diagonal[0].matrix->crs();
    if (S_.is_null()) {
      S_ = rcp(new CrsMatrix(FF.getCrsGraph()));
      S_->fillComplete(FF.getDomainMap(), FF.getRangeMap());
      rows_of_S_ = fields::wrapped(S_);
    }
    S_->resumeFill();
    Kokkos::deep_copy(S_->getLocalMatrixDevice().values, FF.getLocalMatrixDevice().values);
    if (const auto& schur = family.diagonal[0].schur; !schur.is_null()) add_diagonal(*schur);
    const auto &FK = *family.blocks[1]->crs(), &KF = *family.blocks[2]->crs();
    subtract_product(FK, *with_ghost_rows(FK, KF, D_inverse));
    S_->fillComplete(FF.getDomainMap(), FF.getRangeMap());
  }

  void add_diagonal(const Vector& added) {
    const auto local = S_->getLocalMatrixHost();
    const auto rows = S_->getRowMap()->getLocalMap(), columns = S_->getColMap()->getLocalMap();
    const auto values = added.getLocalViewHost(Tpetra::Access::ReadOnly);
    for (LocalIndex row = 0; row < local.numRows(); ++row)
      for (auto k = local.graph.row_map(row); k < local.graph.row_map(row + 1); ++k)
        if (columns.getGlobalElement(local.graph.entries(k)) == rows.getGlobalElement(row))
          local.values(k) += values(row, 0);
  }

  /// D^-1 A_KF with the rows that the columns of A_FK are.
  static RCP<const CrsMatrix> with_ghost_rows(const CrsMatrix& FK, const CrsMatrix& KF, const Vector& D_inverse) {
    const auto scaled = rcp(new CrsMatrix(KF, Teuchos::Copy));
    scaled->leftScale(D_inverse);
    const auto import = FK.getGraph()->getImporter();
    if (import.is_null()) return scaled;
    return Tpetra::importAndFillCompleteCrsMatrix<CrsMatrix>(scaled, *import, KF.getDomainMap(), FK.getColMap());
  }

  void subtract_product(const CrsMatrix& FK, const CrsMatrix& KF) {
    const auto S = S_->getLocalMatrixHost(), left = FK.getLocalMatrixHost(), right = KF.getLocalMatrixHost();
    std::vector<LocalIndex> column;  // [column of KF] that of S, or -1
    for (LocalIndex c = 0, n = base::n_local_elements(*KF.getColMap()); c < n; ++c)
      column.push_back(S_->getColMap()->getLocalElement(KF.getColMap()->getGlobalElement(c)));
    std::vector<std::size_t> place(base::n_local_elements(*S_->getColMap()), 0);  // [column] one past that in the row
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

  Block block_;
  RCP<BlockSolver> solver_;
  RCP<CrsMatrix> S_;
  RCP<const Matrix> rows_of_S_;
  RCP<const Operator> inverse_;
};

class FamilySweep : public Operator {
 public:
  FamilySweep(const LinearSystem& system, const std::vector<std::vector<int>>& families,
              const std::vector<RCP<const Operator>>& inverses)
      : joined_(system.joined), A_(system.joined_operator()), families_(families), inverses_(inverses) {}
  RCP<const Map> getDomainMap() const override { return joined_->map(); }
  RCP<const Map> getRangeMap() const override { return joined_->map(); }

  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, Real alpha, Real beta) const override {
    MultiVector sum(y.getMap(), y.getNumVectors()), rest(x, Teuchos::Copy);
    for (std::size_t f = 0; f < families_.size(); ++f) {
      if (f > 0) {
        A_->apply(sum, rest);
        rest.update(1, x, -1);
      }
      add_correction(families_[f], *inverses_[f], rest, sum);
    }
    y.update(alpha, sum, beta);
  }

 private:
  /// A family of one block has an inverse of the block itself, without its scale.
  void add_correction(const std::vector<int>& family, const Operator& inverse, const MultiVector& rest,
                      MultiVector& sum) const {
    const auto n_vectors = rest.getNumVectors();
    const auto from = [&](int r) { return rest.offsetView(joined_->map(r), joined_->first(r)); };
    const auto to = [&](int r) { return sum.offsetViewNonConst(joined_->map(r), joined_->first(r)); };
    if (family.size() == 1) {
      const int r = family.front();
      inverse.apply(*from(r), *to(r));
      to(r)->scale(1 / (joined_->scale(r) * joined_->scale(r)));
      return;
    }
    MultiVector b(inverse.getDomainMap(), n_vectors), z(inverse.getDomainMap(), n_vectors);
    LocalIndex first = 0;
    for (int r : family) {
      Tpetra::deep_copy(*b.offsetViewNonConst(joined_->map(r), first), *from(r));
      first += static_cast<LocalIndex>(base::n_local_elements(*joined_->map(r)));
    }
    inverse.apply(b, z);
    first = 0;
    for (int r : family) {
      Tpetra::deep_copy(*to(r), *z.offsetView(joined_->map(r), first));
      first += static_cast<LocalIndex>(base::n_local_elements(*joined_->map(r)));
    }
  }

  std::shared_ptr<const Joined> joined_;
  RCP<const Operator> A_;
  std::vector<std::vector<int>> families_;
  std::vector<RCP<const Operator>> inverses_;
};

}  // namespace

namespace {

const std::string& belongs_to(const Block& block) {
  return block.enriches.empty() ? block.condensed_into : block.enriches;
}

std::unique_ptr<Family> make_family(const ParameterList& muelu, const std::vector<Block>& blocks) {
  if (have_fine_level(blocks)) return std::make_unique<Enriched>(muelu, blocks);
  if (blocks.size() == 1) return std::make_unique<OneBlock>(muelu, blocks.front());
  return std::make_unique<Pair>(muelu, blocks);
}

}  // namespace

Families::Families(const ParameterList& muelu, const std::vector<Block>& blocks) {
  for (int first = 0; first < static_cast<int>(blocks.size()); ++first) {
    if (!belongs_to(blocks[first]).empty()) continue;
    std::vector<int> members = {first};
    for (int r = 0; r < static_cast<int>(blocks.size()); ++r)
      if (belongs_to(blocks[r]) == blocks[first].name) members.push_back(r);
    std::vector<Block> own;
    std::vector<RCP<const Map>> maps;
    for (int r : members) {
      own.push_back(blocks[r]);
      maps.push_back(blocks[r].map);
    }
    names_.push_back(blocks[first].name);
    joined_.push_back(std::make_shared<Joined>(maps));
    solvers_.push_back(make_family(muelu, own));
    members_.push_back(members);
  }
}

void Families::setup(int family, const LinearSystem& system) {
  std::vector<Real> scales;
  LinearSystem part{joined_[family], {}, true, {}, {}, system.reproducible};
  for (int r : members_[family]) {
    scales.push_back(system.joined->scale(r));
    part.diagonal.push_back(system.diagonal[r]);
    part.symmetric = part.symmetric && system.diagonal[r].symmetric;
    for (int s : members_[family]) part.blocks.push_back(system.blocks[r * system.joined->n_blocks() + s]);
  }
  joined_[family]->set_scales(scales);
  solvers_[family]->setup(part);
}

RCP<const Operator> Families::sweep(const LinearSystem& system) const {
  std::vector<RCP<const Operator>> inverses;
  for (const auto& solver : solvers_) inverses.push_back(solver->inverse());
  return rcp(new FamilySweep(system, members_, inverses));
}

std::vector<SolverCost> Families::costs() const {
  std::vector<SolverCost> all;
  for (const auto& solver : solvers_)
    for (const auto& cost : solver->costs()) all.push_back(cost);
  return all;
}

}  // namespace sprekk::solve
