// Slip-dependent laws at one point: slip weakening, damage, mobilised roughness, composed friction.
#include "point_scenes.hpp"

namespace sprekk::tests {
namespace {

using laws::ContactState;

constexpr Real K_s = 2.0 / 3;  // column of stiffness 1 in series with a joint of stiffness 2

/// A load step beyond the peak from the end of sticking, and the end of weakening; values by hand.
TEST(SlipWeakening, FollowsTheLine) {
  const auto states = drive("slip_weakening.xml");
  const Real u[] = {0, 0, 3.0 / 55, 0.22, 0.32, 0.42, 0.52};
  for (int k = 0; k < 7; ++k) {
    EXPECT_NEAR(states[k].plastic[1], u[k], 1e-14) << k;
    EXPECT_NEAR(states[k].traction[1], K_s * (0.1 * (k + 1) - u[k]), 1e-14) << k;
  }
  const auto fine = drive("slip_weakening.xml", {"Time.steps=700"});  // implicit steps on a linear law have no time
                                                                      // error
  EXPECT_NEAR(fine[299].plastic[1], u[2], 1e-13);
}

/// The bound decreases faster than the column unloads (1.2 against 2/3), so there is no neighbouring state. Slip jumps
/// from 0 to 0.09 at 0.27, for any steps. States before and after obey the law.
TEST(SlipWeakening, JumpsWhereTheColumnIsTooSoft) {
  for (const int steps : {1, 3, 7, 30}) {
    SCOPED_TRACE(steps);
    const auto states = drive("slip_weakening.xml", {"Materials.joint.weakening distance=0.05", "Time.end=3",
                                                     fmt::format("Time.steps={}", steps)});
    int jumps = 0;
    for (std::size_t k = 0; k < states.size(); ++k) {
      const auto& s = states[k];
      const Real d = 0.1 * s.t;
      const bool after = jumps > 0 || !s.remark.empty();
      EXPECT_NEAR(s.plastic[1], after ? d - 0.12 / K_s : 0, 1e-12) << d;
      if (s.remark.empty()) continue;
      ++jumps;
      EXPECT_NEAR(d, 0.27, 1e-8);
      EXPECT_NEAR(s.plastic[1], 0.09, 1e-8);
      EXPECT_NEAR(states[k - 1].t, s.t, 1e-8);
      EXPECT_NEAR(states[k - 1].traction[1], 0.18, 1e-8);
      EXPECT_NEAR(s.traction[1], 0.12, 1e-12);
      for (const char* word : {"0.09 m", "from 0.18 to 0.12 Pa"}) EXPECT_NE(s.remark.find(word), std::string::npos);
    }
    EXPECT_EQ(jumps, 1);
  }
  for (const auto& s : drive("slip_weakening.xml")) EXPECT_EQ(s.remark, "");
}

/// SI units: peak 0.6 MPa, residual 0.1 MPa, joint and column in series.
TEST(SlipWeakening, JumpsWithAnyNumberOfSteps) {
  const Real K = 1 / (1 / 10e9 + 1 / 1e8);
  for (const int steps : {7, 10, 20, 33, 40, 41, 64, 97, 160}) {
    SCOPED_TRACE(steps);
    int jumps = 0;
    for (const auto& s :
         drive("slip_weakening.xml",
               {"Materials.joint.tangential stiffness=10e9", "Materials.joint.friction coefficient=0.6",
                "Materials.joint.residual friction coefficient=0.1", "Materials.joint.weakening distance=1e-3",
                "Point.path={-1e6, 1e-3*t}", "Point.column tangential stiffness=1e8", "Time.end=20",
                fmt::format("Time.steps={}", steps)})) {
      if (s.remark.empty()) continue;
      ++jumps;
      EXPECT_NEAR(1e-3 * s.t, 0.6e6 / K, 1e-8);
      EXPECT_NEAR(s.plastic[1], 0.5e6 / K, 1e-8);
    }
    EXPECT_EQ(jumps, 1);
  }
}

/// Damage over 0.01 m reduces the bound by 6 Pa/m initially, faster than the column unloads. Slip jumps from the
/// intact bound to the intersection of the column's line with the worn bound.
TEST(Damage, JumpsWhereItIsFast) {
  Real low = 1e-3, high = 1;  // root u > 0 of K_s (0.405 - u) = 0.18 + 0.09 exp(-u/0.01)
  for (int k = 0; k < 100; ++k) {
    const Real u = (low + high) / 2;
    (K_s * (0.405 - u) > 0.18 + 0.09 * std::exp(-100 * u) ? low : high) = u;
  }
  int jumps = 0;
  for (const auto& s :
       drive("damage.xml", {"Materials.joint.damage length of friction=0.01", "Time.end=3", "Time.steps=3"})) {
    if (s.remark.empty()) continue;
    ++jumps;
    EXPECT_NEAR(s.t, 2.025, 1e-8);
    EXPECT_NEAR(s.plastic[1], low, 1e-8);
    EXPECT_NEAR(s.traction[1], 0.18 + 0.09 * std::exp(-100 * low), 1e-8);
  }
  EXPECT_EQ(jumps, 1);
}

/// Gradual weakening: mobilised roughness of a joint sheared by a soft machine. Just before the slip jump, the joint
/// is at its peak strength.
TEST(MobilisedRoughness, JumpsFromItsPeak) {
  const auto states =
      drive("direct_shear.xml", {"Point.control={traction, column}", "Point.column tangential stiffness=20e6",
                                 "Point.path={-1e6, 1e-3*t}", "Point.initial traction={}"});
  int jumps = 0;
  for (std::size_t k = 1; k < states.size(); ++k) {
    if (states[k].remark.empty()) continue;
    ++jumps;
    EXPECT_NEAR(states[k - 1].traction[1], 1.1917535926e6, 2e-3 * 1.19e6);  // up to rounding at the kink
    EXPECT_LT(states[k].traction[1], 1.15e6);
  }
  EXPECT_EQ(jumps, 1);
}

TEST(SlipWeakening, CountsThePathToAndFro) {
  const auto states =
      drive("slip_weakening.xml", {"Point.control={traction, jump}", "Point.path={-0.3, 0.05*(1 - cos(pi*t))}",
                                   "Materials.joint.tangential stiffness=infinite"});
  for (int k = 0; k < 7; ++k) {
    const Real mu = std::max(0.6 - 0.1 * (k + 1), 0.4);
    EXPECT_NEAR(std::abs(states[k].traction[1]), 0.3 * mu, 1e-14) << k;
  }
}

/// Isotropic damage of PorePy: mu 0.6, d0 = 1.5, c = 5, i.e. intact 0.9, residual part 2/3, L = 1/5. Independent
/// values with twelve digits by Lambert's W function.
TEST(Damage, IsotropicUnderCyclicShear) {
  const auto states = drive("damage.xml");
  const struct {
    int step;
    Real u, traction, lambda;
  } expected[] = {{2, 0, 0.266666666667, 0},
                  {3, 0.299855684813, 0.200096210124, 0.299855684813},
                  {5, 0.299855684813, -0.199903789876, 0.299855684813},
                  {6, -0.024031101387, -0.183979265742, 0.623742471014},
                  {7, -0.328698882491, -0.180867411673, 0.928410252117},
                  {10, 0.029783288290, 0.180144474473, 1.286892422898}};
  for (const auto& e : expected) {
    const auto& s = states[e.step - 1];
    EXPECT_NEAR(s.plastic[1], e.u, 1e-9) << e.step;
    EXPECT_NEAR(s.traction[1], e.traction, 1e-9) << e.step;
    if (s.contact != ContactState::slip) continue;
    EXPECT_NEAR(std::abs(s.traction[1]), 0.3 * (0.6 + 0.3 * std::exp(-5 * e.lambda)), 1e-9);
  }
}

/// Returns the history variables of a rigid joint on a path of plastic jumps, from its bound b with mu N = 1 and
/// residual part 0: Lambda = -L ln(b).
std::vector<Real> histories(const std::string& damage, std::vector<Real> path) {
  path.insert(path.begin(), 0);
  std::vector<Real> times(path.size()), all;
  for (std::size_t k = 0; k < times.size(); ++k) times[k] = k;
  for (const auto& s :
       drive("damage.xml",
             {"Materials.joint.tangential stiffness=infinite", "Materials.joint.friction coefficient=1",
              "Materials.joint.residual part of friction=0", "Materials.joint.damage length of friction=1",
              "Materials.joint.damage=" + damage, "Point.control={traction, jump}", "Point.path={-1, shear(t)}",
              fmt::format("Tables.shear.arguments={{{}}}", fmt::join(times, ", ")),
              fmt::format("Tables.shear.values={{{}}}", fmt::join(path, ", ")),
              fmt::format("Time.end={}", times.back()), fmt::format("Time.steps={}", times.back())}))
    all.push_back(-std::log(std::abs(s.traction[1])));
  return all;
}

void expect_equal(const std::vector<Real>& values, const std::vector<Real>& expected) {
  ASSERT_EQ(values.size(), expected.size());
  for (std::size_t k = 0; k < values.size(); ++k) EXPECT_NEAR(values[k], expected[k], 1e-12) << k;
}

/// Two-dimensional paths of PorePy's tests, without steps that have no slip (their bound is unknown).
TEST(Damage, HistoryOfAPath) {
  expect_equal(histories("isotropic", {0.2, 0.01, 0.2, 0.01, -0.2}), {0.2, 0.39, 0.58, 0.77, 0.98});
  expect_equal(histories("isotropic", {-0.2, 0.2, 0.1}), {0.2, 0.6, 0.7});
  expect_equal(histories("anisotropic", {-0.2, 0.2, 0.1}), {0.2, 0.2, 0.3});
}

/// On the way back from u = 0.3, the bound at u = 0 is 0.1845 on the worn side and 0.27 on the intact side. The column
/// traction is 0.2: the joint stays at u = 0 and slips again at 0.27.
TEST(Damage, StaysWhereTheSidesChange) {
  const auto states = drive("damage.xml", {"Materials.joint.damage=anisotropic", "Time.end=7", "Time.steps=7"});
  EXPECT_NEAR(states[4].plastic[1], 0.299855684813, 1e-9);
  EXPECT_NEAR(states[5].plastic[1], 0, 2e-4);
  EXPECT_NEAR(states[5].traction[1], -0.2, 2e-4);
  EXPECT_NEAR(states[6].plastic[1], -0.299855684813, 1e-3);  // up to the wear at u = 0
}

/// Driver: frictional work. mu = 0.5 + 0.3 d, r = 0.3, L = 0.05 MPa m, N = 10 MPa. Independent values with ten to
/// twelve digits: implicit Euler to u = 0.02 in n steps, and the exact history (convergence order 1).
TEST(Damage, DrivenByFrictionalWork) {
  const auto lambda = [](int n) {
    const auto s =
        drive("damage.xml",
              {"Materials.joint.tangential stiffness=infinite", "Materials.joint.friction coefficient=0.8",
               "Materials.joint.residual part of friction=0.7375", "Materials.joint.damage length of friction=0.05",
               "Materials.joint.damage driver=frictional work", "Materials.joint.reference stress=1e6",
               "Point.control={traction, jump}", "Point.path={-10e6, 0.02*t}", "Time.end=1",
               fmt::format("Time.steps={}", n)})
            .back();
    return -0.05 * std::log((s.traction[1] / 8e6 - 0.7375) / (1 - 0.7375));
  };
  const std::pair<int, Real> steps[] = {
      {1, .121683967403}, {4, .128278144050}, {16, .130949304840}, {64, .131707775286}};
  for (const auto& [n, value] : steps) EXPECT_NEAR(lambda(n), value, 1e-9) << n;
  const Real exact = .131969577743;
  EXPECT_NEAR((lambda(512) - exact) / (lambda(1024) - exact), 2, 0.02);
}

/// The work of friction and dilation is never negative: on cyclic paths in both directions, with friction above the
/// dilation.
TEST(Damage, DissipatesInEveryStep) {
  for (const std::string damage : {"isotropic", "anisotropic"})
    for (const std::string driver : {"slip", "compression", "frictional work"}) {
      std::vector<std::string> overrides = {"Materials.joint.dilation angle=8",
                                            "Materials.joint.damage=" + damage,
                                            "Materials.joint.damage driver=" + driver,
                                            "Materials.joint.damage length of dilation=0.3",
                                            "Time.end=6",
                                            "Time.steps=300",
                                            "Point.control={column, column}",
                                            "Point.column normal stiffness=2",
                                            "Point.path={-0.15, 0.6*sin(pi*t) + 0.2*sin(2.7*t)}"};
      if (driver != "slip") overrides.push_back("Materials.joint.reference stress=0.3");
      Real p = 0, opens = 0, maximum = 0;
      int slips = 0;
      for (const auto& s : drive("damage.xml", overrides)) {
        const Real work = s.traction[1] * (s.plastic[1] - p) + s.traction[0] * (s.plastic[0] - opens);
        EXPECT_GE(work, -1e-13) << damage << ", " << driver << ", t = " << s.t;
        slips += s.contact == ContactState::slip;
        maximum = std::max(maximum, work);
        p = s.plastic[1];
        opens = s.plastic[0];
      }
      EXPECT_GT(slips, 100);
      EXPECT_GT(maximum, 1e-4);
    }
}

/// Composed friction for N over N_T and Lambda over L; friction and dilation have the same L except in the last case.
/// Independent values with ten digits. Without damage, the angles add up for N -> 0 (Patton), and at N_T the
/// asperities shear off: 0.5 + 0.3.
TEST(ComposedFriction, KnownValues) {
  const auto mu = [](Real over, Real lambda, Real dilation_length = 1) {
    const auto s = drive(
        "composed.xml", {fmt::format("Point.path={{-{:.17g}, {:.17g}*t}}", over * 40e6, lambda),
                         fmt::format("Materials.joint.damage length of dilation={}", dilation_length), "Time.steps=1"});
    return s.back().traction[1] / (over * 40e6);
  };
  EXPECT_NEAR(mu(.15, 1e-13), .6149016982, 1e-10);
  EXPECT_NEAR(mu(.15, .7), .5818025154, 1e-10);
  EXPECT_NEAR(mu(.4, 1e-13), .6899862458, 1e-10);
  EXPECT_NEAR(mu(.4, 2.5), .5759320923, 1e-10);
  EXPECT_NEAR(mu(.8, .7), .6813819466, 1e-10);
  EXPECT_NEAR(mu(1e-9, 1e-13), std::tan(std::atan(.5) + .05), 1e-8);
  EXPECT_NEAR(mu(1, 1e-13), .8, 1e-12);
  EXPECT_NEAR(mu(1.5, 1e-13), .8, 1e-12);
  EXPECT_NEAR(mu(.15, .7, .613308988), .5782216747, 1e-10);
}

}  // namespace
}  // namespace sprekk::tests
