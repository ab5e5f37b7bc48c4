#include "multigrid/direct_inverse.hpp"

#include <gtest/gtest.h>

#include "base/check.hpp"
#include "truss.hpp"

namespace sprekk::test {
namespace {

/// Numbers of nodes along an edge of a truss: few enough for dense factors; too many for dense factors; enough for
/// several ranks.
constexpr int few = 4, many = 7, shared = 12;

/// Returns the distance of A^-1 A x from x, relative to the largest component of x.
Real error_of(const multigrid::DirectInverse& inverse, const CrsMatrix& A) {
  Vector x(A.getDomainMap()), b(A.getRangeMap()), y(A.getDomainMap());
  for (std::size_t i = 0; i < x.getLocalLength(); ++i)
    x.replaceLocalValue(i, std::cos(0.1 * x.getMap()->getGlobalElement(i)));
  A.apply(x, b);
  inverse.apply(b, y, Teuchos::NO_TRANS, 1, 0);
  y.update(-1, x, 1);
  return y.normInf() / x.normInf();
}

void scale(CrsMatrix& A, Real factor) {
  A.resumeFill();
  A.scale(factor);
  A.fillComplete(A.getDomainMap(), A.getRangeMap());
}

TEST(DirectInverse, InvertsFewAndManyUnknowns) {
  for (const int n : {few, many, shared}) {
    const Truss truss(n, true);
    const int n_rows = truss.matrix->getGlobalNumRows(), n_ranks = truss.matrix->getComm()->getSize();
    ASSERT_EQ(n_rows <= multigrid::DirectInverse::max_dense, n == few);
    ASSERT_EQ(n_rows >= 2 * multigrid::DirectInverse::minimum_per_rank, n == shared);
    Vector factors(truss.matrix->getRowMap());  // unsymmetric matrix
    for (std::size_t i = 0; i < factors.getLocalLength(); ++i)
      factors.replaceLocalValue(i, 1 + 0.1 * (truss.matrix->getRowMap()->getGlobalElement(i) % 7));
    truss.matrix->leftScale(factors);
    multigrid::DirectInverse inverse(truss.matrix, "test", n_ranks);
    for (const Real factor : {1, 3}) {
      scale(*truss.matrix, factor);
      inverse.setup(false);
      EXPECT_LT(error_of(inverse, *truss.matrix), 1e-10) << n;
    }
  }
}

TEST(DirectInverse, ThrowsWhereTheMatrixIsSingular) {
  for (const int n : {few, many, shared}) {
    const Truss truss(n, true);
    scale(*truss.matrix, 0);
    multigrid::DirectInverse inverse(truss.matrix, "test", truss.matrix->getComm()->getSize());
    try {
      inverse.setup(false);
      ADD_FAILURE() << n;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("test: "), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace sprekk::test
