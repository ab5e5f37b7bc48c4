#include "solve/step_control.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace sprekk::solve {
namespace {

using Verdict = StepControl::Verdict;

/// Returns the ends of all steps from 0, for the errors error(t, dt) of the given order.
template <class Error>
std::vector<Real> ends(StepControl control, Real end, const Error& error, Real order) {
  std::vector<Real> all;
  for (Real t = 0; t < end && all.size() < 100000;) {
    const Real next = control.end_of_step(t), dt = next - t;
    if (control.judge(dt, {{"error", error(t, dt), order}}, 1) == Verdict::rejected) continue;
    all.push_back(t = next);
  }
  return all;
}

TEST(StepControl, TakesStepsInverseToTheErrorToThePowerOfTheOrder) {
  for (const Real order : {1.0, 2.0}) {
    std::vector<std::size_t> n;
    for (const Real tolerance : {1e-2, 1e-4}) {
      const StepControl control({.tolerance = tolerance, .first = 1e-3, .smallest = 1e-12, .largest = 1}, {1});
      n.push_back(ends(
                      control, 1, [&](Real, Real dt) { return std::pow(dt, order); }, order)
                      .size());
    }
    EXPECT_NEAR(std::log(static_cast<Real>(n[1]) / n[0]) / std::log(100), 1 / order, 0.08) << n[0] << ", " << n[1];
  }
}

/// First, each step takes five iterations at any length, with a target of three. Then, long steps take ten and short
/// ones three.
TEST(StepControl, DoesNotShortenStepsInVain) {
  StepControl control({.tolerance = {}, .iterations = 3, .first = 0.1, .smallest = 1e-9, .largest = 1}, {100});
  Real t = 0;
  const auto go = [&](int n_steps, const auto& iterations) {
    for (int k = 0; k < n_steps; ++k) {
      const Real end = control.end_of_step(t);
      EXPECT_EQ(control.judge(end - t, {}, iterations(end - t)), Verdict::accepted);
      t = end;
    }
    return control.memory().length;
  };
  const Real length = go(100, [](Real) { return 5; });
  EXPECT_GT(length, 0.005);
  const Real hard = go(100, [](Real dt) { return dt > 1e-3 ? 10 : 3; });
  EXPECT_LE(hard, 1e-3);
  EXPECT_GT(hard, 1e-4);
}

TEST(StepControl, FollowsErrorsThatComeAndGo) {
  const StepControl control({.tolerance = 1e-2, .first = 0.01, .smallest = 1e-9, .largest = 1}, {10});
  const auto error = [](Real t, Real dt) { return dt * (std::abs(t - 5) < 1 ? 1 : 0.01); };
  int inside = 0;
  Real last = 0;
  for (const Real t : ends(control, 10, error, 1)) {
    EXPECT_LE(error(last, t - last), 1e-2);
    inside += std::abs(t - 5) < 1;
    last = t;
  }
  EXPECT_GE(inside, 2 / 0.01);
  EXPECT_LE(inside, 2 / 0.008 + 5);
}

TEST(StepControl, EndsStepsAtAllStopsAndMakesTheLastTwoBeforeThemEqual) {
  const std::vector<Real> stops = {0.3, 0.31, 1 / 1.7, 1};
  StepControl control({.tolerance = 1e-2, .first = 0.07, .smallest = 1e-9, .largest = 0.07}, stops);
  std::vector<Real> met;
  Real before = 0;
  for (Real t = 0; t < 1;) {
    const Real next = control.end_of_step(t), dt = next - t;
    if (std::find(stops.begin(), stops.end(), next) != stops.end()) {
      met.push_back(next);
      if (next != 0.31) EXPECT_NEAR(dt, before, 1e-12);
    }
    before = dt;
    control.judge(dt, {{"error", 1e-9, 1}}, 1);
    t = next;
  }
  EXPECT_EQ(met, stops);
}

TEST(StepControl, GrowsNoFasterThanItMayAndNotAfterARejection) {
  StepControl control({.tolerance = 1e-2, .first = 0.01, .smallest = 1e-9, .largest = 1, .max_growth = 2}, {1});
  EXPECT_EQ(control.judge(0.01, {{"error", 1e-9, 1}}, 1), Verdict::accepted);
  EXPECT_DOUBLE_EQ(control.memory().length, 0.02);
  EXPECT_EQ(control.judge(0.02, {{"error", 0.04, 1}}, 1), Verdict::rejected);
  EXPECT_DOUBLE_EQ(control.memory().length, 0.004);
  EXPECT_EQ(control.judge(0.004, {{"error", 0.001, 1}}, 1), Verdict::accepted);
  EXPECT_DOUBLE_EQ(control.memory().length, 0.004);
  EXPECT_EQ(control.judge(0.004, {}, 1), Verdict::accepted);  // no information
  EXPECT_DOUBLE_EQ(control.memory().length, 0.004);
}

TEST(StepControl, AcceptsWhatNoShorterStepMakesBetter) {
  StepControl control({.tolerance = 1e-2, .first = 0.1, .smallest = 1e-9, .largest = 1}, {1});
  EXPECT_EQ(control.judge(0.1, {{"error", 0.5, 1}}, 1), Verdict::rejected);
  EXPECT_EQ(control.judge(control.memory().length, {{"error", 0.5, 1}}, 1), Verdict::jumped);
  StepControl smallest({.tolerance = 1e-2, .first = 0.1, .smallest = 0.1, .largest = 1}, {1});
  EXPECT_EQ(smallest.judge(0.1, {{"error", 0.5, 1}}, 1), Verdict::limited);
}

/// The last step before a stop has the smallest allowed length, up to round-off.
TEST(StepControl, TriesNoStepTwiceWithTheSameLength) {
  StepControl control({.tolerance = 1e-2, .first = 1e-7, .smallest = 1e-8, .largest = 1}, {1});
  EXPECT_EQ(control.judge(1e-7, {{"error", 1e3, 1}}, 1), Verdict::rejected);
  EXPECT_EQ(control.judge(1.000000000000001e-8, {{"error", 1e2, 1}}, 1), Verdict::limited);
}

/// Errors decrease with each attempt, but so slowly that the tolerance is not reached.
TEST(StepControl, LimitsRejectionsInARow) {
  StepControl control({.tolerance = 1e-2, .first = 1, .smallest = 1e-300, .largest = 1}, {1});
  Real error = 1e30;
  int n = 0;
  for (auto verdict = Verdict::rejected; verdict == Verdict::rejected && n < 1000; ++n, error *= 0.7) {
    verdict = control.judge(control.memory().length, {{"error", error, 1}}, 1);
    if (verdict != Verdict::rejected) {
      EXPECT_EQ(verdict, Verdict::limited);
    }
  }
  EXPECT_EQ(n, StepControl::max_rejections + 1);
}

/// Steps shorter than the round-off of times near the last stop end there.
TEST(StepControl, EndsAtTheLastStop) {
  const StepControl control({.tolerance = 1e-2, .first = 1e-13, .smallest = 1e-13, .largest = 1}, {0.5, 1});
  for (const Real t : {1 - 1e-13, 1 - 1e-15, 1.0}) EXPECT_EQ(control.end_of_step(t), 1);
}

/// Alternating iteration counts do not determine the step length.
TEST(StepControl, IsNotDrivenToEverShorterStepsByCountsThatAlternate) {
  for (const int more : {5, 6, 7}) {
    StepControl control({.tolerance = {}, .iterations = 3, .first = 0.1, .smallest = 1e-12, .largest = 1}, {100});
    for (int k = 0; k < 200; ++k) control.judge(control.memory().length, {}, k % 2 == 0 ? 4 : more);
    EXPECT_GT(control.memory().length, 1e-3) << more;
  }
}

TEST(StepControl, AimsAtACountOfNewtonIterations) {
  StepControl control({.tolerance = {}, .iterations = 8, .first = 0.1, .smallest = 1e-9, .largest = 1}, {1});
  EXPECT_EQ(control.judge(0.1, {}, 2), Verdict::accepted);
  EXPECT_DOUBLE_EQ(control.memory().length, 0.2);
  EXPECT_EQ(control.judge(0.1, {}, 32), Verdict::accepted);
  EXPECT_DOUBLE_EQ(control.memory().length, 0.05);
}

}  // namespace
}  // namespace sprekk::solve
