// Damage laws with exponential decay of friction and dilation.
#pragma once

#include "laws/damage/direction_fan.hpp"
#include "laws/damage/none.hpp"

#include <cmath>
#include <limits>

namespace sprekk::laws {

/// Remaining fractions of friction and dilation, each d = r + (1 - r) exp(-Lambda/L). Lambda is the damage history, m.
/// This is the form of PorePy's fracture_damage after White (2014), with d0 = 1/r and mu the residual coefficient
/// there. Derived laws define Lambda and its history variables.
struct ExponentialDecay {
  Real friction = 0, dilation = 0;                               ///< r of each
  Real friction_length = std::numeric_limits<Real>::infinity();  ///< L of each, m
  Real dilation_length = std::numeric_limits<Real>::infinity();

  template <class Law>
  static std::vector<Parameter<Law>> entries() {
    const Real none = std::numeric_limits<Real>::infinity();
    return {{&Law::friction, Entry{"residual part of friction", "-", base::at_least(0).to(1),
                                   "fraction of the friction bound that remains after complete damage"}
                                 .or_else(0)},
            {&Law::friction_length, Entry{"damage length of friction", "m", base::positive_or_infinite(),
                                          "length L of the exponential decay by damage; infinite: no damage"}
                                        .or_else(none)},
            {&Law::dilation, Entry{"residual part of dilation", "-", base::at_least(0).to(1),
                                   "fraction of the opening by slip that remains after complete damage"}
                                 .or_else(0)},
            {&Law::dilation_length, Entry{"damage length of dilation", "m", base::positive_or_infinite(),
                                          "length L of the exponential decay by damage; infinite: no damage"}
                                        .or_else(none)}};
  }

  template <class Law>
  static std::vector<Quantity<Law>> reported() {
    return {{"damage of friction", "-", "the part of its bound that slip has worn",
             [](const Law& law, const Contact<Real>& at) { return 1 - law.left(at).friction; }},
            {"damage of dilation", "-", "the part of its opening that slip has worn",
             [](const Law& law, const Contact<Real>& at) { return 1 - law.left(at).dilation; }}};
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION Left<T> after(const T& lambda) const {
    using std::exp;
    return {friction + (1 - friction) * exp(-lambda / friction_length),
            dilation + (1 - dilation) * exp(-lambda / dilation_length)};
  }
};

/// Damage by slip in any direction. Lambda = sum of k |du|, the path length of slip weighted by the driver k.
struct IsotropicDamage : ExponentialDecay {
  static constexpr int n_history = 1;  ///< Lambda
  static constexpr const char *name = "isotropic", *meaning = "wear by slip in any direction";
  static std::vector<Parameter<IsotropicDamage>> parameters() { return entries<IsotropicDamage>(); }
  static std::vector<Quantity<IsotropicDamage>> quantities() {
    auto all = reported<IsotropicDamage>();
    all.push_back({"damage history", "m", "what slip has worn, Lambda",
                   [](const IsotropicDamage&, const Contact<Real>& at) -> Real { return at.history[0]; }});
    return all;
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION Left<T> left(const Contact<T>& at) const {
    return after(T(at.history[0] + at.wear * at.slip_of_step));
  }
  KOKKOS_INLINE_FUNCTION void commit(const Contact<Real>& at, const Numbers<Real>& history) const {
    history[0] += at.wear * at.slip_of_step;
  }
};

/// Damage of the asperity flanks that face the slip, as in PorePy's fracture_damage:
///   Lambda(m) = sum of k `|<m.u> - <m.u_before>|`
/// `<x>` is the positive part of x and m the present direction of the plastic jump u. In 2D there are two directions,
/// and two history variables suffice. In 3D Lambda is a directional table with an error bound.
///
/// At u = 0 the fractions jump from one direction's value to the other's, and some loads would have no equilibrium.
/// Therefore they are interpolated for |u| < w, with w = 1e-3 of the smaller damage length:
/// * in 2D linearly between both directions;
/// * in 3D by s^2 (3 - 2 s), s = |u|/w, from the fractions at the mean of Lambda over all m, sum of k |du|/pi.
struct AnisotropicDamage : ExponentialDecay {
  static constexpr int n_history = 1 + DirectionFan::n_numbers;  ///< sum of k |du|, table of Lambda(m)
  static constexpr int n_history_2d = 2;                         ///< Lambda(+t), Lambda(-t)
  static constexpr const char *name = "anisotropic",
                              *meaning = "wear by slip on the side of the present plastic jump (White 2014)";
  static std::vector<Parameter<AnisotropicDamage>> parameters() { return entries<AnisotropicDamage>(); }
  static std::vector<Quantity<AnisotropicDamage>> quantities() {
    auto all = reported<AnisotropicDamage>();
    all.push_back({"damage history", "m", "what slip has worn on the side of the present plastic jump, Lambda",
                   [](const AnisotropicDamage& law, const Contact<Real>& at) { return law.history(at); }});
    all.push_back({"error of damage history", "-", "a bound of it, over the largest Lambda of all directions",
                   [](const AnisotropicDamage& law, const Contact<Real>& at) { return law.error(at); },
                   "damage history"});
    return all;
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION Left<T> left(const Contact<T>& at) const {
    if (at.dim == 3) return left_in_space(at);
    const T& u = at.plastic_jump[0];
    if (u >= width()) return after(history_of_side(at, 0));
    if (u <= -width()) return after(history_of_side(at, 1));
    const T share = width() < std::numeric_limits<Real>::infinity() ? T((u / width() + 1) / 2) : T(1);
    return between(after(history_of_side(at, 1)), after(history_of_side(at, 0)), share);
  }
  KOKKOS_INLINE_FUNCTION void commit(const Contact<Real>& at, const Numbers<Real>& history) const {
    const auto &u = at.plastic_jump, &before = at.last_plastic_jump;
    if (at.dim == 3) {
      history[0] += at.wear * at.slip_of_step;
      DirectionFan fan(at.history.from(1));
      fan.add(before, u, at.wear);
      fan.write(history.from(1));
      return;
    }
    const auto positive = [](Real x) { return x > 0 ? x : 0; };
    for (const int side : {0, 1}) {
      const Real m = side == 0 ? 1 : -1;
      history[side] += at.wear * std::abs(positive(m * u[0]) - positive(m * before[0]));
    }
  }

  /// Lambda in the direction of the present plastic jump, m.
  template <class T>
  KOKKOS_INLINE_FUNCTION T history(const Contact<T>& at) const {
    return at.dim == 3 ? history_along(at) : history_of_side(at, at.plastic_jump[0] < 0);
  }
  /// Error bound of the stored history, relative to its largest value over all directions.
  KOKKOS_INLINE_FUNCTION Real error(const Contact<Real>& at) const {
    if (at.dim != 3) return 0;
    const DirectionFan fan(at.history.from(1));
    return fan.error() > 0 ? fan.error() / fan.largest() : 0;
  }

 private:
  KOKKOS_INLINE_FUNCTION Real width() const {
    return 1e-3 * (friction_length < dilation_length ? friction_length : dilation_length);
  }
  template <class T>
  KOKKOS_INLINE_FUNCTION static Left<T> between(const Left<T>& a, const Left<T>& b, const T& share) {
    return {a.friction + share * (b.friction - a.friction), a.dilation + share * (b.dilation - a.dilation)};
  }
  template <class T>
  KOKKOS_INLINE_FUNCTION T history_of_side(const Contact<T>& at, int side) const {
    const Real m = side == 0 ? 1 : -1, before = m * at.last_plastic_jump[0];
    const T now = m * at.plastic_jump[0];
    T length = before > 0 ? before : 0;  // |<m.u> - <m.u_before>|
    if (now > 0) length = before > 0 ? at.slip_of_step : at.plastic_slip;
    return at.history[side] + at.wear * length;
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION Left<T> left_in_space(const Contact<T>& at) const {
    constexpr Real pi = 3.14159265358979323846;
    const T& size = at.plastic_slip;
    if (size >= width()) return after(history_along(at));
    const auto mean = after(T((at.history[0] + at.wear * at.slip_of_step) / pi));
    if (!(size > 0)) return mean;
    const T s = size / width();
    return between(mean, after(history_along(at)), T(s * s * (3 - 2 * s)));
  }
  /// Lambda(u/|u|) including this step. Slip is parallel to the traction, so |m.u - m.u_before| is its component along
  /// m.
  template <class T>
  KOKKOS_INLINE_FUNCTION T history_along(const Contact<T>& at) const {
    const T& size = at.plastic_slip;
    if (!(size > 0)) return T(0);
    const T m[] = {at.plastic_jump[0] / size, at.plastic_jump[1] / size};
    const auto form = DirectionFan::form(at.history.from(1), value_of(m[0]), value_of(m[1]));
    const T before = m[0] * at.last_plastic_jump[0] + m[1] * at.last_plastic_jump[1];
    T length = size;
    if (before > 0) {
      const T along = m[0] * at.slip_direction[0] + m[1] * at.slip_direction[1];
      length = along < 0 ? T(-along * at.slip_of_step) : T(along * at.slip_of_step);
    }
    const T lambda = form.constant + form.gradient[0] * m[0] + form.gradient[1] * m[1] + at.wear * length;
    return lambda > 0 ? lambda : T(0);
  }
};

}  // namespace sprekk::laws
