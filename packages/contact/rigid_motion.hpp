// Rigid motions of bodies, in coordinates of the size of one.
#pragma once

#include "mesh/facets.hpp"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace sprekk::contact {

/// The part of a motion that is below this, relative to its largest, is round-off. Eigenvalues are squares of it.
inline constexpr Real negligible = 1e-6;

/// Of the six modes of a body: translations, then rotations times the body's size.
using RigidRow = std::array<Real, 6>;
using RigidBlock = std::array<RigidRow, 6>;

/// Where the motions of a body are measured.
struct RigidFrame {
  mesh::Vector centre{};
  Real size = 1;  ///< largest extent of the body, m
};

/// Component i of the displacement at x under each mode.
RigidRow rigid_row(const RigidFrame& frame, const mesh::Vector& x, int i);

/// The displacement at x under the motion q.
mesh::Vector rigid_displacement(const RigidFrame& frame, const RigidRow& q, const mesh::Vector& x);

/// Adds sign a b^T.
void add_product(RigidBlock& block, const RigidRow& a, const RigidRow& b, Real sign = 1);

/// The modes that there are in 2D, 3D.
std::vector<int> rigid_modes(int dim);

/// Orthonormal vectors that span the null space of a symmetric, positive semi-definite n x n matrix: eigenvalues up to
/// 1e-12 of the largest; all, if the matrix is zero.
std::vector<std::vector<Real>> null_space(std::vector<Real> matrix, int n);

/// Gauss-Jordan elimination with the largest pivots, first in columns for which `first` holds: so that motions come out
/// along coordinates where that is possible, and translations apart from rotations.
void reduce(std::vector<std::vector<Real>>& rows, const std::function<bool(std::size_t)>& first);

/// A rigid motion of one body at small rotation, v(x) = translation + rotation x (x - centre).
struct FreeMotion {
  int body;  ///< see mesh::find_bodies()
  mesh::Vector translation, rotation, centre;
};

/// The motion of these rigid coordinates; parts that are round-off next to the largest are zero.
FreeMotion free_motion(int body, const RigidFrame& frame, const RigidRow& q);

/// "can move along (1, 0)", "can rotate about the axis (0, 0, 1) through (0, 1, 0)"; in 2D about a point.
std::string to_text(const FreeMotion& motion, int dim);

/// "(0, 1.5)": a point or vector; components that are round-off next to `scale` are zero.
std::string to_text(const mesh::Vector& x, int dim, Real scale);

}  // namespace sprekk::contact
