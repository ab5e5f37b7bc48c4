// One plane fracture of any orientation through a box under uniform stress.
// In the frame of the plane, sigma_nn = -0.3. The tangential block of the stress is -0.5 in 2D and [[-0.5, 0.07],
// [0.07, -0.2]] in 3D. The shear is T, in 3D along (0.6, 0.8). A sticking joint has T = 0.1. A slipping joint has T =
// mu 0.3, with the plastic jump 0.25 along the shear. The jump follows from the joint law at this traction, see
// at_stress().
#pragma once

#include "verification/patch/patch.hpp"

namespace sprekk::tests {

constexpr Real friction_coefficient = 0.6;

inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

inline Vector3 unit(Vector3 v) {
  const Real length = norm(v);
  for (Real& c : v) c /= length;
  return v;
}

/// Returns the exact state for a plane through `origin` with the normal n (of any length).
inline Patch inclined_patch(int dim, Vector3 n, bool slips, const Vector3& origin = {}) {
  n = unit(n);
  const Vector3 a = std::abs(n[2]) < 0.9 ? Vector3{0, 0, 1} : Vector3{1, 0, 0};
  const Vector3 t1 = dim == 2 ? Vector3{n[1], -n[0], 0} : unit(cross(a, n));
  const Vector3 axes[] = {t1, dim == 2 ? Vector3{} : cross(n, t1), n};
  const Real N = 0.3, T = slips ? friction_coefficient * N : 0.1, q1 = dim == 2 ? 1 : 0.6, q2 = dim == 2 ? 0 : 0.8;
  const Matrix3 local = {{{-0.5, 0.07, q1 * T}, {0.07, -0.2, q2 * T}, {q1 * T, q2 * T, -N}}};
  Matrix3 stress{};
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l) stress[i][j] += local[k][l] * axes[k][i] * axes[l][j];
  Patch patch = uniform_patch(dim, stress);
  patch.origin = origin;
  Vector3 u_p{};
  for (int i = 0; i < 3; ++i) u_p[i] = slips ? 0.25 * (q1 * axes[0][i] + q2 * axes[1][i]) : 0;
  patch.joints["f1"] = at_stress({2, std::tan(10 * M_PI / 180), 0.01, 0.1, 5}, n, stress, u_p);
  add_blocks(patch);
  return patch;
}

/// Returns the normals of the meshes cut_lines1 to 5 and cut_plane1 to 3.
inline std::vector<Vector3> inclined_normals(int dim) {
  if (dim == 3) return {{1, 2, 3}, {0, 0, 1}, {-0.2, 0.9, 0.1}};
  return {{0, 1, 0}, {-0.5, std::sqrt(0.75), 0}, {-1, 1, 0}, {1, 0, 0}, {0.31, -0.95, 0}};
}

}  // namespace sprekk::tests
