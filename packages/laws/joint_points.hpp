// Joint laws at the centres of fracture faces, independent of the mesh: compiled once for all cell shapes.
#pragma once

#include "base/view.hpp"
#include "laws/contact.hpp"
#include "laws/joint_fwd.hpp"

namespace sprekk::laws {

/// Jump, traction, residual, last plastic jump, contact state, augmentation constant and proximal stiffness of a face.
/// `rounding`: rounding error of the jump, m.
template <int dim>
struct JointPoint {
  Real w[dim], traction[dim], R[dim], p_old[dim - 1];
  ContactState state;
  Real constant, spring, rounding;
};

/// History variables that commit() advances to the end of a step; on the device.
struct JointHistory {
  View<Real**> plastic_jump;  ///< [face, dim - 1] m
  View<Real**> slid;          ///< [face, 2] 0: never slid, 1: slid in the step, 2: slid before; sum of work(), J/m^2
  View<Real**> runaway;       ///< [face, 1] m, see runaway.hpp; empty if laws have no history
  View<Real*> softness;       ///< [face] m/Pa, see runaway_slip(); empty if laws have no history
};

/// Joint laws on fracture faces. The functions evaluate one face and are callable in kernels.
///
/// | symbol       | shape                  | unit  |                                                  |
/// | w, lambda    | [dim]                  | m, Pa | jump and traction in the frame of the face       |
/// | R            | [dim]                  | Pa    | R(w, lambda) of laws/joint.hpp                   |
/// | frame        | [face, dim, dim]       | -     | rows n, t1[, t2]                                 |
/// | law          | [number]               |       | joint laws, in device memory                     |
/// | number       | [face]                 |       | number of the joint law                          |
/// | augmentation | [face]                 | Pa/m  | c without `factor`                               |
/// | p_old        | [face, dim - 1]        | m     | plastic jump of the last step                    |
/// | stored_history| [face, number]; empty: none |  | history variables of the laws                    |
/// | damping      | [face]; empty: zero    | -     | see jacobian()                                   |
/// | factor       | [face]; empty: 1       | -     | factor of c                                      |
/// | duration     |                        | s     | length of the step; 0: outside of a step         |
/// | proximal     |                        | -     | proximal stiffness relative to c, see contact()  |
/// | anchor       | [face, 2 dim]          | m, Pa | jump and traction at the origin of the proximal term |
/// | prescribed   | [face, dim]; empty: none| m    | `given` of prescribed_residual(), all `not_prescribed`:  |
/// |              |                        |       | a face without prescribed slip                   |
template <int dim>
struct JointPoints {
  ConstView<Real***> frame;
  const Joint* law = nullptr;
  ConstView<int*> number;
  ConstView<Real*> augmentation;
  View<Real**> p_old = {};
  View<Real**> stored_history = {};
  ConstView<Real*> damping = {};
  ConstView<Real*> factor = {};
  Real duration = 0;
  Real proximal = 0;
  ConstView<Real**> anchor = {};
  ConstView<Real**> prescribed = {};

  /// Augmentation constant c, Pa/m, without the stiffness of the joint.
  KOKKOS_INLINE_FUNCTION Real constant(int f) const {
    return factor.extent(0) > 0 ? factor(f) * augmentation(f) : augmentation(f);
  }
  /// Stiffness of the proximal term, Pa/m.
  KOKKOS_INLINE_FUNCTION Real spring(int f) const { return proximal * constant(f); }
  KOKKOS_INLINE_FUNCTION Numbers<Real> history_of(int f) const {
    if (stored_history.extent(1) == 0) return {};
    return {&stored_history(f, 0), static_cast<long>(stored_history.stride(1))};
  }
  KOKKOS_INLINE_FUNCTION History history(int f) const {
    const auto numbers = history_of(f);
    return {numbers.first, numbers.stride};
  }

  /// Computes R and returns the contact state.
  KOKKOS_FUNCTION ContactState residual(int f, const Real (&w)[dim], const Real (&lambda)[dim], Real (&R)[dim]) const;
  /// Computes the derivatives of R in w, then in lambda. Sliding and open faces have additional springs of damping
  /// times c_t, c_n. They appear in the derivatives only.
  KOKKOS_FUNCTION void jacobian(int f, const Real (&w)[dim], const Real (&lambda)[dim], Real (&dR)[dim][2 * dim]) const;

  /// Energy dissipated by plastic slip in the step, J/m^2, and its derivatives in w, then in lambda:
  ///   lambda_t . (p_t - p_old) + lambda_n (p_n - p_n,old),   p_t = w_t - lambda_t/K_t,
  /// where p_n is the dilation due to p_t. It is the work of friction minus the work against the compression. It is
  /// zero if the face sticks or is open. With a prescribed slip against the traction it is negative.
  KOKKOS_FUNCTION Real work(int f, const Real (&w)[dim], const Real (&lambda)[dim]) const;
  KOKKOS_FUNCTION void dwork(int f, const Real (&w)[dim], const Real (&lambda)[dim],
                             Real (&derivatives)[2 * dim]) const;

  /// Advances the history variables of a face to the end of a step with the result `end`.
  KOKKOS_FUNCTION void commit(int f, const JointPoint<dim>& end, const JointHistory& history) const;

 private:
  KOKKOS_INLINE_FUNCTION bool is_prescribed(int f) const;
  template <class T>
  KOKKOS_INLINE_FUNCTION T contact(int f, const T (&w)[dim], const T (&traction)[dim], T (&jump)[dim],
                                   T (&borne)[dim]) const;
  template <class T>
  KOKKOS_INLINE_FUNCTION ContactState evaluate(int f, const T (&w)[dim], const T (&traction)[dim], T (&R)[dim]) const;
  template <class T>
  KOKKOS_INLINE_FUNCTION void damp(int f, ContactState state, T (&R)[dim]) const;
  template <class T>
  KOKKOS_INLINE_FUNCTION T dissipated(int f, const T (&w)[dim], const T (&traction)[dim]) const;
};

}  // namespace sprekk::laws

// Device code cannot call functions of other translation units, so the definitions are included.
#if defined(KOKKOS_ENABLE_CUDA) || defined(KOKKOS_ENABLE_HIP) || defined(KOKKOS_ENABLE_SYCL)
#include "laws/joint_points_laws.hpp"
#endif
