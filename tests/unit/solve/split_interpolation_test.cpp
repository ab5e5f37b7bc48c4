#include "solve/split_interpolation.hpp"

#include <Tpetra_Core.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "base/over_ranks.hpp"
#include "solve/preconditioner.hpp"

namespace sprekk::solve {
namespace {

using fields::Map;

/// Returns the Laplacian of a ring of 12 nodes with the conductance k(i) between nodes i and i + 1.
template <class Conductance>
RCP<CrsMatrix> ring(const RCP<const Map>& map, const Conductance& k) {
  const GlobalIndex n = 12;
  const auto A = rcp(new CrsMatrix(map, 3));
  for (GlobalIndex i = 0; i < n; ++i) {
    if (!map->isNodeGlobalElement(i)) continue;
    const Real before = k((i + n - 1) % n), after = k(i);
    const std::vector<GlobalIndex> columns = {(i + n - 1) % n, i, (i + 1) % n};
    const std::vector<Real> values = {-before, before + after, -after};
    A->insertGlobalValues(i, columns, values);
  }
  A->fillComplete();
  return A;
}

/// Returns an interpolation from two unknowns: row i takes half of each; rows of the node `zero` are zero.
RCP<const CrsMatrix> from_two(const RCP<const Map>& map, GlobalIndex zero = -1) {
  const auto domain = rcp(new const Map(2, 0, map->getComm()));
  const auto P = rcp(new CrsMatrix(map, 2));
  for (GlobalIndex i = 0; i < 12; ++i) {
    const std::vector<GlobalIndex> columns = {0, 1};
    const std::vector<Real> values(2, i == zero ? 0 : 0.5);
    if (map->isNodeGlobalElement(i)) P->insertGlobalValues(i, columns, values);
  }
  P->fillComplete(domain, map);
  return P;
}

/// Returns the Laplacian of a ring of n nodes with conductance k(i) between i and i + 1, plus 1e-9 on the diagonal.
template <class Conductance>
RCP<CrsMatrix> long_ring(const RCP<const Map>& map, const Conductance& k) {
  const auto A = rcp(new CrsMatrix(map, 3));
  const auto n = static_cast<GlobalIndex>(map->getGlobalNumElements());
  for (const GlobalIndex i : base::local_elements(*map)) {
    const Real before = k((i + n - 1) % n), after = k(i);
    A->insertGlobalValues(i, 3, std::array{-before, before + after + 1e-9, -after}.data(),
                          std::array{(i + n - 1) % n, i, (i + 1) % n}.data());
  }
  A->fillComplete();
  return A;
}

RCP<const Map> nodes() { return rcp(new const Map(12, 0, Tpetra::getDefaultComm())); }

TEST(SplitInterpolation, KeepsColumnsOfConnectedRows) {
  const auto map = nodes();
  const auto P = from_two(map);
  EXPECT_EQ(split_interpolation(*ring(map, [](GlobalIndex) { return 1; }), P), P);
  // one weak coupling does not divide a ring
  const auto split = split_interpolation(*ring(map, [](GlobalIndex i) { return i == 3 ? 1e-9 : 1; }), P);
  EXPECT_EQ(split->getDomainMap()->getGlobalNumElements(), 2);
}

/// Two weak couplings divide the ring. A vector that is constant on each part is then interpolated exactly.
TEST(SplitInterpolation, DividesColumnsBetweenParts) {
  const auto map = nodes();
  const auto is_first = [](GlobalIndex i) { return i > 3 && i <= 9; };
  const auto A = ring(map, [](GlobalIndex i) { return i == 3 || i == 9 ? 1e-9 : 1; });
  const auto split = split_interpolation(*A, from_two(map, 4));
  EXPECT_EQ(split->getDomainMap()->getGlobalNumElements(), 4);
  fields::MultiVector ones(split->getDomainMap(), 1), sums(map, 1), back(split->getDomainMap(), 1);
  ones.putScalar(1);
  split->apply(ones, sums);
  const auto view = sums.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t i = 0; i < view.extent(0); ++i)
    EXPECT_EQ(view(i, 0), map->getGlobalElement(static_cast<LocalIndex>(i)) == 4 ? 0 : 1);
  // the part of a column: sums of the rows of each part
  fields::MultiVector part(map, 1);
  for (std::size_t i = 0; i < part.getLocalLength(); ++i)
    part.replaceLocalValue(static_cast<LocalIndex>(i), 0, is_first(map->getGlobalElement(static_cast<LocalIndex>(i))));
  split->apply(part, back, Teuchos::TRANS);
  int here = 0;
  const auto sum = back.getLocalViewHost(Tpetra::Access::ReadOnly);
  for (std::size_t k = 0; k < sum.extent(0); ++k) {
    EXPECT_TRUE(sum(k, 0) == 0 || sum(k, 0) == 2.5) << sum(k, 0);  // 5 of the 6 rows of the first part are not zero
    here += sum(k, 0) > 0;
  }
  EXPECT_EQ(base::sum_over_ranks(*map->getComm(), here), 2);
}

/// The second of two matrices has two weak couplings. A vector e of opposite constants on both parts is then nearly in
/// the kernel, and a cycle M of the fine level must return it: |e - M A e| << |e|. The columns of the first matrix
/// represent one constant only.
TEST(SplitInterpolation, FollowsChangedCouplings) {
  constexpr GlobalIndex n = 200;
  const auto map = rcp(new const Map(n, 0, Tpetra::getDefaultComm())),
             corner = rcp(new const Map(1, 0, map->getComm()));
  const auto P = rcp(new CrsMatrix(map, 1));
  const Real one = 1;
  const GlobalIndex zero = 0;
  for (const GlobalIndex i : base::local_elements(*map)) P->insertGlobalValues(i, 1, &one, &zero);
  P->fillComplete(corner, map);
  fields::Block block;
  block.name = "facets";
  block.map = map;
  block.n_components = 1;
  block.coordinates = rcp(new fields::MultiVector(corner, 2));
  block.interpolation = P;
  const auto preconditioner = make_preconditioner({}, {block});
  const auto set_up = [&](const auto& conductance) {
    const auto A = long_ring(map, conductance);
    preconditioner->setup(alone({.block = block, .matrix = fields::wrapped(A), .bulk = {}}));
    return A;
  };
  set_up([](GlobalIndex) { return 1; });
  const auto A = set_up([](GlobalIndex i) { return i == n / 2 - 1 || i == n - 1 ? 1e-7 : 1; });
  fields::MultiVector e(map, 1), Ae(map, 1), MAe(map, 1);
  for (std::size_t i = 0; i < e.getLocalLength(); ++i) {
    const auto row = static_cast<LocalIndex>(i);
    e.replaceLocalValue(row, 0, map->getGlobalElement(row) < n / 2 ? 1 : -1);
  }
  A->apply(e, Ae);
  preconditioner->inverse()->apply(Ae, MAe);
  MAe.update(1, e, -1);
  EXPECT_LT(MAe.getVector(0)->normInf(), 1e-3);
}

}  // namespace
}  // namespace sprekk::solve
