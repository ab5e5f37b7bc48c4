// Rigid motions of bodies, in coordinates scaled by the body's size.
#pragma once

#include "mesh/facets.hpp"

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace sprekk::contact {

/// Relative limit of round-off in motions. Eigenvalues below its square are round-off.
inline constexpr Real negligible = 1e-6;

/// Values for the six rigid modes of a body: translations, then rotations times the body's size.
using RigidRow = std::array<Real, 6>;
using RigidBlock = std::array<RigidRow, 6>;

/// Reference point and length of the motions of a body.
struct RigidFrame {
  mesh::Vector centre{};
  Real size = 1;  ///< largest extent of the body, m
};

/// Returns component i of the displacement at x for each mode.
RigidRow rigid_row(const RigidFrame& frame, const mesh::Vector& x, int i);

/// Returns the displacement at x for the motion q.
mesh::Vector rigid_displacement(const RigidFrame& frame, const RigidRow& q, const mesh::Vector& x);

/// Adds sign * a b^T to the block.
void add_product(RigidBlock& block, const RigidRow& a, const RigidRow& b, Real sign = 1);

/// Returns the modes that exist in 2D or 3D.
std::vector<int> rigid_modes(int dim);

/// Returns an orthonormal basis of the null space of a symmetric, positive semi-definite n x n matrix: eigenvectors
/// with eigenvalues up to 1e-12 of the largest. A zero matrix yields n vectors. Throws an Error if LAPACK fails.
std::vector<std::vector<Real>> null_space(std::vector<Real> matrix, int n);

/// Applies Gauss-Jordan elimination with the largest pivots, starting with the columns selected by `first`. Motions
/// then follow coordinate axes where possible, and translations are separated from rotations.
void reduce(std::vector<std::vector<Real>>& rows, const std::function<bool(std::size_t)>& first);

/// Rigid motion of one body with small rotation, v(x) = translation + rotation x (x - centre).
struct FreeMotion {
  int body;  ///< see mesh::find_bodies()
  mesh::Vector translation, rotation, centre;
};

/// Returns the motion with the rigid coordinates q. Components below round-off, relative to the largest, are set to
/// zero.
FreeMotion free_motion(int body, const RigidFrame& frame, const RigidRow& q);

/// Returns e.g. "can move along (1, 0)", or "can rotate about the axis (0, 0, 1) through (0, 1, 0)"; in 2D about a
/// point.
std::string to_text(const FreeMotion& motion, int dim);

/// Returns a point or vector, e.g. "(0, 1.5)". Components below round-off, relative to `scale`, are set to zero.
std::string to_text(const mesh::Vector& x, int dim, Real scale);

}  // namespace sprekk::contact
