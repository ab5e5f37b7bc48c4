// Fronts of fractures in the rock: their points, frames and surroundings.
#pragma once

#include "mesh/facets.hpp"
#include "mesh/matrix.hpp"

#include <array>
#include <functional>
#include <vector>

namespace sprekk::mesh {

/// Node where a fracture ends in the rock: a tip in 2D, a point of a front in 3D. The front is replaced by the circle
/// through the node and its neighbours on the front, or by a straight line.
struct FrontPoint {
  GlobalIndex node;
  int single;                                     ///< single fracture
  Vector x, ahead, normal, along;                 ///< position, m, and frame; the normal is that of the faces
  Real curvature = 0;                             ///< of the front, 1/m; positive if the crack lies inside
  Real size;                                      ///< largest distance of corners of the faces at the node, m
  Real radius = 0;                                ///< of the domain of integration, m; 0: there is none
  const char* nearest = "";                       ///< nearest of the obstacles, see find_fronts()
  Real length = 1;                                ///< integral of the weight along the front, m; 1 in 2D
  std::vector<std::array<Vector, 2>> edges = {};  ///< of the front near the point, in 3D
  std::array<Real, 3> rock;                       ///< constants of the cell on side minus

  /// Coordinates relative to the circle, and the frame of the nearest point of the circle.
  struct Local {
    Real x1, x2, curvature;  ///< curvature of the concentric circle through the point
    Vector ahead, along;
  };
  Local at(const Vector& point) const;
  /// Returns the weight w of the domain, 1 in its inner part and 0 from the distance `radius` on, and sets its
  /// gradient, 1/m.
  Real weight(const Vector& point, Vector& gradient) const;
  /// Returns the distance of a point behind the front from the edges of the mesh along the front. They are chords of
  /// the circle: the faces of the mesh begin at the chords.
  Real distance(const Vector& point) const;
};

/// Virtual advance of a front at a point.
struct Advance {
  FrontPoint::Local local;
  Vector q;   ///< weight w times the direction ahead
  Matrix dq;  ///< [k][j] derivative of q_k along j, 1/m
  Real weight;

  Advance(const FrontPoint& front, const Vector& x) : local(front.at(x)) {
    Vector g;
    weight = front.weight(x, g);
    q = weight * local.ahead;
    for (int k = 0; k < 3; ++k) dq[k] = local.ahead[k] * g + (weight * local.curvature * local.along[k]) * local.along;
  }
};

/// Constants of the rock in a local cell: a domain of integration contains cells of equal constants only.
using RockConstants = std::function<std::array<Real, 3>(LocalIndex cell)>;

/// Finds the points of the fronts of the fractures [fracture] with `requested`, ordered by node, equal on all ranks.
/// The radius is at most 0.9 of the distance to
///
/// - the boundary, without plane sides that the front meets at a right angle;
/// - another fracture, or faces of the same one that leave its plane at the point;
/// - another front, or a part of the same front that leaves the circle;
/// - cells with constants `rock` that differ by more than 2e-9 of their mean.
///
/// In 3D, it is also at most 10 sizes and half the radius of the circle. It is zero at corners of the front, and if it
/// would be less than 1.2 sizes. Collective.
std::vector<FrontPoint> find_fronts(const Mesh& mesh, const std::vector<char>& requested, const RockConstants& rock);

}  // namespace sprekk::mesh
