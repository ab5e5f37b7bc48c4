// The traction rows of a fracture face, and their derivatives by Sacado.
#pragma once

#include "assembly/reference_cell.hpp"
#include "assembly/slots.hpp"
#include "laws/joint.hpp"

#include <Sacado.hpp>

#include <limits>

namespace sprekk::physics {

/// The joint law on one fracture face.
///
/// | symbol       | shape                                                    | unit |                              |
/// | x            | u [minus then plus node, dim], beta [2 dim], lambda [dim] | m, m, Pa | unknowns                |
/// |              | q [minus then plus node, dim], with tips                 | m    | see tip_enrichment.hpp       |
/// | r            | [dim]                                                    | Pa   | R(w, lambda)                 |
/// | frame        | [face, dim, dim]                                         | -    | rows n, t1[, t2]             |
/// | share        | [face, node of a side]                                   | -    | node's part of the face mean |
/// | tip_share    | [face, minus then plus node]                             | -    | face mean of psi; with tips  |
/// | bubble_mean  | [face]                                                   | -    | mean(b)                      |
/// | law          | [number]                                                 |      | joint laws                   |
/// | number       | [face]                                                   |      | number of the face's law     |
/// | rest         | [face, dim]                                              | m    | w_0; empty: zero             |
/// | augmentation | [face]                                                   | Pa/m | c, but for the factor        |
/// | factor       | [face]; empty: 1                                         | -    | of c                         |
/// | p_old        | [face, dim - 1]                                          | m    | plastic jump of the last step |
/// | kept         | [face, number]; empty: none                              |      | what laws keep of a face     |
/// | damping      | [face]; empty: zero                                      | -    | see damp()                   |
/// | tether       |                                                          | -    | share of c, see contact()    |
/// | anchor       | [face, 2 dim]                                            | m, Pa | jump, traction it pulls to |
template <mesh::Shape shape, bool tips>
struct JointFace {
  using Cell = assembly::ReferenceCell<shape>;
  static constexpr int dim = Cell::dim, n = Cell::n_face_nodes;
  template <class... More>
  using Slots =
      assembly::Slots<assembly::Slot<2 * n, dim>, assembly::Slot<1, 2 * dim>, assembly::Slot<1, dim>, More...>;
  using Columns = std::conditional_t<tips, Slots<assembly::Slot<2 * n, dim>>, Slots<>>;
  using Rows = assembly::Slots<assembly::Slot<1, dim>>;
  static constexpr int beta = 2 * n * dim, lambda = beta + 2 * dim, q = lambda + dim;  // where they start in x
  using Fad = Sacado::Fad::SFad<Real, 2 * dim>;

  ConstView<Real***> frame;
  ConstView<Real**> share, tip_share;
  ConstView<Real*> bubble_mean;
  ConstView<laws::Joint*> law;
  ConstView<int*> number;
  ConstView<Real**> rest;
  ConstView<Real*> augmentation;
  View<Real**> p_old;
  View<Real**> kept = {};
  ConstView<Real*> damping = {};
  ConstView<Real*> factor = {};
  Real tether = 0;
  ConstView<Real**> anchor = {};

  /// c, Pa/m, before the stiffness of the joint joins it.
  KOKKOS_INLINE_FUNCTION Real constant(int f) const {
    return factor.extent(0) > 0 ? factor(f) * augmentation(f) : augmentation(f);
  }
  KOKKOS_INLINE_FUNCTION laws::Augmentation constants(int f) const {
    return laws::augmentation(law(number(f)), constant(f));
  }

  KOKKOS_INLINE_FUNCTION laws::Numbers<Real> kept_of(int f) const {
    if (kept.extent(1) == 0) return {};
    return {&kept(f, 0), static_cast<long>(kept.stride(1))};
  }
  KOKKOS_INLINE_FUNCTION laws::History history(int f) const {
    const auto numbers = kept_of(f);
    return {numbers.first, numbers.stride};
  }

  /// w = mean of R (u+ - u-) over the face.
  KOKKOS_INLINE_FUNCTION void jump(int f, const Real (&x)[Columns::size], Real (&w)[dim]) const {
    Real global[dim];
    for (int i = 0; i < dim; ++i) {
      global[i] = bubble_mean(f) * (x[beta + dim + i] - x[beta + i]);
      for (int a = 0; a < n; ++a) {
        global[i] += share(f, a) * (x[(n + a) * dim + i] - x[a * dim + i]);
        if (tips) global[i] += tip_share(f, n + a) * x[q + (n + a) * dim + i] - tip_share(f, a) * x[q + a * dim + i];
      }
    }
    for (int k = 0; k < dim; ++k) {
      w[k] = rest.extent(0) > 0 ? rest(f, k) : 0;
      for (int i = 0; i < dim; ++i) w[k] += frame(f, k, i) * global[i];
    }
  }

  /// Sum of the sizes of the terms of w: what rounding leaves of w is in proportion to it.
  KOKKOS_INLINE_FUNCTION Real size_of_terms(int f, const Real (&x)[Columns::size]) const {
    const auto size = [](Real value) { return value < 0 ? -value : value; };
    Real sum = 0;
    for (int i = 0; i < dim; ++i) {
      if (rest.extent(0) > 0) sum += size(rest(f, i));
      sum += bubble_mean(f) * (size(x[beta + dim + i]) + size(x[beta + i]));
      for (int a = 0; a < 2 * n; ++a) {
        sum += share(f, a % n) * size(x[a * dim + i]);
        if (tips) sum += size(tip_share(f, a) * x[q + a * dim + i]);
      }
    }
    return sum;
  }

  /// The part of the traction that contact and friction bear, and the jump that goes with it: a tether bears
  /// tether c (w_n - anchor) of the normal traction, and tether c (p - anchor) of the tangential one, which still
  /// stretches the joint as a whole: p = w_t - lambda_t/K_t, K_t being that at first loading.
  template <class T>
  KOKKOS_INLINE_FUNCTION void contact(int f, const T (&w)[dim], const T (&traction)[dim], T (&jump)[dim],
                                      T (&borne)[dim]) const {
    for (int k = 0; k < dim; ++k) {
      jump[k] = w[k];
      borne[k] = traction[k];
      if (tether == 0) continue;
      const Real compliance = k == 0 ? 0 : law(number(f)).elastic.initial_compliance();
      Real there = 0;
      for (int i = 0; i < dim; ++i) there += frame(f, k, i) * (anchor(f, i) - compliance * anchor(f, dim + i));
      const T pull = tether * constant(f) * (w[k] - compliance * traction[k] - there);
      jump[k] -= compliance * pull;
      borne[k] -= pull;
    }
  }

  template <class T>
  KOKKOS_INLINE_FUNCTION laws::ContactState evaluate(int f, const T (&w)[dim], const T (&traction)[dim],
                                                     T (&R)[dim]) const {
    Real old[dim - 1];
    for (int i = 0; i < dim - 1; ++i) old[i] = p_old(f, i);
    T jump[dim], borne[dim];
    contact(f, w, traction, jump, borne);
    return laws::contact_residual<dim>(law(number(f)), constants(f), jump, borne, old, R, history(f));
  }

  /// Jump, traction, residual, last plastic jump, state and constant of a face; what rounding may leave of the jump, m.
  struct Point {
    Real w[dim], traction[dim], R[dim], p_old[dim - 1];
    laws::ContactState state;
    Real constant, rounding;
  };
  KOKKOS_INLINE_FUNCTION Point point(int f, const Real (&x)[Columns::size]) const {
    Point p;
    jump(f, x, p.w);
    for (int i = 0; i < dim; ++i) p.traction[i] = x[lambda + i];
    for (int i = 0; i < dim - 1; ++i) p.p_old[i] = p_old(f, i);
    p.state = evaluate(f, p.w, p.traction, p.R);
    p.constant = constant(f);
    p.rounding = 64 * std::numeric_limits<Real>::epsilon() * size_of_terms(f, x);
    return p;
  }

  KOKKOS_INLINE_FUNCTION void residual(int f, const Real (&x)[Columns::size], Real (&r)[dim]) const {
    const Point p = point(f, x);
    for (int i = 0; i < dim; ++i) r[i] = p.R[i];
  }

  /// Lets faces that are free to slide or part resist it like a spring of damping times c_t, c_n, in derivatives alone.
  KOKKOS_INLINE_FUNCTION void damp(int f, laws::ContactState state, Fad (&R)[dim]) const {
    const Real share = damping.extent(0) > 0 ? damping(f) : 0;
    if (share == 0 || state == laws::ContactState::stick) return;
    const auto& joint = law(number(f));
    const auto add = [&](int k, Real stiffness, Real compliance) {
      R[k].fastAccessDx(k) -= stiffness;
      R[k].fastAccessDx(dim + k) += stiffness * compliance;
    };
    for (int k = 1; k < dim; ++k) add(k, share * constants(f).tangential, joint.elastic.initial_compliance());
    if (state == laws::ContactState::open) add(0, share * constants(f).normal, joint.gap.closure.initial_compliance());
  }

  /// dR/dx = dR/dw dw/dx + dR/dlambda: the law is differentiated in (w, lambda), w is linear in x.
  KOKKOS_INLINE_FUNCTION void jacobian(int f, const Real (&x)[Columns::size], Real (&J)[dim][Columns::size]) const {
    Real w_value[dim];
    jump(f, x, w_value);
    Fad w[dim], traction[dim], R[dim];
    for (int i = 0; i < dim; ++i) {
      w[i] = Fad(2 * dim, i, w_value[i]);
      traction[i] = Fad(2 * dim, dim + i, x[lambda + i]);
    }
    damp(f, evaluate(f, w, traction, R), R);
    for (int k = 0; k < dim; ++k) {
      Real by_w[dim];
      for (int l = 0; l < dim; ++l) {
        by_w[l] = R[k].dx(l);
        J[k][lambda + l] = R[k].dx(dim + l);
      }
      chain(f, by_w, J[k]);
    }
  }
  /// From the derivatives in w those in the displacements.
  KOKKOS_INLINE_FUNCTION void chain(int f, const Real (&by_w)[dim], Real (&row)[Columns::size]) const {
    for (int i = 0; i < dim; ++i) {
      Real by_jump = 0;  // derivative in component i of the global jump
      for (int l = 0; l < dim; ++l) by_jump += by_w[l] * frame(f, l, i);
      for (int a = 0; a < n; ++a) {
        row[a * dim + i] = -share(f, a) * by_jump;
        row[(n + a) * dim + i] = share(f, a) * by_jump;
        if (!tips) continue;
        row[q + a * dim + i] = -tip_share(f, a) * by_jump;
        row[q + (n + a) * dim + i] = tip_share(f, n + a) * by_jump;
      }
      row[beta + i] = -bubble_mean(f) * by_jump;
      row[beta + dim + i] = bubble_mean(f) * by_jump;
    }
  }
};

}  // namespace sprekk::physics
