// Integrands of the interaction integral at a point: virtual advance of a front, and crack fields.
#pragma once

#include "laws/crack_field.hpp"
#include "mesh/fronts.hpp"

#include <array>

namespace sprekk::physics::front {

using mesh::Vector;
using mesh::operator+, mesh::operator*;
using Matrix = std::array<Vector, 3>;  // [row][column]

inline Real product(const Matrix& A, const Matrix& B) {
  return mesh::dot(A[0], B[0]) + mesh::dot(A[1], B[1]) + mesh::dot(A[2], B[2]);
}
inline Vector times(const Matrix& A, const Vector& v) {
  return {mesh::dot(A[0], v), mesh::dot(A[1], v), mesh::dot(A[2], v)};
}
/// Returns A^T v.
inline Vector transposed_times(const Matrix& A, const Vector& v) { return v[0] * A[0] + v[1] * A[1] + v[2] * A[2]; }
inline Real trace(const Matrix& A) { return A[0][0] + A[1][1] + A[2][2]; }

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

struct Advance {
  mesh::FrontPoint::Local local;
  Vector q;   // w times the direction ahead
  Matrix dq;  // [k][j] derivative of q_k along j, 1/m
  Real weight;

  Advance(const mesh::FrontPoint& front, const Vector& x) : local(front.at(x)) {
    Vector g;
    weight = front.weight(x, g);
    q = weight * local.ahead;
    for (int k = 0; k < 3; ++k) dq[k] = local.ahead[k] * g + (weight * local.curvature * local.along[k]) * local.along;
  }
};

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
