// The joint laws at the centres of fracture faces, apart from the mesh: compiled once, for all shapes of cells.
#pragma once

#include "base/view.hpp"
#include "laws/contact.hpp"
#include "laws/joint_fwd.hpp"

namespace sprekk::physics {

/// Jump, traction, residual, last plastic jump, state and constant of a face; the share of rounding in the jump, m.
template <int dim>
struct JointPoint {
  Real w[dim], traction[dim], R[dim], p_old[dim - 1];
  laws::ContactState state;
  Real constant, rounding;
};

/// The history variables that commit() moves to the end of a step; device.
struct JointHistory {
  View<Real**> plastic_jump;  ///< [face, dim - 1] m
  View<Real**> slid;          ///< [face, 1] 1 where the face slid in the step
  View<Real**> runaway;       ///< [face, 1] m, see runaway.hpp; empty where laws have no history
  View<Real*> softness;       ///< [face] m/Pa, see runaway_slip; empty where laws have no history
};

/// The joint law on fracture faces. Its functions are those of one face, for kernels.
///
/// | symbol       | shape                  | unit  |                                                  |
/// | w, lambda    | [dim]                  | m, Pa | jump and traction in the frame of the face       |
/// | R            | [dim]                  | Pa    | R(w, lambda) of laws/joint.hpp                   |
/// | frame        | [face, dim, dim]       | -     | rows n, t1[, t2]                                 |
/// | law          | [number]               |       | joint laws, in memory of the kernels             |
/// | number       | [face]                 |       | number of the face's law                         |
/// | augmentation | [face]                 | Pa/m  | c, without the factor                            |
/// | p_old        | [face, dim - 1]        | m     | plastic jump of the last step                    |
/// | kept         | [face, number]; empty: none |  | history variables of the laws                    |
/// | damping      | [face]; empty: zero    | -     | see jacobian()                                   |
/// | factor       | [face]; empty: 1       | -     | of c                                             |
/// | tether       |                        | -     | share of c in the proximal term, see contact()   |
/// | anchor       | [face, 2 dim]          | m, Pa | jump and traction to which the proximal term pulls |
template <int dim>
struct JointPoints {
  ConstView<Real***> frame;
  const laws::Joint* law = nullptr;
  ConstView<int*> number;
  ConstView<Real*> augmentation;
  View<Real**> p_old = {};
  View<Real**> kept = {};
  ConstView<Real*> damping = {};
  ConstView<Real*> factor = {};
  Real tether = 0;
  ConstView<Real**> anchor = {};

  /// c, Pa/m, before the stiffness of the joint joins it.
  KOKKOS_INLINE_FUNCTION Real constant(int f) const {
    return factor.extent(0) > 0 ? factor(f) * augmentation(f) : augmentation(f);
  }
  KOKKOS_INLINE_FUNCTION laws::Numbers<Real> kept_of(int f) const {
    if (kept.extent(1) == 0) return {};
    return {&kept(f, 0), static_cast<long>(kept.stride(1))};
  }
  KOKKOS_INLINE_FUNCTION laws::History history(int f) const {
    const auto numbers = kept_of(f);
    return {numbers.first, numbers.stride};
  }

  /// R and the state of contact.
  KOKKOS_FUNCTION laws::ContactState residual(int f, const Real (&w)[dim], const Real (&lambda)[dim],
                                              Real (&R)[dim]) const;
  /// The derivatives of R in w, then in lambda. Faces that are free to slide or part resist it like a spring of damping
  /// times c_t, c_n, in derivatives alone.
  KOKKOS_FUNCTION void jacobian(int f, const Real (&w)[dim], const Real (&lambda)[dim], Real (&dR)[dim][2 * dim]) const;

  /// Energy that plastic slip dissipates in the step, J/m^2, and its derivatives in w, then in lambda:
  ///   lambda_t . (p_t - p_old) + lambda_n (p_n - p_n,old),   p_t = w_t - lambda_t/K_t
  /// with p_n the dilation by p_t: the work of friction minus the work that lifts the sides. It is zero where the face
  /// sticks or is open.
  KOKKOS_FUNCTION Real work(int f, const Real (&w)[dim], const Real (&lambda)[dim]) const;
  KOKKOS_FUNCTION void dwork(int f, const Real (&w)[dim], const Real (&lambda)[dim],
                             Real (&derivatives)[2 * dim]) const;

  /// Moves the history of a face to the end of a step that ends at `end`.
  KOKKOS_FUNCTION void commit(int f, const JointPoint<dim>& end, const JointHistory& history) const;

 private:
  template <class T>
  KOKKOS_INLINE_FUNCTION void contact(int f, const T (&w)[dim], const T (&traction)[dim], T (&jump)[dim],
                                      T (&borne)[dim]) const;
  template <class T>
  KOKKOS_INLINE_FUNCTION laws::ContactState evaluate(int f, const T (&w)[dim], const T (&traction)[dim],
                                                     T (&R)[dim]) const;
  template <class T>
  KOKKOS_INLINE_FUNCTION void damp(int f, laws::ContactState state, T (&R)[dim]) const;
  template <class T>
  KOKKOS_INLINE_FUNCTION T dissipated(int f, const T (&w)[dim], const T (&traction)[dim]) const;
};

}  // namespace sprekk::physics

// Device code cannot call functions of other translation units.
#if defined(KOKKOS_ENABLE_CUDA) || defined(KOKKOS_ENABLE_HIP) || defined(KOKKOS_ENABLE_SYCL)
#include "physics/mechanics/joint_points_laws.hpp"
#endif
