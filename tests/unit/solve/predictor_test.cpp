// Extrapolation of states to the next step.
#include "solve/predictor.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

#include <cmath>
#include <functional>

namespace sprekk::solve {
namespace {

using Path = std::function<Real(Real)>;

/// Returns a state of one block with two unknowns on each rank, both f(t).
fields::BlockVector state(const Path& f, Real t) {
  const auto comm = Tpetra::getDefaultComm();
  const GlobalIndex first = 2 * comm->getRank();
  fields::BlockVector x{rcp(new fields::Vector(fields::make_map({first, first + 1}, comm)))};
  x[0]->putScalar(f(t));
  return x;
}

/// Saves the substeps between these times and returns the error of the prediction at `end` from `start`.
Real error(const Path& f, const std::vector<Real>& times, Real start, Real end) {
  Predictor predictor;
  for (std::size_t k = 0; k + 1 < times.size(); ++k)
    predictor.add(state(f, times[k]), state(f, times[k + 1]), times[k], times[k + 1]);
  const auto predicted = predictor.predict(state(f, start), start, end - start);
  EXPECT_FALSE(predicted.empty());
  predicted[0]->update(-1, *state(f, end)[0], 1);
  return predicted[0]->normInf();
}

TEST(Predictor, IsExactForQuadraticPathsAndUnequalSteps) {
  const Path f = [](Real t) { return 3 + 2 * t + t * t; };
  EXPECT_LT(error(f, {0, 0.5, 1.5}, 1.5, 2), 1e-13);
  EXPECT_LT(error(f, {0, 1.5, 1.6}, 1.6, 1.7), 1e-13);
}

TEST(Predictor, IsExactForCubicPathsAfterThreeSteps) {
  const Path f = [](Real t) { return 3 + 2 * t + t * t + 0.1 * t * t * t; };
  EXPECT_LT(error(f, {0, 0.5, 1.5, 2.5}, 2.5, 3), 1e-13);
  EXPECT_LT(error(f, {0, 0.5, 1.5, 2.5, 3}, 2.5, 3.5), 1e-13);  // the last substep is that of a rejected step
}

/// One substep has one rate only.
TEST(Predictor, IsExactForLinearPathsAfterOneStep) {
  EXPECT_LT(error([](Real t) { return 3 + 2 * t; }, {0, 0.5}, 0.5, 2), 1e-14);
}

/// The last substep is that of a rejected step: the prediction starts before it.
TEST(Predictor, ContinuesFromTheStateBeforeARejectedStep) {
  const Path f = [](Real t) { return t < 1 ? 3 + 2 * t + t * t : 7 - t; };
  EXPECT_LT(error([](Real t) { return 3 + 2 * t + t * t; }, {0, 0.5, 1, 2}, 1, 1.5), 1e-14);
  EXPECT_GT(error(f, {0, 0.5, 1, 2}, 1, 1.5), 1);  // the path after 1 has no effect
}

/// A rate that drops to zero is not extrapolated to the opposite sign.
TEST(Predictor, LimitsTheChangeOfTheRate) {
  const Path f = [](Real t) { return t < 1 ? 10 * t : 10 + (t - 1); };
  EXPECT_NEAR(error(f, {0, 1, 2}, 2, 3), 0.5, 1e-13);  // the rate is half of 1
}

TEST(Predictor, HasNoPredictionFromOtherTimes) {
  const Path f = [](Real t) { return t; };
  Predictor predictor;
  EXPECT_TRUE(predictor.predict(state(f, 0), 0, 1).empty());
  predictor.add(state(f, 0), state(f, 1), 0, 1);
  EXPECT_TRUE(predictor.predict(state(f, 2), 2, 1).empty());
}

}  // namespace
}  // namespace sprekk::solve
