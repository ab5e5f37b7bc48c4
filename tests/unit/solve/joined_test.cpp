// Blocks as one: the operator, the matrix, and a matrix of chosen unknowns all say the same.
#include "solve/joined.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace sprekk::test {
namespace {

using fields::CrsMatrix;
using fields::Map;
using fields::MultiVector;
using fields::Vector;
using fields::wrapped;

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

  RCP<const fields::Matrix> block(int r, int s) const {
    const auto matrix = rcp(new CrsMatrix(maps[r], 9));
    const GlobalIndex n = maps[s]->getGlobalNumElements();
    for (std::size_t i = 0; i < base::n_local_elements(*maps[r]); ++i) {
      const GlobalIndex row = maps[r]->getGlobalElement(i);
      const GlobalIndex reach = r == 0 && s == 0 ? 4 : 1;  // rows of nine entries, or of three
      for (GlobalIndex k = -reach; k <= reach; ++k) {
        const GlobalIndex column = (row + (reach > 1 ? 1 : 3) * k + 3 * n) % n;
        const Real value = std::cos(1.0 + row + 7 * column + 100 * r + 1000 * s);
        matrix->insertGlobalValues(row, 1, &value, &column);
      }
    }
    matrix->fillComplete(maps[s], maps[r]);
    return wrapped(matrix);
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
    for (std::size_t i = 0; i < base::n_local_elements(*map); ++i)
      chosen.back()->replaceLocalValue(i, map->getGlobalElement(i) % 3 != 1);
  }
  solve::JoinedMatrix part(pair.joined, pair.blocks, chosen);
  part.update();
  const auto whole = joined_operator(pair.joined, pair.blocks);
  const auto rows = part.rows();
  ASSERT_LT(rows.extent(0), base::n_local_elements(*pair.joined->map()));
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

/// In rows of both blocks, which also name columns of other ranks.
TEST(Joined, ChosenRowsHaveTheSumsOfTheWhole) {
  const Pair pair;
  std::vector<LocalIndex> chosen = {0, 1, 8, 10, 12};
  const View<LocalIndex*> rows("rows", chosen.size());
  std::copy(chosen.begin(), chosen.end(), rows.data());
  const solve::JoinedRows some(pair.joined, pair.blocks, rows);
  const auto invalid = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
  const auto map = rcp(new Map(invalid, chosen.size(), 0, pair.joined->map()->getComm()));
  for (const std::size_t n_vectors : {1, 2}) {
    MultiVector x(pair.joined->map(), n_vectors), y(pair.joined->map(), n_vectors), part(map, n_vectors);
    for (std::size_t v = 0; v < n_vectors; ++v)
      for (std::size_t i = 0; i < x.getLocalLength(); ++i)
        x.replaceLocalValue(i, v, std::sin(1 + v + x.getMap()->getGlobalElement(i)));
    part.putScalar(3);
    joined_operator(pair.joined, pair.blocks)->apply(x, y);
    some.subtract_product(x, part);
    const auto all = y.getLocalViewHost(Tpetra::Access::ReadOnly),
               of_rows = part.getLocalViewHost(Tpetra::Access::ReadOnly);
    for (std::size_t v = 0; v < n_vectors; ++v)
      for (std::size_t i = 0; i < chosen.size(); ++i) EXPECT_NEAR(of_rows(i, v), 3 - all(chosen[i], v), 1e-14);
  }
}

}  // namespace
}  // namespace sprekk::test
