// Laws of rough joints at one point: mobilised roughness with scale effect and dilation, closure. Numbers with nine or
// ten digits are independent evaluations of the formulas.
#include "point_scenes.hpp"

namespace sprekk::tests {
namespace {

using Overrides = std::vector<std::string>;

constexpr Real peak = 0.9141763792e-3;  // delta_p of JRC 10 and 0.1 m

/// Returns the state of the joint of direct_shear.xml under 1 MPa (constant normal load), sheared to x delta_p in one
/// step.
PointState sheared(Real x, Overrides overrides = {}) {
  overrides.insert(overrides.begin(), {"Point.control={traction, jump}", "Time.end=1", "Time.steps=1",
                                       fmt::format("Point.path={{-1e6, {:.17g}}}", x * peak)});
  return drive("direct_shear.xml", overrides).back();
}

TEST(MobilisedRoughness, StrengthUnderConstantLoad) {
  const std::pair<Real, Real> between[] = {
      {0.15, .2679491924}, {0.45, .7673269880}, {0.8, 1.0913085011}, {1.5, 1.1302943864}, {50, .7147570420}};
  for (const auto& [x, tau] : between) EXPECT_NEAR(sheared(x).traction[1], tau * 1e6, 1e-9 * 1e6) << x;
  // Points of the table, which are rounded within 1e-3 of the roughness.
  const std::pair<Real, Real> corners[] = {{0.3, .5773502692}, {0.6, 1},          {1, 1.1917535926}, {2, 1.0723687100},
                                           {4, .9656887748},   {10, .8390996312}, {100, .5773502692}};
  for (const auto& [x, tau] : corners) EXPECT_NEAR(sheared(x).traction[1], tau * 1e6, 1e-3 * 1e6) << x;
}

/// The strength depends on the length of the slip path: many steps, also backward ones, give equal strength.
TEST(MobilisedRoughness, CountsThePath) {
  const auto states =
      drive("direct_shear.xml", {"Point.control={traction, jump}", "Time.end=1", "Time.steps=60",
                                 fmt::format("Point.path={{-1e6, {:.17g}*min(t, 1.5 - t)}}", 2 * peak)});
  EXPECT_NEAR(states[44].traction[1], 1.1302943864e6, 1e-3);
  EXPECT_NEAR(states[59].traction[1], -sheared(2.0 - 1e-9).traction[1], 1e3);
}

TEST(MobilisedRoughness, Dilation) {
  const struct {
    Real x, once, twice;  // mm, M = 1 and 2
  } openings[] = {{1, .151693359, .074292531},
                  {2, .457650228, .223184339},
                  {4, .964822112, .472026705},
                  {10, 2.131202423, 1.048588752}};
  for (const auto& e : openings)
    for (const int M : {1, 2}) {
      const auto s = sheared(e.x, {fmt::format("Materials.joint.asperity damage coefficient={}", M)});
      EXPECT_NEAR(s.plastic[0] * 1e3, M == 1 ? e.once : e.twice, 2e-9) << e.x;
    }
  const auto steps = drive("direct_shear.xml", {"Point.control={traction, jump}", "Time.end=1", "Time.steps=37",
                                                fmt::format("Point.path={{-1e6, {:.17g}*t}}", 4 * peak)});
  EXPECT_NEAR(steps.back().plastic[0] * 1e3, .472026705, 2e-9);
}

/// Springs of 5 MPa/mm resist dilation: dN/ds = k tan(d(s, N)). The reference is an independent Runge-Kutta
/// integration; implicit Euler converges to it with order 1.
TEST(MobilisedRoughness, ConstantNormalStiffness) {
  const struct {
    Real x, N, tau;
  } exact[] = {{.6, 1.0891511405, 1.0786268694},
               {1, 1.3581459115, 1.5443426316},
               {2, 2.0173095722, 1.9761462363},
               {4, 3.0110590869, 2.5852566776},
               {10, 5.0221634792, 3.7156013183}};
  const auto at = [](Real x, int steps) {
    return drive("direct_shear.xml",
                 {"Materials.joint.closure=Barton-Bandis", "Materials.joint.maximum closure=0", "Time.end=1",
                  fmt::format("Time.steps={}", steps), fmt::format("Point.path={{0, {:.17g}*t}}", x * peak)})
        .back();
  };
  for (const auto& e : exact) {
    const auto coarse = at(e.x, 200), fine = at(e.x, 400);
    EXPECT_NEAR(coarse.traction[0], -e.N * 1e6, 2e-2 * 1e6) << e.x;
    const Real error = coarse.traction[0] + e.N * 1e6, half = fine.traction[0] + e.N * 1e6;
    EXPECT_NEAR(error / half, 2, 0.05) << e.x;
    EXPECT_NEAR(2 * fine.traction[0] - coarse.traction[0], -e.N * 1e6, 1e-4 * 1e6) << e.x;
    if (e.x == 2) EXPECT_NEAR(2 * fine.traction[1] - coarse.traction[1], e.tau * 1e6, 1e-3 * 1e6);
  }
}

/// At constant volume, the normal jump stays as under the initial traction.
TEST(MobilisedRoughness, ConstantVolume) {
  const auto states = drive("direct_shear.xml", {"Point.control={jump, jump}"});
  for (const auto& s : states) {
    EXPECT_NEAR(s.jump[0], -1e6 / 50e9, 1e-18);
    EXPECT_NEAR(s.traction[0], -50e9 * (s.plastic[0] + 1e6 / 50e9), 1e-6 * 1e6);
  }
  EXPECT_LT(states.back().traction[0], -3e6);
}

/// JRC and JCS of samples of 0.1 m, scaled to longer joints.
TEST(JointScale, StrengthAndPeakSlip) {
  const struct {
    Real JRC, JCS, length, peak_slip, tau;
  } joints[] = {{10, 100, 1, 3.673076687e-3, .860933867},
                {15, 80, 5, 9.755555043e-3, .707553680},
                {5, 50, 2, 4.902822882e-3, .715207846}};
  for (const auto& j : joints) {
    const Overrides numbers = {fmt::format("Materials.joint.joint roughness coefficient={}", j.JRC),
                               fmt::format("Materials.joint.joint wall strength={} MPa", j.JCS),
                               fmt::format("Materials.joint.joint length={}", j.length)};
    auto peak_strength = numbers;
    peak_strength.push_back("Materials.joint.friction=Barton-Choubey");
    EXPECT_NEAR(sheared(1, peak_strength).traction[1], j.tau * 1e6, 1e-3);
    // at 0.3 of the peak slip, only the residual friction is mobilised
    const auto early = sheared(0.15 * j.peak_slip / peak, numbers);
    EXPECT_NEAR(early.traction[1], 1e6 * std::tan(M_PI / 12), 1e-3);
  }
}

/// On unloading, the closure decreases less by the fraction r, and r V(N_max) remains. V(5 MPa) = 0.09375 mm by hand.
TEST(ClosureWithMemory, UnloadsStifferAndKeepsAPart) {
  const auto V = [](Real N) { return 0.15e-3 * N / (20e9 * 0.15e-3 + N); };
  Real largest = 0, before = 0, closed_before = 0, work = 0;
  for (const auto& s : drive("closure_cycles.xml")) {
    const Real N = -s.traction[0];
    largest = std::max(largest, N);
    EXPECT_NEAR(-s.jump[0], 0.6 * V(N) + 0.4 * V(largest), 1e-17) << s.t;
    EXPECT_NEAR(-s.elastic[0], 0.6 * V(N), 1e-17) << s.t;
    work += (N + before) / 2 * (-s.jump[0] - closed_before);
    before = N;
    closed_before = -s.jump[0];
    if (std::abs(s.t - std::round(s.t)) < 1e-9 && std::lround(s.t) % 2 == 0) EXPECT_GT(work, 0);
  }
  EXPECT_NEAR(V(5e6), 0.09375e-3, 1e-17);
}

}  // namespace
}  // namespace sprekk::tests
