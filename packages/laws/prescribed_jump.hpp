// Residual of a joint whose slip is prescribed.
#pragma once

#include "laws/joint.hpp"

namespace sprekk::laws {

/// Marks a component that is not prescribed.
constexpr Real not_prescribed = 1e300;

/// Computes the residual R(w, lambda), Pa, of a joint with a prescribed plastic tangential jump g_t, and returns the
/// contact state.
///   R_t = -c_t (w_t - u_t^e(lambda) - g_t)
///   R_n = -c_n (w_n - g_n)           with a prescribed normal jump g_n: closed under any traction
///   R_n as in contact_residual()     otherwise, with the gap and the bond at the slip g_t; open: R_n = lambda_n
/// The friction bound has no effect. The slip is prescribed on open faces, too: their shear traction need not vanish.
/// Thus the normal contact is independent of the slip. Closed faces have the state stick, since no component is free.
///
/// `given`: (g_n, g_t), m, in the frame of the face; g_n may be `not_prescribed`. `duration`: length of the step, s,
/// for gaps that depend on the slip rate. Other symbols as in contact_residual().
template <int dim, class T, class Law>
KOKKOS_INLINE_FUNCTION ContactState prescribed_residual(const Law& law, const Augmentation& c, const T (&w)[dim],
                                                        const T (&lambda)[dim], const Real (&p_old)[dim - 1],
                                                        const Real (&given)[dim], T (&R)[dim],
                                                        const History& history = {}, Real duration = 0) {
  const T none[dim - 1] = {};
  const T compliance = law.compliance(contact<dim>(lambda[0], T(0), none, p_old, history));
  Real step[dim - 1], slip[dim - 1];
  T p[dim - 1], shear[dim - 1];
  for (int i = 0; i < dim - 1; ++i) {
    slip[i] = given[i + 1];
    step[i] = slip[i] - p_old[i];
    p[i] = slip[i];
    shear[i] = lambda[i + 1];
    R[i + 1] = -c.tangential * (w[i + 1] - compliance * lambda[i + 1] - slip[i]);
  }
  if (given[0] != not_prescribed) {
    R[0] = -c.normal * (w[0] - given[0]);
    return ContactState::stick;
  }
  auto at = contact<dim>(lambda[0], T(norm(slip)), p, p_old, history);
  at.duration = duration;
  at.shear = norm(shear);
  const Real moved = norm(step);
  at.slip_of_step = moved;
  for (int i = 0; i < dim - 1 && moved > 0; ++i) at.slip_direction[i] = step[i] / moved;
  at.separation = w[0] - law.normal_gap(at);
  const T pushed = c.normal * at.separation;
  Cohesion<T> cohesion;
  if (law.is_bonded()) cohesion = law.cohesion(at);
  if (lambda[0] + pushed <= cohesion.strength) {
    R[0] = -pushed;
  } else if (!cohesion.lost) {
    R[0] = lambda[0] - cohesion.tension;
  } else {
    R[0] = lambda[0];
    return ContactState::open;
  }
  return ContactState::stick;
}

}  // namespace sprekk::laws
