// Crack fields at a front, in global components.
#pragma once

#include "laws/crack_field.hpp"
#include "mesh/fronts.hpp"

#include <array>

namespace sprekk::physics::front {

using mesh::Vector;
using mesh::operator+, mesh::operator*;
using mesh::Advance, mesh::Matrix, mesh::product, mesh::times, mesh::transposed_times, mesh::trace;

inline Matrix stress(const laws::Elasticity& law, const Matrix& H) {
  Matrix s;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) s[i][j] = law.G * (H[i][j] + H[j][i]) + (i == j ? law.lambda * trace(H) : 0);
  return s;
}

/// Crack field at a point in global components, and the direction of the advance of the front.
struct Virtual {
  Matrix H, stress;  // of the crack field
  Vector force;      // divergence of the stress
  Real slope;        // derivative of tr H in the direction of the advance
};

/// Constants of the rock for mesh::find_fronts: shear modulus G, G + lambda, Pa, and a number that differs where
/// integrals must not cross.
inline std::array<Real, 3> constants(const laws::Elasticity& rock, Real label) {
  return {rock.G, rock.G + rock.lambda, label};
}
inline laws::Elasticity rock_at(const mesh::FrontPoint& front) {
  return {front.rock[0], front.rock[1] - front.rock[0]};
}

/// Crack fields of unit intensity of all modes, in global components.
inline std::array<Virtual, 3> virtual_fields(const mesh::FrontPoint& front, const mesh::FrontPoint::Local& at) {
  const Matrix axes = {at.ahead, front.normal, at.along};
  std::array<Virtual, 3> all;
  const auto rock = rock_at(front);
  const auto fields = laws::crack_fields(rock, at.x1, at.x2, at.curvature);
  for (int m = 0; m < 3; ++m) {
    auto& one = all[m];
    one = {};
    for (int a = 0; a < 3; ++a)
      for (int i = 0; i < 3; ++i)
        for (int b = 0; b < 3; ++b) one.H[i] = one.H[i] + (axes[a][i] * fields[m].H[a][b]) * axes[b];
    one.stress = stress(rock, one.H);
    one.force = transposed_times(axes, fields[m].force);
    one.slope = fields[m].slope;
  }
  return all;
}

}  // namespace sprekk::physics::front
