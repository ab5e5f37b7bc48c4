#include "solve/direct_inverse.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Teuchos_LAPACK.hpp>

#include <algorithm>
#include <cmath>

#include "base/check.hpp"
#include "solve/columns.hpp"

namespace sprekk::solve {
namespace {

using fields::Map;

/// The matrix with rows and columns numbered from 0 without gaps; it shares the values. Collective.
RCP<CrsMatrix> renumbered(const RCP<const CrsMatrix>& A) {
  const auto invalid = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  const auto &rows = A->getRowMap(), &columns = A->getColMap();
  const auto map = rcp(new Map(invalid, rows->getNodeNumElements(), 0, rows->getComm()));
  Tpetra::Vector<GlobalIndex, LocalIndex, GlobalIndex> of_rows(rows), of_columns(columns);
  for (LocalIndex i = 0, n = rows->getNodeNumElements(); i < n; ++i)
    of_rows.replaceLocalValue(i, map->getGlobalElement(i));
  if (A->getGraph()->getImporter().is_null())
    Tpetra::deep_copy(of_columns, of_rows);
  else
    of_columns.doImport(of_rows, *A->getGraph()->getImporter(), Tpetra::INSERT);
  const auto numbers = of_columns.getData();
  const auto column_map = rcp(new Map(invalid, numbers(), 0, rows->getComm()));
  return rcp(new CrsMatrix(A->getLocalMatrixDevice(), map, column_map, map, map));
}

}  // namespace

DirectInverse::DirectInverse(const RCP<const CrsMatrix>& A, const std::string& name)
    : name_(name), map_(A->getRowMap()), A_(renumbered(A)), from_(A_->getRowMap()), to_(A_->getRowMap()) {
  if (A_->getGlobalNumRows() > most_dense)
    solver_ = make_direct_solver(Teuchos::ParameterList().set("ICNTL(8)", 1, "scaling: by the diagonal"), true);
}

void DirectInverse::setup(bool symmetric, Real change) {
  if (!solver_) return factor_dense();
  if (change > 0 && symmetric == symmetric_ && !has_changed(change)) return;
  symmetric_ = symmetric;
  factored_ = View<Real*>();
  const auto joined = std::make_shared<Joined>(std::vector<RCP<const Map>>{A_->getRowMap()});
  const auto failure = solver_->setup({joined, {A_}, symmetric, {}, A_});
  SPREKK_CHECK(failure.empty(), "{}: {}", name_, failure);
  if (change == 0) return;
  const auto values = A_->getLocalMatrixDevice().values;
  factored_ = View<Real*>(Kokkos::view_alloc("factored", Kokkos::WithoutInitializing), values.extent(0));
  Kokkos::deep_copy(factored_, values);
}

/// Whether any entry has by more than so much of the geometric mean of its row's and column's diagonals, since they
/// were factored.
bool DirectInverse::has_changed(Real much) const {
  const auto& comm = *A_->getComm();
  int here = factored_.extent(0) != A_->getNodeNumEntries(), anywhere = 0;
  Teuchos::reduceAll(comm, Teuchos::REDUCE_MAX, 1, &here, &anywhere);
  if (anywhere) return true;
  Vector diagonal(A_->getRowMap()), of_columns(A_->getColMap());
  A_->getLocalDiagCopy(diagonal);
  spread(diagonal, *A_, of_columns);
  const auto local = A_->getLocalMatrixDevice();
  const auto row_size = diagonal.getLocalViewDevice(Tpetra::Access::ReadOnly),
             column_size = of_columns.getLocalViewDevice(Tpetra::Access::ReadOnly);
  const auto before = factored_;
  Kokkos::parallel_reduce(
      "changed entries", Kokkos::RangePolicy<Execution>(0, local.numRows()),
      KOKKOS_LAMBDA(LocalIndex row, int& any) {
        for (auto k = local.graph.row_map(row); k < local.graph.row_map(row + 1); ++k) {
          const Real size = std::sqrt(std::fabs(row_size(row, 0) * column_size(local.graph.entries(k), 0)));
          if (!(std::fabs(local.values(k) - before(k)) <= much * size)) any = 1;
        }
      },
      Kokkos::Max<int>(here));
  Teuchos::reduceAll(comm, Teuchos::REDUCE_MAX, 1, &here, &anywhere);
  return anywhere > 0;
}

void DirectInverse::factor_dense() {
  const auto& rows = *A_->getRowMap();
  const auto& columns = *A_->getColMap();
  const int n = static_cast<int>(rows.getGlobalNumElements());
  std::vector<Real> part(static_cast<std::size_t>(n) * n, 0);
  const auto local = A_->getLocalMatrixHost();
  for (LocalIndex row = 0, n_rows = local.numRows(); row < n_rows; ++row)
    for (auto k = local.graph.row_map(row); k < local.graph.row_map(row + 1); ++k)
      part[columns.getGlobalElement(local.graph.entries(k)) * n + rows.getGlobalElement(row)] = local.values(k);
  factors_.resize(part.size());
  pivots_.resize(n);
  Teuchos::reduceAll(*rows.getComm(), Teuchos::REDUCE_SUM, n * n, part.data(), factors_.data());
  int info = 0;
  Teuchos::LAPACK<int, Real>().GETRF(n, n, factors_.data(), n, pivots_.data(), &info);
  SPREKK_CHECK(info == 0, "{}: the matrix is singular (after {} pivots)", name_, info - 1);
}

void DirectInverse::solve_dense(const Vector& b, Vector& x) const {
  const int n = static_cast<int>(pivots_.size());
  const std::size_t first = b.getMap()->getMinGlobalIndex(), n_here = b.getLocalLength();
  part_.assign(n, 0);
  whole_.resize(n);
  std::copy_n(b.getLocalViewHost(Tpetra::Access::ReadOnly).data(), n_here, part_.begin() + (n_here > 0 ? first : 0));
  Teuchos::reduceAll(*b.getMap()->getComm(), Teuchos::REDUCE_SUM, n, part_.data(), whole_.data());
  int info = 0;
  Teuchos::LAPACK<int, Real>().GETRS('N', n, 1, factors_.data(), n, pivots_.data(), whole_.data(), n, &info);
  std::copy_n(whole_.begin() + (n_here > 0 ? first : 0), n_here,
              x.getLocalViewHost(Tpetra::Access::OverwriteAll).data());
}

void DirectInverse::apply(const fields::MultiVector& b, fields::MultiVector& y, Teuchos::ETransp, Real, Real) const {
  for (std::size_t v = 0; v < b.getNumVectors(); ++v) {
    Kokkos::deep_copy(from_.getLocalViewDevice(Tpetra::Access::OverwriteAll),
                      b.getVector(v)->getLocalViewDevice(Tpetra::Access::ReadOnly));
    if (solver_)
      solver_->solve(from_, to_, 1);
    else
      solve_dense(from_, to_);
    Kokkos::deep_copy(y.getVectorNonConst(v)->getLocalViewDevice(Tpetra::Access::OverwriteAll),
                      to_.getLocalViewDevice(Tpetra::Access::ReadOnly));
  }
}

}  // namespace sprekk::solve
