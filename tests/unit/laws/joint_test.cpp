// Joint law in series with a block of rock: every contact regime, cyclic shear, rotating shear.
#include "laws/joint.hpp"

#include <vector>

#include "series_block.hpp"

namespace sprekk::laws::testing {
namespace {

struct Regime {
  const char* name;
  Real d_t, d_n, p_old;
  ClosedForm exact;
};

/// Closed form: in each regime, a quadratic equation in the normal force N.
const std::vector<Regime> case_a1 = {
    {"open", 0.2, 0.2, 0, {ContactState::open, 0, 0, 0.2, 0.2}},
    {"stick", 0.05, -0.1, 0, {ContactState::stick, 0.033333333333333, -0.234281365494, 0, -0.021906211502}},
    {"slip", 0.5, -0.1, 0, {ContactState::slip, 0.193791423668, -0.322985706114, 0.209312864497, 0.007661902038}},
    {"strongly dilating",
     1.0,
     -0.05,
     0,
     {ContactState::slip, 0.234665843754, -0.391109739590, 0.648001234369, 0.080369913197}},
    {"unload to stick",
     0.35,
     -0.1,
     0.209312864497,
     {ContactState::stick, 0.093791423668, -0.322985706114, 0.209312864497, 0.007661902038}},
    {"reverse slip",
     -0.6,
     -0.1,
     0.209312864497,
     {ContactState::slip, -0.212578130501, -0.354296884168, -0.281132804249, 0.018098961389}},
    {"nearly open",
     0.3,
     0.05,
     0,
     {ContactState::slip, 0.011301447522, -0.018835745870, 0.283047828717, 0.056278581957}}};

TEST(SeriesBlock, EveryRegimeOfOneStep) {
  for (const auto& regime : case_a1) {
    SCOPED_TRACE(regime.name);
    SeriesBlock<2> block;
    block.law = reference_joint();
    block.p_old = {regime.p_old};
    block.step({regime.d_n, regime.d_t});
    expect_equal(block, regime.exact, 1e-9);
    expect_equal(block, closed_form(block.law, 3, 1, regime.d_t, regime.d_n, regime.p_old), 1e-12);
  }
}

TEST(SeriesBlock, TheSameInThreeDimensionsInAnyShearDirection) {
  const Real direction[] = {0.6, -0.8};
  for (const auto& regime : case_a1) {
    SCOPED_TRACE(regime.name);
    SeriesBlock<3> block;
    block.law = reference_joint();
    block.p_old = {regime.p_old * direction[0], regime.p_old * direction[1]};
    block.step({regime.d_n, regime.d_t * direction[0], regime.d_t * direction[1]});
    EXPECT_NEAR(block.lambda[0], regime.exact.lambda_n, 1e-9);
    EXPECT_NEAR(block.w[0], regime.exact.opening, 1e-9);
    for (int i = 0; i < 2; ++i) {
      EXPECT_NEAR(block.lambda[i + 1], regime.exact.lambda_t * direction[i], 1e-9);
      EXPECT_NEAR(block.plastic()[i], regime.exact.plastic * direction[i], 1e-9);
    }
  }
}

/// Column of height 1, G = 1e6, lambda = 1e3, with a very soft joint: push and pull tests of Wollmann (2024).
SeriesBlock<2> soft_joint() {
  SeriesBlock<2> block;
  block.law.elastic.inverse_stiffness = 1e5;
  block.law.friction.coefficient = 1;
  block.k_s = 1e6;
  block.k_n = 1e3 + 2e6;
  block.c = 1e6;
  return block;
}

TEST(SeriesBlock, PushOnASoftJointIsElastic) {
  auto block = soft_joint();
  block.step({-1, 1});
  EXPECT_EQ(static_cast<int>(block.state), static_cast<int>(ContactState::stick));
  EXPECT_NEAR(block.lambda[1], 9.9999999999e-6, 1e-9 * 1e-5);
  EXPECT_NEAR(block.lambda[0], -2.001e6, 1e-9 * 2.001e6);
  Real elastic[2], plastic[2];
  split_jump<2>(block.law, block.state, block.w, block.lambda, {0}, elastic, plastic);
  EXPECT_NEAR(elastic[1], 1 - 1e-11, 1e-13);
  EXPECT_NEAR(plastic[1], 0, 1e-13);
}

TEST(SeriesBlock, PullOpensAndAllJumpIsPlastic) {
  auto block = soft_joint();
  block.step({1, 1});
  expect_equal(block, {ContactState::open, 0, 0, 1, 1}, 1e-14);
  Real elastic[2], plastic[2];
  split_jump<2>(block.law, block.state, block.w, block.lambda, {0}, elastic, plastic);
  EXPECT_EQ(elastic[0], 0);
  EXPECT_EQ(elastic[1], 0);
  EXPECT_NEAR(plastic[0], 1, 1e-14);
}

/// Cyclic shear at the normal force N = 0.3; slip starts at an elastic displacement of 0.27.
TEST(CyclicShear, FollowsTheHysteresisLoop) {
  const Real d_t[] = {0.1, 0.5, 0.5, 0.3, -0.5, -0.2, 0.5, 0.5};
  const Real lambda_t[] = {0.2 / 3, 0.18, 0.18, 0.14 / 3, -0.18, 0.02, 0.18, 0.18};
  const Real plastic[] = {0, 0.23, 0.23, 0.23, -0.23, -0.23, 0.23, 0.23};
  SeriesBlock<2> block;
  block.law = plain_joint();
  for (int k = 0; k < 8; ++k) {
    block.step({-0.1, d_t[k]});
    EXPECT_NEAR(block.lambda[1], lambda_t[k], 1e-12) << k;
    EXPECT_NEAR(block.lambda[0], -0.3, 1e-12);
    block.commit();
    EXPECT_NEAR(block.p_old[0], plastic[k], 1e-12) << k;
  }
}

TEST(CyclicShear, DoesNotDependOnSubsteps) {
  SeriesBlock<2> coarse, fine;
  coarse.law = fine.law = plain_joint();
  const Real turning_points[] = {0, 0.5, -0.4, 0.45, 0.1};
  for (int k = 1; k < 5; ++k) {
    coarse.step({-0.1, turning_points[k]});
    coarse.commit();
    for (int s = 1; s <= 17; ++s) {
      fine.step({-0.1, turning_points[k - 1] + s / 17.0 * (turning_points[k] - turning_points[k - 1])});
      fine.commit();
    }
    EXPECT_NEAR(fine.p_old[0], coarse.p_old[0], 1e-12);
    EXPECT_NEAR(fine.lambda[1], coarse.lambda[1], 1e-12);
  }
}

TEST(CyclicShear, WorkPerCycleIsTheAreaOfTheLoop) {
  SeriesBlock<2> block;
  block.law = plain_joint();
  const Real D = 0.5;
  const int n =
      100;  // steps per branch; corners of the loop (2 S after its ends) coincide with steps: trapezoids are exact
  Real work = 0, last = 0;
  const auto go = [&](Real from, Real to, bool count) {
    for (int s = 1; s <= n; ++s) {
      block.step({-0.1, from + (to - from) * s / n});
      block.commit();
      if (count) work += (last + block.lambda[1]) / 2 * (to - from) / n;
      last = block.lambda[1];
    }
  };
  go(0, D, false);
  go(D, -D, true);
  go(-D, D, true);
  EXPECT_NEAR(work, 0.1656, 1e-12);  // 4 mu N (D - S)
}

TEST(CyclicShear, DoesNotDriftOverAThousandCycles) {
  SeriesBlock<2> block;
  block.law = plain_joint();
  for (int k = 0; k < 1000; ++k)
    for (Real d : {0.5, -0.5}) {
      block.step({-0.1, d});
      block.commit();
    }
  EXPECT_NEAR(block.p_old[0], -0.23, 1e-9);
  EXPECT_NEAR(block.lambda[1], -0.18, 1e-9);
}

/// Shear path with a right angle; implicit Euler equals radial return.
TEST(RotatingShear, CornerPath) {
  const struct {
    int steps;
    Real t1, t2;
  } ends[] = {{1, 0.100705113900, 0.149192761334}, {4, 0.086703396577, 0.157741944397}};
  for (const auto& end : ends) {
    SeriesBlock<3> block;
    block.law = plain_joint();
    block.step({-0.1, 0.5, 0});
    block.commit();
    for (int s = 1; s <= end.steps; ++s) {
      block.step({-0.1, 0.5, 0.4 * s / end.steps});
      block.commit();
    }
    EXPECT_NEAR(block.lambda[1], end.t1, 1e-10);
    EXPECT_NEAR(block.lambda[2], end.t2, 1e-10);
  }
}

/// Plastic jump of steady circular motion, with the angle D per step: -S sin(D/2) + sqrt(R^2 - S^2 cos^2(D/2)).
TEST(RotatingShear, Circle) {
  const Real pi = 3.14159265358979323846, R = 0.5, S = 0.27;
  for (int n : {8, 64}) {
    SeriesBlock<3> block;
    block.law = plain_joint();
    for (int s = 0; s <= 12 * n; ++s) {
      block.step({-0.1, R * std::cos(2 * pi * s / n), R * std::sin(2 * pi * s / n)});
      block.commit();
    }
    const Real half = pi / n, closed = -S * std::sin(half) + std::sqrt(R * R - std::pow(S * std::cos(half), 2));
    EXPECT_NEAR(closed, n == 8 ? 0.330006706645 : 0.407792719657, 1e-12);
    EXPECT_NEAR(std::hypot(block.p_old[0], block.p_old[1]), closed, 1e-10);
    EXPECT_NEAR(std::hypot(block.lambda[1], block.lambda[2]), 0.18, 1e-12);
  }
}

}  // namespace
}  // namespace sprekk::laws::testing
