#include "solve/direct_inverse.hpp"

#include "base/check.hpp"

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
    : name_(name),
      map_(A->getRowMap()),
      A_(renumbered(A)),
      solver_(make_direct_solver(Teuchos::ParameterList().set("ICNTL(8)", 1, "scaling: by the diagonal"), true)) {}

void DirectInverse::setup(bool symmetric) {
  const auto joined = std::make_shared<Joined>(std::vector<RCP<const Map>>{A_->getRowMap()});
  const auto failure = solver_->setup({joined, {A_}, symmetric, {}, A_});
  SPREKK_CHECK(failure.empty(), "{}: {}", name_, failure);
}

void DirectInverse::apply(const fields::MultiVector& b, fields::MultiVector& y, Teuchos::ETransp, Real, Real) const {
  for (std::size_t v = 0; v < b.getNumVectors(); ++v) {
    Vector from(A_->getRowMap()), to(A_->getRowMap());
    Kokkos::deep_copy(from.getLocalViewDevice(Tpetra::Access::OverwriteAll),
                      b.getVector(v)->getLocalViewDevice(Tpetra::Access::ReadOnly));
    solver_->solve(from, to, 1);
    Kokkos::deep_copy(y.getVectorNonConst(v)->getLocalViewDevice(Tpetra::Access::OverwriteAll),
                      to.getLocalViewDevice(Tpetra::Access::ReadOnly));
  }
}

}  // namespace sprekk::solve
