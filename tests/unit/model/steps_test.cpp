// Times of steps: prescribed, adaptive, and at knots of tables.
#include "model/knots.hpp"
#include "model/steps.hpp"
#include "block.hpp"

namespace sprekk::model::test {
namespace {

using ::testing::DoubleEq;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<Real> times_of(const Entries& changes) { return block(changes).time.times(); }

/// Takes all steps of a scene.
std::vector<StepTaken> steps_of(const Entries& changes) {
  Model model(block(changes), world());
  Steps steps(model);
  std::vector<StepTaken> all;
  while (steps.any() && all.size() < 100) {
    all.push_back(steps.take());
    EXPECT_TRUE(all.back().report.converged) << all.back().report.reason;
    EXPECT_EQ(model.time(), all.back().end);
  }
  return all;
}

std::vector<Real> ends_of(const std::vector<StepTaken>& steps) {
  std::vector<Real> ends;
  for (const auto& step : steps) ends.push_back(step.end);
  return ends;
}

/// Entries of a piecewise linear load with a knot at 0.3.
const Entries kinked = {"Tables.load.arguments={0, 0.3, 1}", "Tables.load.values={0, 1, 1}",
                        "Boundary conditions.pull.traction={load(t), 0}"};

Entries joined(Entries a, const Entries& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(Time, WithoutNumberThereIsOneStep) { EXPECT_THAT(times_of({"Time.end=3.0"}), ElementsAre(3)); }

TEST(Time, StepsAreEqualFromStartToEnd) {
  EXPECT_THAT(times_of({"Time.start=1.0", "Time.end=2.0", "Time.steps=4"}), ElementsAre(1.25, 1.5, 1.75, 2));
  EXPECT_EQ(times_of({"Time.end=0.7", "Time.steps=3"}).back(), 0.7);  // without round-off
  EXPECT_THAT(times_of({"Time.start=-2.0", "Time.end=-1.0", "Time.steps=2"}), ElementsAre(-1.5, -1));
}

TEST(Time, TheScheduleReplacesEndAndSteps) {
  EXPECT_THAT(times_of({"Time.schedule={0.5, 2, 7}", "Time.steps=9", "Time.end=1.0"}), ElementsAre(0.5, 2, 7));
}

TEST(Time, RefusesTimesThatDoNotIncrease) {
  EXPECT_THAT(refusal({"Time.start=1.0", "Time.end=1.0"}),
              HasSubstr("Time > \"end\": is 1 after 1; times must increase"));
  EXPECT_THAT(refusal({"Time.schedule={1, 3, 2}"}),
              HasSubstr("Time > \"schedule\": is 2 after 3; times must increase"));
  EXPECT_THAT(refusal({"Time.start=2.0", "Time.schedule={1, 3}"}), HasSubstr("Time > \"schedule\": is 1 after 2"));
  EXPECT_THAT(refusal({"Time.schedule={}"}), HasSubstr("Time > \"schedule\": is empty"));
}

TEST(Time, RefusesContradictoryLimitsOfAdaptiveSteps) {
  const Entries adaptive = {"Time.tolerance=0.1"};
  EXPECT_THAT(refusal({"Time.steps=2", "Time.tolerance=0.1"}),
              HasSubstr("Time > \"steps\": is 2: not allowed with \"tolerance\""));
  EXPECT_THAT(refusal({"Time.steps=2", "Time.target Newton iterations=5"}),
              HasSubstr("Time > \"steps\": is 2: not allowed with \"target Newton iterations\""));
  for (const std::string name : {"first step", "smallest step", "largest step"})
    EXPECT_THAT(refusal({"Time." + name + "=0.5"}),
                HasSubstr("Time > \"" + name + "\": is 0.5 s: needs \"tolerance\""));
  EXPECT_THAT(refusal(joined(adaptive, {"Time.smallest step=0.5", "Time.largest step=0.25"})),
              HasSubstr("\"smallest step\": is 0.5 s, must be at most the \"largest step\", 0.25 s"));
  EXPECT_THAT(refusal(joined(adaptive, {"Time.first step=0.125", "Time.smallest step=0.25"})),
              HasSubstr("\"first step\": is 0.125 s, must be at least the \"smallest step\", 0.25 s"));
  EXPECT_THAT(refusal(joined(adaptive, {"Time.first step=0.5", "Time.largest step=0.25"})),
              HasSubstr("\"first step\": is 0.5 s, must be at most the \"largest step\", 0.25 s"));
}

TEST(Steps, FollowTheSchedule) {
  Model model(block({"Time.start=1.0", "Time.schedule={1.5, 2, 5}"}), world());
  Steps steps(model);
  EXPECT_EQ(steps.n_left(), 3);
  EXPECT_EQ(steps.share_done(), 0);
  auto step = steps.take();
  EXPECT_EQ(step.begin, 1);
  EXPECT_EQ(step.end, 1.5);
  EXPECT_TRUE(step.at_time);
  EXPECT_EQ(step.stage, "");
  EXPECT_FALSE(step.begins_stage);
  EXPECT_EQ(steps.n_left(), 2);
  EXPECT_EQ(steps.share_done(), 0.125);
  steps.take();
  EXPECT_TRUE(steps.any());
  step = steps.take();
  EXPECT_EQ(step.begin, 2);
  EXPECT_EQ(step.end, 5);
  EXPECT_FALSE(steps.any());
  EXPECT_EQ(steps.share_done(), 1);
  EXPECT_TRUE(steps.memory().is_null());
}

TEST(Steps, OfAModelWithALaterTimeBeginThere) {
  Model model(block({"Time.schedule={1, 2, 3}"}), world());
  model.step_to(2);
  Steps steps(model);
  EXPECT_EQ(steps.n_left(), 1);
  EXPECT_EQ(steps.take().end, 3);
}

/// The load is linear in time. Steps grow threefold from the first step to the largest. The last two are equal.
TEST(Steps, GrowFromTheFirstToTheLargest) {
  for (const std::string control : {"tolerance=0.1", "target Newton iterations=1000"}) {
    const auto steps = steps_of({"Time." + control, "Time.first step=0.1", "Time.largest step=0.4"});
    EXPECT_THAT(ends_of(steps), ElementsAre(DoubleEq(0.1), DoubleEq(0.4), DoubleEq(0.7), 1)) << control;
    EXPECT_FALSE(steps[2].at_time);
    EXPECT_TRUE(steps[3].at_time);
    for (const auto& step : steps) EXPECT_EQ(step.warning, "");
  }
}

/// One Newton iteration per step exceeds no target, so steps remain equal if the target is 1.
TEST(Steps, RemainEqualAtTheTargetOfIterations) {
  const auto steps = steps_of({"Time.target Newton iterations=1", "Time.first step=0.25"});
  for (const auto& step : steps) EXPECT_EQ(step.report.newton_iterations, 1);
  EXPECT_THAT(ends_of(steps), ElementsAre(0.25, 0.5, 0.75, 1));
}

TEST(Steps, AdaptiveOnesEndAtTimesAndKnots) {
  const auto steps = steps_of(
      joined(kinked, {"Time.tolerance=0.1", "Time.first step=1.0", "Time.largest step=1.0", "Time.schedule={0.5, 1}"}));
  EXPECT_THAT(ends_of(steps), ElementsAre(0.3, 0.5, 1));
  EXPECT_FALSE(steps[0].at_time);
  EXPECT_TRUE(steps[1].at_time);
}

/// The load t^2 deviates from its secant over a step by a quarter of the step squared, above the tolerance.
TEST(Steps, WarnIfTheSmallestStepIsTooLong) {
  const Entries parabola = {"Boundary conditions.pull.traction={t^2, 0}", "Time.tolerance=0.001",
                            "Time.smallest step=0.5", "Time.largest step=0.5", "Time.first step=0.5"};
  const auto steps = steps_of(parabola);
  EXPECT_THAT(ends_of(steps), ElementsAre(0.5, 1));
  for (const auto& step : steps) {
    EXPECT_EQ(step.errors.back().name, "loads");
    EXPECT_THAT(step.warning, HasSubstr("the step of length 0.5 is accepted with a relative error of"));
    EXPECT_THAT(step.warning, HasSubstr("shorter ones are below Time > \"smallest step\""));
  }
}

TEST(Steps, ShortenForCurvedLoads) {
  const Entries parabola = {"Boundary conditions.pull.traction={t^2, 0}", "Time.tolerance=0.01", "Time.first step=0.5"};
  const auto steps = steps_of(parabola);
  EXPECT_GT(steps.size(), 3);
  for (const auto& step : steps) {
    EXPECT_LE(step.errors.back().value, 0.01);
    EXPECT_EQ(step.warning, "");
  }
}

TEST(Steps, ContinueFromTheirMemory) {
  const auto scene = block({"Time.tolerance=0.1", "Time.first step=0.1"});
  Model model(scene, world()), other(scene, world());
  Steps steps(model), resumed(other);
  steps.take();
  EXPECT_NEAR(steps.memory()[0].get<Real>(), 0.3, 1e-14);
  other.restore(model.save());
  resumed.resume(steps.memory());
  const auto next = steps.take();
  EXPECT_NEAR(next.end, 0.4, 1e-14);
  EXPECT_EQ(resumed.take().end, next.end);
}

TEST(Knots, AreTimesBetweenStartAndEnd) {
  const auto scene = block({"Tables.load.arguments={-1, 0, 1, 3}", "Tables.load.values={0, 2, 1, 1}",
                            "Boundary conditions.pull.traction={load(2*t - 1), load(2*t - 1)}"});
  const auto tables = tables_of_time(scene);
  ASSERT_EQ(tables.size(), 1);  // once per argument
  EXPECT_EQ(tables[0].name, "load");
  EXPECT_EQ(tables[0].shift, -1);
  EXPECT_EQ(tables[0].factor, 2);
  EXPECT_THAT(knots(scene, 1), ElementsAre(0.5));
  EXPECT_THAT(knots(scene, 1.5), ElementsAre(0.5, 1));
}

TEST(Knots, OfSeveralArgumentsAreMerged) {
  const auto scene = block({"Tables.load.arguments={-9, 0.5, 9}", "Tables.load.values={0, 2, 1}",
                            "Boundary conditions.pull.traction={load(t) + load(2*t) + load(1 - t), load(-t)}"});
  EXPECT_THAT(knots(scene, 1), ElementsAre(0.25, 0.5));
  EXPECT_EQ(tables_of_time(scene).size(), 4);
}

TEST(Knots, RequireArgumentsLinearInTime) {
  const auto scene = block({"Tables.load.arguments={0, 0.5, 9}", "Tables.load.values={0, 2, 1}",
                            "Boundary conditions.pull.traction={load(t*t) + load(x) + load(t + x), 0}"});
  EXPECT_TRUE(tables_of_time(scene).empty());
  EXPECT_TRUE(knots(scene, 1).empty());
}

TEST(Warnings, NameStepsThatSkipKnots) {
  const auto warnings_of = [](const Entries& changes) { return Model(block(changes), world()).warnings(); };
  EXPECT_THAT(warnings_of(joined(kinked, {"Time.steps=2"})),
              ElementsAre(HasSubstr("1 step goes over knots of the table \"load\", the first at t = 0.3 s")));
  EXPECT_THAT(warnings_of(joined(kinked, {"Time.steps=10"})), ElementsAre());
  EXPECT_THAT(warnings_of(joined(kinked, {"Time.tolerance=0.1"})), ElementsAre());
}

}  // namespace
}  // namespace sprekk::model::test
