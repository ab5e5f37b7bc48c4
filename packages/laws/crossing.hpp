// Crossing of an interface by a growing crack.
#pragma once

#include "base/types.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::laws {

/// Interface that a crack in plane strain meets. Axis 1 is the direction of growth, axis 2 its left normal. The
/// interface is along t = (cos(angle), sin(angle)), with the normal n = (-sin(angle), cos(angle)). Its stress is that
/// without the singular field of the crack, tension positive.
struct Interface {
  Real angle;                 ///< b, rad, in (0, pi)
  Real normal, shear, along;  ///< n.s n, t.s n, t.s t, Pa
};

/// Margin with which a crack crosses an interface, (bound/|shear| - 1) of the weaker of both rays from the tip; above
/// 0, it crosses. On each ray, theta = b and theta = b - pi, the singular field of opening
///   s11 = k cos(theta/2) (1 - sin(theta/2) sin(3 theta/2)),   s22 = k cos(theta/2) (1 + sin(theta/2) sin(3 theta/2)),
///   s12 = k cos(theta/2) sin(theta/2) cos(3 theta/2)
/// is added with the k = K_I/(2 pi r)^(1/2) at which the stress along the interface is the strength of the rock beyond
/// (Renshaw and Pollard 1995; other angles as in Gu et al. 2012). `bound` is a function of normal and shear stress, Pa:
/// the shear bound of the interface, 0 if it opens. For Coulomb friction mu and b = pi/2, the margin is positive if
///   -s11/(strength - s22) > (1 + 1/mu)/3.
/// -1: the strength is not reached for any k. At most 999.
template <class Bound>
Real margin_of_crossing(const Interface& at, Real strength, const Bound& bound) {
  const Real ct = std::cos(at.angle), st = std::sin(at.angle);
  Real margin = 999;
  for (const Real theta : {at.angle, at.angle - M_PI}) {
    const Real c = std::cos(theta / 2), s = std::sin(theta / 2), c3 = std::cos(3 * theta / 2),
               s3 = std::sin(3 * theta / 2), s11 = c * (1 - s * s3), s22 = c * (1 + s * s3), s12 = c * s * c3;
    const Real along = s11 * ct * ct + s22 * st * st + 2 * s12 * st * ct,
               normal = s11 * st * st + s22 * ct * ct - 2 * s12 * st * ct,
               shear = (s22 - s11) * st * ct + s12 * (ct * ct - st * st), left = std::max<Real>(strength - at.along, 0);
    if (left > 0 && !(along > 0)) return -1;
    const Real k = left > 0 ? left / along : 0, total = std::abs(at.shear + k * shear),
               largest = bound(at.normal + k * normal, total);
    margin = std::min(margin, largest / std::max(total, std::max<Real>(1e-3 * largest, 1e-300)) - 1);
  }
  return margin;
}

}  // namespace sprekk::laws
