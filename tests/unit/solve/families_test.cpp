// Families of blocks against the systems that they are about the inverse of, where what they leave to multigrid is
// small enough to be solved directly.
#include "solve/families.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace sprekk::test {
namespace {

using fields::CrsMatrix;
using fields::Map;
using fields::MultiVector;
using fields::Vector;
using fields::wrapped;
using solve::Families;
using solve::LinearSystem;

/// A chain over all ranks: faces with a pressure each, cells between them, and nodes that move, as many as faces. Every
/// row reads its neighbours; cells do not read each other.
struct Chain {
  enum Which { nodes, faces, cells };

  /// `order` of the blocks; without `back`, nodes do not read pressures.
  Chain(const std::vector<Which>& order_, bool back, bool schur) : order(order_) {
    const auto comm = Tpetra::getDefaultComm();
    const GlobalIndex n = 5 * comm->getSize() + 2;
    std::vector<RCP<const Map>> maps;
    for (const Which which : order) {
      fields::Block block;
      block.name = std::array{"nodes", "faces", "cells"}[which];
      block.map = rcp(new Map(which == cells ? n - 1 : n, 0, comm));
      block.n_components = 1;
      if (which == cells) block.condensed_into = "faces";
      const auto places = rcp(new MultiVector(block.map, 2));
      for (std::size_t i = 0; i < base::n_local_elements(*block.map); ++i)
        places->replaceLocalValue(i, 0, Real(block.map->getGlobalElement(i)));
      if (which != cells) block.coordinates = places;
      blocks.push_back(block);
      maps.push_back(block.map);
    }
    const auto joined = std::make_shared<solve::Joined>(maps);
    joined->set_scales({0.5, 4, 0.01});
    system.joined = joined;
    for (std::size_t r = 0; r < order.size(); ++r)
      for (std::size_t s = 0; s < order.size(); ++s) {
        const bool absent = !back && order[r] == nodes && order[s] != nodes;
        system.blocks.push_back(absent ? Teuchos::null : matrix(r, s));
      }
    for (std::size_t r = 0; r < order.size(); ++r) {
      system.diagonal.push_back({blocks[r], system.blocks[r * order.size() + r], {}, false});
      if (schur && order[r] != nodes) {
        const auto more = rcp(new Vector(maps[r]));
        more->randomize(1, 2);
        system.diagonal.back().schur = more;
      }
    }
  }

  /// Of faces and cells: the faces beside a cell, and back; of others, up to one place apart. No row is symmetric.
  RCP<const fields::Matrix> matrix(int r, int s) const {
    const auto result = rcp(new CrsMatrix(blocks[r].map, 3));
    const auto& rows = *blocks[r].map;
    const bool down = order[r] != cells && order[s] == cells, up = order[r] == cells && order[s] != cells;
    for (std::size_t i = 0; i < base::n_local_elements(rows); ++i) {
      const GlobalIndex row = rows.getGlobalElement(i), n = blocks[s].map->getGlobalNumElements();
      for (GlobalIndex k = up ? 0 : -1; k <= (down ? 0 : 1); ++k) {
        const GlobalIndex column = row + k;
        if (column < 0 || column >= n || (order[r] == cells && order[s] == cells && k != 0)) continue;
        const Real value = (r == s && k == 0 ? 4 : 0) + 0.5 * std::cos(1.0 + row + 7 * column + 100 * r + 1000 * s);
        result->insertGlobalValues(row, 1, &value, &column);
      }
    }
    result->fillComplete(blocks[s].map, blocks[r].map);
    return wrapped(result);
  }

  /// What the families are about the inverse of: with the Schur complements that are given.
  void apply(const Vector& x, Vector& y) const {
    system.joined_operator()->apply(x, y);
    for (std::size_t r = 0; r < order.size(); ++r) {
      if (system.diagonal[r].schur.is_null()) continue;
      const auto& joined = *system.joined;
      y.offsetViewNonConst(joined.map(r), joined.first(r))
          ->elementWiseMultiply(joined.scale(r) * joined.scale(r), *system.diagonal[r].schur,
                                *x.offsetView(joined.map(r), joined.first(r)), 1);
    }
  }

  std::vector<Which> order;
  std::vector<fields::Block> blocks;
  LinearSystem system;
};

constexpr Real rounding = 1e-6;  // multigrid raises the diagonal of its last matrix by 1e-8 of itself

/// y = sweep(x), once all families are set up `times` times.
Vector swept(const Chain& chain, const Vector& x, int times = 2) {
  Families families({}, chain.blocks);
  for (int k = 0; k < times; ++k)
    for (int f = 0; f < families.n(); ++f) families.setup(f, chain.system);
  Vector y(x.getMap());
  y.putScalar(3);
  families.sweep(chain.system)->apply(x, y);
  return y;
}

Vector random_vector(const Chain& chain) {
  Vector x(chain.system.joined->map());
  x.randomize(-1, 1);
  return x;
}

/// The largest of |y| among the unknowns of block r, over all ranks.
Real largest(const Chain& chain, const Vector& y, int r) {
  return y.offsetView(chain.system.joined->map(r), chain.system.joined->first(r))->getVector(0)->normInf();
}

TEST(Families, AreBlocksWithWhatIsCondensedIntoThem) {
  const Chain chain({Chain::cells, Chain::nodes, Chain::faces}, true, false);
  const Families families({}, chain.blocks);
  ASSERT_EQ(families.n(), 2);
  EXPECT_EQ(families.name(0), "nodes");
  EXPECT_EQ(families.name(1), "faces");
}

/// The product by which cells are eliminated fits into the graph of the faces: nothing is left out.
TEST(Families, PairIsTheInverseOfBothBlocks) {
  for (const bool schur : {false, true})
    for (const auto& order : {std::vector{Chain::faces, Chain::cells}, std::vector{Chain::cells, Chain::faces}}) {
      const Chain chain(order, true, schur);
      const auto x = random_vector(chain);
      const auto y = swept(chain, x);
      Vector back(x.getMap());
      chain.apply(y, back);
      back.update(-1, x, 1);
      EXPECT_LT(back.normInf(), rounding) << schur;
    }
}

/// Where nodes do not read pressures, one sweep is the inverse.
TEST(Families, SweepIsTheInverseOfATriangularSystem) {
  const Chain chain({Chain::nodes, Chain::faces, Chain::cells}, false, false);
  const auto x = random_vector(chain);
  const auto y = swept(chain, x);
  Vector back(x.getMap());
  chain.apply(y, back);
  back.update(-1, x, 1);
  EXPECT_LT(back.normInf(), rounding);
}

/// Rows of the last family are in balance, those of the first with its own unknowns alone.
TEST(Families, SweepSolvesOneFamilyAfterTheOther) {
  const Chain chain({Chain::nodes, Chain::faces, Chain::cells}, true, false),
      triangular({Chain::nodes, Chain::faces, Chain::cells}, false, false);
  const auto x = random_vector(chain);
  const auto y = swept(chain, x);
  Vector back(x.getMap()), own(x.getMap());
  chain.apply(y, back);
  triangular.apply(y, own);
  back.update(-1, x, 1);
  own.update(-1, x, 1);
  EXPECT_LT(largest(chain, own, 0), rounding);
  EXPECT_GT(largest(chain, back, 0), 1e-3);
  for (const int r : {1, 2}) EXPECT_LT(largest(chain, back, r), rounding);
}

TEST(Families, SweepAddsToWhatIsThere) {
  const Chain chain({Chain::faces, Chain::nodes, Chain::cells}, true, false);
  const auto x = random_vector(chain);
  const auto once = swept(chain, x);
  Families families({}, chain.blocks);
  for (int f = 0; f < families.n(); ++f) families.setup(f, chain.system);
  Vector y(x, Teuchos::Copy);
  families.sweep(chain.system)->apply(x, y, Teuchos::NO_TRANS, 2, -3);
  y.update(-2, once, 1);
  y.update(3, x, 1);
  EXPECT_LT(y.normInf(), 1e-13 * once.normInf());
}

}  // namespace
}  // namespace sprekk::test
