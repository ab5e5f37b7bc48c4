// Joint at one point compared with exact states: all contact regimes, hysteresis, rotating shear, extreme parameters.
// Exact values are independent closed forms (roots of a quadratic in the normal force) in 60 digits.
#include "point_scenes.hpp"

namespace sprekk::tests {
namespace {

using laws::ContactState;
using Overrides = std::vector<std::string>;

constexpr Real R = 0.5, S = 0.27;  // amplitude of shear; elastic displacement at the onset of slip, mu N / K_s

/// Returns the state after one step from a plastic jump to the column end (d_t, d_n), with the parameters of
/// regimes.xml.
PointState one_step(Real d_t, Real d_n, Real p_old = 0, Overrides overrides = {}) {
  overrides.insert(overrides.begin(), {fmt::format("Point.path={{{:.17g}, {:.17g}}}", d_n, d_t), "Time.steps=1",
                                       fmt::format("Point.plastic jump={{{:.17g}}}", p_old)});
  return drive("regimes.xml", overrides).back();
}

struct Regime {
  const char* name;
  ContactState state;
  Real d_t, d_n, p_old, shear, normal, plastic, opening;
};

TEST(Regimes, OneStepIntoEach) {
  const Regime regimes[] = {
      {"open", ContactState::open, 0.2, 0.2, 0, 0, 0, 0.2, 0.2},
      {"stick", ContactState::stick, 0.05, -0.1, 0, 0.033333333333, -0.234281365494, 0, -0.021906211502},
      {"slip", ContactState::slip, 0.5, -0.1, 0, 0.193791423668, -0.322985706114, 0.209312864497, 0.007661902038},
      {"dilating", ContactState::slip, 1, -0.05, 0, 0.234665843754, -0.391109739590, 0.648001234369, 0.080369913197},
      {"unloaded", ContactState::stick, 0.35, -0.1, 0.209312864497, 0.093791423668, -0.322985706114, 0.209312864497,
       0.007661902038},
      {"reverse", ContactState::slip, -0.6, -0.1, 0.209312864497, -0.212578130501, -0.354296884168, -0.281132804249,
       0.018098961389},
      {"nearly open", ContactState::slip, 0.3, 0.05, 0, 0.011301447522, -0.018835745870, 0.283047828717,
       0.056278581957}};
  for (const auto& r : regimes) {
    SCOPED_TRACE(r.name);
    const auto s = one_step(r.d_t, r.d_n, r.p_old);
    EXPECT_EQ(s.contact, r.state);
    EXPECT_NEAR(s.traction[1], r.shear, 2e-12);  // the exact values have 12 digits
    EXPECT_NEAR(s.traction[0], r.normal, 2e-12);
    EXPECT_NEAR(s.plastic[1], r.plastic, 2e-12);
    EXPECT_NEAR(s.jump[0], r.opening, 2e-12);
  }
}

TEST(Regimes, OnePathThroughAll) {
  const auto states = drive("regimes.xml", {"Time.steps=4"});
  EXPECT_NEAR(states[0].plastic[1], 0.209312864497, 2e-12);
  EXPECT_NEAR(states[1].traction[1], 0.093791423668, 2e-12);
  EXPECT_NEAR(states[2].traction[1], -0.212578130501, 2e-12);
  EXPECT_EQ(states[3].contact, ContactState::open);
  EXPECT_NEAR(states[3].plastic[1], 0.2, 1e-15);
}

const Overrides thesis = {"Materials.joint.tangential stiffness=1e-5", "Materials.joint.friction coefficient=1",
                          "Materials.joint.dilation angle=0",          "Materials.joint.initial gap=0",
                          "Materials.joint.maximum closure=0",         "Point.column normal stiffness=2.001e6",
                          "Point.column tangential stiffness=1e6"};

TEST(Regimes, PushAndPullOfWollmann2024) {
  const auto push = one_step(1, -1, 0, thesis), pull = one_step(1, 1, 0, thesis);
  EXPECT_EQ(push.contact, ContactState::stick);
  EXPECT_NEAR(push.elastic[1], 1 - 1e-11, 1e-14);
  EXPECT_NEAR(push.traction[1], 9.9999999999e-6, 1e-17);
  EXPECT_NEAR(push.traction[0], -2.001e6, 1e-6);
  EXPECT_EQ(pull.contact, ContactState::open);
  EXPECT_EQ(pull.elastic[1], 0);
  EXPECT_NEAR(pull.plastic[1], 1, 1e-15);
  EXPECT_NEAR(pull.jump[0], 1, 1e-15);
}

TEST(Hysteresis, TurningPointsForAnyNumberOfSteps) {
  const Real shear[] = {0.2 / 3, 0.18, 0.18, 0.14 / 3, -0.18, 0.02, 0.18, 0.18};
  const Real plastic[] = {0, 0.23, 0.23, 0.23, -0.23, -0.23, 0.23, 0.23};
  for (int steps : {1, 2, 7, 50}) {
    SCOPED_TRACE(steps);
    const auto states = drive("cyclic_shear.xml", {fmt::format("Time.steps={}", 8 * steps)});
    for (int i = 0; i < 8; ++i) {
      const auto& s = states[(i + 1) * steps - 1];
      EXPECT_NEAR(s.traction[1], shear[i], 1e-14);
      EXPECT_NEAR(s.plastic[1], plastic[i], 1e-14);
    }
  }
}

TEST(Hysteresis, WorkOfACycle) {
  const int quarter = 200;  // the turning points of the loop are steps
  const auto states = drive("cyclic_shear.xml", {"Time.end=2", fmt::format("Time.steps={}", 8 * quarter),
                                                 "Point.path={-0.1, 0.5*(1 - 4*abs(t - rint(t)))}"});
  Real work = 0;  // on the column: integral of the shear traction over the displacement of its end
  const auto end = [](const PointState& s) { return s.jump[1] + s.traction[1]; };  // the stiffness of the column is 1
  for (std::size_t i = states.size() / 2; i < states.size(); ++i)
    work += (states[i].traction[1] + states[i - 1].traction[1]) / 2 * (end(states[i]) - end(states[i - 1]));
  EXPECT_NEAR(work, 4 * 0.18 * (R - S), 1e-12);
}

TEST(Hysteresis, NoDriftInThousandCycles) {
  const auto states =
      drive("cyclic_shear.xml", {"Time.end=2000", "Time.steps=2000", "Point.path={-0.1, 0.5*cos(pi*t)}"});
  for (const auto& s : states) ASSERT_NEAR(s.plastic[1], s.jump[1] > 0 ? 0.23 : -0.23, 1e-13) << "t = " << s.t;
}

TEST(Hysteresis, InUnitsOfRock) {
  const Overrides units = {"Materials.joint.tangential stiffness=20e9", "Point.column normal stiffness=30e9",
                           "Point.column tangential stiffness=10e9", "Point.path={-1e-4, 1e-3*shear(t)}"};
  const auto states = drive("cyclic_shear.xml", units), unscaled = drive("cyclic_shear.xml");
  for (std::size_t i = 0; i < states.size(); ++i) {
    EXPECT_NEAR(states[i].traction[1] / 1e7, unscaled[i].traction[1], 1e-14);
    EXPECT_NEAR(states[i].plastic[1] / 1e-3, unscaled[i].plastic[1], 1e-14);
  }
}

/// Returns the shear tractions after the path (0, 0) -> (R, 0) -> (R, 0.4), with n steps on the second part.
std::array<Real, 2> corner(int n) {
  const auto states = drive("turning_shear.xml", {"Point.path={-0.1, 0.5, 0.4*t}", "Time.end=1",
                                                  "Point.plastic jump={0.23, 0}", fmt::format("Time.steps={}", n)});
  return {states.back().traction[1], states.back().traction[2]};
}

TEST(TurningShear, CornerOfThePath) {
  EXPECT_NEAR(corner(1)[0], 0.100705113900, 1e-12);
  EXPECT_NEAR(corner(1)[1], 0.149192761334, 1e-12);
  EXPECT_NEAR(corner(4)[0], 0.086703396577, 1e-12);
  EXPECT_NEAR(corner(4)[1], 0.157741944397, 1e-12);
}

TEST(TurningShear, FirstOrderInTheStep) {
  const Real psi = 2 * std::atan(std::exp(-0.4 / S));  // between traction and loading, exact in time
  const auto error = [&](int n) {
    const auto lambda = corner(n);
    return std::hypot(lambda[0] - 0.18 * std::sin(psi), lambda[1] - 0.18 * std::cos(psi));
  };
  Real coarse = error(16);
  for (int n : {32, 64, 128}) {
    const Real fine = error(n);
    EXPECT_NEAR(std::log2(coarse / fine), 1, 0.05) << n;
    coarse = fine;
  }
}

/// Returns |u^p| of the periodic state on a circle of radius R, with n steps per revolution.
Real radius_on_circle(int n) {
  const Real turn = 2 * M_PI / n;
  return -S * std::sin(turn / 2) + std::sqrt(R * R - S * S * std::pow(std::cos(turn / 2), 2));
}

TEST(TurningShear, Circle) {
  EXPECT_NEAR(radius_on_circle(64), 0.407792719657, 1e-12);
  for (int n : {8, 64}) {
    SCOPED_TRACE(n);
    const auto last = drive("turning_shear.xml", {fmt::format("Time.steps={}", 12 * n)}).back();
    EXPECT_NEAR(std::hypot(last.plastic[1], last.plastic[2]), radius_on_circle(n), 1e-11);
    const Real lead = std::atan2(last.traction[2], last.traction[1]) - std::atan2(last.plastic[2], last.plastic[1]);
    EXPECT_NEAR(std::cos(lead), std::cos(M_PI / 2 - M_PI / n), 1e-10);
  }
}

TEST(TurningShear, NoDriftInThousandTurns) {
  const auto states = drive("turning_shear.xml", {"Time.end=1000", "Time.steps=64000"});
  for (std::size_t i = 12 * 64; i < states.size(); ++i)
    ASSERT_NEAR(std::hypot(states[i].plastic[1], states[i].plastic[2]), radius_on_circle(64), 1e-11) << states[i].t;
}

struct Extreme {
  const char* what;
  ContactState state;
  Real shear, normal;
  Real d_t = 0.5, d_n = -0.1;
};

TEST(Extremes, OneParameterChanged) {
  const std::pair<Extreme, Overrides> cases[] = {
      {{"K_t", ContactState::stick, 4.999999999995e-13, -0.234281365494},
       {"Materials.joint.tangential stiffness=1e-12"}},
      {{"K_t", ContactState::slip, 0.213889274767, -0.356482124612}, {"Materials.joint.tangential stiffness=1e12"}},
      {{"K_n", ContactState::slip, 0.119704854567, -0.199508090944}, {"Materials.joint.normal stiffness=1e-12"}},
      {{"K_n", ContactState::slip, 0.241649229338, -0.402748715563}, {"Materials.joint.normal stiffness=1e12"}},
      {{"Du", ContactState::slip, 0.241649229337, -0.402748715562}, {"Materials.joint.maximum closure=1e-12"}},
      {{"mu", ContactState::slip, 0, -0.452045899872}, {"Materials.joint.friction coefficient=0"}},
      {{"mu", ContactState::stick, 1.0 / 3, -0.234281365494}, {"Materials.joint.friction coefficient=1e6"}},
      {{"nu = 0.4999", ContactState::stick, 1.0 / 3, -54.5520640332}, {"Point.column normal stiffness=5001"}},
      {{"nu = 0.499999", ContactState::stick, 1.0 / 3, -5005.00451166},
       {fmt::format("Point.column normal stiffness={:.17g}", 2 + 2 * 0.499999 / (1 - 2 * 0.499999))}},
      {{"g0", ContactState::slip, 0.081467548440, -0.135779247399, 0.5, -1e-15}, {"Materials.joint.initial gap=1e-12"}},
      {{"theta", ContactState::slip, 0.332857181374, -0.332857181374},
       {"Materials.joint.dilation angle=89", "Materials.joint.friction coefficient=1"}}};
  for (const auto& [extreme, overrides] : cases) {
    SCOPED_TRACE(fmt::format("{}: {}", extreme.what, overrides.front()));
    const auto s = one_step(extreme.d_t, extreme.d_n, 0, overrides);
    EXPECT_EQ(s.contact, extreme.state);
    EXPECT_NEAR(s.traction[1], extreme.shear, 1e-11 * std::abs(extreme.shear));
    EXPECT_NEAR(s.traction[0], extreme.normal, 1e-11 * std::abs(extreme.normal));
  }
}

TEST(Extremes, ContrastOfRockAndJoint) {
  for (const Real G : {1e12, 1e-12}) {
    auto overrides = thesis;
    overrides.insert(overrides.end(), {fmt::format("Materials.joint.tangential stiffness={:.17g}", 1 / G),
                                       fmt::format("Point.column normal stiffness={:.17g}", 3 * G),
                                       fmt::format("Point.column tangential stiffness={:.17g}", G)});
    const auto s = one_step(1, -1, 0, overrides);
    EXPECT_EQ(s.contact, ContactState::stick) << G;
    EXPECT_NEAR(s.traction[1] / 1e-12, 1, 1e-12) << G;
    EXPECT_NEAR(s.traction[0] / (3 * G), -1, 1e-12) << G;
  }
}

}  // namespace
}  // namespace sprekk::tests
