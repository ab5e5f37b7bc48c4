#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

#include "dense.hpp"
#include "solve/time_stepping.hpp"

namespace sprekk::test {
namespace {

using solve::Newton;
using solve::NewtonOptions;
using solve::TimeStepper;

/// Returns the problem x = t for steps up to `largest`; longer steps have no solution.
ScalarProblem impatient(Real largest) {
  return ScalarProblem(
      Tpetra::getDefaultComm(), 4, [largest](Real x, Real t, Real dt) { return dt <= largest ? x - t : 1 + x * x; },
      [largest](Real x, Real, Real dt) { return dt <= largest ? 1 : 2 * x + 1e-3; });
}

TEST(TimeStepper, CutsAndGrowsBack) {
  auto problem = impatient(0.3);
  NewtonOptions options;
  options.max_iterations = 5;
  Newton newton(problem, options);
  TimeStepper stepper(problem, newton, {});
  auto x = problem.constant(2);
  Real t = 2;
  const auto report = stepper.advance(x, t, 3);
  ASSERT_TRUE(report.converged) << report.reason;
  EXPECT_EQ(t, 3);
  EXPECT_EQ(problem.committed_times, (std::vector<Real>{2.25, 2.5, 2.75, 3}));
  EXPECT_EQ(report.time, 3);
  EXPECT_EQ(report.substeps, 4);
  EXPECT_GE(report.cuts, 2);
  EXPECT_GT(report.newton_iterations, 4 + 2 * 5 - 1);
  EXPECT_NEAR(x[0]->normInf(), 3, 1e-12);
}

/// Returns a problem whose derivative has the wrong sign far from the solution 3, without a proximal term.
ScalarProblem misled() {
  return ScalarProblem(
      Tpetra::getDefaultComm(), 4, [](Real x, Real, Real) { return x - 3; },
      [](Real x, Real, Real) { return std::abs(x - 3) > 1 ? -0.05 : 1; });
}

TEST(TimeStepper, CreepsWhereNewtonFails) {
  auto problem = misled();
  problem.proximal_stiffness = 1;
  Newton newton(problem, {});
  TimeStepper stepper(problem, newton, {});
  auto x = problem.constant(0);
  Real t = 0;
  const auto report = stepper.advance(x, t, 1);
  ASSERT_TRUE(report.converged) << report.reason;
  EXPECT_EQ(report.cuts, 0);
  EXPECT_EQ(report.substeps, 1);
  EXPECT_EQ(problem.committed_times, (std::vector<Real>{1}));
  for (std::size_t i = 0; i < x[0]->getLocalLength(); ++i) EXPECT_NEAR(x[0]->getData()[i], 3, 1e-11);
  ASSERT_GT(problem.proximal_terms.size(), 3u);
  EXPECT_EQ(problem.proximal_terms.front(), 10);
  EXPECT_EQ(problem.proximal_terms.back(), 0);
}

/// Proximal continuation fails in the whole step, but not in the smallest substep.
TEST(TimeStepper, CreepsAgainInTheSmallestSubstep) {
  ScalarProblem problem(
      Tpetra::getDefaultComm(), 4, [](Real x, Real, Real dt) { return dt <= 0.3 ? x - 3 : 1 + x * x; },
      [](Real x, Real, Real dt) { return dt > 0.3              ? 2 * x + 1e-3
                                         : std::abs(x - 3) > 1 ? -0.05
                                                               : 1; });
  problem.proximal_stiffness = 1;
  Newton newton(problem, {});
  TimeStepper stepper(problem, newton, {.max_halvings = 2});
  auto x = problem.constant(0);
  Real t = 0;
  const auto report = stepper.advance(x, t, 1);
  ASSERT_TRUE(report.converged) << report.reason;
  EXPECT_EQ(problem.committed_times, (std::vector<Real>{0.25, 0.5, 0.75, 1}));
}

TEST(TimeStepper, HalvesThreeTimesBeforeProximalContinuationWhereShorterStepsAreEasier) {
  auto problem = misled();
  problem.proximal_stiffness = 1;
  problem.storing = true;
  Newton newton(problem, {});
  TimeStepper stepper(problem, newton, {});
  auto x = problem.constant(0);
  Real t = 0;
  const auto report = stepper.advance(x, t, 1);
  ASSERT_TRUE(report.converged) << report.reason;
  EXPECT_EQ(report.cuts, 3);
  EXPECT_EQ(problem.committed_times.front(), 0.125);
  EXPECT_FALSE(problem.proximal_terms.empty());
}

/// Newton's method overshoots by a fifth of each step in substeps longer than `largest`, so the states change in each
/// iteration. Halving ends with an eighth of the step.
TEST(TimeStepper, HalvesWhereStatesChangeOftenAndShorterStepsAreEasier) {
  const auto committed = [](bool storing, Real largest) {
    Real end = 0;
    ScalarProblem problem(
        Tpetra::getDefaultComm(), 4, [&](Real x, Real t, Real) { return x - (end = t); },
        [=](Real, Real, Real dt) { return dt <= largest ? 1 : 1 / 1.2; });
    problem.state_of = [&](Real x) { return x > end; };
    problem.storing = storing;
    Newton newton(problem, {});
    TimeStepper stepper(problem, newton, {});
    auto x = problem.constant(2);
    Real t = 2;
    const auto report = stepper.advance(x, t, 3);
    EXPECT_TRUE(report.converged) << report.reason;
    for (const Real found : x[0]->getData()) EXPECT_NEAR(found, 3, 1e-10);
    EXPECT_TRUE(problem.proximal_terms.empty());
    return problem.committed_times;
  };
  EXPECT_EQ(committed(false, 0.3), (std::vector<Real>{3}));
  EXPECT_EQ(committed(true, 0.3), (std::vector<Real>{2.25, 2.5, 2.75, 3}));
  EXPECT_EQ(committed(true, 0.01).size(), 8u);
}

/// Each attempt ends after four linear solves with different dampings, the proximal continuation after eleven attempts.
TEST(TimeStepper, EndsAfterManyFailedLinearSolves) {
  ScalarProblem problem(
      Tpetra::getDefaultComm(), 4, [](Real x, Real, Real) { return 1 + x * x; }, [](Real, Real, Real) { return 0; });
  Newton newton(problem, {});
  TimeStepper stepper(problem, newton, {});
  auto x = problem.constant(0);
  Real t = 0;
  const auto report = stepper.advance(x, t, 1);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.linear_solves.size(), 4u * (1 + 11 + 6 + 8));  // proximal continuation at first and at last
  EXPECT_EQ(report.cuts, 6);
  EXPECT_NE(report.reason.find("; more than 100 linear solves failed"), std::string::npos) << report.reason;
  EXPECT_NE(report.reason.find("singular"), std::string::npos) << report.reason;
}

/// Newton directions that are twenty times too long: after the first step, step lengths of 1/16 reduce the error to a
/// quarter each.
TEST(Newton, GivesUpShortStepsWhereShorterTimeStepsAreEasier) {
  for (const bool storing : {false, true}) {
    ScalarProblem problem(
        Tpetra::getDefaultComm(), 4, [](Real x, Real, Real) { return x - 3; }, [](Real, Real, Real) { return 0.05; });
    problem.storing = storing;
    Newton newton(problem, {});
    auto x = problem.constant(0);
    const auto report = newton.solve(x);
    EXPECT_EQ(report.converged, !storing);
    EXPECT_EQ(report.iterations < 7, storing) << report.iterations;
  }
}

/// The same problem without contact: no iteration is spent on proximal terms without effect.
TEST(TimeStepper, HasNoProximalContinuationWithoutContact) {
  const auto iterations = [](bool proximal_terms) {
    auto problem = misled();
    problem.has_contact = false;
    Newton newton(problem, {});
    solve::TimeSteppingOptions options;
    options.proximal_continuation = proximal_terms;
    options.max_halvings = 2;
    TimeStepper stepper(problem, newton, options);
    auto x = problem.constant(0);
    Real t = 0;
    const auto report = stepper.advance(x, t, 1);
    EXPECT_FALSE(report.converged);
    return report.newton_iterations;
  };
  EXPECT_EQ(iterations(true), iterations(false));
}

TEST(TimeStepper, TimeGoesWithTheStateWhereAnEvaluationThrows) {
  const auto f = [](Real x, Real t, Real dt) {
    if (t > 2.6 && dt <= 0.3) throw Error("no loads beyond 2.6");
    return dt <= 0.3 ? x - t : 1 + x * x;
  };
  ScalarProblem problem(Tpetra::getDefaultComm(), 4, f,
                        [](Real x, Real, Real dt) { return dt <= 0.3 ? 1 : 2 * x + 1e-3; });
  NewtonOptions options;
  options.max_iterations = 5;
  Newton newton(problem, options);
  TimeStepper stepper(problem, newton, {});
  auto x = problem.constant(2);
  Real t = 2;
  EXPECT_THROW(stepper.advance(x, t, 3), Error);
  EXPECT_EQ(problem.committed_times, (std::vector<Real>{2.25, 2.5}));
  EXPECT_EQ(t, 2.5);
  for (std::size_t i = 0; i < x[0]->getLocalLength(); ++i) EXPECT_NEAR(x[0]->getData()[i], 2.5, 1e-12);
}

TEST(TimeStepper, ReportsAndRestoresPastTheSmallestSubstep) {
  auto problem = impatient(0);
  NewtonOptions options;
  options.max_iterations = 3;
  Newton newton(problem, options);
  TimeStepper stepper(problem, newton, {});
  auto x = problem.constant(0.125);
  Real t = 0;
  const auto report = stepper.advance(x, t, 1);
  EXPECT_EQ(t, 0);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.cuts, 6);
  EXPECT_EQ(report.time, 0);
  EXPECT_NE(report.reason.find("dt = 0.0156"), std::string::npos) << report.reason;
  EXPECT_TRUE(problem.committed_times.empty());
  for (std::size_t i = 0; i < x[0]->getLocalLength(); ++i) EXPECT_EQ(x[0]->getData()[i], 0.125);
}

TEST(TimeStepper, TakesOneStepWhereNothingIsWrong) {
  GridProblem problem(Tpetra::getDefaultComm(), {});
  Newton newton(problem, {});
  TimeStepper stepper(problem, newton, {});
  auto x = problem.zero();
  Real t = 0;
  const auto report = stepper.advance(x, t, 1);
  EXPECT_TRUE(report.converged) << report.reason;
  EXPECT_EQ(report.substeps, 1);
  EXPECT_EQ(report.cuts, 0);
  EXPECT_EQ(problem.n_commits, 1);
}

}  // namespace
}  // namespace sprekk::test
