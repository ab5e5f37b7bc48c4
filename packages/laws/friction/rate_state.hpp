// Friction that depends on the slip rate and on a state variable.
#pragma once

#include "laws/contact.hpp"
#include "laws/exponentials.hpp"
#include "laws/friction/radiation_damping.hpp"
#include "laws/friction/rate_entries.hpp"
#include "laws/kinds.hpp"

#include <cmath>

namespace sprekk::laws {

/// Returns asinh(exp(y)) for any y.
template <class T>
KOKKOS_INLINE_FUNCTION T asinh_of_exponential(const T& y) {
  using std::exp, std::log, std::sqrt;
  if (y > 0) return y + log(1 + sqrt(1 + exp(-2 * y)));
  const T u = exp(y);
  return logarithm_of_one_and(T(u + u * u / (1 + sqrt(1 + u * u))));
}

/// Mean of exp(-x) between 0 and m >= 0, and its derivative.
template <class T>
KOKKOS_INLINE_FUNCTION T mean_decay(const T& m) {
  return m > 1e-12 ? T(-exponential_less_one(T(-m)) / m) : T(1 - m / 2);
}
KOKKOS_INLINE_FUNCTION Real mean_decay_slope(Real m) {
  if (m > 0.1) return (std::exp(-m) * (1 + m) - 1) / (m * m);
  Real sum = 0, power = -0.5;  // power: (-1)^(k+1) m^k/(k+2)!
  for (int k = 0; k < 9; ++k) {
    sum += power * (k + 1);
    power *= -m / (k + 3);
  }
  return sum;
}

/// Correction of ln theta for a slip rate that grows in a step by the factor exp(2e), in place of its mean. Of second
/// order in the length of the step; with the derivatives in e and in ln m.
struct Lag {
  Real change, by_rate, by_slip;
};

/// Ageing law d theta/dt = 1 - V theta/L (Dieterich 1979), integrated over a step at constant slip rate. All functions:
/// m is the slip of the step divided by L, r the length of the step divided by theta at its start.
struct Ageing {
  static constexpr const char *name = "rate and state",
                              *meaning = "dependent on slip rate and state, ageing law (Dieterich 1979; Ruina 1983)";
  /// Returns ln(theta/theta_old).
  template <class T>
  KOKKOS_INLINE_FUNCTION static T change(const T& m, Real r) {
    using std::exp, std::log;
    const T mean = mean_decay(m), relative = mean * (r - m);
    if (relative < -0.5) return log(exp(-m) + r * mean);
    if (relative >= 0) return logarithm_of_one_and(relative);
    return -logarithm_of_one_and(T(-relative / (1 + relative)));
  }
  /// Derivative of change() in m.
  KOKKOS_INLINE_FUNCTION static Real slope(Real m, Real r) {
    const Real decay = std::exp(-m);
    return (r * mean_decay_slope(m) - decay) / (decay + r * mean_decay(m));
  }
  /// Lower bound of slope() and of the derivative of lag() for all m, with the sign changed.
  KOKKOS_INLINE_FUNCTION static Real steepest(Real) { return 1.5; }
  /// See Lag.
  KOKKOS_INLINE_FUNCTION static Lag lag(Real e, Real m, Real r) {
    const Real w = -std::fmin(1, r) * m / (1 + m) / 6;
    return {w * e, w, w * e / (1 + m)};
  }
};

/// Slip law d theta/dt = -V theta/L ln(V theta/L) (Ruina 1983), likewise.
struct SlipEvolution {
  static constexpr const char *name = "rate and state, slip law",
                              *meaning = "dependent on slip rate and state, slip law (Ruina 1983)";
  template <class T>
  KOKKOS_INLINE_FUNCTION static T change(const T& m, Real r) {
    using std::log;
    return log(m / r) * exponential_less_one(T(-m));
  }
  KOKKOS_INLINE_FUNCTION static Real slope(Real m, Real r) { return -mean_decay(m) - std::log(m / r) * std::exp(-m); }
  KOKKOS_INLINE_FUNCTION static Real steepest(Real r) { return 2.7 + (r < 1 ? -std::log(r) : Real(0)); }
  KOKKOS_INLINE_FUNCTION static Lag lag(Real e, Real m, Real) {
    const Real w = m / (1 + m);
    return {-w * e * (w + e) / 6, -w * (w + 2 * e) / 6, -w * e * (2 * w + e) / (1 + m) / 6};
  }
};

/// Regularised rate-and-state friction with radiation damping, Pa, under the compression N = -lambda_n:
///   b = N a asinh(V/(2 V0) exp(psi/a)) + eta V,  psi = f0 + b ln(V0 theta/L)
/// (Rice, Lapusta and Ranjith 2001; Rice 1993). b = 0 for N <= 0 and for V = 0.
///
/// V is the slip rate at the end of a step. It is extrapolated from the mean rates V_m of this step and of the two
/// steps before, with the step lengths dt, dt_1, dt_2, and r = dt/dt_1:
///   ln V = ln V_m + e + c q/(q + c^2),  q = e^2 + f^2,  e = D tanh(d/D),  d = r/(1 + r) ln(V_m/V_m,1),  D = 2
/// e is of second order. c is the term of third order of a parabola through the logarithms at the middles of the steps,
/// with the slope g at the middle of this step, the curvature k and h = (dt + dt_1)/2:
///   c = k (h dt/4 + dt^2/12) - g^2 dt^2/24
/// It includes the difference between the logarithm of a mean and the mean of the logarithm. f retains it where the
/// slip rate turns smoothly; it vanishes if the last two rates differ by a factor of Euler's number or more:
///   f = 0.2 max(0, 1 - ln(V_m,1/V_m,2)^2)
/// Limits prevent large extrapolations after abrupt changes: g dt is at most D in size. Then d ln V/d ln V_m >= 2/3 for
/// any history, and V increases with V_m. The rate is exact for steady slip, and of third order for step lengths that
/// vary smoothly. At the start, the initial slip rate replaces V_m,1, r/(1 + r) = 1 and c = 0. theta is integrated
/// exactly for the slip rate V_m, and corrected for the change of the rate in the step, see Lag, with e/cosh(d/D)^2:
/// without correction after an abrupt change at the start of the step.
///
/// Without a duration, the bound is that of the slip rate and state at the end of the last step.
template <class Evolution>
struct RateStateFriction {
  /// ln(theta/theta_i); ln(V_m/V_i) of the last step; its length, s; ln(V/V_i) at its end; ln(V_m/V_i) and length of
  /// the step before
  static constexpr int n_history = 6;
  Real direct = 0.01, evolution = 0.01;  ///< a, b
  Real distance = 1;                     ///< L, m
  Real reference_rate = 1e-6;            ///< V0, m/s
  Real reference = 0.6;                  ///< f0
  Real initial_rate = 1e-9;              ///< V_i, m/s
  Real initial_state = 0;                ///< theta_i, s; 0: see log_initial_state()
  Real initial_friction = 0;             ///< f_i; 0: none
  Real damping = 0;                      ///< eta, Pa s/m

  static constexpr const char *name = Evolution::name, *meaning = Evolution::meaning;
  static std::vector<Parameter<RateStateFriction>> parameters() {
    using Law = RateStateFriction;
    return {
        {&Law::direct, Entry{"direct effect", "-", base::positive(), "parameter a of the direct effect of the rate"}},
        {&Law::evolution, Entry{"evolution effect", "-", base::at_least(0), "parameter b of the effect of the state"}},
        {&Law::distance, evolution_distance_entry()},
        {&Law::reference_rate,
         Entry{"reference slip rate", "m/s", base::positive(), "slip rate V0 with the reference friction coefficient"}
             .or_else(1e-6)},
        {&Law::reference, Entry{"reference friction coefficient", "-", base::at_least(0),
                                "friction coefficient f0 in steady slip at the reference slip rate"}
                              .or_else(0.6)},
        {&Law::initial_rate, initial_rate_entry()},
        {&Law::initial_state, Entry{"initial state", "s", base::positive(),
                                    "state variable theta at the start; absent: that of steady slip at the initial "
                                    "slip rate, or of the initial friction coefficient"}
                                  .may_be_absent()},
        {&Law::initial_friction, Entry{"initial friction coefficient", "-", base::positive(),
                                       "ratio of initial shear traction to compression, from which the state at "
                                       "the start follows, in place of the initial state"}
                                     .may_be_absent()},
        {&Law::damping, damping_entry()}};
  }
  static std::vector<Quantity<RateStateFriction>> quantities() {
    return {{"slip rate", "m/s", "at the end of the step",
             [](const RateStateFriction& law, const Contact<Real>& at) -> Real {
               return law.initial_rate * std::exp(at.history[3]);
             }},
            {"friction state", "s", "state variable theta",
             [](const RateStateFriction& law, const Contact<Real>& at) -> Real {
               return std::exp(law.log_initial_state() + at.history[0]);
             }}};
  }
  std::string defect() const {
    if (!(initial_friction > 0)) return "";
    if (initial_state > 0) return "give either \"initial state\" or \"initial friction coefficient\"";
    return evolution > 0 ? "" : "\"initial friction coefficient\": requires an \"evolution effect\" above 0";
  }

  /// ln(theta_i/s)
  KOKKOS_INLINE_FUNCTION Real log_initial_state() const {
    if (initial_state > 0) return std::log(initial_state);
    if (!(initial_friction > 0)) return std::log(distance / initial_rate);
    const Real x = initial_friction / direct;  // psi/a = ln(2 V0/V_i sinh(x))
    const Real psi = direct * (std::log(reference_rate / initial_rate) + x + std::log1p(-std::exp(-2 * x)));
    return std::log(distance / reference_rate) + (psi - reference) / evolution;
  }

  KOKKOS_INLINE_FUNCTION bool depends_on_rate() const { return true; }
  /// Decrease of the friction coefficient per slip, 1/m, behind the tip of a rupture; 0: no rupture.
  Real weakening() const { return evolution > direct ? evolution / distance : 0; }

  template <class T>
  KOKKOS_INLINE_FUNCTION T bound(const Contact<T>& at) const {
    using std::exp, std::log;
    const T N = -at.lambda_n;
    if (!(N > 0)) return T(0);
    if (!(at.duration > 0)) return of_rate(N, T(at.history[3]), T(at.history[0]));
    if (!(at.slip_of_step > 0)) return T(0);
    const T mean = log(at.slip_of_step / (at.duration * initial_rate)), m = at.slip_of_step / distance;
    const End end = at_end(value_of(mean), value_of(m), ratio(at), at.duration, at.history);
    const T change = mean - value_of(mean);  // with derivatives
    return of_rate(N, T(end.rate + end.rate_slope * change),
                   T(at.history[0] + Evolution::change(m, ratio(at)) + end.state + end.state_slope * change));
  }
  /// Derivative of bound() in the slip of the step, Pa/m; slip and duration are positive.
  KOKKOS_INLINE_FUNCTION Real hardening(const Contact<Real>& at) const {
    const Real N = -at.lambda_n, slip = at.slip_of_step;
    if (!(N > 0) || !(slip > 0)) return 0;
    const Real m = slip / distance, r = ratio(at);
    const End end = at_end(std::log(slip / (at.duration * initial_rate)), m, r, at.duration, at.history);
    const Real y = exponent(end.rate, at.history[0] + Evolution::change(m, r) + end.state),
               by_exponent = y > 0 ? 1 / std::sqrt(1 + std::exp(-2 * y)) : std::exp(y) / std::hypot(1, std::exp(y)),
               by_state = m * Evolution::slope(m, r) + end.state_slope;
    return (N * by_exponent * (direct * end.rate_slope + evolution * by_state) +
            damping * initial_rate * std::exp(end.rate) * end.rate_slope) /
           slip;
  }
  /// Upper bound of the decrease of bound() by slip, divided by the compression, 1/m; at least a/L. Only the state
  /// decreases it, since the rate at the end of a step increases with the slip.
  KOKKOS_INLINE_FUNCTION Real softening(const Contact<Real>& at) const {
    return (direct + evolution * Evolution::steepest(ratio(at))) / distance;
  }
  KOKKOS_INLINE_FUNCTION void commit(const Contact<Real>& at, const Numbers<Real>& history) const {
    if (!(at.duration > 0)) return;
    const Real slip = std::fmax(at.slip_of_step, at.duration * slowest),
               mean = std::log(slip / (at.duration * initial_rate)), m = slip / distance, r = ratio(at);
    const End end = at_end(mean, m, r, at.duration, at.history);
    const Real last[] = {mean, at.duration, end.rate, at.history[1], at.history[2]};
    history[0] += Evolution::change(m, r) + end.state;
    for (int k = 0; k < 5; ++k) history[k + 1] = last[k];
  }

  /// Errors of a step; negative in the first one. E, the error of ln V, is the deviation of ln V_m from the line
  /// through V_m,1 and V_1, extrapolated. It changes the slip of the step by E m L, m = slip/L, relative to slip + L by
  /// E m/(1 + m), and the friction coefficient relatively by about E a/(a + f0). The larger one counts: later steps
  /// depend on slip and state only. The error of ln theta is the part of second order, which Lag contains, times
  /// m/(1 + m). Perturbations of steady slip grow at most at the rate s = (b - a')/a' V/L, a' = a + eta V/N (Rice and
  /// Ruina 1983, without stiffness); the error of their growth is (s dt)^3/4. Longer steps suppress instabilities,
  /// since they are implicit.
  KOKKOS_INLINE_FUNCTION StepDefect defect_of_step(const Contact<Real>& at) const {
    const Real dt = at.duration, old = at.history[2];
    if (!(old > 0)) return {-1, -1, 0};
    const Real slip = std::fmax(at.slip_of_step, dt * slowest), mean = std::log(slip / (dt * initial_rate)),
               expected = at.history[1] + (at.history[3] - at.history[1]) * (1 + dt / old), h = (dt + old) / 2,
               m = slip / distance, part = m / (1 + m), of_friction = direct / (direct + reference), N = -at.lambda_n,
               resisting = N > 0 ? direct + damping * slip / (dt * N) : direct + evolution,
               growth = m * std::fmax(evolution / resisting - 1, 0);
    return {std::fmax(part, of_friction) * std::abs(mean - expected) * dt * (dt / 2 + h) / (2 * h * (h + old)),
            part * part * std::abs(mean - at.history[1]) * std::fmin(1, ratio(at)) * dt / h / 12,
            growth * growth * growth / 4};
  }

 private:
  static constexpr Real limit = 2;         // D
  static constexpr Real slowest = 1e-100;  // m/s

  /// ln(V/V_i) and the correction of ln theta at the end of a step, and their derivatives in ln V_m.
  struct End {
    Real rate, rate_slope, state = 0, state_slope = 0;
  };
  template <class T>
  KOKKOS_INLINE_FUNCTION Real ratio(const Contact<T>& at) const {
    return at.duration * std::exp(-log_initial_state() - at.history[0]);
  }
  /// `mean` is ln(V_m/V_i), m the slip of the step divided by L, r the length dt of the step divided by theta.
  KOKKOS_INLINE_FUNCTION static End at_end(Real mean, Real m, Real r, Real dt, const History& history) {
    const Real dt_1 = history[2], dt_2 = history[5], share = dt / (dt + dt_1);
    const Real bend = std::tanh(share * (mean - history[1]) / limit), e = limit * bend, by = share * (1 - bend * bend);
    End end{mean + e, 1 + by};
    if (!(dt_1 > 0)) return end;
    const Real b = bend * bend;
    const Lag lag = Evolution::lag(e * (1 - b), m, r);  // none after an abrupt change
    end.state = lag.change;
    end.state_slope = lag.by_rate * by * (1 - 3 * b) + lag.by_slip;
    if (dt_2 > 0) add_third_order(mean, dt, history, e, by, end);
    return end;
  }
  /// Adds c q/(q + c^2). `by` is the derivative of e. That of c is between -D/6 and (5 + D)/3, and its factor between
  /// -1/8 and 1: the derivative of the term is at least -0.65 by - 1/3.
  KOKKOS_INLINE_FUNCTION static void add_third_order(Real mean, Real dt, const History& history, Real e, Real by,
                                                     End& end) {
    const Real h = (dt + history[2]) / 2, h_1 = (history[2] + history[5]) / 2, s = (mean - history[1]) / h,
               by_k = 2 / (h * (h + h_1)), k = 2 * (s - (history[1] - history[4]) / h_1) / (h + h_1),
               growth = (s + k * h / 2) * dt, size = std::fmin(std::abs(growth), limit),
               by_size = size < limit ? std::copysign((1 / h + by_k * h / 2) * dt, growth) : 0,
               weight = h * dt / 4 + dt * dt / 12, c = k * weight - size * size / 24,
               by_c = by_k * weight - size * by_size / 12;
    const Real last = history[1] - history[4], smooth = 0.2 * std::fmax(1 - last * last, 0),
               q = e * e + smooth * smooth, sum = q + c * c;
    if (!(sum > 0)) return;
    const Real of_q = q / sum, of_c = c * c / sum;
    end.rate += c * of_q;
    end.rate_slope += of_q * (of_q - of_c) * by_c + 2 * of_c * e * c / sum * by;
  }
  /// ln(V/(2 V0)) + psi/a from ln(V/V_i) and ln(theta/theta_i).
  template <class T>
  KOKKOS_INLINE_FUNCTION T exponent(const T& rate, const T& state) const {
    const Real start = std::log(initial_rate / (2 * reference_rate)),
               psi = reference + evolution * (std::log(reference_rate / distance) + log_initial_state());
    return start + rate + (psi + evolution * state) / direct;
  }
  template <class T>
  KOKKOS_INLINE_FUNCTION T of_rate(const T& N, const T& rate, const T& state) const {
    using std::exp;
    const T friction = N * direct * asinh_of_exponential(exponent(rate, state));
    return damping > 0 ? T(friction + damping * initial_rate * exp(rate)) : friction;
  }
};

using AgeingFriction = RateStateFriction<Ageing>;
using SlipLawFriction = RateStateFriction<SlipEvolution>;

}  // namespace sprekk::laws
