// One point of a joint, driven along a path without a mesh.
#pragma once

#include "model/scene.hpp"

#include <iosfwd>

namespace sprekk::model {

/// What drives the point. For every component either the jump w or the traction lambda is prescribed, or the joint
/// stands in a column of rock of stiffness k whose end is displaced by d: lambda = k (d - w). With an initial traction
/// lambda_0, under which the joint has the jump w_0, jumps count from there: w_0 + path, lambda = lambda_0 + k (d - (w -
/// w_0)). So a path of 0 is a test at constant normal stiffness (column) or constant volume (jump).
struct PointPath {
  std::string material;                                 ///< a joint
  std::vector<std::string> control;                     ///< per component n, t[, t2]: "jump", "traction" or "column"
  std::vector<base::Expression> path;                   ///< per component w, lambda or d as a function of t; m or Pa
  Real normal_stiffness = 0, tangential_stiffness = 0;  ///< k of a column, Pa/m
  std::vector<Real> plastic_jump;                       ///< at the start, tangential; default 0
  std::vector<Real> initial_traction;                   ///< lambda_0, Pa; default 0
  void describe(base::Section& section);
};

struct PointScene {
  std::map<std::string, Material> materials;
  base::Tables tables;
  base::Expression::Named expressions;  ///< that others call by name
  Time time;
  PointPath point;
  void describe(base::Section& section);
};

PointScene read_point_scene(const Comm& comm, const std::string& path, const std::vector<std::string>& overrides = {});

/// The state of the point at the end of a step.
struct PointState {
  Real t;
  laws::ContactState contact;
  std::vector<Real> jump, elastic, plastic, traction;  ///< n, t[, t2]
  std::string remark = {};                             ///< what is doubtful about the step, for a user; or empty
};

/// Implicit Euler along the path, one state per step. Throws an Error, with the prescribed values and the reason, where
/// these determine no state: a jump that a rigid joint cannot have, a shear traction above the friction bound. A step
/// in which the bound falls faster with slip than what shears the joint unloads has a remark: slip jumped in it.
std::vector<PointState> drive_point(const PointScene& scene);

/// Writes the states as CSV: t, contact state (0 open, 1 stick, 2 slip), then jump, elastic jump, plastic jump and
/// traction by component, with 17 digits.
void write_csv(std::ostream& out, const std::vector<PointState>& states);

}  // namespace sprekk::model
