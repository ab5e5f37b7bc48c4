// Displacement fields at a crack front with unit stress intensity factors.
#pragma once

#include "laws/elasticity.hpp"
#include <array>
#include <cmath>
#include <complex>

namespace sprekk::laws {

/// Displacement gradient of a crack field in the local frame: axis 1 ahead of the crack, 2 along its normal, 3 along
/// its front.
struct CrackField {
  std::array<std::array<Real, 3>, 3> H{};  ///< H_ab = derivative of component a along axis b, 1
  Real slope = 0;                          ///< derivative of tr H along axis 1, 1/m
  std::array<Real, 3> force{};             ///< divergence of the stress, Pa/m; zero at a straight front
};

/// Jump of H_a1 across the crack at the distance r behind the front for mode a of unit intensity; the other components
/// of this mode are continuous. Modes 0 and 1 are those of opening and sliding, with the components 2 and 1; mode 2 is
/// tearing, with the component 3.
inline Real jump_of_slope(const Elasticity& rock, int mode, Real r) {
  const Real nu = rock.lambda / (2 * (rock.lambda + rock.G));
  return -2 * (mode < 2 ? 1 - nu : 1) / (rock.G * std::sqrt(2 * M_PI * r));
}

/// Fields of opening, sliding and tearing with K = 1 Pa m^0.5 at (x1, x2) in plane or antiplane strain, bent to a front
/// with the curvature k, 1/m, positive around the crack. With Z = (2 pi z)^(-1/2), z = x1 + i x2, and Y' = Z:
///   opening: 2 G u1 = (1 - 2 nu) Re Y - x2 Im Z,   2 G u2 = 2 (1 - nu) Im Y - x2 Re Z
///   sliding: 2 G u1 = 2 (1 - nu) Im Y + x2 Re Z,   2 G u2 = -(1 - 2 nu) Re Y - x2 Im Z
///   tearing: G u3 = Im Y
/// (Williams 1957). The components are constant along the front. `curvature` is that of the arc through the point.
///
/// The hoop strain k u1 of sliding would load the faces with sigma_22 = lambda k u1. Sliding therefore has the
/// additional
///   2 G u2 = -2 (1 - nu) lambda k/(lambda + 2 G) x2 Im Y,
/// of higher order in k r. All faces are then free of traction.
inline std::array<CrackField, 3> crack_fields(const Elasticity& rock, Real x1, Real x2, Real curvature) {
  const Real G = rock.G, lambda = rock.lambda, nu = lambda / (2 * (lambda + G)), k = curvature;
  const std::complex<Real> z(x1, x2), root = std::sqrt(z), Z = Real(1) / (std::sqrt(2 * M_PI) * root),
                                      Y = Real(2) * z * Z, dZ = Real(-0.5) * Z / z;
  const auto plane = [&](Real u1, Real u11, Real u12, Real u21, Real u22, Real slope) {
    const Real f = 1 / (2 * G);
    CrackField field;
    field.H = {{{f * u11, f * u12, 0}, {f * u21, f * u22, 0}, {0, 0, f * k * u1}}};
    field.slope = f * (slope + k * (u11 - k * u1));
    field.force = {f * (lambda + 2 * G) * k * (u11 - k * u1), f * k * (lambda * u12 + G * (u12 + u21)), 0};
    return field;
  };
  const Real low = 1 - 2 * nu, high = 2 - 2 * nu;
  std::array<CrackField, 3> all;
  all[0] = plane(low * Y.real() - x2 * Z.imag(), low * Z.real() - x2 * dZ.imag(), -high * Z.imag() - x2 * dZ.real(),
                 high * Z.imag() - x2 * dZ.real(), low * Z.real() + x2 * dZ.imag(), 2 * low * dZ.real());
  all[1] =
      plane(high * Y.imag() + x2 * Z.real(), high * Z.imag() + x2 * dZ.real(), (high + 1) * Z.real() - x2 * dZ.imag(),
            -low * Z.real() - x2 * dZ.imag(), -2 * nu * Z.imag() - x2 * dZ.real(), 2 * low * dZ.imag());
  {
    // w = -a x2 U with a = lambda k/(lambda + 2 G) and the harmonic U = 2 (1 - nu) Im Y/(2 G); da/dx1 = -k a
    const Real a = lambda * k / (lambda + 2 * G), f = high / (2 * G), U = f * Y.imag(), U1 = f * Z.imag(),
               U2 = f * Z.real(), U11 = f * dZ.imag(), U12 = f * dZ.real();
    const Real w1 = -a * x2 * (U1 - k * U), w11 = -a * x2 * (U11 - 2 * k * (U1 - k * U)), w2 = -a * (U + x2 * U2),
               w22 = -a * (2 * U2 - x2 * U11), w12 = -a * (U1 - k * U + x2 * (U12 - k * U2));
    auto& [H, slope, force] = all[1];
    H[1][0] += w1;
    H[1][1] += w2;
    slope += w12;
    force[0] += (lambda + G) * w12;
    force[1] += (lambda + 2 * G) * w22 + G * (w11 + k * w1);
  }
  const Real u3 = Y.imag() / G, u31 = Z.imag() / G, u32 = Z.real() / G;
  all[2].H = {{{0, 0, -k * u3}, {0, 0, 0}, {u31, u32, 0}}};
  all[2].force = {0, 0, G * k * (u31 - k * u3)};
  return all;
}

}  // namespace sprekk::laws
