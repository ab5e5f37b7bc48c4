// Newton's method when its step does not help: damping, floating blocks, and final messages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

#include "fake_problems.hpp"
#include "solve/time_stepping.hpp"

namespace sprekk::test {
namespace {

using solve::Newton;

ScalarProblem linear(Real slope_far, Real slope_near) {
  return {Tpetra::getDefaultComm(), 5, [](Real x, Real, Real) { return x; },
          [=](Real x, Real, Real) { return std::abs(x) > 0.6 ? slope_far : slope_near; }};
}

/// f = x with a derivative of wrong sign below 0.6: from 0.5 the step leads away from the solution.
TEST(Damping, HelpsWhereStepsLeadAway) {
  auto problem = linear(2, -1e-3);
  problem.resistance = 10;
  Newton newton(problem, {});
  auto x = problem.constant(1);
  const auto report = newton.solve(x);
  ASSERT_TRUE(report.converged) << report.reason;
  EXPECT_LE(report.measures[0].value, 1e-11);
  // Every step begins with the derivative itself: damping ends with the step that needed it.
  ASSERT_GE(problem.damps.size(), 5u);
  EXPECT_EQ(std::vector<Real>(problem.damps.begin(), problem.damps.begin() + 5),
            (std::vector<Real>{0, 0.1, 0, 0.1, 0}));
  problem.damps.clear();
  auto again = problem.constant(1);
  EXPECT_TRUE(newton.solve(again).converged);
  EXPECT_EQ(problem.damps.front(), 0);
}

/// Damping increases tenfold while steps lead away; after a full step it decreases to a tenth, then to zero.
TEST(Damping, GrowsAsFarAsNeededAndFalls) {
  auto problem = linear(2, -0.5);
  problem.resistance = 1.4;  // with damping 0.1 (slope -0.36) the step still leads away; with 1 (slope 0.9) it leads
                             // near the solution
  Newton newton(problem, {});
  auto x = problem.constant(1);
  const auto report = newton.solve(x);
  ASSERT_TRUE(report.converged) << report.reason;
  ASSERT_GE(problem.damps.size(), 5u);
  const Real expected[] = {0, 0.1, 1, 0.1, 0};
  for (int k = 0; k < 5; ++k) EXPECT_NEAR(problem.damps[k], expected[k], 1e-15);
}

TEST(Damping, RescuesASingularMatrix) {
  auto problem = linear(0, 0);
  {
    Newton newton(problem, {});
    auto x = problem.constant(1);
    const auto report = newton.solve(x);
    EXPECT_FALSE(report.converged);
    EXPECT_NE(report.reason.find("singular"), std::string::npos) << report.reason;
    EXPECT_EQ(problem.damps, (std::vector<Real>{0, 0.1, 1, 10}));
  }
  problem.resistance = 10;
  problem.damps.clear();
  Newton newton(problem, {});
  auto x = problem.constant(1);
  const auto report = newton.solve(x);
  ASSERT_TRUE(report.converged) << report.reason;
  EXPECT_EQ(report.reason, "");
  EXPECT_EQ(problem.damps, (std::vector<Real>{0, 0.1, 0}));
  EXPECT_NEAR(x[0]->normInf(), 0, 1e-12);
}

/// The only step is damped, with the derivative 1. The derivative at its end is 2; the linearised solve uses this
/// value.
TEST(Damping, IsNoPartOfLinearizedSolves) {
  Real near = 2;
  ScalarProblem problem(
      Tpetra::getDefaultComm(), 5, [](Real x, Real, Real) { return x; },
      [&](Real x, Real, Real) { return std::abs(x) > 0.6 ? 0 : near; });
  problem.resistance = 10;
  Newton newton(problem, {});
  auto x = problem.constant(1), solution = problem.constant(0);
  const auto report = newton.solve(x);
  ASSERT_TRUE(report.converged) << report.reason;
  ASSERT_EQ(problem.damps, (std::vector<Real>{0, 0.1, 0}));
  near = 5;
  ASSERT_TRUE(newton.solve_linearized(x, problem.constant(1), solution, 1e-12).converged);
  for (std::size_t i = 0; i < solution[0]->getLocalLength(); ++i) EXPECT_NEAR(solution[0]->getData()[i], 0.5, 1e-12);
}

/// Full steps lead to -0.9 of the start, so the states change in each step. With the damping of the third step the
/// derivative is exact.
TEST(Damping, OfStatesThatGoToAndFro) {
  auto problem = linear(1 / 1.9, 1 / 1.9);
  problem.resistance = (1 - 1 / 1.9) / 0.3;
  Newton newton(problem, {});
  auto x = problem.constant(1);
  EXPECT_FALSE(newton.solve(x).converged);
  problem.state_of = [](Real x) { return x > 0; };
  problem.damps.clear();
  x = problem.constant(1);
  const auto report = newton.solve(x);
  ASSERT_TRUE(report.converged) << report.reason;
  EXPECT_EQ(report.iterations, 4);
  EXPECT_EQ(problem.damps, (std::vector<Real>{0, 0.3, 0}));
}

/// The merit decreases by a factor of 0.998 per step.
TEST(Newton, EndsWithoutProgress) {
  auto problem = linear(1 / 1.999, 1 / 1.999);
  Newton newton(problem, {});
  auto x = problem.constant(1);
  const auto report = newton.solve(x);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 10);
  EXPECT_EQ(report.reason, "no progress in 10 iterations: 'r' is 9.90e-01, required is 1e-11");
}

TEST(Damping, SaysWhereNothingHelps) {
  auto problem = linear(2, -1e-3);
  Newton newton(problem, {});
  auto x = problem.constant(1);
  const auto report = newton.solve(x);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.reason, "no step along Newton's direction brings the iterate nearer to a solution");
  EXPECT_EQ(problem.damps, (std::vector<Real>{0, 0.1, 1, 10}));
  for (std::size_t i = 0; i < x[0]->getLocalLength(); ++i) EXPECT_EQ(x[0]->getData()[i], 0.5);  // the last iterate
}

/// From 0, the path to the solution 5 leads over 3, where the merit is four thousand times as large. The step is
/// accepted if the contact state at 3 is different.
TEST(Damping, SearchRestartsInOtherStates) {
  const auto region = [](Real x) { return x < -1 ? 0 : x < 1e-4 ? 1 : 2; };
  for (const bool states : {true, false}) {
    ScalarProblem problem(
        Tpetra::getDefaultComm(), 5,
        [=](Real x, Real, Real) { return region(x) == 2 ? 100 * (x - 5) : x - 3 * region(x); },
        [=](Real x, Real, Real) { return region(x) == 2 ? 100 : 1; });
    if (states) problem.state_of = [=](Real x) { return static_cast<char>(region(x)); };
    Newton newton(problem, {});
    auto x = problem.constant(-10);
    const auto report = newton.solve(x);
    EXPECT_EQ(report.converged, states) << report.reason;
    for (const Real found : x[0]->getData()) EXPECT_NEAR(found, states ? 5 : 0, 1e-12);
  }
}

/// exp(-x) decreases without a zero: each step increases x by one.
TEST(FreeBodies, ThatFindNoResistanceEndNewton) {
  ScalarProblem problem(
      Tpetra::getDefaultComm(), 4, [](Real x, Real, Real) { return std::exp(-x); },
      [](Real x, Real, Real) { return -std::exp(-x); });
  problem.free_body = "a stone can move along (1, 0)";
  Newton newton(problem, {});
  auto x = problem.constant(0);
  const auto report = newton.solve(x);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.reason, "no resistance to the loads found: a stone can move along (1, 0), and meets none");
  EXPECT_EQ(report.floating, problem.free_body);
  for (std::size_t i = 0; i < x[0]->getLocalLength(); ++i) EXPECT_NEAR(x[0]->getData()[i], 3, 1e-12);
  solve::TimeStepper stepper(problem, newton, {});
  x = problem.constant(0);
  Real t = 0;
  const auto step = stepper.advance(x, t, 1);
  EXPECT_FALSE(step.converged);
  EXPECT_THAT(step.reason,
              testing::StartsWith("no equilibrium found: in the last iterates a stone can move along (1, 0), "
                                  "and nothing constrains it; t = "));
}

/// A floating body in equilibrium is reported, without failure.
TEST(FreeBodies, InEquilibriumAreReported) {
  auto problem = linear(1, 1);
  problem.free_body = "a stone";
  Newton newton(problem, {});
  solve::TimeStepper stepper(problem, newton, {});
  auto x = problem.constant(1);
  Real t = 0;
  const auto step = stepper.advance(x, t, 1);
  EXPECT_TRUE(step.converged) << step.reason;
  EXPECT_EQ(step.floating, "a stone");
}

}  // namespace
}  // namespace sprekk::test
