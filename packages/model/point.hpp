// One point of a joint, driven along a path without a mesh.
#pragma once

#include "laws/contact.hpp"
#include "model/scene.hpp"

#include <iosfwd>

namespace sprekk::model {

/// What drives the point. For every component either the jump w or the traction lambda is prescribed, or the joint
/// stands in a column of rock of stiffness k whose end is displaced by d: lambda = k (d - w). With an initial traction
/// lambda_0, under which the joint has the jump w_0, jumps count from there: w_0 + path, lambda = lambda_0 + k (d - (w
/// - w_0)). So a path of 0 is a test at constant normal stiffness (column) or constant volume (jump).
struct PointPath {
  std::string material;                                 ///< a joint
  std::vector<std::string> control;                     ///< per component n, t[, t2]: "jump", "traction" or "column"
  std::vector<base::Expression> path;                   ///< per component w, lambda or d as a function of t; m or Pa
  Real normal_stiffness = 0, tangential_stiffness = 0;  ///< k of a column, Pa/m
  std::vector<Real> plastic_jump;                       ///< at the start, tangential; default 0
  std::vector<Real> initial_traction;                   ///< lambda_0, Pa; default 0
  void describe(base::Section& section);
};

/// One point, or several specimens that share the time steps.
struct PointScene {
  std::map<std::string, Material> materials;
  base::Tables tables;
  base::Expression::Named expressions;  ///< that others call by name
  Time time;
  PointPath point;
  std::map<std::string, PointPath> specimens;  ///< by name; empty: `point`
  std::string file;                            ///< for messages
  void describe(base::Section& section);
  /// Where each path is in the scene, `Specimens > NAME` or `Point`, with it.
  std::vector<std::pair<std::string, const PointPath*>> paths() const;

 private:
  void check_material(base::Section& section, const std::string& place, const PointPath& path);
};

PointScene read_point_scene(const Comm& comm, const std::string& path, const std::vector<std::string>& overrides = {});
/// The same of entries as a file would have them; `origin` opens messages. Not collective.
PointScene point_scene_of(Teuchos::ParameterList entries, const std::string& origin,
                          const std::vector<std::string>& overrides = {});

/// A state of the point: at the start, at the end of a step, or before and after slip that jumps in a step.
struct PointState {
  Real t = 0;
  laws::ContactState contact = laws::ContactState::open;
  std::vector<Real> jump = {}, elastic = {}, plastic = {}, traction = {};  ///< n, t[, t2]
  Real strength = 0;        ///< the bound on |lambda_t| under this normal traction, after this slip, Pa
  std::string remark = {};  ///< how slip jumped, for a user; or empty
  bool slip_jumps = false;  ///< since the state before
};

/// The states along a path. Those before a step that has none are kept.
struct PointCurve {
  PointState initial = {};
  std::vector<PointState> states = {};
  std::string failure = {};   ///< file, place, step and reason, if not all steps have a state
  std::string specimen = {};  ///< its name, if the scene has several
};

/// Implicit Euler along the path, one state per step. There is none where the prescribed values determine no state: a
/// jump that a rigid joint cannot have, a shear traction above the friction bound. Where the bound falls faster with
/// slip than what shears the joint unloads, slip jumps: the step is cut there, and has states just before and after the
/// jump.
std::vector<PointCurve> drive_points(const PointScene& scene);

/// The states at the ends of the steps, and at jumps, of the one point of a scene. Throws an Error where a step has
/// none.
std::vector<PointState> drive_point(const PointScene& scene);

/// Writes the initial states and all others as CSV: the specimen, if there are several; t, contact state (0 open, 1
/// stick, 2 slip), then jump, elastic jump, plastic jump and traction by component, and the strength, with 17 digits.
void write_csv(std::ostream& out, const std::vector<PointCurve>& curves);

}  // namespace sprekk::model
