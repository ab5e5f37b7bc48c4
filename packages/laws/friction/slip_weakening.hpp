// Friction that decreases with the path length of slip.
#pragma once

#include "laws/contact.hpp"
#include "laws/friction/radiation_damping.hpp"
#include "laws/kinds.hpp"

namespace sprekk::laws {

/// Bound on |lambda_t|, Pa, with linear slip weakening:
///   b = -lambda_n (mu_r + (mu_p - mu_r) max(0, 1 - s/D)) + eta V
/// s is the path length of slip of closed faces, V the mean slip rate of the step. There is no healing. If the bound
/// decreases faster than the rock unloads, N (mu_p - mu_r)/D > k, slip is unstable and jumps to a distant state.
struct SlipWeakeningFriction {
  static constexpr int n_history = 1;  ///< s, m
  Real peak = 0, residual = 0;         ///< mu_p, mu_r
  Real distance = 1;                   ///< D, m
  Real damping = 0;                    ///< eta, Pa s/m

  static constexpr const char *name = "slip weakening", *meaning = "linear decrease with slip, from peak to residual";
  static std::vector<Parameter<SlipWeakeningFriction>> parameters() {
    using Law = SlipWeakeningFriction;
    return {{&Law::peak, Entry{"friction coefficient", "-", base::at_least(0),
                               "friction coefficient mu at peak, in place of the angle"}},
            {&Law::peak, Entry{"friction angle", "degree", base::at_least(0).below(90),
                               "friction angle atan(mu) at peak, in place of the coefficient"}
                             .converted(tangent_of_degrees)},
            {&Law::residual, Entry{"residual friction coefficient", "-", base::at_least(0),
                                   "residual friction coefficient mu_r at large slip, in place of the angle"}},
            {&Law::residual, Entry{"residual friction angle", "degree", base::at_least(0).below(90),
                                   "residual friction angle atan(mu_r), in place of the coefficient"}
                                 .converted(tangent_of_degrees)},
            {&Law::distance, Entry{"weakening distance", "m", base::positive(),
                                   "slip distance D over which friction falls to its residual value"}},
            {&Law::damping, damping_entry()}};
  }
  static std::vector<Quantity<SlipWeakeningFriction>> quantities() {
    return {accumulated_slip<SlipWeakeningFriction>()};
  }
  std::string defect() const {
    return residual > peak ? "residual friction must not be above the friction at peak" : "";
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION T bound(const Contact<T>& at) const {
    const T left = 1 - (at.history[0] + at.slip_of_step) / distance;
    const T coefficient = left > 0 ? T(residual + (peak - residual) * left) : T(residual);
    if (!depends_on_rate() || !(at.duration > 0) || !(at.slip_of_step > 0) || !(at.lambda_n < 0))
      return -coefficient * at.lambda_n;
    return damping / at.duration * at.slip_of_step - coefficient * at.lambda_n;
  }
  KOKKOS_INLINE_FUNCTION bool depends_on_rate() const { return damping > 0; }
  /// Decrease of the friction coefficient per slip, 1/m, behind the tip of a rupture.
  Real weakening() const { return (peak - residual) / distance; }
  /// Derivative of bound() in the slip of the step, Pa/m; slip and duration are positive.
  KOKKOS_INLINE_FUNCTION Real hardening(const Contact<Real>& at) const {
    if (!(at.lambda_n < 0)) return 0;
    const bool weakens = at.history[0] + at.slip_of_step < distance;
    return damping / at.duration + (weakens ? (peak - residual) / distance * at.lambda_n : 0);
  }
  /// Upper bound of the decrease of bound() by slip, divided by the compression, 1/m.
  KOKKOS_INLINE_FUNCTION Real softening(const Contact<Real>&) const { return peak / distance; }
  KOKKOS_INLINE_FUNCTION void commit(const Contact<Real>& at, const Numbers<Real>& history) const {
    history[0] += at.rubs * at.slip_of_step;
  }
};

}  // namespace sprekk::laws
