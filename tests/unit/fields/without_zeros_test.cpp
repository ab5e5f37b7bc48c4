#include "fields/without_zeros.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <cmath>

namespace sprekk::fields {
namespace {

/// Returns a matrix with five rows per rank and three entries per row, also in columns of the next rank. Every
/// `every`-th value is zero (0: none).
RCP<CrsMatrix> matrix(GlobalIndex every) {
  const auto comm = Tpetra::getDefaultComm();
  const GlobalIndex n = 5 * comm->getSize();
  const auto map = rcp(new const Map(n, 0, comm));
  const auto A = rcp(new CrsMatrix(map, 3));
  for (const GlobalIndex row : base::local_elements(*map))
    for (GlobalIndex k = 0; k < 3; ++k) {
      const GlobalIndex column = (row + 2 * k) % n, number = 3 * row + k;
      const Real value = every > 0 && number % every == 0 ? 0 : std::sin(Real(number + 1));
      A->insertGlobalValues(row, 1, &value, &column);
    }
  A->fillComplete();
  return A;
}

TEST(WithoutZeros, IsTheSameMatrix) {
  for (const GlobalIndex every : {1, 2, 3, 14}) {  // all zero; a column of each row; some rows on some ranks
    const auto A = matrix(every), B = without_zeros(A);
    const auto values = B->getLocalMatrixHost().values;
    for (std::size_t k = 0; k < values.extent(0); ++k) EXPECT_NE(values(k), 0);
    EXPECT_LT(B->getGlobalNumEntries(), A->getGlobalNumEntries());
    EXPECT_EQ(B->getColMap(), A->getColMap());
    Vector x(A->getDomainMap()), y(A->getRangeMap()), z(A->getRangeMap());
    x.randomize(1, 2);
    A->apply(x, y);
    B->apply(x, z);
    for (std::size_t i = 0; i < y.getLocalLength(); ++i) EXPECT_NEAR(z.getData()[i], y.getData()[i], 1e-15);
  }
}

TEST(WithoutZeros, IsTheMatrixItselfWhereThereAreNone) {
  const auto A = matrix(0);
  EXPECT_EQ(without_zeros(A), A);
}

}  // namespace
}  // namespace sprekk::fields
