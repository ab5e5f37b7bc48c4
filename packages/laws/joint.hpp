// The joint law at one point of a fracture, composed of small laws, written as one residual.
//
// Frame (n, t1[, t2]), n from side minus to side plus; jump w = u+ - u-, traction lambda = sigma n, tension positive.
// Equation numbers are those of Wollmann (2024). Any scalar type T; derivatives are taken in (w, lambda) alone.
#pragma once

#include "base/types.hpp"
#include "laws/contact.hpp"
#include "laws/joint_kinds.hpp"

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

/// One of the kinds of each role.
struct Shear : ShearKinds {
  using ShearKinds::ShearKinds;
  template <class T>
  KOKKOS_INLINE_FUNCTION T compliance(const Contact<T>& at) const {
    return visit([&](const auto& law) { return T(law.compliance(at)); });
  }
  KOKKOS_INLINE_FUNCTION Real initial_compliance() const {
    return visit([](const auto& law) { return law.initial_compliance(); });
  }
};
struct Friction : FrictionKinds {
  using FrictionKinds::FrictionKinds;
  template <class T>
  KOKKOS_INLINE_FUNCTION T bound(const Contact<T>& at) const {
    return visit([&](const auto& law) { return T(law.bound(at)); });
  }
};
struct Dilation : DilationKinds {
  using DilationKinds::DilationKinds;
  template <class T>
  KOKKOS_INLINE_FUNCTION T opening(const Contact<T>& at) const {
    return visit([&](const auto& law) { return T(law.opening(at)); });
  }
};
struct Closure : ClosureKinds {
  using ClosureKinds::ClosureKinds;
  template <class T>
  KOKKOS_INLINE_FUNCTION T opening(const Contact<T>& at) const {
    return visit([&](const auto& law) { return T(law.opening(at)); });
  }
  KOKKOS_INLINE_FUNCTION Real initial_compliance() const {
    return visit([](const auto& law) { return law.initial_compliance(); });
  }
};

/// The gap (14) below which the faces touch, m: g = g0 + dilation + closure, the latter negative under compression.
template <class Dilation = laws::Dilation, class Closure = laws::Closure>
struct NormalGap {
  Real initial = 0;  ///< g0, m
  Dilation dilation = {};
  Closure closure = {};

  template <class T>
  KOKKOS_INLINE_FUNCTION T operator()(const Contact<T>& at) const {
    return initial + dilation.opening(at) + closure.opening(at.after(n_history(dilation)));
  }
};

/// A joint: how it deforms elastically, what bounds its friction, where its faces touch. Each part is a law of its role
/// or one of several. The numbers that they keep of a face follow each other: dilation, closure, friction, elasticity.
template <class Elastic = Shear, class Friction = laws::Friction, class Gap = NormalGap<>>
struct JointLaw {
  Elastic elastic = {};
  Friction friction = {};
  Gap gap = {};
  Real sliding_compliance = 0;  ///< mu tan(theta)/K_t, m/Pa: less slip, and so less dilation, under more compression

  template <class T>
  KOKKOS_INLINE_FUNCTION T bound(const Contact<T>& at) const {
    return friction.bound(at.after(of_gap()));
  }
  template <class T>
  KOKKOS_INLINE_FUNCTION T compliance(const Contact<T>& at) const {
    return elastic.compliance(at.after(of_gap() + laws::n_history(friction)));
  }
  KOKKOS_INLINE_FUNCTION int n_history() const {
    return of_gap() + laws::n_history(friction) + laws::n_history(elastic);
  }
  /// Moves the numbers of a face to the end of a step; `at` is its end, with the numbers of its beginning.
  KOKKOS_INLINE_FUNCTION void commit(const Contact<Real>& at, const Numbers<Real>& kept) const {
    int offset = 0;
    const auto move = [&](const auto& law) {
      laws::commit(law, at.after(offset), kept.from(offset));
      offset += laws::n_history(law);
    };
    move(gap.dilation);
    move(gap.closure);
    move(friction);
    move(elastic);
  }

 private:
  KOKKOS_INLINE_FUNCTION int of_gap() const { return laws::n_history(gap.dilation) + laws::n_history(gap.closure); }
};

using Joint = JointLaw<>;

/// The constants of the projection for an augmentation c, Pa/m:
///   1/c_t = 1/c + 1/K_t,  1/c_n = 1/c + 1/K_n + 2 mu tan(theta)/K_t
/// The last term is twice what a sliding face gives in along its normal. A face without traction that has moved by p
/// and dilates overlaps by tan(theta) |p|: with it |z| = c_t |p| exceeds b = mu c_n tan(theta) |p| wherever mu
/// tan(theta) < 1, so that it slides and does not spring back to p = 0. The constants steer the iteration; the solution
/// does not depend on them.
struct Augmentation {
  Real normal, tangential;
};

template <class Law>
KOKKOS_INLINE_FUNCTION Augmentation augmentation(const Law& law, Real c) {
  return {1 / (1 / c + law.gap.closure.initial_compliance() + 2 * law.sliding_compliance),
          1 / (1 / c + law.elastic.initial_compliance())};
}

/// The contact of normal traction lambda_n after the plastic tangential jump p, of size |p| or what stands for it.
template <int dim, class T>
KOKKOS_INLINE_FUNCTION Contact<T> contact(const T& lambda_n, const T& size, const T (&p)[dim - 1],
                                          const Real (&p_old)[dim - 1], const History& history) {
  Contact<T> at;
  at.lambda_n = lambda_n;
  at.plastic_slip = size;
  at.history = history;
  for (int i = 0; i < dim - 1; ++i) {
    at.plastic_jump[i] = p[i];
    at.last_plastic_jump[i] = p_old[i];
  }
  return at;
}

/// Contact and elastic-plastic split (9)-(14) as one residual R(w, lambda) = 0 of projections, Pa:
///   p = w_t - u_t^e(lambda), e.g. w_t - lambda_t/K_t         plastic tangential jump
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
///
/// `history` holds what the laws have kept of the face. A bound b(0) > 0 holds as long as the faces touch: an open face
/// bears no traction. A tensile strength would need q = min(y, strength) while a number of the history says that the
/// face is whole, here and in split_jump().
template <int dim, class T, class Law>
KOKKOS_INLINE_FUNCTION ContactState contact_residual(const Law& law, const Augmentation& c, const T (&w)[dim],
                                                     const T (&lambda)[dim], const Real (&p_old)[dim - 1], T (&R)[dim],
                                                     const History& history = {}) {
  T p[dim - 1] = {}, step[dim - 1], z[dim - 1];
  const T compliance = law.compliance(contact<dim>(lambda[0], T(0), p, p_old, history));
  for (int i = 0; i < dim - 1; ++i) {
    p[i] = w[i + 1] - compliance * lambda[i + 1];
    step[i] = c.tangential * (p[i] - p_old[i]);
    z[i] = lambda[i + 1] + step[i];
  }
  const T size = norm(z);
  T distance = norm(p);
  if (size > 0 && c.tangential * distance <= 1e-13 * size) {
    distance = 0;
    for (int i = 0; i < dim - 1; ++i) distance += p[i] * z[i] / size;
  }
  T penetration = c.normal * (w[0] - law.gap(contact<dim>(lambda[0], distance, p, p_old, history)));
  T y = lambda[0] + penetration;
  if (y > 0) {
    for (int i = 0; i < dim; ++i) R[i] = lambda[i];
    return ContactState::open;
  }
  R[0] = -penetration;
  T b = law.bound(contact<dim>(y, distance, p, p_old, history));
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
    penetration = c.normal * (w[0] - law.gap(contact<dim>(lambda[0], distance, p, p_old, history)));
    y = lambda[0] + penetration;
    b = law.bound(contact<dim>(y, distance, p, p_old, history));
    R[0] = -penetration;
  }
  for (int i = 0; i < dim - 1; ++i) R[i + 1] = lambda[i + 1] - b * z[i] / size;
  return ContactState::slip;
}

/// The parts of the jump of a converged state (9): u^e = (B(lambda_n), lambda_t/K_t) where the faces touch, zero where
/// they are open; u^p = w - u^e.
template <int dim, class Law>
KOKKOS_INLINE_FUNCTION void split_jump(const Law& law, ContactState state, const Real (&w)[dim],
                                       const Real (&lambda)[dim], const Real (&p_old)[dim - 1], Real (&elastic)[dim],
                                       Real (&plastic)[dim], const History& history = {}) {
  const bool open = state == ContactState::open;
  Real p[dim - 1] = {};
  const Real compliance = open ? 0 : law.compliance(contact<dim>(lambda[0], Real(0), p, p_old, history));
  for (int i = 1; i < dim; ++i) {
    elastic[i] = open ? 0 : compliance * lambda[i];
    plastic[i] = p[i - 1] = w[i] - elastic[i];
  }
  const auto at = contact<dim>(lambda[0], norm(p), p, p_old, history);
  elastic[0] = open ? 0 : law.gap.closure.opening(at.after(n_history(law.gap.dilation)));
  plastic[0] = w[0] - elastic[0];
}

}  // namespace sprekk::laws
