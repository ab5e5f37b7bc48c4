#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

#include "dense.hpp"
#include "solve/condensed_block.hpp"
#include "solve/condensed_solve.hpp"
#include "solve/small_lu.hpp"

namespace sprekk::test {
namespace {

using solve::CondensedSolve;
using solve::LinearSolverOptions;
using solve::LocalElimination;

std::vector<Real> some_values(std::size_t n) {
  std::vector<Real> values(n);
  for (std::size_t i = 0; i < n; ++i) values[i] = std::sin(3.7 * i + 1);
  return values;
}

/// Row with the unknowns 8, 9, 0, 1, in this order.
TEST(RowCursor, FindsWhatARowHasAndCountsWhatItHasNot) {
  fields::NodeRows numbers{.height = 1, .width = 2};
  numbers.start = View<std::size_t*>("start", 2);
  numbers.start(1) = 2;
  numbers.column = View<LocalIndex*>("column", 2);
  numbers.column(0) = 4;
  numbers.column(1) = 0;
  solve::RowCursor cursor(numbers, 0);
  EXPECT_EQ(cursor.find(9), 1u);
  EXPECT_EQ(cursor.find(0), 2u);
  EXPECT_EQ(cursor.find(1), 3u);
  EXPECT_NO_THROW(solve::check_found(cursor.n_missing));
  cursor.find(6);
  cursor.find(2);
  cursor.find(-1);
  EXPECT_EQ(cursor.n_missing, 3);
  EXPECT_EQ(cursor.find(8), 0u);
  EXPECT_THROW(solve::check_found(cursor.n_missing), Error);
}

/// Returns a state with open and closed faces.
BlockVector mixed_state(const GridProblem& problem) {
  auto x = problem.zero();
  scatter(some_values(gather(x).size()), x);
  return x;
}

void expect_equal_solutions(const GridOptions& options) {
  GridProblem problem(Tpetra::getDefaultComm(), options);
  problem.jacobian(mixed_state(problem));
  auto b = problem.zero(), x = problem.zero();
  const auto values = some_values(gather(b).size());
  scatter(values, b);
  CondensedSolve solve(problem, {});
  solve.update();
  const auto report = solve.solve(b, x, 1e-12);
  ASSERT_TRUE(report.converged) << report.reason;
  const auto exact = solve_dense(gather_matrix(problem), {values.begin(), values.end()});
  const auto found = gather(x);
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], exact[i], 1e-11) << "unknown " << i;
}

TEST(LocalElimination, SolvesTheFullSystem2D) { expect_equal_solutions({}); }

TEST(LocalElimination, SolvesTheFullSystem3D) {
  GridOptions options;
  options.d = 3;
  expect_equal_solutions(options);
}

/// Entries that couple a row with an entity are contiguous.
TEST(LocalElimination, SolvesTheFullSystemWhereComponentsMix) {
  for (const int d : {2, 3}) {
    GridOptions options;
    options.d = d;
    options.mix = 0.3;
    expect_equal_solutions(options);
  }
}

TEST(LocalElimination, SolvesWithoutGroups) {
  GridOptions options;
  options.faces = false;
  expect_equal_solutions(options);
}

TEST(LocalElimination, CondensedMatrixIsSymmetricWithZeroedConstraints) {
  GridProblem problem(Tpetra::getDefaultComm(), {});
  problem.jacobian(mixed_state(problem));
  LocalElimination elimination(problem);
  ASSERT_EQ(elimination.update(problem).failure, "");
  const auto j = elimination.condensed(0, 0);
  Vector x(j->getDomainMap()), y(j->getDomainMap()), jx(j->getRangeMap()), jy(j->getRangeMap());
  x.randomize();
  y.randomize();
  j->apply(x, jx);
  j->apply(y, jy);
  EXPECT_NEAR(y.dot(jx), x.dot(jy), 1e-12 * x.norm2() * jy.norm2());
  const auto numbers = j->numbers();
  const auto constrained = problem.constrained(0);
  for (LocalIndex row = 0; row < numbers.n_rows(); ++row)
    numbers.for_row(row, [&](LocalIndex column, std::size_t k) {
      if (!constrained(row)) return;
      if (j->column_map()->getGlobalElement(column) == j->row_map()->getGlobalElement(row))
        EXPECT_GT(numbers.value(k), 0);
      else
        EXPECT_EQ(numbers.value(k), 0);
    });
}

/// The solution equals that of the dense matrix with the added diagonal. Other entries of the condensed matrix are
/// bitwise equal.
TEST(LocalElimination, AddsTheProximalDiagonalAndNothingElse) {
  for (int d : {2, 3}) {
    GridOptions options;
    options.d = d;
    GridProblem problem(Tpetra::getDefaultComm(), options);
    problem.jacobian(mixed_state(problem));
    LocalElimination without(problem), with(problem);
    ASSERT_EQ(without.update(problem).failure, "");
    const auto diagonal = rcp(new Vector(problem.blocks()[0].map));
    for (std::size_t i = 0; i < diagonal->getLocalLength(); ++i)
      diagonal->replaceLocalValue(i, 1 + 0.5 * std::sin(1.0 * diagonal->getMap()->getGlobalElement(i)));
    problem.added = diagonal;
    ASSERT_EQ(with.update(problem).failure, "");
    const auto a = without.condensed(0, 0), b = with.condensed(0, 0);
    const auto before = a->numbers(), after = b->numbers();
    const auto constrained = problem.constrained(0);
    for (LocalIndex row = 0; row < before.n_rows(); ++row)
      before.for_row(row, [&](LocalIndex column, std::size_t k) {
        if (constrained(row)) return;
        if (a->column_map()->getGlobalElement(column) == a->row_map()->getGlobalElement(row))
          EXPECT_NEAR(after.value(k) - before.value(k), diagonal->getData()[row], 1e-14);
        else
          EXPECT_EQ(after.value(k), before.value(k));
      });
    auto right = problem.zero(), x = problem.zero();
    const auto values = some_values(gather(right).size());
    scatter(values, right);
    CondensedSolve solve(problem, {});
    solve.update();
    ASSERT_TRUE(solve.solve(right, x, 1e-12).converged);
    auto matrix = gather_matrix(problem);
    const auto added = gather(*diagonal);
    for (std::size_t i = 0; i < added.size(); ++i)
      if (i / d % (options.nx * options.ny) >= std::size_t(options.nx) && i / d < added.size() / d - options.nx)
        matrix[i][i] += added[i];  // except the fixed and the moved row
    const auto exact = solve_dense(matrix, {values.begin(), values.end()});
    const auto found = gather(x);
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], exact[i], 1e-11) << "unknown " << i;
    problem.added = Teuchos::null;
    EXPECT_TRUE(with.update(problem).changed);
  }
}

std::vector<Real> values_of(const fields::Matrix& matrix) {
  const auto values = matrix.numbers().value;
  return {values.data(), values.data() + values.extent(0)};
}

std::vector<Real> bulk_of(const LocalElimination& elimination) {
  std::vector<Real> values;
  elimination.with_bulk(0, [&](const RCP<const fields::Matrix>& A) { values = values_of(*A); });
  return values;
}

/// Two eliminations that share the matrix of the problem, and the problem itself, see the same values as a problem
/// with its own matrix. Values are bitwise equal, while more and more rows differ.
TEST(LocalElimination, TakesThePlaceOfTheMatrix) {
  GridOptions options;
  options.ny = 12;
  for (int d : {2, 3}) {
    options.d = d;
    options.shares = false;
    GridProblem alone(Tpetra::getDefaultComm(), options);
    options.shares = true;
    GridProblem sharing(Tpetra::getDefaultComm(), options);
    LocalElimination own(alone), first(sharing);
    std::unique_ptr<LocalElimination> second;
    EXPECT_EQ(sharing.matrix().saved(0)->J(), first.condensed(0, 0));
    EXPECT_TRUE(sharing.matrix()(0, 0).is_null());
    EXPECT_EQ(first.condensed(0, 0)->numbers().width, d);
    const auto diagonal = rcp(new Vector(alone.blocks()[0].map));
    diagonal->putScalar(0.3);
    const auto x = mixed_state(alone), zero = alone.zero();
    auto there = alone.zero(), here = alone.zero();
    const auto n_history = [&] {
      const GlobalIndex here = sharing.matrix().saved(0)->rows().extent(0);
      GlobalIndex all = 0;
      Teuchos::reduceAll(*sharing.comm(), Teuchos::REDUCE_SUM, 1, &here, &all);
      return all;
    };
    std::vector<GlobalIndex> saved{n_history()};
    for (const auto& [state, added] :
         {std::pair{x, RCP<Vector>()}, {zero, RCP<Vector>()}, {x, diagonal}, {zero, RCP<Vector>()}}) {
      for (auto* problem : {&alone, &sharing}) {
        problem->added = added;
        problem->jacobian(state);
      }
      ASSERT_EQ(own.update(alone).failure, "");
      ASSERT_EQ(first.update(sharing).failure, "");
      if (!second) second = std::make_unique<LocalElimination>(sharing);
      ASSERT_EQ(second->update(sharing).failure, "");
      for (const auto* elimination : {&std::as_const(first), &std::as_const(*second)}) {
        EXPECT_EQ(bulk_of(*elimination), bulk_of(own));
        EXPECT_EQ(values_of(*elimination->condensed(0, 0)), values_of(*own.condensed(0, 0)));
      }
      alone.matrix().apply(x, there);
      sharing.matrix().apply(x, here);
      for (std::size_t b = 0; b < x.size(); ++b) {
        here[b]->update(-1, *there[b], 1);
        EXPECT_LE(here[b]->normInf(), 1e-14 * there[b]->normInf());
      }
      saved.push_back(n_history());
    }
    const GlobalIndex n = diagonal->getGlobalLength(), row = d * options.nx;  // 4 rows of nodes at the ends, 3 around
                                                                              // the faces
    EXPECT_EQ(saved, (std::vector<GlobalIndex>{3 * row, 7 * row, 7 * row, n, n}));
  }
}

TEST(LocalElimination, KnowsWhatChanged) {
  GridProblem problem(Tpetra::getDefaultComm(), {});
  LocalElimination elimination(problem);
  auto x = problem.zero();
  problem.jacobian(x);
  EXPECT_TRUE(elimination.update(problem).changed);
  problem.jacobian(x);
  EXPECT_FALSE(elimination.update(problem).changed);
  problem.jacobian(mixed_state(problem));
  EXPECT_TRUE(elimination.update(problem).changed);
}

TEST(LocalElimination, NamesASingularEntity) {
  GridOptions options;
  options.singular_face = 3;
  GridProblem problem(Tpetra::getDefaultComm(), options);
  auto x = problem.zero();
  x[2]->putScalar(1);  // open
  problem.jacobian(x);
  CondensedSolve solve(problem, {});
  solve.update();
  auto dx = problem.zero();
  const auto report = solve.solve(x, dx, 1e-10);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.reason, "local group 'contact': the matrix of entity 3 is singular");
  x[2]->putScalar(-1);  // closed: regular, so the solver recovers
  problem.jacobian(x);
  solve.update();
  EXPECT_TRUE(solve.solve(x, dx, 1e-10).converged);
}

TEST(SmallLu, TinyComponentsAreAccurate) {
  // Rows: two balances with bubble stiffness 1e10, two laws. Normal (0, 2) and tangential (1, 3) unknowns are
  // uncoupled.
  const int m = 4;
  const Real a[m * m] = {1e10, 0, 0.3, 0, 0, 2e10, 0, 0.7, -3e9, 0, 1e-1, 0, 0, -7e9, 0, 1};
  const Real b[m] = {1e7, 1e-4, -2e7, 3e-5};
  Dense dense(m, std::vector<long double>(m));
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) dense[i][j] = a[i * m + j];
  const auto exact = solve_dense(dense, {b, b + m});
  Real lu[m * m], x[m];
  std::copy(a, a + m * m, lu);
  std::copy(b, b + m, x);
  const Real scale[m] = {1e-3, 1e-3, 1e7, 1e7};
  int pivot[m];
  ASSERT_TRUE(solve::lu_factor(m, lu, pivot, scale));
  solve::lu_solve_refined(m, a, lu, pivot, x);
  for (int i = 0; i < m; ++i) EXPECT_NEAR(x[i] / Real(exact[i]), 1, 1e-14) << i;
}

TEST(SmallLu, FindsRankDeficiencyAtAnyScale) {
  for (Real size : {1e-20, 1.0, 1e20}) {
    Real a[9] = {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9};
    for (Real& value : a) value *= size;
    const Real scale[3] = {1, 1, 1};
    int pivot[3];
    EXPECT_FALSE(solve::lu_factor(3, a, pivot, scale));
    Real regular[9] = {1, 2, 3, 4, 5, 6, 7, 8, 10};
    for (Real& value : regular) value *= size;
    EXPECT_TRUE(solve::lu_factor(3, regular, pivot, scale));
  }
}

}  // namespace
}  // namespace sprekk::test
