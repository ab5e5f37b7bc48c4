// Incomplete factors in the order of a flow.
#include "solve/flow_factors.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <random>

#include "fake_problems.hpp"
#include "solve/preconditioner.hpp"

namespace sprekk::test {
namespace {

using solve::flow_order;
using solve::FlowFactors;
using solve::LocalRows;

/// Returns the rows of a dense matrix without its zeros.
LocalRows rows_of(const std::vector<std::vector<Real>>& dense) {
  LocalRows rows{.start = {0}, .column = {}, .value = {}};
  for (const auto& row : dense) {
    for (std::size_t j = 0; j < row.size(); ++j)
      if (row[j] != 0) {
        rows.column.push_back(static_cast<LocalIndex>(j));
        rows.value.push_back(row[j]);
      }
    rows.start.push_back(rows.column.size());
  }
  return rows;
}

/// 3 takes from 1, and 1 from the circulation 0 -> 4 -> 2 -> 0. The rows 3 and 5 exchange equally.
TEST(FlowOrder, GoesUpstream) {
  const auto order = flow_order(rows_of({{2, 0, -1, 0, 0, 0},
                                         {-1, 2, 0, 0, 0, 0},
                                         {0, 0, 2, 0, -1, 0},
                                         {0, -1, 0, 2, 0, -0.5},
                                         {-1, 0, 0, 0, 2, 0},
                                         {0, 0, 0, -0.5, 0, 2}}));
  EXPECT_EQ(order, (std::vector<LocalIndex>{5, 3, 1, 0, 2, 4}));
}

/// Couplings of one part in a thousand, or of at most twice the opposite coupling, have no direction.
TEST(FlowOrder, LeavesRowsWithoutFlowAlone) {
  const auto order = flow_order(rows_of({{1, -0.5, 0}, {-0.3, 1, -0.0009}, {0, 0, 1}}));
  EXPECT_EQ(order, (std::vector<LocalIndex>{2, 1, 0}));
}

/// Flow from rows to others in a random numbering, on each rank; with storage.
RCP<CrsMatrix> network(const RCP<const Comm>& comm, int n) {
  const int size = comm->getSize();
  const auto map = rcp(new Map(n * size, n, 0, comm));
  std::vector<int> number(n);
  for (int k = 0; k < n; ++k) number[k] = k;
  std::shuffle(number.begin(), number.end(), std::mt19937(7));
  Filler A(map, map);
  const GlobalIndex first = map->getMinGlobalIndex();
  for (int k = 0; k < n; ++k) {
    A.add(first + number[k], first + number[k], 0.1);
    for (const int from : {k - 1, k / 2 - 1}) {
      if (from < 0) continue;
      A.add(first + number[k], first + number[from], -2);
      A.add(first + number[k], first + number[k], 2);
    }
  }
  return A.done();
}

/// Returns the largest error of 2 (L U)^-1 A x + 0.5 y for y = 1.
Real error_of_factors(const RCP<CrsMatrix>& A) {
  const FlowFactors factors(*A);
  Vector x(A->getDomainMap()), b(A->getRangeMap()), y(A->getDomainMap());
  x.randomize(-1, 1);
  A->apply(x, b);
  y.putScalar(1);
  factors.apply(b, y, Teuchos::NO_TRANS, 2, 0.5);
  y.update(-2, x, 1);  // 0.5
  Real error = 0;
  for (const Real value : y.getData()) error = std::max(error, std::abs(value - 0.5));
  return error;
}

/// Without circulation, no fill is missing, whatever the numbering.
TEST(FlowFactors, AreExactWithoutCirculation) {
  EXPECT_LT(error_of_factors(network(Tpetra::getDefaultComm(), 200)), 1e-12);
}

/// Returns (L U)^-1 1 for a matrix of two rows on each rank.
std::array<Real, 2> solution_of_ones(const std::array<Real, 4>& values) {
  const auto comm = Tpetra::getDefaultComm();
  const auto map = rcp(new Map(2 * comm->getSize(), 2, 0, comm));
  Filler A(map, map);
  for (int k = 0; k < 4; ++k) A.add(map->getMinGlobalIndex() + k / 2, map->getMinGlobalIndex() + k % 2, values[k]);
  const FlowFactors factors(*A.done());
  Vector b(map), y(map);
  b.putScalar(1);
  factors.apply(b, y, Teuchos::NO_TRANS, 1, 0);
  return {y.getData()[0], y.getData()[1]};
}

/// A negative pivot is that of an indefinite matrix.
TEST(FlowFactors, TakeANegativePivot) {
  for (const Real y : solution_of_ones({1, 2, 2, 1})) EXPECT_DOUBLE_EQ(y, 1.0 / 3);
}

/// A pivot of zero gives way to the diagonal.
TEST(FlowFactors, SurviveAZeroPivot) {
  EXPECT_EQ(solution_of_ones({1, 1, 1, 1}), (std::array<Real, 2>{0, 1}));  // row 1 first: L = U^T = (1, 0; 1, 1)
}

/// Square of m x m points on each rank, above each other; shuffled numbers within a rank.
struct Points {
  static constexpr int m = 40;
  int n_ranks;
  std::vector<int> number;

  explicit Points(int ranks) : n_ranks(ranks), number(m * m) {
    std::iota(number.begin(), number.end(), 0);
    std::shuffle(number.begin(), number.end(), std::mt19937(7));
  }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < m && y < n_ranks * m; }
  GlobalIndex at(int x, int y) const { return y / m * m * m + number[y % m * m + x]; }
  template <class Visit>
  void each(const Visit& visit) const {
    for (int y = 0; y < n_ranks * m; ++y)
      for (int x = 0; x < m; ++x) visit(x, y);
  }
};

/// Conduction and upwind advection along the diagonal, from sides with prescribed values; `peclet`: flow over
/// conductance.
RCP<CrsMatrix> transport(const Points& points, const RCP<const Map>& map, Real peclet) {
  Filler A(map, map);
  points.each([&](int x, int y) {
    const auto row = points.at(x, y);
    for (const auto& [dx, dy] : {std::pair(-1, 0), {0, -1}, {1, 0}, {0, 1}}) {
      const bool upstream = dx + dy < 0, inside = points.contains(x + dx, y + dy);
      const Real coupling = 1 + (upstream ? peclet : 0);
      if (upstream || inside) A.add(row, row, coupling);
      if (inside) A.add(row, points.at(x + dx, y + dy), -coupling);
    }
  });
  return A.done();
}

/// Bilinear interpolation from a quarter of the points, at the centres of squares of four.
RCP<CrsMatrix> interpolation(const Points& points, const RCP<const Map>& map) {
  constexpr int half = Points::m / 2;
  const auto coarse = rcp(new Map(half * half * points.n_ranks, half * half, 0, map->getComm()));
  const auto near = [](int x, int n) {
    return std::array{std::pair(x / 2, 0.75), std::pair(std::clamp(x / 2 + (x % 2 ? 1 : -1), 0, n - 1), 0.25)};
  };
  Filler P(map, coarse);
  points.each([&](int x, int y) {
    for (const auto& [X, by_x] : near(x, half))
      for (const auto& [Y, by_y] : near(y, half * points.n_ranks)) P.add(points.at(x, y), Y * half + X, by_x * by_y);
  });
  return P.done();
}

/// Returns the error after ten iterations x += M (b - A x), relative to the first one.
Real error_after_ten(const RCP<CrsMatrix>& A, const fields::Block& block) {
  const auto M = solve::make_preconditioner({}, {block});
  M->setup(solve::alone({block, wrapped(A), {}, false}));
  Vector error(block.map), b(block.map), x(block.map);
  for (std::size_t i = 0; i < error.getLocalLength(); ++i)
    error.replaceLocalValue(i, std::cos(1.0 * block.map->getGlobalElement(i)) + 1);
  const Real start = error.norm2();
  for (int k = 0; k < 10; ++k) {
    A->apply(error, b);
    M->inverse()->apply(b, x);
    error.update(-1, x, 1);
  }
  return error.norm2() / start;
}

/// The cycle of an advected block converges with and without a flow. Factors alone do not without a flow, and
/// polynomials do not in a strong flow.
TEST(FlowFactors, SmoothAtAnyPecletNumber) {
  const auto comm = Tpetra::getDefaultComm();
  const Points points(comm->getSize());
  fields::Block block;
  block.name = "temperature";
  block.n_components = 1;
  block.advected = true;
  block.map = rcp(new Map(Points::m * Points::m * points.n_ranks, Points::m * Points::m, 0, comm));
  block.interpolation = interpolation(points, block.map);
  block.coordinates = rcp(new MultiVector(block.interpolation->getDomainMap(), 2));
  for (const Real peclet : {0.0, 0.1, 1.0, 10.0, 1e3, 1e6}) {
    const Real error = error_after_ten(transport(points, block.map, peclet), block);
    EXPECT_LT(error, comm->getSize() == 1 ? 1e-9 : 1e-3) << peclet;
  }
}

}  // namespace
}  // namespace sprekk::test
