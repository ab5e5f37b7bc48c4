// Points of a joint with rate-and-state friction, compared with exact solutions and with an explicit integration.
#include "point_scenes.hpp"

#include <complex>

namespace sprekk::tests {
namespace {

constexpr Real a = 0.01, b = 0.015, L = 1e-5, V0 = 1e-6, f0 = 0.6, N = 50e6, eta = 4.41e6;  // of the scenes
constexpr Real k_c = (b - a) * N / L;

Real slip_rate(const PointState& state) { return state.quantities.at(0); }

std::string entry(const std::string& name, Real value) { return fmt::format("{}={:.17g}", name, value); }

/// Shear traction at slip rate V and state theta.
Real shear(Real V, Real theta) {
  return N * a * std::asinh(V / (2 * V0) * std::exp((f0 + b * std::log(V0 * theta / L)) / a)) + eta * V;
}

/// Friction at the rate of the velocity steps, with the exact state of the ageing law.
TEST(RateStatePoint, VelocityStepsAreExactAwayFromThem) {
  const auto states = drive("rate_state.xml");
  int compared = 0;
  for (const auto& state : states) {
    if (state.t < 20 + 1e-3) {
      if (state.t <= 20 && state.t > 0) {
        EXPECT_NEAR(state.traction[1] / N, 0.6, 1e-9) << state.t;
      }
      continue;
    }
    Real theta = 1 + 9 * std::exp(-(state.t - 20)), rate = 1e-5;  // s, m/s
    if (state.t > 25) {
      theta = 10 + (1 + 9 * std::exp(-5.0) - 10) * std::exp(-(state.t - 25) / 10);
      rate = 1e-6;
    }
    if (state.t > 25 && state.t < 25 + 1e-2) continue;
    EXPECT_NEAR(state.traction[1], shear(rate, theta) - eta * rate, 1e-7 * N) << state.t;
    ++compared;
  }
  EXPECT_GT(compared, 10);
}

/// A strength reduction factor of 2 halves the friction of steady slip, but not the radiation damping.
TEST(RateStatePoint, StrengthReductionDoesNotReduceRadiationDamping) {
  constexpr Real strong = 1e13;
  const auto states = drive("rate_state.xml", {"Materials.joint.strength reduction factor=2",
                                               entry("Materials.joint.radiation damping", strong)});
  int compared = 0;
  for (const auto& state : states) {
    if (state.t <= 0 || state.t > 20) continue;
    EXPECT_NEAR(state.traction[1] / N, 0.3 + strong * 1e-6 / N, 1e-9) << state.t;
    ++compared;
  }
  EXPECT_GT(compared, 3);
}

/// Gouge opens by o = h eps ln(10) (1 - exp(-s/L)) after the slip s at ten times the rate, and closes again at the old
/// rate. Pressed by a stiff column, the compression increases by the stiffness times o.
TEST(RateStatePoint, GougeDilatesByTheSlipRate) {
  constexpr Real h = 1e-3, eps = 2e-4, stiffness = 2e12, steady = h * eps * 2.302585092994046;
  const std::vector<std::string> gouge = {"Materials.joint.dilation=slip rate",
                                          entry("Materials.joint.gouge thickness", h),
                                          entry("Materials.joint.dilatancy coefficient", eps)};
  auto column = gouge;
  for (const auto& other :
       {fmt::format("Point.initial traction={{{}, {:.17g}}}", -N, shear(1e-6, 10)),
        entry("Point.column normal stiffness", stiffness), std::string("Point.control={column, jump}"),
        std::string("Point.path={0, 1e-6*t + 9e-6*(max(t - 20, 0) - max(t - 25, 0))}")})
    column.push_back(other);
  for (const bool pressed : {false, true}) {
    for (const auto& state : drive("rate_state.xml", pressed ? column : gouge)) {
      const Real fast = std::clamp(state.t - 20, Real(0), Real(5)), slow = std::max(state.t - 25, Real(0));
      const Real opening = steady * (1 - std::exp(-fast)) * std::exp(-slow / 10);
      ASSERT_NEAR(state.jump[0], opening, 1e-9 * steady) << state.t;
      ASSERT_NEAR(state.quantities.at(0), opening, 1e-9 * steady) << state.t;
      ASSERT_NEAR(state.traction[0], -N - (pressed ? stiffness * opening : 0), 1e-9 * N) << state.t;
    }
  }
}

/// Rates of ln V and ln theta of a spring slider.
struct Slider {
  Real stiffness, pull;  // k, Pa/m; V_p, m/s
  bool ageing;
  std::array<Real, 2> operator()(const std::array<Real, 2>& x) const {
    const Real V = std::exp(x[0]), theta = std::exp(x[1]);
    const Real ageing_rate = 1 / theta - V / L, slip_rate = -V / L * std::log(V * theta / L);
    const Real state = ageing ? ageing_rate : slip_rate;
    const Real u = V / (2 * V0) * std::exp((f0 + b * std::log(V0 * theta / L)) / a), part = u / std::hypot(1, u);
    return {(stiffness * (pull - V) - N * b * part * state) / (N * a * part + eta * V), state};
  }
};

/// Classical Runge-Kutta method of order 4.
std::array<Real, 2> integrate(const Slider& slider, std::array<Real, 2> x, Real time, int steps) {
  const Real h = time / steps;
  const auto at = [&](const std::array<Real, 2>& rate, Real part) {
    return slider({x[0] + part * h * rate[0], x[1] + part * h * rate[1]});
  };
  for (int k = 0; k < steps; ++k) {
    const auto k1 = slider(x), k2 = at(k1, 0.5), k3 = at(k2, 0.5), k4 = at(k3, 1);
    for (int i = 0; i < 2; ++i) x[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
  }
  return x;
}

/// States of the scene of the spring slider with n equal steps, from the slip rate V and the state theta.
std::vector<PointState> slide(const std::string& law, Real stiffness, Real pull, Real V, Real theta, Real end, int n) {
  auto scene =
      read("spring_slider.xml",
           {entry("Point.column tangential stiffness", stiffness), entry("Materials.joint.initial slip rate", V),
            entry("Materials.joint.initial state", theta), fmt::format("Materials.joint.friction={}", law),
            fmt::format("Point.initial traction={{{}, {:.17g}}}", -N, shear(V, theta)),
            fmt::format("Point.path={{{}, {:.17g}*t}}", -N, pull), entry("Time.end", end)});
  scene.time.tolerance.reset();
  scene.time.first_step.reset();
  scene.time.steps = n;
  return laboratory::drive_point(scene);
}

/// A stiff machine pulls ten times as fast as before. Errors of ln V at the end of the run, by the number of steps.
TEST(RateStatePoint, IsOfThirdOrderInTheStepLength) {
  for (const bool ageing : {true, false}) {
    const Slider slider{2 * k_c, 1e-5, ageing};
    const Real end = 1.5, exact = integrate(slider, {std::log(1e-6), std::log(10)}, end, 20000)[0];
    std::vector<Real> errors;
    for (const int n : {100, 200, 400}) {
      const auto states =
          slide(ageing ? "rate and state" : "rate and state, slip law", 2 * k_c, 1e-5, 1e-6, 10, end, n);
      errors.push_back(std::abs(std::log(slip_rate(states.back())) - exact));
    }
    EXPECT_LT(errors[2], 1e-5) << fmt::format("{}", fmt::join(errors, ", "));
    EXPECT_GT(errors[0] / errors[1], 6) << fmt::format("{}", fmt::join(errors, ", "));
    EXPECT_GT(errors[1] / errors[2], 6) << fmt::format("{}", fmt::join(errors, ", "));
  }
}

/// Small perturbations of steady slip are x(t) = Re(C exp(s V t/L)), where A s^2 + (A + kappa - b) s + kappa = 0 with
/// A = a + eta V/N, kappa = k L/N. They decay for k above (b - A) N/L.
TEST(RateStatePoint, PerturbationsOfSteadySlipGrowOrDecayAsInTheory) {
  constexpr Real V = 1e-6, kick = 1e-4, A = a + eta * V / N, end = 60;
  for (const Real relative : {0.9, 1.0, 1.2}) {
    const Real kappa = relative * (b - A), half = (A + kappa - b) / (2 * A);
    const std::complex<Real> root = std::sqrt(std::complex<Real>(half * half - kappa / A)), s = -half + root;
    // x(0) = kick, y(0) = 0, and dx/dt(0) V/L from the law
    const Real rate = (b - kappa) / A * kick;
    const auto C = kick / 2.0 + (rate + half * kick) / (2.0 * root);
    const auto states = slide("rate and state", kappa * N / L, V, V * (1 + kick), L / V, end, 1500);
    for (const auto& state : states) {
      const Real x = 2 * std::real(C * std::exp(s * V / L * state.t));
      ASSERT_NEAR(std::log(slip_rate(state) / V), x, 2e-2 * kick) << relative << ' ' << state.t;
    }
  }
}

/// Times at which the slip rate rises above 1e-3 m/s, and the largest slip rate.
struct Events {
  std::vector<Real> onsets;
  Real fastest = 0;
};
Events events(const std::vector<std::string>& overrides) {
  Events events;
  PointState last;
  for (auto& state : drive("spring_slider.xml", overrides)) {
    const Real V = slip_rate(state), before = last.quantities.empty() ? V : slip_rate(last);
    if (before < 1e-3 && V >= 1e-3)
      events.onsets.push_back(last.t + (state.t - last.t) * std::log(1e-3 / before) / std::log(V / before));
    events.fastest = std::max(events.fastest, V);
    last = std::move(state);
  }
  return events;
}

/// Reference: integration with relative tolerances of 1e-8 and 1e-10 that agree to 2e-9. The error is proportional to
/// the tolerance; the first event grows from a small perturbation of steady slip, and is the least accurate.
TEST(RateStatePoint, SpringSliderHasItsEvents) {
  const auto coarse = events({"Time.tolerance=2e-5"}), fine = events({"Time.tolerance=5e-6"});
  ASSERT_EQ(fine.onsets.size(), 2);
  ASSERT_EQ(coarse.onsets.size(), 2);
  EXPECT_NEAR(fine.onsets[0] / 381465.562, 1, 2e-4);
  EXPECT_NEAR((4 * fine.onsets[0] - coarse.onsets[0]) / 3 / 381465.562, 1, 1e-4);  // extrapolated
  EXPECT_NEAR((fine.onsets[1] - fine.onsets[0]) / 559979.9032, 1, 1e-4);
  EXPECT_NEAR(fine.fastest / .87426, 1, 1e-4);
}

TEST(RateStatePoint, SpringSliderWithTheSlipLawHasItsEvents) {
  const auto events =
      tests::events({"Materials.joint.friction=rate and state, slip law", "Time.tolerance=2e-5", "Time.end=7e5"});
  ASSERT_EQ(events.onsets.size(), 2);
  EXPECT_NEAR(events.onsets[0] / 149097.5627, 1, 1e-4);
  EXPECT_NEAR(events.onsets[1] / 663854.2682, 1, 1e-4);
  EXPECT_NEAR(events.fastest / 1.07391, 1, 1e-4);
}

/// A perturbation of steady slip by 1e-6, far below the tolerance, becomes an event: steps resolve its growth.
TEST(RateStatePoint, StepsDoNotSuppressInstabilities) {
  constexpr Real V = 1e-9 * (1 + 1e-6), theta = 1e4;
  const auto events =
      tests::events({entry("Materials.joint.initial slip rate", V), "Time.tolerance=1e-2",
                     fmt::format("Point.initial traction={{-50e6, {:.17g}}}", shear(V, theta)), "Time.end=2e6"});
  EXPECT_GE(events.onsets.size(), 1);
}

/// The compression vanishes at 5000 s. There is no state beyond, and the steps end there.
TEST(RateStatePoint, EndsWithTheCompression) {
  const auto curves =
      laboratory::drive_points(read("spring_slider.xml", {"Point.path={-50e6 + 1e4*t, 1e-9*t}", "Time.end=1e4"}));
  EXPECT_NE(curves[0].failure.find("the last state is that at t = 5000"), std::string::npos) << curves[0].failure;
  ASSERT_FALSE(curves[0].states.empty());
  EXPECT_NEAR(curves[0].states.back().t, 5000, 1e-6);
}

}  // namespace
}  // namespace sprekk::tests
