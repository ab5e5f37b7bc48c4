// Exponential decay of friction and dilation with what slip has worn.
#pragma once

#include "laws/damage/none.hpp"

#include <cmath>
#include <limits>

namespace sprekk::laws {

/// What is left of friction and dilation, each d = r + (1 - r) exp(-Lambda/L), with the history Lambda, m, of the slip:
/// the form of PorePy's fracture_damage after White (2014), there with d0 = 1/r and mu the residual coefficient.
/// `lambda` and how it is kept is what damages differ in.
struct ExponentialDecay {
  Real friction = 0, dilation = 0;                               ///< r
  Real friction_length = std::numeric_limits<Real>::infinity();  ///< L, m
  Real dilation_length = std::numeric_limits<Real>::infinity();

  template <class Law>
  static std::vector<Parameter<Law>> entries() {
    const Real none = std::numeric_limits<Real>::infinity();
    return {{&Law::friction, Entry{"residual part of friction", "-", base::at_least(0).to(1),
                                   "of the bound of friction that damage leaves at last"}
                                 .or_else(0)},
            {&Law::friction_length, Entry{"damage length of friction", "m", base::positive_or_infinite(),
                                          "L of its exponential decay; infinite: it is not damaged"}
                                        .or_else(none)},
            {&Law::dilation, Entry{"residual part of dilation", "-", base::at_least(0).to(1),
                                   "of the opening by slip that damage leaves at last"}
                                 .or_else(0)},
            {&Law::dilation_length, Entry{"damage length of dilation", "m", base::positive_or_infinite(),
                                          "L of its exponential decay; infinite: it is not damaged"}
                                        .or_else(none)}};
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION Left<T> after(const T& lambda) const {
    using std::exp;
    return {friction + (1 - friction) * exp(-lambda / friction_length),
            dilation + (1 - dilation) * exp(-lambda / dilation_length)};
  }
};

/// Lambda is the length of the path that was slipped, weighted by the driver k: sum of k |du|, whatever the direction.
struct IsotropicDamage : ExponentialDecay {
  static constexpr int n_history = 1;  ///< Lambda
  static constexpr const char *name = "isotropic", *meaning = "by slip in any direction";
  static std::vector<Parameter<IsotropicDamage>> parameters() { return entries<IsotropicDamage>(); }

  template <class T>
  KOKKOS_INLINE_FUNCTION Left<T> left(const Contact<T>& at) const {
    return after(T(at.history[0] + at.wear * at.slip_of_step));
  }
  KOKKOS_INLINE_FUNCTION void commit(const Contact<Real>& at, const Numbers<Real>& kept) const {
    if (!at.open) kept[0] += at.wear * at.slip_of_step;
  }
};

/// Asperities wear on the sides that face the slip: Lambda(m) = sum of k |<m.u> - <m.u_before>|, <> the positive part
/// and m the present direction of the plastic jump u, as in PorePy's fracture_damage; in 2D, where m is one of two.
/// Where u passes through 0 what is left jumps from one side's to the other's, and the bound may have no value at which
/// the rock is in equilibrium; so within 1e-3 of the (smaller) damage length it goes linearly from one to the other.
struct AnisotropicDamage : ExponentialDecay {
  static constexpr int n_history = 2;  ///< Lambda(+t), Lambda(-t)
  static constexpr bool flat = true;   ///< in 2D alone
  static constexpr const char *name = "anisotropic", *meaning = "by slip on the side of the present plastic jump (2D)";
  static std::vector<Parameter<AnisotropicDamage>> parameters() { return entries<AnisotropicDamage>(); }

  template <class T>
  KOKKOS_INLINE_FUNCTION Left<T> left(const Contact<T>& at) const {
    const Real width = 1e-3 * (friction_length < dilation_length ? friction_length : dilation_length);
    const T& u = at.plastic_jump[0];
    if (u >= width) return on_side(at, 0);
    if (u <= -width) return on_side(at, 1);
    const auto plus = on_side(at, 0), minus = on_side(at, 1);
    const T share = width < std::numeric_limits<Real>::infinity() ? T((u / width + 1) / 2) : T(1);
    return {minus.friction + share * (plus.friction - minus.friction),
            minus.dilation + share * (plus.dilation - minus.dilation)};
  }
  KOKKOS_INLINE_FUNCTION void commit(const Contact<Real>& at, const Numbers<Real>& kept) const {
    if (at.open) return;
    const auto positive = [](Real x) { return x > 0 ? x : 0; };
    for (const int side : {0, 1}) {
      const Real m = side == 0 ? 1 : -1;
      kept[side] += at.wear * std::abs(positive(m * at.plastic_jump[0]) - positive(m * at.last_plastic_jump[0]));
    }
  }

 private:
  template <class T>
  KOKKOS_INLINE_FUNCTION Left<T> on_side(const Contact<T>& at, int side) const {
    const Real m = side == 0 ? 1 : -1, before = m * at.last_plastic_jump[0];
    const T now = m * at.plastic_jump[0];
    T length = before > 0 ? before : 0;  // |<m.u> - <m.u_before>|
    if (now > 0) length = before > 0 ? at.slip_of_step : at.plastic_slip;
    return after(T(at.history[side] + at.wear * length));
  }
};

}  // namespace sprekk::laws
