#include "multigrid/direct_inverse.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <Teuchos_LAPACK.hpp>

#include <algorithm>

#include "base/check.hpp"
#include "base/over_ranks.hpp"

namespace sprekk::multigrid {
namespace {

using fields::Map;

/// Returns the matrix with rows and columns numbered from 0 without gaps. The values are shared. Collective.
RCP<CrsMatrix> renumbered(const RCP<const CrsMatrix>& A) {
  const auto invalid = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  const auto &rows = A->getRowMap(), &columns = A->getColMap();
  const auto map = rcp(new Map(invalid, base::n_local_elements(*rows), 0, rows->getComm()));
  Tpetra::Vector<GlobalIndex, LocalIndex, GlobalIndex> of_rows(rows), of_columns(columns);
  for (LocalIndex i = 0, n = base::n_local_elements(*rows); i < n; ++i)
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

DirectInverse::DirectInverse(const RCP<const CrsMatrix>& A, const std::string& name, int max_ranks)
    : name_(name), map_(A->getRowMap()), A_(renumbered(A)), from_(A_->getRowMap()), to_(A_->getRowMap()) {
  const auto n = static_cast<int>(A_->getGlobalNumRows());
  if (n > max_dense)
    mumps_ = std::make_unique<Mumps>(Teuchos::ParameterList()
                                         .set("ICNTL(7)", 2, "ordering: approximate minimum fill, soon found")
                                         .set("ICNTL(8)", 1, "scaling: by the diagonal"),
                                     std::clamp(n / minimum_per_rank, 1, max_ranks));
}

void DirectInverse::setup(bool symmetric) {
  if (!mumps_) return factor_dense();
  const auto failure = mumps_->factor(A_, symmetric);
  SPREKK_CHECK(failure.empty(), "{}: {}", name_, failure);
}

void DirectInverse::factor_dense() {
  const auto& rows = *A_->getRowMap();
  const auto& columns = *A_->getColMap();
  const int n = static_cast<int>(rows.getGlobalNumElements());
  if (n == 0) return;
  std::vector<Real> part(static_cast<std::size_t>(n) * n, 0);
  const auto local = A_->getLocalMatrixHost();
  for (LocalIndex row = 0, n_rows = local.numRows(); row < n_rows; ++row)
    for (auto k = local.graph.row_map(row); k < local.graph.row_map(row + 1); ++k)
      part[columns.getGlobalElement(local.graph.entries(k)) * n + rows.getGlobalElement(row)] = local.values(k);
  factors_ = base::sum_over_ranks(*rows.getComm(), part);
  pivots_.resize(n);
  int info = 0;
  Teuchos::LAPACK<int, Real>().GETRF(n, n, factors_.data(), n, pivots_.data(), &info);
  const int singular = base::max_over_ranks(*rows.getComm(), info);  // round-off may differ among ranks
  SPREKK_CHECK(singular == 0, "{}: the matrix is singular (after {} pivots)", name_, singular - 1);
}

void DirectInverse::solve_dense(const Vector& b, Vector& x) const {
  const int n = static_cast<int>(pivots_.size());
  if (n == 0) return;
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
    if (mumps_) {
      const auto failure = mumps_->substitute(from_, to_);
      SPREKK_CHECK(failure.empty(), "{}: {}", name_, failure);
    } else {
      solve_dense(from_, to_);
    }
    Kokkos::deep_copy(y.getVectorNonConst(v)->getLocalViewDevice(Tpetra::Access::OverwriteAll),
                      to_.getLocalViewDevice(Tpetra::Access::ReadOnly));
  }
}

}  // namespace sprekk::multigrid
