// The power that a sliding fracture dissipates.
#pragma once

#include "physics/mechanics/joint_face.hpp"

namespace sprekk::physics {

/// What a face dissipates by its plastic jump p, taken from a row that stores it,
///   r = -A (lambda_t . (p_t - p_old) + lambda_n (p_n - p_n,old))/dt,   p_t = w_t - lambda_t/K_t
/// with p_n the dilation by p_t: the work of friction less that which lifts the sides. It is zero where the face sticks
/// or is open.
///
/// | symbol | shape           | unit |                    |
/// | x      | as of JointFace |      |                    |
/// | r      | 1               | W    | (2D: W/m)          |
/// | area   | [face]          | m^2  | A                  |
/// | rate   |                 | 1/s  | of assembly::State |
template <mesh::Shape shape, bool tips>
struct SlidingFace {
  using Face = JointFace<shape, tips>;
  using Columns = typename Face::Columns;
  using Rows = assembly::Slots<assembly::Slot<1, 1>>;
  using Fad = typename Face::Fad;
  static constexpr int dim = Face::dim, n = Columns::size;
  Face face;
  ConstView<Real*> area;
  Real rate = 0;

  template <class T>
  static KOKKOS_INLINE_FUNCTION T length(const T (&v)[dim - 1]) {
    T square = 0;
    for (const T& each : v) square += each * each;
    return square > 0 ? T(sqrt(square)) : T(0);
  }

  /// p_t.
  template <class T>
  KOKKOS_INLINE_FUNCTION void plastic(int f, const T (&w)[dim], const T (&traction)[dim], T (&p)[dim - 1]) const {
    const Real none[dim - 1] = {};
    for (T& each : p) each = 0;
    const T compliance =
        face.law(face.number(f)).compliance(laws::contact<dim>(traction[0], T(0), p, none, face.history(f)));
    for (int i = 0; i < dim - 1; ++i) p[i] = w[i + 1] - compliance * traction[i + 1];
  }

  /// Dissipated in the step per area, J/m^2.
  template <class T>
  KOKKOS_INLINE_FUNCTION T work(int f, const T (&w)[dim], const T (&traction)[dim]) const {
    const auto& law = face.law(face.number(f));
    T p[dim - 1], before[dim - 1], sum = 0;
    Real old[dim - 1];
    plastic(f, w, traction, p);
    for (int i = 0; i < dim - 1; ++i) {
      before[i] = old[i] = face.p_old(f, i);
      sum += traction[i + 1] * (p[i] - old[i]);
    }
    const auto gap = [&](const T(&jump)[dim - 1]) {
      auto at = laws::contact<dim>(traction[0], length(jump), jump, old, face.history(f));
      T step[dim - 1], shear[dim - 1];
      for (int i = 0; i < dim - 1; ++i) {
        step[i] = jump[i] - old[i];
        shear[i] = traction[i + 1];
      }
      at.slip_of_step = length(step);
      for (int i = 0; i < dim - 1 && at.slip_of_step > 0; ++i) at.slip_direction[i] = step[i] / at.slip_of_step;
      at.shear = length(shear);
      return law.normal_gap(at);
    };
    return sum + traction[0] * (gap(p) - gap(before));
  }

  KOKKOS_INLINE_FUNCTION void residual(int f, const Real (&x)[n], Real (&r)[1]) const {
    Real w[dim], traction[dim];
    face.jump(f, x, w);
    for (int i = 0; i < dim; ++i) traction[i] = x[Face::lambda + i];
    r[0] = -area(f) * rate * work(f, w, traction);
  }

  KOKKOS_INLINE_FUNCTION void jacobian(int f, const Real (&x)[n], Real (&J)[1][n]) const {
    Real jump[dim];
    face.jump(f, x, jump);
    Fad w[dim], traction[dim];
    for (int i = 0; i < dim; ++i) {
      w[i] = Fad(2 * dim, i, jump[i]);
      traction[i] = Fad(2 * dim, dim + i, x[Face::lambda + i]);
    }
    const Fad sum = work(f, w, traction);
    const Real factor = -area(f) * rate;
    Real by_w[dim];
    for (int k = 0; k < dim; ++k) {
      by_w[k] = factor * sum.dx(k);
      J[0][Face::lambda + k] = factor * sum.dx(dim + k);
    }
    face.chain(f, by_w, J[0]);
  }
};

}  // namespace sprekk::physics
