// Blocks as one: the operator, the matrix, and a matrix of chosen unknowns all say the same.
#include "solve/joined.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace sprekk::test {
namespace {

using fields::CrsMatrix;
using fields::Map;
using fields::MultiVector;
using fields::Vector;

/// Two blocks of 9 and 4 unknowns per rank that couple, within and across ranks.
struct Pair {
  Pair() {
    const auto comm = Tpetra::getDefaultComm();
    const GlobalIndex ranks = comm->getSize();
    maps = {rcp(new Map(9 * ranks, 0, comm)), rcp(new Map(4 * ranks, 0, comm))};
    for (int r = 0; r < 2; ++r)
      for (int s = 0; s < 2; ++s) blocks.push_back(block(r, s));
    joined = std::make_shared<solve::Joined>(maps);
    joined->set_scales({2, 0.25});
  }

  RCP<CrsMatrix> block(int r, int s) const {
    const auto matrix = rcp(new CrsMatrix(maps[r], 5));
    const GlobalIndex n = maps[s]->getGlobalNumElements();
    for (std::size_t i = 0; i < maps[r]->getNodeNumElements(); ++i) {
      const GlobalIndex row = maps[r]->getGlobalElement(i);
      for (GlobalIndex k = -1; k <= 1; ++k) {
        const GlobalIndex column = (row + 3 * k + n) % n;
        const Real value = std::cos(1.0 + row + 7 * column + 100 * r + 1000 * s);
        matrix->insertGlobalValues(row, 1, &value, &column);
      }
    }
    matrix->fillComplete(maps[s], maps[r]);
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

  // and it is S A S: gather multiplies by S
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

TEST(Joined, ChosenRowsAndColumnsAreThoseOfTheWhole) {
  const Pair pair;
  std::vector<RCP<Vector>> chosen;
  for (const auto& map : pair.maps) {
    chosen.push_back(rcp(new Vector(map)));
    for (std::size_t i = 0; i < map->getNodeNumElements(); ++i)
      chosen.back()->replaceLocalValue(i, map->getGlobalElement(i) % 3 != 1);
  }
  solve::JoinedMatrix part(pair.joined, pair.blocks, chosen);
  part.update();
  const auto whole = joined_operator(pair.joined, pair.blocks);
  const auto rows = part.rows();
  ASSERT_LT(rows.extent(0), pair.joined->map()->getNodeNumElements());
  Vector x(pair.joined->map()), y(pair.joined->map());
  Vector x_part(part.matrix()->getDomainMap()), y_part(part.matrix()->getRangeMap());
  for (std::size_t i = 0; i < rows.extent(0); ++i) {
    const Real value = std::sin(1 + x.getMap()->getGlobalElement(rows(i)));
    x.replaceLocalValue(rows(i), value);
    x_part.replaceLocalValue(i, value);
  }
  whole->apply(x, y);
  part.matrix()->apply(x_part, y_part);
  const auto all = y.getLocalViewHost(Tpetra::Access::ReadOnly),
             some = y_part.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t i = 0; i < rows.extent(0); ++i) EXPECT_NEAR(some(i, 0), all(rows(i), 0), 1e-14);
}

/// With all columns: the same sums, and of ghosts only those that the rows name.
TEST(Joined, ChosenRowsHaveTheSumsOfTheWhole) {
  const Pair pair;
  std::vector<RCP<Vector>> chosen;
  for (const auto& map : pair.maps) {
    chosen.push_back(rcp(new Vector(map)));
    chosen.back()->replaceLocalValue(static_cast<LocalIndex>(1), 1);  // couples within the rank, in its own block
  }
  solve::JoinedMatrix part(pair.joined, pair.blocks, chosen, solve::JoinedMatrix::Columns::all);
  part.update();
  Vector x(pair.joined->map()), y(pair.joined->map()), y_part(part.matrix()->getRangeMap());
  for (std::size_t i = 0; i < x.getLocalLength(); ++i)
    x.replaceLocalValue(i, std::sin(1 + x.getMap()->getGlobalElement(i)));
  joined_operator(pair.joined, pair.blocks)->apply(x, y);
  part.matrix()->apply(x, y_part);
  const auto all = y.getLocalViewHost(Tpetra::Access::ReadOnly),
             some = y_part.getLocalViewHost(Tpetra::Access::ReadOnly);
  ASSERT_EQ(part.rows().extent(0), 2u);
  std::set<LocalIndex> named;
  const auto graph = part.matrix()->getLocalMatrixHost().graph;
  for (std::size_t k = 0; k < graph.entries.extent(0); ++k) named.insert(graph.entries(k));
  for (std::size_t i = 0; i < 2; ++i) EXPECT_NEAR(some(i, 0), all(part.rows()(i), 0), 1e-14);
  const auto n_owned = static_cast<LocalIndex>(x.getLocalLength());
  const auto n_columns = static_cast<LocalIndex>(part.matrix()->getColMap()->getNodeNumElements());
  for (LocalIndex ghost = n_owned; ghost < n_columns; ++ghost) EXPECT_EQ(named.count(ghost), 1u) << ghost;
}

}  // namespace
}  // namespace sprekk::test
