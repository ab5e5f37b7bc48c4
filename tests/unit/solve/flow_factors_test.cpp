// Incomplete factors in the order of a flow.
#include "solve/flow_factors.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
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
  EXPECT_EQ(order.row, (std::vector<LocalIndex>{5, 3, 1, 0, 2, 4}));
  EXPECT_EQ(order.n_directed, 5);
}

/// Couplings of one part in a thousand, or of at most twice the opposite coupling, have no direction.
TEST(FlowOrder, LeavesRowsWithoutFlowAlone) {
  const auto order = flow_order(rows_of({{1, -0.5, 0}, {-0.3, 1, -0.0009}, {0, 0, 1}}));
  EXPECT_EQ(order.row, (std::vector<LocalIndex>{2, 1, 0}));
  EXPECT_EQ(order.n_directed, 0);
}

/// Flow from rows to others in a random numbering, on each rank; with storage, and conduction along a chain.
RCP<CrsMatrix> network(const RCP<const Comm>& comm, int n, bool flows, Real conduction) {
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
      const Real along = (flows ? 2 : 0) + (from == k - 1 ? conduction : 0), back = from == k - 1 ? conduction : 0;
      A.add(first + number[k], first + number[from], -along);
      A.add(first + number[k], first + number[k], along);
      A.add(first + number[from], first + number[k], -back);
      A.add(first + number[from], first + number[from], back);
    }
  }
  return A.done();
}

/// Returns the largest error of 2 (L U)^-1 A x + 0.5 y for y = 1.
Real error_of_factors(const RCP<CrsMatrix>& A) {
  FlowFactors factors(*A);
  factors.factor();
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
  EXPECT_LT(error_of_factors(network(Tpetra::getDefaultComm(), 200, true, 0)), 1e-12);
}

/// A negative pivot gives way to the diagonal.
TEST(FlowFactors, SurviveANegativePivot) {
  const auto comm = Tpetra::getDefaultComm();
  const auto map = rcp(new Map(2 * comm->getSize(), 2, 0, comm));
  Filler A(map, map);
  const GlobalIndex i = map->getMinGlobalIndex();
  for (const auto& [row, column, value] : {std::tuple<int, int, Real>{0, 0, 1}, {0, 1, 2}, {1, 0, 2}, {1, 1, 1}})
    A.add(i + row, i + column, value);
  FlowFactors factors(*A.done());
  factors.factor();
  Vector b(map), y(map);
  b.putScalar(1);
  factors.apply(b, y, Teuchos::NO_TRANS, 1, 0);  // row 1 first: L = (1, 0; 2, 1), U = (1, 2; 0, 1)
  EXPECT_DOUBLE_EQ(y.getData()[0], -1);
  EXPECT_DOUBLE_EQ(y.getData()[1], 3);
}

/// The default of an advected block is multigrid until the flow begins, and again after it ends.
TEST(FlowFactors, ReplaceMultigridInAFlow) {
  const auto comm = Tpetra::getDefaultComm();
  const int n = 600;
  fields::Block block;
  block.name = "temperature";
  block.n_components = 1;
  block.advected = true;
  const auto at_rest = network(comm, n, false, 1), flowing = network(comm, n, true, 1);
  block.map = at_rest->getRowMap();
  const auto places = rcp(new MultiVector(block.map, 2));
  for (std::size_t i = 0; i < base::n_local_elements(*block.map); ++i)
    places->replaceLocalValue(i, 0, Real(block.map->getGlobalElement(i)));
  block.coordinates = places;
  const auto preconditioner = solve::make_preconditioner({}, {block});
  const auto count = [&](const std::string& method) {
    int n_setups = 0;
    for (const auto& cost : preconditioner->costs())
      if (cost.name.starts_with(method)) n_setups += cost.n_setups;
    return n_setups;
  };
  int expected = 0;
  for (const auto& A : {at_rest, flowing, at_rest}) {
    preconditioner->setup(solve::alone({block, wrapped(A), {}, false}));
    EXPECT_EQ(count("multigrid"), expected += A == at_rest);
    Vector x(block.map), b(block.map), y(block.map);
    x.randomize(-1, 1);
    A->apply(x, b);
    preconditioner->inverse()->apply(b, y);
    y.update(-1, x, 1);
    EXPECT_LT(y.norm2(), 0.9 * x.norm2());
  }
}

}  // namespace
}  // namespace sprekk::test
