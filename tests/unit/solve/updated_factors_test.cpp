// Solves with factors of an earlier matrix after changes of local groups.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

#include "dense.hpp"
#include "solve/condensed_solve.hpp"

namespace sprekk::test {
namespace {

constexpr int n_states = 40;

/// Solves at states with different open faces and returns the number of factorisations. The solutions of every tenth
/// state equal those of the dense matrix. No solve with the factors needs refinement. `only_rows`: right sides are zero
/// except in the normal tractions, whose rows change.
int factorisations(const GridOptions& grid, const solve::LinearSolverOptions& options, bool only_rows = false) {
  auto unshared = grid;
  unshared.shares = false;
  GridProblem problem(Tpetra::getDefaultComm(), grid), whole(Tpetra::getDefaultComm(), unshared);
  solve::CondensedSolve solve(problem, options);
  auto state = problem.zero(), b = problem.zero(), x = problem.zero();
  const std::size_t first = gather(b).size() - b.back()->getGlobalLength();  // traction
  for (int k = 0; k < n_states; ++k) {
    std::vector<Real> values(gather(b).size());
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(3.7 * i + k);
    scatter(values, state);
    for (std::size_t i = 0; i < values.size() && only_rows; ++i)
      if (i < first || (i - first) % grid.d != 0) values[i] = 0;
    scatter(values, b);
    problem.jacobian(state);
    whole.jacobian(state);
    solve.update();
    const auto report = solve.solve(b, x, 1e-12);
    EXPECT_TRUE(report.converged) << report.reason;
    EXPECT_TRUE(!solve.follows() || report.iterations == 1) << "state " << k;
    if (k % 10 != 9) continue;
    const auto exact = solve_dense(gather_matrix(whole), {values.begin(), values.end()});
    const auto found = gather(x);
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], exact[i], 1e-8) << "unknown " << i;
  }
  return solve.n_setups();
}

GridOptions large_grid(int d) {
  GridOptions options;
  options.d = d;
  options.nx = d == 2 ? 16 : 12;
  options.ny = d == 2 ? 16 : 12;
  options.shares = true;
  return options;
}

TEST(UpdatedFactors, ReplaceFactorisations) {
  for (const int d : {2, 3}) EXPECT_LT(factorisations(large_grid(d), {}), n_states / 2);
}

TEST(UpdatedFactors, SolveForRightSidesOfTheChangedRows) {
  for (const int d : {2, 3}) EXPECT_LT(factorisations(large_grid(d), {}, true), n_states / 2);
}

/// Bitwise reproducible solves have factors of their own matrix.
TEST(UpdatedFactors, AreNotUsedForReproducibleSolves) {
  solve::LinearSolverOptions options;
  options.reproducible = true;
  EXPECT_EQ(factorisations(large_grid(2), options), n_states);
}

/// A diagonal that is added to the matrix requires new factors.
TEST(UpdatedFactors, AreDiscardedAfterOtherChanges) {
  GridProblem problem(Tpetra::getDefaultComm(), large_grid(2));
  solve::CondensedSolve solve(problem, {});
  auto b = problem.zero(), x = problem.zero(), state = problem.zero();
  std::vector<Real> values(gather(b).size());
  const auto diagonal = rcp(new Vector(problem.blocks()[0].map));
  diagonal->putScalar(1);
  for (int k = 0; k < n_states; ++k) {
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = std::sin(3.7 * i + k);
    scatter(values, state);
    scatter(values, b);
    problem.added = Teuchos::null;
    if (k % 10 == 9) problem.added = diagonal;
    const int before = solve.n_setups();
    problem.jacobian(state);
    solve.update();
    EXPECT_TRUE(solve.solve(b, x, 1e-12).converged);
    if (k > 0 && (k % 10 == 9 || k % 10 == 0)) EXPECT_EQ(solve.n_setups(), before + 1) << "state " << k;
  }
}

}  // namespace
}  // namespace sprekk::test
