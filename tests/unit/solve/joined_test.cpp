// Several blocks as one: operator and matrix are equal.
#include "solve/joined.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

namespace sprekk::test {
namespace {

using fields::CrsMatrix;
using fields::Map;
using fields::Vector;
using fields::wrapped;

/// Two coupled blocks, by default of 9 and 4 unknowns per rank, with couplings within and across ranks; nodes of one
/// size.
struct Pair {
  explicit Pair(std::array<GlobalIndex, 2> n_unknowns = {9, 4}, int size = 1) {
    const auto comm = Tpetra::getDefaultComm();
    for (const GlobalIndex n : n_unknowns) maps.push_back(rcp(new Map(n * comm->getSize(), 0, comm)));
    for (int r = 0; r < 2; ++r)
      for (int s = 0; s < 2; ++s)
        blocks.push_back(size > 1 ? in_nodes(*block(r, s, size), size) : wrapped(block(r, s, 1)));
    joined = std::make_shared<solve::Joined>(maps);
    joined->set_scales({2, 0.25});
  }

  RCP<const CrsMatrix> block(int r, int s, int size) const {
    const auto matrix = rcp(new CrsMatrix(maps[r], 9 * size));
    const GlobalIndex n = maps[s]->getGlobalNumElements() / size;
    for (std::size_t i = 0; i < base::n_local_elements(*maps[r]); ++i) {
      const GlobalIndex unknown = maps[r]->getGlobalElement(i), row = unknown / size;
      const GlobalIndex reach = size == 1 && r == 0 && s == 0 ? 4 : 1;  // rows of nine entries, or of three nodes
      for (GlobalIndex k = -reach; k <= reach; ++k)
        for (int c = 0; c < size; ++c) {
          const GlobalIndex column = (row + (reach > 1 || size > 1 ? 1 : 3) * k + 3 * n) % n * size + c;
          const Real value = std::cos(1.0 + unknown + 7 * column + 100 * r + 1000 * s);
          matrix->insertGlobalValues(unknown, 1, &value, &column);
        }
    }
    matrix->fillComplete(maps[s], maps[r]);
    return matrix;
  }

  static RCP<const fields::Matrix> in_nodes(const CrsMatrix& A, int size) {
    const auto local = A.getLocalMatrixHost();
    const View<std::size_t*> start("start", local.numRows() + 1);
    const View<LocalIndex*> column("column", local.nnz());
    Kokkos::deep_copy(start, local.graph.row_map);
    Kokkos::deep_copy(column, local.graph.entries);
    const auto matrix =
        rcp(new fields::Matrix(A.getRowMap(), A.getColMap(), A.getDomainMap(), start, column, size, size));
    Kokkos::deep_copy(matrix->numbers().value, local.values);
    return matrix;
  }

  std::vector<RCP<const Map>> maps;
  solve::Blocks blocks;
  std::shared_ptr<solve::Joined> joined;
};

Real apply_both_and_compare(const fields::Operator& a, const fields::Operator& b, const Vector& x) {
  Vector y(x.getMap()), z(x.getMap());
  y.putScalar(3);
  z.putScalar(3);
  a.apply(x, y, Teuchos::NO_TRANS, 2, -1);
  b.apply(x, z, Teuchos::NO_TRANS, 2, -1);
  y.update(-1, z, 1);
  return y.normInf();
}

TEST(Joined, MatrixIsTheOperator) {
  const Pair pair;
  solve::JoinedMatrix matrix(pair.joined, pair.blocks);
  matrix.update();
  Vector x(pair.joined->map());
  for (std::size_t i = 0; i < x.getLocalLength(); ++i)
    x.replaceLocalValue(i, std::sin(1 + x.getMap()->getGlobalElement(i)));
  EXPECT_LT(apply_both_and_compare(*matrix.matrix(), *joined_operator(pair.joined, pair.blocks), x), 1e-14);

  // The matrix is S A S: gather multiplies by S.
  fields::BlockVector parts = {rcp(new Vector(pair.maps[0])), rcp(new Vector(pair.maps[1]))}, products = parts;
  products = fields::create_like(parts);
  for (auto& part : parts) part->putScalar(1);
  Vector s_as(pair.joined->map());
  matrix.matrix()->apply(*pair.joined->gather(parts), s_as);
  for (int r = 0; r < 2; ++r)
    for (int s = 0; s < 2; ++s) {
      Vector one(pair.maps[s]), part(pair.maps[r]);
      one.putScalar(std::pow(pair.joined->scale(s), 2));
      pair.blocks[r * 2 + s]->apply(one, part);
      products[r]->update(1, part, 1);
    }
  s_as.update(-1, *pair.joined->gather(products), 1);
  EXPECT_LT(s_as.normInf(), 1e-14);
}

/// In blocks of 3 x 3, too, the rows equal those of the operator; each node has one index.
TEST(Joined, OfNodesAlikeIsAMatrixOfNodes) {
  const Pair pair({9, 6}, 3);
  ASSERT_EQ(pair.blocks[1]->numbers().width, 3);
  solve::JoinedMatrix matrix(pair.joined, pair.blocks);
  matrix.update();
  const auto numbers = matrix.matrix()->numbers();
  EXPECT_EQ(numbers.height, 3);
  EXPECT_EQ(numbers.value.extent(0), 9 * numbers.column.extent(0));
  Vector x(pair.joined->map());
  for (std::size_t i = 0; i < x.getLocalLength(); ++i)
    x.replaceLocalValue(i, std::sin(1 + x.getMap()->getGlobalElement(i)));
  const auto whole = joined_operator(pair.joined, pair.blocks);
  EXPECT_LT(apply_both_and_compare(*matrix.matrix(), *whole, x), 1e-13);
  EXPECT_LT(apply_both_and_compare(*matrix.matrix()->crs(), *whole, x), 1e-13);
}

}  // namespace
}  // namespace sprekk::test
