#include "solve/predictor.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>

namespace sprekk::solve {
namespace {

using fields::BlockVector;

/// Two blocks with the values a and -2 a.
BlockVector state(Real a) {
  const auto map = fields::make_map({Tpetra::getDefaultComm()->getRank()}, Tpetra::getDefaultComm());
  BlockVector x = {rcp(new fields::Vector(map)), rcp(new fields::Vector(map))};
  x[0]->putScalar(a);
  x[1]->putScalar(-2 * a);
  return x;
}

void expect_state(const BlockVector& x, Real a) {
  ASSERT_EQ(x.size(), 2u);
  EXPECT_NEAR(x[0]->getData()[0], a, 1e-14);
  EXPECT_NEAR(x[1]->getData()[0], -2 * a, 1e-14);
}

TEST(Predictor, ContinuesTheRateOfTheLastSubstep) {
  Predictor predictor;
  EXPECT_TRUE(predictor.predict(state(1), 0, 1).empty());
  predictor.add(state(1), state(1.5), 2, 2);
  expect_state(predictor.predict(state(1.5), 2, 3), 2.25);
  predictor.add(state(1.5), state(1.2), 2.5, 0.5);
  expect_state(predictor.predict(state(1.2), 2.5, 0.1), 1.14);
  EXPECT_TRUE(predictor.predict(state(1.2), 3, 0.1).empty());
}

/// A rejected step leaves the rate of the substep before it.
TEST(Predictor, ReturnsToTheRateBeforeARejectedStep) {
  Predictor predictor;
  predictor.add(state(1), state(2), 1, 1);
  predictor.add(state(2), state(8), 3, 2);  // rejected
  expect_state(predictor.predict(state(2), 1, 0.5), 2.5);
  predictor.add(state(2), state(2.4), 1.5, 0.5);  // repeated with a shorter step
  expect_state(predictor.predict(state(2.4), 1.5, 0.5), 2.8);
}

/// A later substep that ends at the time of a rejected one counts.
TEST(Predictor, PrefersTheLastSubstepOfATime) {
  Predictor predictor;
  predictor.add(state(1), state(9), 1, 1);  // rejected
  predictor.add(state(1), state(3), 1, 1);
  expect_state(predictor.predict(state(3), 1, 1), 5);
}

}  // namespace
}  // namespace sprekk::solve
