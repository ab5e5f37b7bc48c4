// Member functions of JointPoints for all joint laws, with derivatives by Sacado.
#pragma once

#include "laws/joint.hpp"
#include "laws/joint_points.hpp"
#include "laws/prescribed_jump.hpp"
#include "laws/runaway.hpp"

#include <Sacado.hpp>

namespace sprekk::laws {

/// Value with derivatives in w, then in lambda.
template <int dim>
using JointFad = Sacado::Fad::SFad<Real, 2 * dim>;

template <int dim>
KOKKOS_INLINE_FUNCTION void seed(const Real (&w)[dim], const Real (&lambda)[dim], JointFad<dim> (&w_fad)[dim],
                                 JointFad<dim> (&lambda_fad)[dim]) {
  for (int i = 0; i < dim; ++i) {
    w_fad[i] = JointFad<dim>(2 * dim, i, w[i]);
    lambda_fad[i] = JointFad<dim>(2 * dim, dim + i, lambda[i]);
  }
}

template <int dim>
KOKKOS_INLINE_FUNCTION bool JointPoints<dim>::is_prescribed(int f) const {
  return prescribed.extent(0) > 0 && prescribed(f, 1) != not_prescribed;
}

/// Joint law with a given tangential compliance, m/Pa.
template <class T>
struct WithCompliance : Joint {
  T given;
  KOKKOS_INLINE_FUNCTION T compliance(const Contact<T>&) const { return given; }
};

/// Computes the traction of contact and friction, and the corresponding jump, without the proximal term. The proximal
/// term carries proximal c (w_n - anchor) of the normal traction and proximal c (p - anchor) of the tangential
/// traction, with p = w_t - C lambda_t. The tangential elasticity acts on the whole traction: C is the compliance under
/// the whole normal traction, also in the law, which therefore finds the same p. Returns C.
template <int dim>
template <class T>
KOKKOS_INLINE_FUNCTION T JointPoints<dim>::contact(int f, const T (&w)[dim], const T (&traction)[dim], T (&jump)[dim],
                                                   T (&borne)[dim]) const {
  Real rest[dim], held[dim];  // jump and traction of the anchor
  for (int k = 0; k < dim; ++k) {
    rest[k] = held[k] = 0;
    for (int i = 0; i < dim; ++i) {
      rest[k] += frame(f, k, i) * anchor(f, i);
      held[k] += frame(f, k, i) * anchor(f, dim + i);
    }
  }
  const auto compliance_at = [&](const auto& normal) {
    using Number = std::decay_t<decltype(normal)>;
    const Number p[dim - 1] = {};
    const Real old[dim - 1] = {};
    return Number(law[number(f)].compliance(laws::contact<dim>(normal, Number(0), p, old, history(f))));
  };
  const T compliance = compliance_at(traction[0]);
  const Real at_anchor = compliance_at(held[0]);
  jump[0] = w[0];
  borne[0] = traction[0] - spring(f) * (w[0] - rest[0]);
  for (int k = 1; k < dim; ++k) {
    const T pull = spring(f) * (w[k] - compliance * traction[k] - (rest[k] - at_anchor * held[k]));
    jump[k] = w[k] - compliance * pull;
    borne[k] = traction[k] - pull;
  }
  return compliance;
}

template <int dim>
template <class T>
KOKKOS_INLINE_FUNCTION ContactState JointPoints<dim>::evaluate(int f, const T (&w)[dim], const T (&traction)[dim],
                                                               T (&R)[dim]) const {
  Real old[dim - 1], given[dim];
  for (int i = 0; i < dim - 1; ++i) old[i] = p_old(f, i);
  for (int i = 0; i < dim && is_prescribed(f); ++i) given[i] = prescribed(f, i);
  const auto& joint = law[number(f)];
  const auto c = laws::augmentation(joint, constant(f), spring(f));
  const auto residual_of = [&](const auto& law, const T(&jump)[dim], const T(&borne)[dim]) {
    if (!is_prescribed(f)) return contact_residual<dim>(law, c, jump, borne, old, R, history(f), duration);
    return prescribed_residual<dim>(law, c, jump, borne, old, given, R, history(f), duration);
  };
  if (proximal == 0) return residual_of(joint, w, traction);
  T jump[dim], borne[dim];
  const T compliance = contact(f, w, traction, jump, borne);
  return residual_of(WithCompliance<T>{joint, compliance}, jump, borne);
}

template <int dim>
template <class T>
KOKKOS_INLINE_FUNCTION void JointPoints<dim>::damp(int f, ContactState state, T (&R)[dim]) const {
  const Real share = damping.extent(0) > 0 ? damping(f) : 0;
  if (share == 0 || state == ContactState::stick) return;
  const auto& joint = law[number(f)];
  const auto constants = laws::augmentation(joint, constant(f));
  const auto add = [&](int k, Real stiffness, Real compliance) {
    R[k].fastAccessDx(k) -= stiffness;
    R[k].fastAccessDx(dim + k) += stiffness * compliance;
  };
  for (int k = 1; k < dim && !is_prescribed(f); ++k)
    add(k, share * constants.tangential, joint.elastic.initial_compliance());
  if (state == ContactState::open) add(0, share * constants.normal, joint.gap.closure.initial_compliance());
}

template <int dim>
template <class T>
KOKKOS_INLINE_FUNCTION T JointPoints<dim>::dissipated(int f, const T (&w)[dim], const T (&traction)[dim]) const {
  const auto& joint = law[number(f)];
  T p[dim - 1] = {}, before[dim - 1], sum = 0;
  Real old[dim - 1];
  const Real none[dim - 1] = {};
  const T compliance = joint.compliance(laws::contact<dim>(traction[0], T(0), p, none, history(f)));
  for (int i = 0; i < dim - 1; ++i) {
    p[i] = w[i + 1] - compliance * traction[i + 1];
    before[i] = old[i] = p_old(f, i);
    sum += traction[i + 1] * (p[i] - old[i]);
  }
  const auto gap = [&](const T(&jump)[dim - 1]) {
    auto at = laws::contact<dim>(traction[0], norm(jump), jump, old, history(f));
    at.duration = duration;
    T step[dim - 1], shear[dim - 1];
    for (int i = 0; i < dim - 1; ++i) {
      step[i] = jump[i] - old[i];
      shear[i] = traction[i + 1];
    }
    at.slip_of_step = norm(step);
    for (int i = 0; i < dim - 1 && at.slip_of_step > 0; ++i) at.slip_direction[i] = step[i] / at.slip_of_step;
    at.shear = norm(shear);
    return joint.normal_gap(at);
  };
  return sum + traction[0] * (gap(p) - gap(before));
}

template <int dim>
KOKKOS_FUNCTION ContactState JointPoints<dim>::residual(int f, const Real (&w)[dim], const Real (&lambda)[dim],
                                                        Real (&R)[dim]) const {
  return evaluate(f, w, lambda, R);
}

template <int dim>
KOKKOS_FUNCTION void JointPoints<dim>::jacobian(int f, const Real (&w)[dim], const Real (&lambda)[dim],
                                                Real (&dR)[dim][2 * dim]) const {
  JointFad<dim> jump[dim], traction[dim], R[dim];
  seed(w, lambda, jump, traction);
  damp(f, evaluate(f, jump, traction, R), R);
  for (int k = 0; k < dim; ++k)
    for (int l = 0; l < 2 * dim; ++l) dR[k][l] = R[k].dx(l);
}

template <int dim>
KOKKOS_FUNCTION Real JointPoints<dim>::work(int f, const Real (&w)[dim], const Real (&lambda)[dim]) const {
  return dissipated(f, w, lambda);
}

template <int dim>
KOKKOS_FUNCTION void JointPoints<dim>::dwork(int f, const Real (&w)[dim], const Real (&lambda)[dim],
                                             Real (&derivatives)[2 * dim]) const {
  JointFad<dim> jump[dim], traction[dim];
  seed(w, lambda, jump, traction);
  const JointFad<dim> sum = dissipated(f, jump, traction);
  for (int l = 0; l < 2 * dim; ++l) derivatives[l] = sum.dx(l);
}

template <int dim>
KOKKOS_FUNCTION void JointPoints<dim>::commit(int f, const JointPoint<dim>& end, const JointHistory& to) const {
  const auto& joint = law[number(f)];
  const auto& p = to.plastic_jump;
  const Real work = dissipated(f, end.w, end.traction);
  bool slides = end.state == ContactState::slip;
  const bool given = is_prescribed(f);
  for (int i = 0; i < dim - 1 && given; ++i) {
    slides = slides || prescribed(f, i + 1) != end.p_old[i];
    p(f, i) = prescribed(f, i + 1);
  }
  to.slid(f, 0) = slides ? 1 : to.slid(f, 0) > 0 ? 2 : 0;
  if (slides) to.slid(f, 1) += work;
  if (end.state != ContactState::stick && !given) {
    Real elastic[dim], plastic[dim];
    split_jump<dim>(joint, end.state, end.w, end.traction, end.p_old, elastic, plastic, history(f));
    for (int i = 0; i < dim - 1; ++i) p(f, i) = plastic[i + 1];
  }
  if (stored_history.extent(1) == 0) return;
  Real now[dim - 1];
  for (int i = 0; i < dim - 1; ++i) now[i] = p(f, i);
  auto contact = converged<dim>(joint, end.state, end.w, end.traction, now, end.p_old, history(f), given ? 0 : duration,
                                laws::augmentation(joint, end.constant).tangential);
  contact.duration = duration;
  if (end.state == ContactState::slip) {
    const Real slip = runaway_slip(joint, contact, to.softness(f) + joint.elastic.initial_compliance());
    if (slip > to.runaway(f, 0)) to.runaway(f, 0) = slip;
  }
  joint.commit(contact, history_of(f));
}

}  // namespace sprekk::laws
