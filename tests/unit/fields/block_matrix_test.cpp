#include "fields/block_matrix.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <limits>

namespace sprekk::fields {
namespace {

RCP<const Map> map_of(GlobalIndex n) { return rcp(new const Map(n, 0, Tpetra::getDefaultComm())); }

/// Returns entry (i, j) of the banded test matrix of block (b, c).
Real entry(int b, int c, GlobalIndex i, GlobalIndex j) {
  return std::abs(static_cast<int>(i - j)) > 2
             ? 0
             : 1 + 0.1 * b + 0.01 * c + static_cast<Real>(i) - 0.5 * static_cast<Real>(j);
}

RCP<CrsMatrix> make_block(int b, int c, const RCP<const Map>& rows, const RCP<const Map>& columns) {
  auto matrix = rcp(new CrsMatrix(rows, 5));
  for (const GlobalIndex i : base::local_elements(*rows))
    for (GlobalIndex j = 0; j < static_cast<GlobalIndex>(columns->getGlobalNumElements()); ++j)
      if (entry(b, c, i, j) != 0) matrix->insertGlobalValues(i, 1, std::vector<Real>{entry(b, c, i, j)}.data(), &j);
  matrix->fillComplete(columns, rows);
  return matrix;
}

Real x_value(int block, GlobalIndex i) { return 0.3 * block + 1.0 / (1.0 + static_cast<Real>(i)); }

TEST(BlockMatrix, AppliesThePresentBlocksAndSkipsTheAbsentOnes) {
  const std::vector<RCP<const Map>> maps{map_of(11), map_of(7), map_of(2)};
  const std::vector<std::pair<int, int>> present{{0, 0}, {0, 1}, {1, 1}, {1, 0}, {1, 2}};  // no block in row 2
  BlockMatrix A(3);
  EXPECT_EQ(A.n_blocks(), 3);
  for (const auto& [b, c] : present) A(b, c) = make_block(b, c, maps[b], maps[c]);
  EXPECT_TRUE(A(0, 2).is_null());
  BlockVector x, y;
  for (int b = 0; b < 3; ++b) {
    x.push_back(rcp(new Vector(maps[b])));
    for (const GlobalIndex i : base::local_elements(*maps[b])) x[b]->replaceGlobalValue(i, x_value(b, i));
  }
  y = create_like(x);
  for (const auto& v : y) v->putScalar(std::numeric_limits<Real>::quiet_NaN());  // y is overwritten
  A.apply(x, y);
  for (int b = 0; b < 3; ++b)
    for (const GlobalIndex i : base::local_elements(*maps[b])) {
      Real sum = 0;
      for (const auto& [row, column] : present)
        for (GlobalIndex j = 0; row == b && j < static_cast<GlobalIndex>(maps[column]->getGlobalNumElements()); ++j)
          sum += entry(b, column, i, j) * x_value(column, j);
      EXPECT_NEAR(y[b]->getData()[maps[b]->getLocalElement(i)], sum, 1e-13);
    }
}

TEST(BlockVector, CreateLikeIsZeroAndCopyCopiesValues) {
  BlockVector x{rcp(new Vector(map_of(5))), rcp(new Vector(map_of(1)))};
  for (const auto& v : x) v->putScalar(2);
  auto y = create_like(x);
  ASSERT_EQ(y.size(), 2u);
  for (int b = 0; b < 2; ++b) {
    EXPECT_TRUE(y[b]->getMap()->isSameAs(*x[b]->getMap()));
    EXPECT_EQ(y[b]->normInf(), 0);
  }
  copy(x, y);
  x[0]->putScalar(3);
  EXPECT_EQ(y[0]->normInf(), 2);
  EXPECT_EQ(y[1]->normInf(), 2);
}

}  // namespace
}  // namespace sprekk::fields
