// Traction rows of a fracture face, and the rows that receive the power of its friction.
#pragma once

#include "assembly/slots.hpp"
#include "laws/joint_points.hpp"

#include <limits>
#include <type_traits>

namespace sprekk::physics {

/// Joint law on one fracture face with n nodes on each side.
///
/// | symbol       | shape                                                    | unit |                              |
/// | x            | u [minus then plus node, dim], beta [2 dim], lambda [dim] | m, m, Pa | unknowns                |
/// |              | q [minus then plus node, dim], with tips                 | m    | see tip_enrichment.hpp       |
/// | r            | [dim]                                                    | Pa   | R(w, lambda)                 |
/// | points       |                                                          |      | joint laws of the faces      |
/// | share        | [face, node of a side]                                   | -    | node's share in the face mean |
/// | tip_share    | [face, minus then plus node]                             | -    | face mean of psi; with tips  |
/// | bubble_mean  | [face]                                                   | -    | mean(b)                      |
/// | rest         | [face, dim]                                              | m    | w_0; empty: zero             |
template <int dimension, int n_nodes, bool tips>
struct JointFace {
  static constexpr int dim = dimension, n = n_nodes;
  using Point = laws::JointPoint<dim>;
  template <class... More>
  using Slots =
      assembly::Slots<assembly::Slot<2 * n, dim>, assembly::Slot<1, 2 * dim>, assembly::Slot<1, dim>, More...>;
  using Columns = std::conditional_t<tips, Slots<assembly::Slot<2 * n, dim>>, Slots<>>;
  using Rows = assembly::Slots<assembly::Slot<1, dim>>;
  static constexpr int beta = 2 * n * dim, lambda = beta + 2 * dim, q = lambda + dim;  // offsets in x

  laws::JointPoints<dim> points;
  ConstView<Real**> share, tip_share;
  ConstView<Real*> bubble_mean;
  ConstView<Real**> rest = {};

  /// Computes the jump w = mean of R (u+ - u-) over the face.
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
      for (int i = 0; i < dim; ++i) w[k] += points.frame(f, k, i) * global[i];
    }
  }

  KOKKOS_INLINE_FUNCTION Point point(int f, const Real (&x)[Columns::size]) const {
    Point p;
    jump(f, x, p.w);
    traction(x, p.traction);
    for (int i = 0; i < dim - 1; ++i) p.p_old[i] = points.p_old(f, i);
    p.state = points.residual(f, p.w, p.traction, p.R);
    p.constant = points.constant(f);
    p.spring = points.spring(f);
    p.rounding = 64 * std::numeric_limits<Real>::epsilon() * size_of_terms(f, x);
    return p;
  }

  KOKKOS_INLINE_FUNCTION void residual(int f, const Real (&x)[Columns::size], Real (&r)[dim]) const {
    Real w[dim], borne[dim];
    jump(f, x, w);
    traction(x, borne);
    points.residual(f, w, borne, r);
  }

  /// Computes dR/dx = dR/dw dw/dx + dR/dlambda. The law is differentiated in (w, lambda); w is linear in x.
  KOKKOS_INLINE_FUNCTION void jacobian(int f, const Real (&x)[Columns::size], Real (&J)[dim][Columns::size]) const {
    Real w[dim], borne[dim], dR[dim][2 * dim];
    jump(f, x, w);
    traction(x, borne);
    points.jacobian(f, w, borne, dR);
    for (int k = 0; k < dim; ++k) chain(f, dR[k], J[k]);
  }

  /// Computes the derivatives in x from those in w and lambda.
  KOKKOS_INLINE_FUNCTION void chain(int f, const Real (&derivatives)[2 * dim], Real (&row)[Columns::size]) const {
    for (int i = 0; i < dim; ++i) {
      row[lambda + i] = derivatives[dim + i];
      Real by_jump = 0;  // derivative by component i of the global jump
      for (int l = 0; l < dim; ++l) by_jump += derivatives[l] * points.frame(f, l, i);
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

  KOKKOS_INLINE_FUNCTION void traction(const Real (&x)[Columns::size], Real (&borne)[dim]) const {
    for (int i = 0; i < dim; ++i) borne[i] = x[lambda + i];
  }

 private:
  /// Returns the sum of the absolute terms of w, to which the rounding error of w is proportional.
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
};

/// Power dissipated by plastic slip of a face, a source of a row of stored energy: r = -A/dt work, see
/// laws::JointPoints::work().
///
/// | symbol | shape           | unit |                    |
/// | x      | as in JointFace |      |                    |
/// | r      | 1               | W    | (2D: W/m)          |
/// | area   | [face]          | m^2  | A                  |
/// | rate   |                 | 1/s  | of assembly::State |
template <class Face>
struct SlidingFace {
  using Columns = typename Face::Columns;
  using Rows = assembly::Slots<assembly::Slot<1, 1>>;
  static constexpr int dim = Face::dim, n = Columns::size;
  Face face;
  ConstView<Real*> area;
  Real rate = 0;

  KOKKOS_INLINE_FUNCTION void residual(int f, const Real (&x)[n], Real (&r)[1]) const {
    Real w[dim], borne[dim];
    face.jump(f, x, w);
    face.traction(x, borne);
    r[0] = -area(f) * rate * face.points.work(f, w, borne);
  }

  KOKKOS_INLINE_FUNCTION void jacobian(int f, const Real (&x)[n], Real (&J)[1][n]) const {
    Real w[dim], borne[dim], derivatives[2 * dim];
    face.jump(f, x, w);
    face.traction(x, borne);
    face.points.dwork(f, w, borne, derivatives);
    for (Real& each : derivatives) each *= -area(f) * rate;
    face.chain(f, derivatives, J[0]);
  }
};

}  // namespace sprekk::physics
