// Joint law at one point of a fracture, composed of small laws and written as one residual.
//
// Frame (n, t1[, t2]), n from side - to side +. Jump w = u+ - u-, traction lambda = sigma n, tension positive. Equation
// numbers are those of Wollmann (2024). Scalars are of any type T. Derivatives are with respect to (w, lambda) only.
#pragma once

#include "base/view.hpp"
#include "laws/contact.hpp"
#include "laws/joint_fwd.hpp"
#include "laws/joint_kinds.hpp"
#include "laws/rated_slip.hpp"

#include <cmath>

namespace sprekk::laws {

/// Returns |v|, with zero derivative at v = 0 (the derivative of the root is infinite there).
template <int n, class T>
KOKKOS_INLINE_FUNCTION T norm(const T (&v)[n]) {
  using std::sqrt;
  T square = v[0] * v[0];
  for (int i = 1; i < n; ++i) square += v[i] * v[i];
  return square > 0 ? T(sqrt(square)) : T(0);
}

/// One of the laws of each role; see joint_kinds.hpp for the functions.
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
struct Bond : BondKinds {
  using BondKinds::BondKinds;
  template <class T>
  KOKKOS_INLINE_FUNCTION Cohesion<T> cohesion(const Contact<T>& at) const {
    return visit([&](const auto& law) { return law.cohesion(at); });
  }
};
struct Driver : DriverKinds {
  using DriverKinds::DriverKinds;
  template <class T>
  KOKKOS_INLINE_FUNCTION T wear(const Contact<T>& at) const {
    return visit([&](const auto& law) { return T(law.wear(at)); });
  }
};
struct Damage : DamageKinds {
  using DamageKinds::DamageKinds;
  template <class T>
  KOKKOS_INLINE_FUNCTION Left<T> left(const Contact<T>& at) const {
    return visit([&](const auto& law) { return law.left(at); });
  }
};

/// Terms of the gap (14).
template <class Dilation = laws::Dilation, class Closure = laws::Closure>
struct NormalGap {
  Real initial = 0;  ///< g0, m
  Dilation dilation = {};
  Closure closure = {};
};

/// Joint law: tangential elasticity, friction, gap, bond and damage. Each part is a law of its role, or a Kinds of
/// several. Their history variables are stored in the order dilation, closure, friction, elasticity, bond, damage.
template <class Elastic = Shear, class Friction = laws::Friction, class Gap = NormalGap<>>
struct JointLaw {
  Elastic elastic = {};
  Friction friction = {};
  Gap gap = {};
  Bond bond = {};
  Damage damage = {};
  Driver driver = {};
  Real strength = 1;            ///< factor of friction and bond (strength reduction)
  Real sliding_compliance = 0;  ///< mu tan(theta)/K_t, m/Pa: loss of slip and dilation by compression

  /// Gap (14), m: g = g0 + dilation + closure. The faces touch below it. Closure is negative under compression.
  template <class T>
  KOKKOS_INLINE_FUNCTION T normal_gap(const Contact<T>& at) const {
    T opens = gap.dilation.opening(at);
    if (wears()) opens *= left(at).dilation;
    return gap.initial + opens + closure(at);
  }
  /// Closure, m; negative under compression.
  template <class T>
  KOKKOS_INLINE_FUNCTION T closure(const Contact<T>& at) const {
    return at.after(laws::n_history(gap.dilation), [&](const auto& own) { return gap.closure.opening(own); });
  }
  /// Bound on |lambda_t|, Pa, with friction and bond.
  template <class T>
  KOKKOS_INLINE_FUNCTION T bound(const Contact<T>& at) const {
    const T b = friction_bound(at);
    return is_bonded() ? with_cohesion(at, b, cohesion(at)) : b;
  }
  /// Bound of friction without bond, Pa.
  template <class T>
  KOKKOS_INLINE_FUNCTION T friction_bound(const Contact<T>& at) const {
    return strength * (wears() ? worn_friction(at) : unworn_friction(at));
  }
  /// Sum of the friction bound b and the cohesion, Pa; at least 0 under tension.
  template <class T>
  KOKKOS_INLINE_FUNCTION T with_cohesion(const Contact<T>& at, const T& b, const Cohesion<T>& cohesion) const {
    const T sum = b + cohesion.shear;
    return at.lambda_n > 0 && sum < 0 ? T(0) : sum;
  }
  KOKKOS_INLINE_FUNCTION bool is_bonded() const {
    return bond.visit([](const auto& law) { return !std::is_same_v<std::decay_t<decltype(law)>, NoBond>; });
  }
  /// True if closed faces stick under any shear traction.
  KOKKOS_INLINE_FUNCTION bool never_slips() const {
    const auto is = [](const auto& law) { return std::is_same_v<std::decay_t<decltype(law)>, NoSlip>; };
    if constexpr (requires { friction.visit(is); })
      return !is_bonded() && friction.visit(is);
    else
      return !is_bonded() && is(friction);
  }
  /// True if friction depends on the slip rate, see rated_slip.hpp. Not available with a bond or damage.
  KOKKOS_INLINE_FUNCTION bool depends_on_rate() const {
    return if_rated<bool>(friction, [](const auto&) { return true; });
  }
  /// Derivative of friction_bound() in the slip of the step, Pa/m, and the largest decrease of friction_bound() by
  /// slip, divided by the compression, 1/m; of friction that depends on the slip rate.
  KOKKOS_INLINE_FUNCTION Real hardening(const Contact<Real>& at) const {
    return strength * rated<Real>(at, [](const auto& law, const auto& own) { return law.hardening(own); });
  }
  KOKKOS_INLINE_FUNCTION Real softening(const Contact<Real>& at) const {
    return strength * rated<Real>(at, [](const auto& law, const auto& own) { return law.softening(own); });
  }
  /// Errors of a step by rate-dependent friction. `at` is the contact at its end, with the history variables of its
  /// beginning.
  KOKKOS_INLINE_FUNCTION StepDefect defect_of_step(const Contact<Real>& at) const {
    return rated<StepDefect>(at, [](const auto& law, const auto& own) {
      if constexpr (requires { law.defect_of_step(own); }) return law.defect_of_step(own);
      return StepDefect();
    });
  }
  template <class T>
  KOKKOS_INLINE_FUNCTION T compliance(const Contact<T>& at) const {
    return at.after(of_gap() + laws::n_history(friction), [&](const auto& own) { return elastic.compliance(own); });
  }
  template <class T>
  KOKKOS_INLINE_FUNCTION Cohesion<T> cohesion(const Contact<T>& at) const {
    auto all = at.after(before_bond(), [&](const auto& own) { return bond.cohesion(own); });
    all.shear *= strength;
    all.strength *= strength;
    all.tension *= strength;
    return all;
  }
  /// Remaining fractions of friction and dilation after damage.
  template <class T>
  KOKKOS_INLINE_FUNCTION Left<T> left(const Contact<T>& at) const {
    if (!wears()) return {};
    Contact<T> worn = at;
    worn.wear = at.rubs * driver.wear(at);
    return worn.after(before_bond() + laws::n_history(bond), [&](const auto& own) { return damage.left(own); });
  }
  /// Number of history variables on each face.
  KOKKOS_INLINE_FUNCTION int n_history(int dim = 3) const {
    return before_bond() + laws::n_history(bond) + (dim == 2 ? n_history_2d(damage) : laws::n_history(damage));
  }
  /// Updates the history variables of a face at the end of a step. `at` is the contact at the end of the step, with the
  /// history variables of its beginning.
  KOKKOS_INLINE_FUNCTION void commit(Contact<Real> at, const Numbers<Real>& history) const {
    if (at.open) at.rubs = rubbed_share(at);
    at.wear = at.rubs * driver.wear(at);
    for_each_part([&](const auto& law, int offset) {
      if (laws::n_history(law) == 0) return;
      at.after(offset, [&](const auto& own) { return laws::commit(law, own, history.from(offset)), 0; });
    });
  }
  /// Calls visit(law, index of its first history variable) for the parts that may have history variables.
  template <class Visit>
  KOKKOS_INLINE_FUNCTION void for_each_part(const Visit& visit) const {
    int offset = 0;
    const auto next = [&](const auto& law) {
      visit(law, offset);
      offset += laws::n_history(law);
    };
    next(gap.dilation);
    next(gap.closure);
    next(friction);
    next(elastic);
    next(bond);
    next(damage);
  }

 private:
  /// Share of the step's slip that counts as wear on faces open at the end of the step: the smallest share without
  /// overlap of the sides. It is 0 if the sides do not overlap without wear, or if wear does not reduce the gap. (The
  /// state open itself is determined with wear by all slip.)
  KOKKOS_INLINE_FUNCTION Real rubbed_share(Contact<Real> at) const {
    const auto gap = [&](Real share) {
      at.rubs = share;
      return normal_gap(at);
    };
    const Real fresh = gap(0), worn = gap(1), room = at.separation + worn - 1e-13 * (worn < 0 ? -worn : worn);
    if (fresh <= room || fresh <= worn) return 0;
    Real low = 0, high = 1;
    for (int k = 0; k < 53; ++k) {
      const Real middle = (low + high) / 2;
      (gap(middle) <= room ? high : low) = middle;
    }
    return high;
  }
  template <class Result, class Use>
  KOKKOS_INLINE_FUNCTION Result rated(const Contact<Real>& at, const Use& use) const {
    return at.after(of_gap(), [&](const auto& own) {
      return if_rated<Result>(friction, [&](const auto& law) { return use(law, own); });
    });
  }
  KOKKOS_INLINE_FUNCTION bool wears() const { return laws::n_history(damage) > 0; }
  template <class T>
  KOKKOS_INLINE_FUNCTION T unworn_friction(const Contact<T>& at) const {
    return at.after(of_gap(), [&](const auto& own) { return friction.bound(own); });
  }
  template <class T>
  KOKKOS_INLINE_FUNCTION T worn_friction(const Contact<T>& at) const {
    const auto rest = left(at);
    if (!laws::takes_damage(friction)) return rest.friction * unworn_friction(at);
    Contact<T> worn = at;
    worn.friction_left = rest.friction;
    worn.dilation_left = rest.dilation;
    return unworn_friction(worn);
  }
  KOKKOS_INLINE_FUNCTION int of_gap() const { return laws::n_history(gap.dilation) + laws::n_history(gap.closure); }
  KOKKOS_INLINE_FUNCTION int before_bond() const {
    return of_gap() + laws::n_history(friction) + laws::n_history(elastic);
  }
};

/// Stiffnesses of the projections for an augmentation constant c, Pa/m:
///   1/c_t = 1/c + 1/K_t,  1/c_n = 1/c + 1/K_n + 2 mu tan(theta)/K_t
/// The last term is twice the normal compliance of a sliding face. Consider a dilating face without traction that has
/// moved by p: it overlaps by tan(theta) |p|. With the last term, |z| = c_t |p| exceeds b = mu c_n tan(theta) |p| if mu
/// tan(theta) < 1, so the face slides and does not return to p = 0. The constants affect the iteration only, not the
/// solution.
struct Augmentation {
  Real normal, tangential;
};

/// A spring s, Pa/m, parallel to the law (proximal term) stiffens the surroundings of the law:
///   c_t + s in place of c_t,  c + s in place of c,  mu tan(theta)/(K_t + s) in place of mu tan(theta)/K_t
/// Otherwise z and y would decrease with slip and opening if s exceeds c.
template <class Law>
KOKKOS_INLINE_FUNCTION Augmentation augmentation(const Law& law, Real c, Real spring = 0) {
  const Real elastic = law.elastic.initial_compliance();
  return {1 / (1 / (c + spring) + law.gap.closure.initial_compliance() +
               2 * law.sliding_compliance / (1 + spring * elastic)),
          1 / (1 / c + elastic) + spring};
}

/// Returns a contact with normal traction lambda_n and plastic tangential jump p. `size` is |p| or its substitute in
/// iterates.
template <int dim, class T>
KOKKOS_INLINE_FUNCTION Contact<T> contact(const T& lambda_n, const T& size, const T (&p)[dim - 1],
                                          const Real (&p_old)[dim - 1], const History& history) {
  Contact<T> at;
  at.dim = dim;
  at.lambda_n = lambda_n;
  at.plastic_slip = size;
  at.history = history;
  for (int i = 0; i < dim - 1; ++i) {
    at.plastic_jump[i] = p[i];
    at.last_plastic_jump[i] = p_old[i];
  }
  return at;
}

/// Returns the contact of a converged face with jump w, traction lambda and plastic tangential jump p. Under friction
/// that depends on the slip rate, the slip of the step is the projected one for c_t, Pa/m: round-off may exceed the
/// difference p - p_old of slow slip.
template <int dim, class Law>
KOKKOS_INLINE_FUNCTION Contact<Real> converged(const Law& law, ContactState state, const Real (&w)[dim],
                                               const Real (&lambda)[dim], const Real (&p)[dim - 1],
                                               const Real (&p_old)[dim - 1], const History& history, Real duration = 0,
                                               Real c_t = 0) {
  auto at = contact<dim>(lambda[0], norm(p), p, p_old, history);
  Real step[dim - 1], shear[dim - 1];
  for (int i = 0; i < dim - 1; ++i) {
    step[i] = p[i] - p_old[i];
    shear[i] = lambda[i + 1];
  }
  at.slip_of_step = norm(step);
  for (int i = 0; i < dim - 1 && at.slip_of_step > 0; ++i) at.slip_direction[i] = step[i] / at.slip_of_step;
  at.shear = norm(shear);
  at.separation = w[0] - law.normal_gap(at);
  at.open = state == ContactState::open;
  at.duration = duration;
  if (duration > 0 && !at.open && law.depends_on_rate()) {
    const Real c = rated_constant(law, at, c_t);
    for (int i = 0; i < dim - 1; ++i) shear[i] += c * step[i];
    at.slip_of_step = projected_slip(law, at, norm(shear), c);
  }
  return at;
}

/// Returns |v|. If v is zero up to round-off (c |v| <= 1e-13 size), its direction is noise; the result is then the
/// component of v along z/size.
template <int n, class T>
KOKKOS_INLINE_FUNCTION T length_along(const T (&v)[n], const T (&z)[n], const T& size, Real c) {
  T length = norm(v);
  if (size > 0 && c * length <= 1e-13 * size) {
    length = 0;
    for (int i = 0; i < n; ++i) length += v[i] * z[i] / size;
  }
  return length;
}

/// If v.z < 0 <= old.z, assigns to the length the derivatives that it has for v parallel to z, and returns true. The
/// value of the length is unchanged.
template <int n, class T>
KOKKOS_INLINE_FUNCTION bool turn_along(const T (&v)[n], const Real (&old)[n], const T (&z)[n], const T& size,
                                       T& length) {
  T along = 0;
  Real old_along = 0;
  for (int i = 0; i < n; ++i) {
    along += v[i] * (value_of(z[i]) / value_of(size));
    old_along += old[i] * value_of(z[i]);
  }
  if (!(along < 0 && old_along >= 0)) return false;
  length = along + (value_of(length) - value_of(along));
  return true;
}

/// Computes contact and the elastic-plastic split (9)-(14) as one residual R(w, lambda) = 0 of projections, Pa. Returns
/// the contact state.
///   p = w_t - u_t^e(lambda), e.g. w_t - lambda_t/K_t         plastic tangential jump
///   o = w_n - g,  y = lambda_n + c_n o,  T = strength        R_n = -c_n o             closed, y <= T: q = y
///                                                            R_n = lambda_n - t(o)    separated, bonded: q = t(o)
///                                                            R = lambda               open
///   z = lambda_t + c_t (p - p_old), b = bound(q)             R_t = lambda_t - z       stick, |z| <= b
///                                                            R_t = lambda_t - b z/|z| slip
/// p_old is the plastic jump at the end of the last step, `history` the history variables then. Without a bond T = 0,
/// and separated faces are open; see laws/bond.
///
/// Faces that just touch (y = 0) are closed and stick. If opening destroys the cohesion, this holds up to y = T + 1e-10
/// cohesion: round-off of a vanishing normal traction must not open them.
///
/// A joint that never slips sticks unless it is open. A huge friction coefficient is no substitute: its bound is 0 on
/// unloaded faces, which would slip, and iterative solvers do not converge for the matrix of slip.
///
/// For laws with history variables, the bound b_0 at p = p_old also matters:
/// * In 2D a face sticks only if also |z| <= b_0, the bound of a sticking face. Otherwise a face with slip hardening
///   would stick because of its slip, and slip again in the next iterate. In 3D z turns too much where it is small.
/// * Against z (backward slip) the bound is at most b_0. Otherwise slip weakening would admit states with backward
///   slip.
///
/// If |z| = b and p = p_old up to 1e-10 b, both residuals are small. The state is then the one with the smaller
/// residual. So round-off does not decide which faces slip at the beginning of a step, and a solution retains its
/// state.
///
/// If p or p - p_old is zero up to round-off, its direction is noise. Its length then grows along z, as at the onset of
/// sliding.
///
/// Iterates of a slipping face may have p.z < 0 <= p_old.z, which no solution has. Dilation may then soften the face,
/// with 1/k = B' + mu tan(theta) p.z/(|p||z| K_t), and the matrix may be far from symmetric. Therefore d|p| = z.dp/|z|,
/// as for p parallel to z. Friction that depends on the slip rate has a residual of its own, see rated_slip.hpp, if a
/// `duration` of the step, s, is given. The slip of the step passed to the laws is the component of p - p_old along z.
/// It equals |p - p_old| in solutions and is smooth at the onset of slip.
template <int dim, class T, class Law>
KOKKOS_INLINE_FUNCTION ContactState contact_residual(const Law& law, const Augmentation& c, const T (&w)[dim],
                                                     const T (&lambda)[dim], const Real (&p_old)[dim - 1], T (&R)[dim],
                                                     const History& history = {}, Real duration = 0) {
  T p[dim - 1] = {}, step[dim - 1], z[dim - 1];
  auto at = contact<dim>(lambda[0], T(0), p, p_old, history);
  at.duration = duration;
  const T compliance = law.compliance(at);
  for (int i = 0; i < dim - 1; ++i) {
    at.plastic_jump[i] = p[i] = w[i + 1] - compliance * lambda[i + 1];
    step[i] = p[i] - p_old[i];
    z[i] = lambda[i + 1] + c.tangential * step[i];
  }
  const T size = norm(z);
  at.plastic_slip = length_along(p, z, size, c.tangential);
  const bool bonded = law.is_bonded(), remembers = law.n_history() > 0;
  if (remembers) {  // only laws with history variables use these
    T shear[dim - 1];
    for (int i = 0; i < dim - 1; ++i) shear[i] = lambda[i + 1];
    at.shear = norm(shear);
    for (int i = 0; i < dim - 1 && size > 0; ++i) {
      at.slip_direction[i] = z[i] / size;
      at.slip_of_step += step[i] * at.slip_direction[i];
    }
  }
  T b = 0;
  bool bears_at_rest = true;
  Cohesion<T> cohesion;
  const auto bound = [&](const auto& at) {
    const T friction = law.friction_bound(at);
    return bonded ? law.with_cohesion(at, friction, cohesion) : friction;
  };
  // Evaluates the normal component: R[0] and the bound b. Returns true if the face is open.
  const auto is_open = [&] {
    at.lambda_n = lambda[0];
    at.separation = w[0] - law.normal_gap(at);
    const T pushed = c.normal * at.separation, y = lambda[0] + pushed;
    if (bonded) cohesion = law.cohesion(at);
    const bool parted = y > cohesion.strength;
    if (parted && cohesion.lost && y > cohesion.strength + 1e-10 * cohesion.shear) return true;
    if (parted && !cohesion.lost) {
      R[0] = lambda[0] - cohesion.tension;
      at.lambda_n = cohesion.tension;
    } else {
      R[0] = -pushed;
      at.lambda_n = y;
    }
    b = bound(at);
    if (remembers && (at.slip_of_step < 0 || size <= b)) {
      auto rest = at;
      rest.slip_of_step = 0;
      for (int i = 0; i < dim - 1; ++i) rest.plastic_jump[i] = p_old[i];
      rest.plastic_slip = norm(rest.plastic_jump);
      const T minimum = bound(rest);
      bears_at_rest = dim > 2 || !(size > minimum);
      if (at.slip_of_step < 0 && minimum < b) b = minimum;
    }
    return false;
  };
  if (is_open()) {
    for (int i = 0; i < dim; ++i) R[i] = lambda[i];
    return ContactState::open;
  }
  const auto stick = [&] {
    for (int i = 0; i < dim - 1; ++i) R[i + 1] = -c.tangential * step[i];
    return ContactState::stick;
  };
  if constexpr (requires { law.depends_on_rate(); })
    if (duration > 0 && law.depends_on_rate()) return rated_residual(law, c.tangential, lambda, step, at, R);
  if constexpr (requires { law.never_slips(); })
    if (law.never_slips()) return stick();
  if (bears_at_rest && size <= b) return stick();
  const T moved = c.tangential * norm(step);
  if (size <= (1 + 1e-10) * b && moved <= 1e-10 * b) {
    T beyond[dim - 1];
    for (int i = 0; i < dim - 1; ++i) beyond[i] = lambda[i + 1] - b * z[i] / size;
    if (moved <= norm(beyond)) return stick();
  }
  if (turn_along(p, p_old, z, size, at.plastic_slip)) is_open();
  for (int i = 0; i < dim - 1; ++i) R[i + 1] = lambda[i + 1] - b * z[i] / size;
  return ContactState::slip;
}

/// Splits the jump of a converged state (9), m: u^e = (B(lambda_n) - B(0), lambda_t/K_t) on closed faces, zero on open
/// faces; u^p = w - u^e. B(0) is irrecoverable closure.
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
  const auto closure = [&](Real normal) { return law.closure(contact<dim>(normal, norm(p), p, p_old, history)); };
  elastic[0] = open ? 0 : closure(lambda[0]) - closure(0);
  plastic[0] = w[0] - elastic[0];
}

}  // namespace sprekk::laws
