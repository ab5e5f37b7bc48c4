// Dilation of a rough joint, with roughness mobilised and worn by slip.
#pragma once

#include "laws/contact.hpp"
#include "laws/roughness.hpp"

namespace sprekk::laws {

/// Opening by slip, m, after Barton. Slip du away from the initial position opens the joint by tan(d) du; slip back
/// closes it. The angle after the path s, under the compression N, is
///   d = f(s/delta_p) JRC log10(JCS/N)/M degrees, never negative
/// A step uses the mean of tan(d) along its path with N at its end. This is exact at constant N and first-order
/// accurate otherwise.
struct MobilisedDilation {
  static constexpr int n_history = 2;  ///< path length s, present opening; m
  Real roughness = 0;                  ///< JRC, degree
  Real wall_strength = 1;              ///< JCS, Pa
  Real damage = 2;                     ///< M
  Real length = 0, sample = 0.1;       ///< joint and sample length as in friction, m
  Real peak_slip = 0;                  ///< delta_p, m

  static constexpr const char *name = "mobilised", *meaning = "rough joint, by JRC and JCS, mobilised by slip";
  static std::vector<Parameter<MobilisedDilation>> parameters() {
    using Law = MobilisedDilation;
    return {{&Law::roughness, roughness_entry()},
            {&Law::wall_strength, wall_strength_entry()},
            {&Law::damage, Entry{"asperity damage coefficient", "-", base::positive(),
                                 "damage coefficient M: the fraction 1/M of the roughness angle causes dilation; "
                                 "typical: 1 at low, 2 at high stress"}
                               .or_else(2)},
            {&Law::length, length_entry()},
            {&Law::sample, sample_entry()},
            {&Law::peak_slip, peak_slip_entry()}};
  }
  static std::vector<Quantity<MobilisedDilation>> quantities() {
    return {accumulated_slip<MobilisedDilation>(),
            {"opening by slip", "m", "of a joint that is not damaged",
             [](const MobilisedDilation&, const Contact<Real>& at) -> Real { return at.history[1]; }}};
  }
  void complete() {
    if (length > 0) scale_roughness(roughness, wall_strength, length, sample);
    if (peak_slip == 0 && length > 0) peak_slip = peak_slip_of(roughness, length);
  }
  std::string defect() const { return peak_slip > 0 ? "" : "give either \"peak slip\" or \"joint length\""; }

  template <class T>
  KOKKOS_INLINE_FUNCTION T opening(const Contact<T>& at) const {
    using std::log10, std::sqrt;
    constexpr Real degree = 3.14159265358979323846 / 180;
    const Real* old = at.last_plastic_jump;
    const T moved = at.plastic_slip - sqrt(old[0] * old[0] + old[1] * old[1]);
    T angle = 0;  // d/f, radians
    const T N = -at.lambda_n;
    const Real minimum = 1e-6 * wall_strength;  // constant angle below this compression
    if (N < wall_strength) angle = degree * roughness / damage * (N > minimum ? T(log10(wall_strength / N)) : T(6));
    return at.history[1] + moved * mean_tangent(at.history[0] / peak_slip, T(at.rubs * at.slip_of_step), angle);
  }
  KOKKOS_INLINE_FUNCTION void commit(const Contact<Real>& at, const Numbers<Real>& history) const {
    history[1] = opening(at);
    history[0] += at.rubs * at.slip_of_step;
  }

 private:
  /// Mean of tan(f angle) over a slip that begins at s/delta_p = x.
  template <class T>
  KOKKOS_INLINE_FUNCTION T mean_tangent(Real x, const T& slip, const T& angle) const {
    static constexpr auto table = mobilised_roughness();
    const T end = x + slip / peak_slip;
    if (!(slip > 1e-9 * peak_slip)) return tangent_over(T(angle * table.sharp(end)), T(0));
    T sum = 0, from = x;
    for (int k = 0; from < end; ++k) {  // from corner to corner of f
      const bool last = k == table.size;
      if (!last && !(from < table.x[k])) continue;
      const T to = last || end < table.x[k] ? end : T(table.x[k]);
      const T a = angle * table.sharp(from), b = angle * table.sharp(to);
      sum += (to - from) * tangent_over(a, T(b - a));
      from = to;
    }
    return sum / (end - x);
  }
  /// Mean of tan between a and a + by.
  template <class T>
  KOKKOS_INLINE_FUNCTION static T tangent_over(const T& a, const T& by) {
    using std::cos, std::log, std::tan;
    if (by < 0.03 && by > -0.03) {  // series about the midpoint, because the logarithm loses digits
      const T t = tan(a + by / 2), q = t * t, h = by * by;
      const T second = 2 + 2 * q, fourth = 16 + q * (40 + 24 * q), sixth = 272 + q * (1232 + q * (1680 + 720 * q));
      return t * (1 + h * (second / 24 + h * (fourth / 1920 + h * sixth / 322560)));
    }
    return log(cos(a) / cos(a + by)) / by;
  }
};

}  // namespace sprekk::laws
