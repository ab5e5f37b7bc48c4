// The joint law at one point of a fracture, composed of small laws, written as one residual.
//
// Frame (n, t1[, t2]), n from side minus to side plus; jump w = u+ - u-, traction lambda = sigma n, tension positive.
// Equation numbers are those of Wollmann (2024). Any scalar type T; derivatives are taken in (w, lambda) alone.
#pragma once

#include "base/types.hpp"

#include <cmath>
#include <type_traits>

namespace sprekk::laws {

enum class ContactState : int { open = 0, stick = 1, slip = 2 };

/// |v|, with derivative zero at v = 0 (the root's own derivative is infinite there).
template <int n, class T>
KOKKOS_INLINE_FUNCTION T norm(const T (&v)[n]) {
  using std::sqrt;
  T square = v[0] * v[0];
  for (int i = 1; i < n; ++i) square += v[i] * v[i];
  return square > 0 ? T(sqrt(square)) : T(0);
}

/// x without derivatives.
template <class T>
KOKKOS_INLINE_FUNCTION Real value_of(const T& x) {
  if constexpr (std::is_arithmetic_v<T>) {
    return x;
  } else {
    return x.val();
  }
}

/// Elastic part of the tangential jump (12): u_t^e = lambda_t / K_t.
struct TangentialElasticity {
  Real compliance = 0;  ///< 1/K_t, m/Pa; 0 is a rigid joint
};

/// Coulomb's bound on |lambda_t| (13): b = -mu lambda_n.
struct CoulombFriction {
  Real coefficient = 0;  ///< mu

  template <class T>
  KOKKOS_INLINE_FUNCTION T bound(const T& lambda_n) const {
    return -coefficient * lambda_n;
  }
};

/// Normal closure under compression, the last term of (14) (Barton and Bandis): B = lambda_n/(K_n - lambda_n/Du),
/// continued as lambda_n/K_n, once continuously differentiable, for the tensile tractions that iterates visit. An
/// infinite Du makes it lambda_n/K_n throughout.
struct BartonBandisClosure {
  Real maximum = 0;    ///< Du, m; 0 is a joint that does not close, infinite one that closes linearly
  Real stiffness = 1;  ///< K_n at zero traction, Pa/m

  template <class T>
  KOKKOS_INLINE_FUNCTION T operator()(const T& lambda_n) const {
    if (maximum == 0) return T(0);
    if (lambda_n > 0) return lambda_n / stiffness;
    return lambda_n / (stiffness - lambda_n / maximum);
  }
  KOKKOS_INLINE_FUNCTION Real initial_compliance() const { return maximum == 0 ? 0 : 1 / stiffness; }
};

/// Shear dilation, the middle term of (14): tan(theta) |u_t^p|.
struct Dilation {
  Real tangent = 0;  ///< tan(theta)

  template <class T>
  KOKKOS_INLINE_FUNCTION T operator()(const T& plastic_slip) const {
    return tangent * plastic_slip;
  }
};

/// The gap (14) below which the faces touch: g = g0 + tan(theta)|u_t^p| + B(lambda_n), m.
struct NormalGap {
  Real initial = 0;  ///< g0, m
  Dilation dilation;
  BartonBandisClosure closure;

  template <class T>
  KOKKOS_INLINE_FUNCTION T operator()(const T& plastic_slip, const T& lambda_n) const {
    return initial + dilation(plastic_slip) + closure(lambda_n);
  }
};

/// A joint: how it deforms elastically, what bounds its friction, where its faces touch. Another law of one of the
/// three kinds replaces the template argument; nothing else changes.
template <class Elastic = TangentialElasticity, class Friction = CoulombFriction, class Gap = NormalGap>
struct JointLaw {
  Elastic elastic;
  Friction friction;
  Gap gap;
};

using Joint = JointLaw<>;

/// The constants of the projection for an augmentation c, Pa/m: 1/c_t = 1/c + 1/K_t, 1/c_n = 1/c + 1/K_n. They steer
/// the iteration; the solution does not depend on them.
struct Augmentation {
  Real normal, tangential;
};

template <class Law>
KOKKOS_INLINE_FUNCTION Augmentation augmentation(const Law& law, Real c) {
  return {1 / (1 / c + law.gap.closure.initial_compliance()), 1 / (1 / c + law.elastic.compliance)};
}

/// Contact and elastic-plastic split (9)-(14) as one residual R(w, lambda) = 0 of projections, Pa:
///   p = w_t - lambda_t/K_t                                   plastic tangential jump
///   y = lambda_n + c_n (w_n - g),  q = min(y, 0)             R_n = lambda_n - q
///   z = lambda_t + c_t (p - p_old), b = bound(q)             R_t = lambda_t           open,  y > 0
///                                                            R_t = lambda_t - z       stick, |z| <= b
///                                                            R_t = lambda_t - b z/|z| slip
/// Faces that just touch (y = 0) are closed and stick; so do those that a step finds on the limit, |z| = b to 1e-10,
/// until they move, c_t |p - p_old| > 1e-10 b: else rounding would say which of them slip. p_old is the plastic jump at
/// the end of the last step. Where p is zero to rounding its direction is noise; |p| then grows along z, as it does
/// when sliding begins.
///
/// Of a face that slips, iterates may have p.z < 0 <= p_old.z, which no solution has. Dilation may soften the face
/// then, by 1/k = B' + mu tan(theta) p.z/(|p||z| K_t), and the matrix be far from symmetric. There d|p| = z.dp/|z|, as
/// it is where p is along z.
template <int dim, class T, class Law>
KOKKOS_INLINE_FUNCTION ContactState contact_residual(const Law& law, const Augmentation& c, const T (&w)[dim],
                                                     const T (&lambda)[dim], const Real (&p_old)[dim - 1],
                                                     T (&R)[dim]) {
  T p[dim - 1], step[dim - 1], z[dim - 1];
  for (int i = 0; i < dim - 1; ++i) {
    p[i] = w[i + 1] - law.elastic.compliance * lambda[i + 1];
    step[i] = c.tangential * (p[i] - p_old[i]);
    z[i] = lambda[i + 1] + step[i];
  }
  const T size = norm(z);
  T distance = norm(p);
  if (size > 0 && c.tangential * distance <= 1e-13 * size) {
    distance = 0;
    for (int i = 0; i < dim - 1; ++i) distance += p[i] * z[i] / size;
  }
  T penetration = c.normal * (w[0] - law.gap(distance, lambda[0]));
  T y = lambda[0] + penetration;
  if (y > 0) {
    for (int i = 0; i < dim; ++i) R[i] = lambda[i];
    return ContactState::open;
  }
  R[0] = -penetration;
  T b = law.friction.bound(y);
  if (size <= b || (size <= (1 + 1e-10) * b && norm(step) <= 1e-10 * b)) {
    for (int i = 0; i < dim - 1; ++i) R[i + 1] = -step[i];
    return ContactState::stick;
  }
  T along = 0;
  Real old_along = 0;
  for (int i = 0; i < dim - 1; ++i) {
    along += p[i] * (value_of(z[i]) / value_of(size));
    old_along += p_old[i] * value_of(z[i]);
  }
  if (along < 0 && old_along >= 0) {
    distance = along + (value_of(distance) - value_of(along));
    penetration = c.normal * (w[0] - law.gap(distance, lambda[0]));
    y = lambda[0] + penetration;
    b = law.friction.bound(y);
    R[0] = -penetration;
  }
  for (int i = 0; i < dim - 1; ++i) R[i + 1] = lambda[i + 1] - b * z[i] / size;
  return ContactState::slip;
}

/// The parts of the jump of a converged state (9): u^e = (B(lambda_n), lambda_t/K_t) where the faces touch, zero where
/// they are open; u^p = w - u^e.
template <int dim, class Law>
KOKKOS_INLINE_FUNCTION void split_jump(const Law& law, ContactState state, const Real (&w)[dim],
                                       const Real (&lambda)[dim], Real (&elastic)[dim], Real (&plastic)[dim]) {
  const bool open = state == ContactState::open;
  elastic[0] = open ? 0 : law.gap.closure(lambda[0]);
  for (int i = 1; i < dim; ++i) elastic[i] = open ? 0 : law.elastic.compliance * lambda[i];
  for (int i = 0; i < dim; ++i) plastic[i] = w[i] - elastic[i];
}

}  // namespace sprekk::laws
