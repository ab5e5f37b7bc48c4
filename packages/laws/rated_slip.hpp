// Slip of a step under friction that depends on the slip rate.
#pragma once

#include "laws/contact.hpp"

#include <cmath>

namespace sprekk::laws {

/// Contact without derivatives.
template <class T>
KOKKOS_INLINE_FUNCTION Contact<Real> value_of(const Contact<T>& at) {
  Contact<Real> value;
  value.lambda_n = value_of(at.lambda_n);
  value.shear = value_of(at.shear);
  value.plastic_slip = value_of(at.plastic_slip);
  value.slip_of_step = value_of(at.slip_of_step);
  value.separation = value_of(at.separation);
  value.friction_left = value_of(at.friction_left);
  value.dilation_left = value_of(at.dilation_left);
  value.wear = value_of(at.wear);
  for (int i = 0; i < 2; ++i) {
    value.plastic_jump[i] = value_of(at.plastic_jump[i]);
    value.slip_direction[i] = value_of(at.slip_direction[i]);
    value.last_plastic_jump[i] = at.last_plastic_jump[i];
  }
  value.dim = at.dim;
  value.open = at.open;
  value.rubs = at.rubs;
  value.history = at.history;
  value.duration = at.duration;
  return value;
}

/// Returns the slip S >= 0 of the step with b(S) + c S = size, where b is the friction bound; 0 for size <= b(0). The
/// left side must increase with S. `least` is a slip for c = 0 if b vanishes. The search is Newton's method in ln S
/// within a bracket: b may increase like the logarithm of S over hundreds of decades, or linearly.
template <class Law>
KOKKOS_INLINE_FUNCTION Real projected_slip(const Law& law, Contact<Real> at, Real size, Real c) {
  at.slip_of_step = 0;
  if (!(size > law.friction_bound(at))) return 0;
  constexpr Real lowest = -690;  // ln of the smallest slip
  Real high = c > 0 ? std::log(size / c) : std::log(at.duration * 1e3), low = lowest, x = high;
  for (int k = 0; k < 200 && high - low > 1e-15; ++k) {
    at.slip_of_step = std::exp(x);
    const Real excess = law.friction_bound(at) + c * at.slip_of_step - size;
    const Real step = excess / ((law.hardening(at) + c) * at.slip_of_step);
    if ((step < 0 ? -step : step) <= 1e-15 * (x < 0 ? 1 - x : 1 + x)) break;
    (excess > 0 ? high : low) = x;
    x -= step;
    if (!(x > low && x < high)) x = low + (high - low) / 2;
  }
  return std::exp(x);
}

/// Projection constant of a law that depends on the slip rate, Pa/m: c, or twice the largest decrease of its bound by
/// slip if this is larger. b(S) + c S then increases with S.
template <class Law, class T>
KOKKOS_INLINE_FUNCTION T rated_constant(const Law& law, const Contact<T>& at, Real c) {
  const T least = -2 * law.softening(value_of(at)) * at.lambda_n;
  return least > c ? least : T(c);
}

/// Computes the tangential residual of a closed face under friction that depends on the slip rate:
///   z = lambda_t + c (p - p_old),  |z| = b(S) + c S,  R_t = lambda_t - b(S) z/|z| = c (S z/|z| - (p - p_old))
/// S equals |p - p_old| in solutions. b(S), evaluated at p - p_old itself, may have an unbounded slope in iterates: it
/// is a logarithm of the slip. That of the projected b is between -1 and 1. `at` contains the normal traction of the
/// projection. Without slip, R_t = -c (p - p_old) under compression, otherwise lambda_t, and the face sticks.
template <int dim, class T, class Law>
KOKKOS_INLINE_FUNCTION ContactState rated_residual(const Law& law, Real c_t, const T (&lambda)[dim],
                                                   const T (&step)[dim - 1], Contact<T>& at, T (&R)[dim]) {
  using std::sqrt;
  const T c = rated_constant(law, at, c_t);
  T z[dim - 1], square = 0;
  for (int i = 0; i < dim - 1; ++i) {
    z[i] = lambda[i + 1] + c * step[i];
    square += z[i] * z[i];
  }
  const T size = square > 0 ? T(sqrt(square)) : T(0);
  auto value = value_of(at);
  value.slip_of_step = projected_slip(law, value, value_of(size), value_of(c));
  if (!(value.slip_of_step > 0)) {
    for (int i = 0; i < dim - 1; ++i) R[i + 1] = at.lambda_n < 0 ? T(-c * step[i]) : T(lambda[i + 1]);
    return ContactState::stick;
  }
  at.slip_of_step = value.slip_of_step;
  const Real slope = law.hardening(value);
  const T slip = value.slip_of_step +
                 (size - law.friction_bound(at) - c * value.slip_of_step) / (slope + value_of(c));  // with derivatives
  for (int i = 0; i < dim - 1; ++i) R[i + 1] = c * (slip * z[i] / size - step[i]);
  return ContactState::slip;
}

}  // namespace sprekk::laws
