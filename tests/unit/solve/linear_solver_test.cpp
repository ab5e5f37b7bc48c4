#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

#include "base/check.hpp"
#include "dense.hpp"
#include "solve/condensed_solve.hpp"
#include "unit/multigrid/truss.hpp"

namespace sprekk::test {
namespace {

using solve::CondensedSolve;
using solve::LinearSolverOptions;

solve::LinearSystem system_of(const RCP<CrsMatrix>& matrix, const Block& block, bool symmetric) {
  const auto joined = std::make_shared<solve::Joined>(std::vector{block.map});
  return {joined, {wrapped(matrix)}, symmetric, {{block, wrapped(matrix), {}}}, matrix};
}

/// Builds A x = b with a known x and checks the solution.
void expect_solved(const RCP<CrsMatrix>& matrix, const Block& block, bool symmetric, solve::LinearSolver& solver) {
  ASSERT_EQ(solver.setup(system_of(matrix, block, symmetric)), "");
  for (int again = 0; again < 2; ++again) {
    Vector exact(block.map), b(block.map), x(block.map);
    for (std::size_t i = 0; i < exact.getLocalLength(); ++i)
      exact.replaceLocalValue(i, std::cos(0.1 * block.map->getGlobalElement(i)));
    matrix->apply(exact, b);
    const auto report = solver.solve(b, x, 1e-12);
    ASSERT_TRUE(report.converged) << report.reason;
    EXPECT_LE(report.residual, 1e-10);
    x.update(-1, exact, 1);
    EXPECT_LE(x.normInf(), 1e-9);
    matrix->resumeFill();  // other values on the same graph
    matrix->scale(2);
    matrix->fillComplete(matrix->getDomainMap(), matrix->getRangeMap());
    ASSERT_EQ(solver.setup(system_of(matrix, block, symmetric)), "");
  }
}

/// Constrained grid as one matrix.
struct Grid {
  explicit Grid(int n, int d = 2) : problem(Tpetra::getDefaultComm(), {d, n, n, false, true, -1}) {
    solve::LocalElimination elimination(problem);
    elimination.update(problem);
    matrix = rcp(new CrsMatrix(*elimination.condensed(0, 0)->crs(), Teuchos::Copy));
  }
  GridProblem problem;
  RCP<CrsMatrix> matrix;
};

TEST(DirectSolver, SolvesSymmetricAndUnsymmetric) {
  for (const auto& [symmetric, max_ranks] : {std::pair{true, 9}, {false, 9}, {true, 1}, {false, 1}, {false, 2}}) {
    Grid grid(12);
    if (!symmetric) {
      Vector scale(grid.matrix->getRowMap());
      for (std::size_t i = 0; i < scale.getLocalLength(); ++i)
        scale.replaceLocalValue(i, 1 + 0.1 * (grid.matrix->getRowMap()->getGlobalElement(i) % 7));
      grid.matrix->leftScale(scale);
    }
    const auto solver = solve::make_direct_solver({}, max_ranks);
    expect_solved(grid.matrix, grid.problem.blocks()[0], symmetric, *solver);
  }
}

/// Factors act on all columns of a multivector together.
TEST(DirectSolver, SubstitutesSeveralColumns) {
  constexpr int n_columns = 3;
  for (const int max_ranks : {9, 1}) {
    Grid grid(6);
    const auto map = grid.matrix->getRowMap();
    const auto solver = solve::make_direct_solver({}, max_ranks);
    ASSERT_EQ(solver->setup(system_of(grid.matrix, grid.problem.blocks()[0], true)), "");
    fields::MultiVector exact(map, n_columns), b(map, n_columns), x(map, n_columns);
    for (int k = 0; k < n_columns; ++k)
      for (std::size_t i = 0; i < exact.getLocalLength(); ++i)
        exact.replaceLocalValue(i, k, std::cos((k + 1.0) * map->getGlobalElement(i)));
    grid.matrix->apply(exact, b);
    solver->preconditioner()->apply(b, x);
    x.update(-1, exact, 1);
    for (int k = 0; k < n_columns; ++k) EXPECT_LE(x.getVector(k)->normInf(), 1e-9) << "column " << k;
    solver->preconditioner()->apply(*b.getVector(1), *x.getVectorNonConst(1));  // another number of columns
    x.getVectorNonConst(1)->update(-1, *exact.getVector(1), 1);
    EXPECT_LE(x.getVector(1)->normInf(), 1e-9);
  }
}

TEST(DirectSolver, SolvesWhereMostRanksHaveNoRows) {
  const auto comm = Tpetra::getDefaultComm();
  const auto map = make_map(
      comm->getRank() == comm->getSize() - 1 ? std::vector<GlobalIndex>{0, 1, 2} : std::vector<GlobalIndex>{}, comm);
  Filler fill(map, map);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) fill.add(i, j, i == j ? 4 : i + 0.5 * j);
  const auto solver = solve::make_direct_solver({});
  expect_solved(fill.done(), {"few", map, 1, 1, 1, Teuchos::null, {}}, false, *solver);
}

TEST(DirectSolver, ReportsASingularMatrix) {
  for (const auto& [structural, max_ranks] : {std::pair{true, 9}, {false, 9}, {true, 1}, {false, 1}, {false, 2}}) {
    const auto comm = Tpetra::getDefaultComm();
    std::vector<GlobalIndex> mine;
    for (int i = comm->getRank(); i < 6; i += comm->getSize()) mine.push_back(i);
    const auto map = make_map(mine, comm);
    Filler fill(map, map);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) fill.add(i, j, structural ? (j < 3) : i * 6 + j);  // rank 1 or 2
    const auto matrix = fill.done();
    const auto solver = solve::make_direct_solver({}, max_ranks);
    const std::string failure = solver->setup(system_of(matrix, {"s", map, 1, 1, 1, Teuchos::null, {}}, false));
    Vector b(map), x(map);
    for (std::size_t i = 0; i < b.getLocalLength(); ++i) b.replaceLocalValue(i, std::cos(map->getGlobalElement(i)));
    const auto report = solver->solve(b, x, 1e-10);
    EXPECT_FALSE(report.converged);
    EXPECT_NE(report.reason.find("singular"), std::string::npos) << report.reason;
  }
}

/// MUMPS replaces the small pivots 2 by 5: the factors are of another matrix. Refinement reduces the error to a third
/// per step. GMRES needs one step per replaced pivot, and one more.
TEST(DirectSolver, SolvesWithFactorsOfAnotherMatrix) {
  constexpr int n = 40, n_small = 5;
  const auto map = rcp(new fields::Map(n, 0, Tpetra::getDefaultComm()));
  Filler fill(map, map);
  for (int i = 0; i < n; ++i)
    for (int j = std::max(0, i - 1); j < std::min(n, i + 2); ++j)
      fill.add(i, j, i != j ? -1 : i % (n / n_small) == 3 ? 2 : 10);
  Teuchos::ParameterList controls;
  controls.set("ICNTL(8)", 0).set("CNTL(1)", 0.0).set("CNTL(4)", 5.0);
  const auto solver = solve::make_direct_solver(controls);
  const auto matrix = fill.done();
  ASSERT_EQ(solver->setup(system_of(matrix, {"s", map, 1, 1, 1, Teuchos::null, {}}, false)), "");
  Vector b(map), x(map), r(map);
  for (std::size_t i = 0; i < b.getLocalLength(); ++i) b.replaceLocalValue(i, std::cos(map->getGlobalElement(i)));
  const auto report = solver->solve(b, x, 1e-10);
  EXPECT_TRUE(report.converged) << report.reason;
  EXPECT_GT(report.iterations, 1);
  EXPECT_LE(report.iterations, 1 + n_small + 1);
  EXPECT_LT(solve::relative_residual(*matrix, b, x, r), solve::acceptable_linear_residual);
}

TEST(DirectSolver, RefusesUnknownParameters) {
  Teuchos::ParameterList list;
  list.set("ICNTL(99)", 1);
  EXPECT_THROW(solve::make_direct_solver(list), Error);
}

TEST(IterativeSolver, SolvesSymmetricAndUnsymmetric) {
  for (bool symmetric : {true, false}) {
    Grid grid(48);
    LinearSolverOptions options;
    const auto solver = solve::make_iterative_solver(options, grid.problem.blocks());
    expect_solved(grid.matrix, grid.problem.blocks()[0], symmetric, *solver);
  }
}

/// The set-up temporarily increases the diagonal.
TEST(IterativeSolver, LeavesTheMatrixAsItWas) {
  Grid grid(48);
  const auto values = grid.matrix->getLocalMatrixHost().values;
  const std::vector<Real> before(values.data(), values.data() + values.extent(0));
  const auto solver = solve::make_iterative_solver({}, grid.problem.blocks());
  ASSERT_EQ(solver->setup(system_of(grid.matrix, grid.problem.blocks()[0], true)), "");
  EXPECT_EQ(std::vector<Real>(values.data(), values.data() + values.extent(0)), before);
}

TEST(IterativeSolver, NeedsFewIterationsAtAnySize) {
  for (int n : {32, 64}) {
    Grid grid(n);
    const auto solver = solve::make_iterative_solver({}, grid.problem.blocks());
    ASSERT_EQ(solver->setup(system_of(grid.matrix, grid.problem.blocks()[0], true)), "");
    Vector b(grid.matrix->getRangeMap()), x(grid.matrix->getDomainMap());
    b.putScalar(1);
    const auto report = solver->solve(b, x, 1e-8);
    EXPECT_TRUE(report.converged) << report.reason;
    EXPECT_LE(report.iterations, 25);
  }
}

/// Returns the number of multigrid set-ups if the diagonal of the first `n_changed` rows of each rank increases by
/// half.
int setups_after(LocalIndex n_changed) {
  Grid grid(48);
  const auto& block = grid.problem.blocks()[0];
  const auto solver = solve::make_iterative_solver({}, grid.problem.blocks());
  Vector b(grid.matrix->getRangeMap()), x(grid.matrix->getDomainMap());
  b.putScalar(1);
  for (const LocalIndex n : {LocalIndex(0), n_changed}) {
    const auto local = grid.matrix->getLocalMatrixHost();
    const auto &rows = *grid.matrix->getRowMap(), &columns = *grid.matrix->getColMap();
    for (LocalIndex row = 0; row < std::min(n, local.numRows()); ++row)
      for (auto k = local.graph.row_map(row); k < local.graph.row_map(row + 1); ++k)
        if (columns.getGlobalElement(local.graph.entries(k)) == rows.getGlobalElement(row)) local.values(k) *= 1.5;
    EXPECT_EQ(solver->setup(system_of(grid.matrix, block, true)), "");
    const auto report = solver->solve(b, x, 1e-10);
    EXPECT_TRUE(report.converged && report.residual < 1e-9) << report.residual;
  }
  return solver->costs().front().n_setups;
}

TEST(IterativeSolver, KeepsMultigridWhileFewRowsChange) {
  EXPECT_EQ(setups_after(4), 1);
  EXPECT_EQ(setups_after(40), 2);
}

/// The Krylov space has one vector.
TEST(IterativeSolver, SolvesWhatItsPreconditionerInverts) {
  const int n = 2000;
  const auto map = rcp(new Map(n, 0, Tpetra::getDefaultComm()));
  const auto matrix = rcp(new CrsMatrix(map, 1));
  for (const GlobalIndex row : base::local_elements(*map)) {
    const Real two = 2;
    matrix->insertGlobalValues(row, 1, &two, &row);
  }
  matrix->fillComplete();
  for (const bool symmetric : {true, false}) {
    const Block block{"u", map, 1, 1, 1, Teuchos::null, {}};
    const auto solver = solve::make_iterative_solver({}, {block});
    ASSERT_EQ(solver->setup(system_of(matrix, block, symmetric)), "");
    Vector b(map), x(map);
    b.putScalar(1);
    const auto report = solver->solve(b, x, 1e-8);
    EXPECT_TRUE(report.converged) << report.reason;
    EXPECT_LT(report.residual, 1e-8);
  }
}

/// For unsymmetric matrices, multigrid is set up again with a test of its cycles only after a long solve.
TEST(IterativeSolver, LooksAtMultigridOnceASolveIsLong) {
  for (const Real skew : {0.0, 0.3}) {
    const Truss truss(11, true, skew);
    std::vector<GlobalIndex> nodes;
    for (std::size_t i = 0; i < base::n_local_elements(*truss.map); i += 3)
      nodes.push_back(truss.map->getGlobalElement(static_cast<LocalIndex>(i)) / 3);
    const GlobalIndex n_nodes = truss.map->getGlobalNumElements() / 3;
    const auto node_map = rcp(new Map(n_nodes, Teuchos::arrayViewFromVector(nodes), 0, truss.map->getComm()));
    const auto places = rcp(new fields::MultiVector(node_map, 3));
    for (std::size_t i = 0; i < nodes.size(); ++i)
      for (int k = 0; k < 3; ++k) places->replaceLocalValue(static_cast<LocalIndex>(i), k, truss.place(nodes[i])[k]);
    const Block block{"u", truss.map, 3, 1, 1, places, {6, [&] { return truss.modes; }}};
    const auto solver = solve::make_iterative_solver({}, {block});
    ASSERT_EQ(solver->setup(system_of(truss.matrix, block, false)), "");
    Vector b(truss.map), x(truss.map);
    for (std::size_t i = 0; i < b.getLocalLength(); ++i)
      b.replaceLocalValue(i, std::sin(1.0 * truss.map->getGlobalElement(i)));
    for (int again = 0; again < 2; ++again) {
      const auto report = solver->solve(b, x, 1e-8);
      EXPECT_TRUE(report.converged) << report.reason;
      EXPECT_EQ(report.iterations > 40, skew != 0) << report.iterations;
      EXPECT_EQ(solver->costs().front().n_setups, skew == 0 ? 1 : 2);
    }
  }
}

TEST(IterativeSolver, SolvesLessThanACoarseLevel) {
  Grid grid(4);
  const auto solver = solve::make_iterative_solver({}, grid.problem.blocks());
  expect_solved(grid.matrix, grid.problem.blocks()[0], true, *solver);
}

TEST(IterativeSolver, ReportsWhatDidNotConverge) {
  Grid grid(32);
  LinearSolverOptions options;
  options.belos.set("Maximum Iterations", 2);
  const auto solver = solve::make_iterative_solver(options, grid.problem.blocks());
  ASSERT_EQ(solver->setup(system_of(grid.matrix, grid.problem.blocks()[0], true)), "");
  Vector b(grid.matrix->getRangeMap()), x(grid.matrix->getDomainMap());
  b.putScalar(1);
  const auto report = solver->solve(b, x, 1e-10);
  EXPECT_FALSE(report.converged);
  EXPECT_NE(report.reason.find("after 2 iterations"), std::string::npos) << report.reason;
}

TEST(IterativeSolver, AggregatesByTheBulkAndSolvesContact) {
  GridProblem problem(Tpetra::getDefaultComm(), {2, 40, 40, true, true, -1});
  LinearSolverOptions options;
  options.type = "iterative";
  CondensedSolve solve(problem, options);
  auto x = problem.zero(), b = problem.zero(), dx = problem.zero(), r = problem.zero();
  for (Real state : {1.0, -1.0, 1.0}) {  // all open, closed, open again with the same hierarchy
    x[2]->putScalar(state);
    problem.jacobian(x);
    solve.update();
    for (auto& v : b) v->putScalar(1);
    const auto report = solve.solve(b, dx, 1e-10);
    ASSERT_TRUE(report.converged) << report.reason;
    EXPECT_LE(report.iterations, 40);
    problem.matrix().apply(dx, r);
    for (std::size_t block = 0; block < r.size(); ++block)
      for (std::size_t i = 0; i < r[block]->getLocalLength(); ++i)
        if (block > 0 || !problem.constrained(0)(i)) {
          EXPECT_NEAR(r[block]->getData()[i], 1, 1e-7);
        }
  }
  EXPECT_EQ(solve.n_setups(), 3);
}

/// Face unknowns that are not eliminated: the solution equals that with elimination, for very different units.
TEST(CondensedSolve, SolvesForSeveralBlocksAtOnce) {
  const auto comm = Tpetra::getDefaultComm();
  GridProblem eliminated(comm, {2, 40, 40, true, true, -1});
  GridOptions options{2, 40, 40, true, true, -1};
  options.eliminate = false;
  GridProblem together(comm, options);
  for (const std::string type : {"direct", "iterative"}) {
    LinearSolverOptions linear;
    linear.type = type;
    CondensedSolve reference(eliminated, {}), solve(together, linear);
    auto b = together.zero(), expected = together.zero(), dx = together.zero(), x = together.zero();
    for (Real state : {1.0, -1.0}) {
      x[2]->putScalar(state);
      for (GridProblem* problem : {&eliminated, &together}) problem->jacobian(x);
      for (auto& v : b) v->putScalar(1);
      reference.update();
      solve.update();
      ASSERT_TRUE(reference.solve(b, expected, 1e-12).converged);
      const auto report = solve.solve(b, dx, 1e-12);
      if (type == "iterative" && state < 0) {  // closed: tractions have a zero diagonal block
        EXPECT_FALSE(report.converged);
        EXPECT_NE(report.reason.find("block 'traction': its matrix has zeros"), std::string::npos) << report.reason;
        continue;
      }
      ASSERT_TRUE(report.converged) << report.reason;
      EXPECT_LE(report.iterations, 60) << type;
      for (std::size_t k = 0; k < dx.size(); ++k) {
        const Real size = expected[k]->normInf();
        expected[k]->update(-1, *dx[k], 1);
        EXPECT_LE(expected[k]->normInf(), 1e-8 * size) << type << ", block " << k;
      }
    }
  }
}

TEST(MakeLinearSolver, ChoosesBySizeAndSaysWhy) {
  Grid grid(6);
  LinearSolverOptions options;
  options.direct_limit_2d = 72;
  EXPECT_EQ(make_linear_solver(options, grid.problem.blocks()).reason, "direct: 2D with 72 unknowns; direct up to 72");
  options.direct_limit_2d = 71;
  const auto name = grid.problem.blocks()[0].name;
  options.preconditioner.blocks[name].multigrid.emplace().coarsest =
      20;  // otherwise it would have the size of a coarsest level
  const auto chosen = make_linear_solver(options, grid.problem.blocks());
  EXPECT_EQ(chosen.reason, "iterative: 2D with 72 unknowns; direct up to 71");
  for (const auto& part : {name + " -> ", std::string("type = multigrid"), std::string("coarsest level = 20")})
    EXPECT_NE(chosen.describe().find(part), std::string::npos) << part << "\n" << chosen.describe();
}

}  // namespace
}  // namespace sprekk::test
