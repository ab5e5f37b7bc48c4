#include "fields/kept_rows.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <cmath>

namespace sprekk::fields {
namespace {

/// Of A; every third number of odd rows is zero, though J has a place for it.
Real number(GlobalIndex i, GlobalIndex j) {
  return i % 2 == 1 && j % 3 == 0 ? 0 : std::sin(static_cast<Real>(7 * i + 3 * j + 1));
}

/// Full rows of 150 places, three words of bits, spread over the ranks.
struct Matrix {
  static constexpr GlobalIndex n = 150;
  RCP<const Map> map = rcp(new const Map(n, 0, Tpetra::getDefaultComm()));
  RCP<CrsMatrix> J = rcp(new CrsMatrix(map, n));

  Matrix() {
    for (std::size_t row = 0; row < map->getNodeNumElements(); ++row)
      for (GlobalIndex j = 0; j < n; ++j) {
        const GlobalIndex i = map->getGlobalElement(row);
        const Real value = number(i, j);
        J->insertGlobalValues(i, 1, &value, &j);
      }
    J->fillComplete();
  }

  void overwrite(const View<char*>& rows) const {
    const auto local = J->getLocalMatrixHost();
    for (LocalIndex row = 0; row < local.numRows(); ++row)
      for (auto k = local.graph.row_map(row); rows(row) && k < local.graph.row_map(row + 1); ++k)
        local.values(k) = 1e3 + static_cast<Real>(k);
  }

  View<char*> rows(int every) const {
    const View<char*> chosen("chosen", map->getNodeNumElements());
    for (std::size_t row = 0; row < chosen.extent(0); ++row) chosen(row) = map->getGlobalElement(row) % every == 0;
    return chosen;
  }
};

TEST(KeptRows, MultiplyAndGiveBackWhatWasThere) {
  const Matrix matrix;
  KeptRows kept(matrix.J);
  Vector x(matrix.map), before(matrix.map), y(matrix.map);
  for (std::size_t i = 0; i < x.getLocalLength(); ++i)
    x.replaceLocalValue(i, std::cos(static_cast<Real>(matrix.map->getGlobalElement(i))));
  matrix.J->apply(x, before);
  std::size_t n_before = 0;
  for (const int every : {5, 3}) {  // the second time some are kept already, and are other ones in J
    kept.keep(matrix.rows(every));
    EXPECT_GE(kept.rows().extent(0), n_before);
    n_before = kept.rows().extent(0);
    matrix.overwrite(matrix.rows(every));
    y.putScalar(0);
    kept.add_product(x, y);
    y.update(-1, before, 1);
    EXPECT_LE(y.normInf(), 1e-13);
  }
  kept.restore(*matrix.J);
  const auto local = matrix.J->getLocalMatrixHost();
  for (LocalIndex row = 0; row < local.numRows(); ++row)
    for (auto k = local.graph.row_map(row); k < local.graph.row_map(row + 1); ++k)
      ASSERT_EQ(local.values(k), number(matrix.map->getGlobalElement(row),
                                        matrix.J->getColMap()->getGlobalElement(local.graph.entries(k))));
}

TEST(KeptRows, MayBeNone) {
  const Matrix matrix;
  KeptRows kept(matrix.J);
  kept.keep(View<char*>("none", matrix.map->getNodeNumElements()));
  EXPECT_EQ(kept.rows().extent(0), 0u);
  kept.restore(*matrix.J);
  Vector x(matrix.map), y(matrix.map), expected(matrix.map);
  x.putScalar(1);
  matrix.J->apply(x, expected);
  kept.add_product(x, y);
  y.update(-1, expected, 1);
  EXPECT_LE(y.normInf(), 1e-13);
}

}  // namespace
}  // namespace sprekk::fields
