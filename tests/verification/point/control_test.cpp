// Joint at one point under every kind of control. Results obey the joint law and the prescribed values; if these
// determine no state, the error names the reason.
#include "point_scenes.hpp"

#include <random>

namespace sprekk::tests {
namespace {

using Overrides = std::vector<std::string>;

TEST(Control, TractionOfNormalAndJumpOfShear) {
  const auto states = drive("cyclic_shear.xml", {"Point.control={traction, jump}", "Point.path={-0.3, shear(t)}"});
  const Real shear[] = {0.18, 0.18, 0.18, -0.18, -0.18, 0.18, 0.18, 0.18};  // K_t = 2: slip begins at 0.09
  for (int i = 0; i < 8; ++i) EXPECT_NEAR(states[i].traction[1], shear[i], 1e-14) << i;
  EXPECT_NEAR(states[2].plastic[1], 0.41, 1e-14);
  EXPECT_NEAR(states[3].plastic[1], 0.39, 1e-14);
}

TEST(Control, TractionsBelowTheFrictionBoundAreElastic) {
  const auto states =
      drive("regimes.xml", {"Point.control={traction, traction}", "Point.path={-0.5, 0.29*sin(t)}", "Time.end=10"});
  for (const auto& s : states) {
    EXPECT_EQ(s.contact, laws::ContactState::stick);
    EXPECT_NEAR(s.jump[1], s.traction[1] / 2, 1e-15);
    EXPECT_NEAR(s.jump[0], 0.01 - 0.05, 1e-15);  // half of the maximum closure at lambda_n = -Du K_n
  }
}

/// Without a maximum closure, closure is linear: 0.04 mm for 2 MPa at 50 GPa/m, and twice this for 4 MPa.
TEST(Control, ClosureWithoutAMaximumIsLinear) {
  for (const auto& [control, path] : {std::pair{"{traction, jump}", "{-2e6*t, 0}"}, {"{jump, jump}", "{-4e-5*t, 0}"}}) {
    const auto states =
        drive("cyclic_shear.xml", {"Materials.joint.normal stiffness=50 GPa/m", "Time.end=2", "Time.steps=2",
                                   std::string("Point.control=") + control, std::string("Point.path=") + path});
    for (const auto& s : states) {
      EXPECT_EQ(s.contact, laws::ContactState::stick);
      EXPECT_NEAR(s.jump[0], -4e-5 * s.t, 1e-18) << control;
      EXPECT_NEAR(s.elastic[0], -4e-5 * s.t, 1e-18) << control;
      EXPECT_NEAR(s.traction[0], -2e6 * s.t, 1e-7) << control;
    }
  }
}

TEST(Control, JumpOfARigidJointIsPlastic) {
  const auto states = drive("cyclic_shear.xml", {"Materials.joint.tangential stiffness=infinite", "Time.steps=80",
                                                 "Point.control={traction, jump}", "Point.path={-1e7, 1e-3*sin(t)}"});
  for (std::size_t i = 1; i < states.size(); ++i) {
    const Real direction = states[i].jump[1] > states[i - 1].jump[1] ? 1 : -1;
    EXPECT_NEAR(states[i].traction[1], direction * 6e6, 1e-6) << states[i].t;
    EXPECT_EQ(states[i].plastic[1], states[i].jump[1]);
  }
}

/// A rigid joint with constant jump can have any shear traction up to the bound. It keeps its last traction, unless
/// the bound decreases below it. In 3D this holds for each component.
TEST(Control, RigidJointAtRestKeepsItsTraction) {
  const std::string rigid = "Materials.joint.tangential stiffness=infinite";
  const auto flat = drive("cyclic_shear.xml", {"Point.control={traction, jump}", rigid, "Time.end=4", "Time.steps=4",
                                               "Point.path={-0.3 - 0.1*max(0, t - 2) + 0.3*max(0, t - 3), 0.1}"});
  const Real expected[] = {0.18, 0.18, 0.18, 0.12};
  for (int k = 0; k < 4; ++k) EXPECT_NEAR(flat[k].traction[1], expected[k], 1e-14) << k;
  const auto turned = drive("turning_shear.xml", {"Point.control={traction, traction, jump}", rigid, "Time.end=3",
                                                  "Time.steps=3", "Point.path={-0.3, 0.05*(t - 1), 0.1}"});
  const Real across[] = {0.18, std::sqrt(0.18 * 0.18 - 0.05 * 0.05), std::sqrt(0.18 * 0.18 - 0.1 * 0.1)};
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(turned[k].traction[2], across[k], 1e-13) << k;
}

TEST(Control, DilationUnderConstantNormalJumpBuildsNormalTraction) {
  const auto states = drive("regimes.xml", {"Point.control={jump, jump}", "Point.path={-0.01, 0.1*t}"});
  for (const auto& s : states) {
    const Real N = -s.traction[0];  // g0 + tan(theta) |u^p| - V(N) = w_n
    EXPECT_NEAR(0.1 * N / (0.5 + N), 0.02 + std::tan(M_PI / 18) * s.plastic[1], 1e-14);
  }
  EXPECT_GT(-states.back().traction[0], 3 * -states.front().traction[0]);
}

/// Returns a random joint with random controls and path; stiffnesses and lengths vary over several orders of
/// magnitude.
Overrides random_case(std::mt19937& random) {
  const auto uniform = [&](Real low, Real high) { return std::uniform_real_distribution<Real>(low, high)(random); };
  const auto any_size = [&](Real low, Real high) { return std::exp(uniform(std::log(low), std::log(high))); };
  const auto set = [](const char* entry, Real value) { return fmt::format("{}={:.17g}", entry, value); };
  const Real stiffness = any_size(1e-3, 1e12), length = any_size(1e-6, 1e3);
  const char* controls[] = {"{column, column, column}", "{traction, column, column}", "{traction, jump, jump}",
                            "{jump, jump, column}",     "{column, jump, jump}",       "{traction, column, jump}"};
  const std::string control = controls[random() % 6];
  const bool clamped = control[1] == 'j';  // prescribed normal jump: the closure must be able to compensate jump and
                                           // dilation
  Overrides overrides = {"Point.control=" + control,
                         set("Materials.joint.tangential stiffness", stiffness * any_size(0.01, 100)),
                         set("Materials.joint.friction coefficient", uniform(0, 1)),
                         set("Materials.joint.dilation angle", uniform(0, clamped ? 5 : 20)),
                         set("Materials.joint.initial gap", length * uniform(-0.1, 0.1)),
                         set("Materials.joint.maximum closure", length * any_size(clamped ? 0.5 : 0.05, 1)),
                         set("Materials.joint.normal stiffness", stiffness * any_size(0.1, 10)),
                         set("Point.column normal stiffness", stiffness * any_size(0.1, 10)),
                         set("Point.column tangential stiffness", stiffness * any_size(0.1, 10)),
                         "Time.end=6",
                         "Time.steps=30"};
  const bool loaded = control[1] == 't';
  overrides.push_back(fmt::format(
      "Point.path={{{0:.17g}*({1}*sin(t) - 1), {2:.17g}*sin({3}*t), {2:.17g}*sin({4}*t + 1)}}",
      length * (loaded ? 0.1 * stiffness : 0.04), loaded ? 0.5 : 1.2, length, uniform(0.5, 2), uniform(0.5, 2)));
  return overrides;
}

/// Checks the inequalities of the joint law ("elastic and plastic jump" of the theory) at every state of a path.
void expect_lawful(const laboratory::PointScene& scene, const std::vector<PointState>& states) {
  const auto value = [&](const char* entry) { return (*scene.materials.at("joint").entry(entry))({}, 0); };
  const Real K = value("tangential stiffness"), mu = value("friction coefficient"), closure = value("maximum closure"),
             K_n = value("normal stiffness"), dilation = std::tan(value("dilation angle") * M_PI / 180),
             g0 = scene.materials.at("joint").initial_gap({}, 0);
  std::array<Real, 2> old = {0, 0};
  for (const auto& s : states) {
    SCOPED_TRACE(fmt::format("t = {}", s.t));
    const Real N = -s.traction[0], shear = std::hypot(s.traction[1], s.traction[2]);
    const Real p[] = {s.jump[1] - s.traction[1] / K, s.jump[2] - s.traction[2] / K};
    const Real step[] = {p[0] - old[0], p[1] - old[1]}, size = std::hypot(step[0], step[1]);
    const Real gap = g0 + dilation * std::hypot(p[0], p[1]) - closure * N / (closure * K_n + N);
    const Real length = std::max({std::abs(s.jump[0]), std::abs(s.jump[1]), std::abs(s.jump[2]), closure});
    const Real stress = std::max(N, shear) + 1e-12 * K * length;
    ASSERT_GE(N, 0);
    ASSERT_LE(shear, mu * N + 1e-10 * stress);
    ASSERT_GE(s.jump[0], gap - 1e-10 * length);
    ASSERT_LE(N * (s.jump[0] - gap), 1e-10 * stress * length);
    if (N > 0) {
      ASSERT_LE((mu * N - shear) * size, 1e-10 * stress * length);
      ASSERT_NEAR(s.traction[1] * step[0] + s.traction[2] * step[1], shear * size, 1e-10 * stress * length);
    }
    old = {p[0], p[1]};
  }
}

TEST(Control, RandomJointsOnRandomPathsObeyTheLaw) {
  std::mt19937 random(20240603);
  const std::string path = source_dir() + "/xml/point/turning_shear.xml";
  for (int i = 0; i < 300; ++i) {
    const auto overrides = random_case(random);
    SCOPED_TRACE(fmt::format("case {}: {}", i, fmt::join(overrides, "; ")));
    const auto scene = laboratory::read_point_scene(*Tpetra::getDefaultComm(), path, overrides);
    try {
      expect_lawful(scene, laboratory::drive_point(scene));
    } catch (const Error& error) {
      ADD_FAILURE() << error.what();
    }
    if (HasFatalFailure()) return;
  }
}

/// Returns the message of the error at the end of a path.
std::string message(const Overrides& overrides) {
  try {
    drive("cyclic_shear.xml", overrides);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Control, WhatDeterminesNoStateIsAnErrorThatSaysWhy) {
  const std::string rigid = "Materials.joint.tangential stiffness=infinite";
  EXPECT_EQ(
      message({"Point.control={traction, traction}", "Point.path={-0.3, 0.05*t}"}),
      source_dir() +
          "/xml/point/cyclic_shear.xml: Sprekk > Point: step 4 of 8, t = 4: no state found for traction "
          "n = -0.3, traction t = 0.2: the shear traction exceeds the friction bound, the joint slides without bound; "
          "the last state is that at t = 3.6");
  const std::pair<Overrides, const char*> cases[] = {
      {{"Point.control={traction, jump}", "Point.path={0.3, 0.1}"}, "an open joint has no traction"},
      {{"Point.control={jump, traction}", "Point.path={0.3, 0.1}"}, "an open joint has no traction"},
      {{"Point.control={jump, jump}", "Point.path={-0.1, 0.1}"}, "the faces touch and do not close"},
      {{"Point.control={jump, column}", "Point.path={0, 0.1}"}, "the faces touch and do not close"},
      {{"Point.control={traction, traction}", "Point.path={-1e7, 7e6}", rigid}, "slides without bound"},
      {{"Point.control={traction, traction, jump}", "Point.path={-0.3, 0.19, 0.1}"}, "slides without bound"},
  };
  for (const auto& [overrides, words] : cases)
    EXPECT_NE(message(overrides).find(words), std::string::npos) << words << ": " << message(overrides);
}

TEST(Control, WrongEntriesAreNamed) {
  const auto expect = [](const std::string& override, const char* words) {
    EXPECT_NE(message({override}).find(words), std::string::npos) << message({override});
  };
  expect("Point.control={column, push}", "\"push\"");
  expect("Point.path={0}", "number of components is 1");
  expect("Point.plastic jump={0, 0}", "must be 1");
  expect("Point.column normal stiffness=0", "missing; a column needs it");
  expect("Point.material=rock", "must be the name of a joint material");
  expect("Point.colunm normal stiffness=1", "Did you mean \"column normal stiffness\"?");
}

}  // namespace
}  // namespace sprekk::tests
