// Single point of a joint, loaded along a path without a mesh.
#pragma once

#include "laws/contact.hpp"
#include "physics/scene.hpp"
#include "solve/time.hpp"

#include <iosfwd>

namespace sprekk::laboratory {

/// Loading of the point. Each component is controlled by the jump w, the traction lambda, or a column of rock of
/// stiffness k. The end of the column is displaced by d: lambda = k (d - w). With an initial traction lambda_0, jumps
/// are relative to its jump w_0. Then w = w_0 + path, and lambda = lambda_0 + k (d - (w - w_0)). A zero path is then a
/// test at constant normal stiffness (column) or constant volume (jump).
struct PointPath {
  std::string material;                                 ///< name of a joint material
  std::vector<std::string> control;                     ///< per component n, t[, t2]: "jump", "traction" or "column"
  std::vector<base::Expression> path;                   ///< per component w, lambda or d as a function of t; m or Pa
  Real normal_stiffness = 0, tangential_stiffness = 0;  ///< k of a column, Pa/m
  std::vector<Real> plastic_jump;                       ///< initial tangential plastic jump, m; default 0
  std::vector<Real> initial_traction;                   ///< lambda_0, Pa; default 0
  Real slip_path = 0;                                   ///< path length of the initial slip, m; of joints in situ
  void describe(base::Section& section);
  std::array<Real, 3> start_traction() const;  ///< lambda_0 or zero, Pa
  /// Joint of the material with the initial state of the path; if in situ, unloaded. Throws an Error if there is none.
  laws::JointParameters joint_of(const physics::Material& material) const;
};

/// One point, or several specimens with common time steps.
struct PointScene {
  std::map<std::string, physics::Material> materials;
  base::Tables tables;
  base::Expression::Named expressions;  ///< named expressions, for use in others
  solve::Time time;
  PointPath point;
  std::map<std::string, PointPath> specimens;  ///< by name; empty: `point`
  std::string file;                            ///< file name for messages
  void describe(base::Section& section);
  /// Returns each path with its place in the scene, `Specimens > NAME` or `Point`.
  std::vector<std::pair<std::string, const PointPath*>> paths() const;

 private:
  void check_material(base::Section& section, const std::string& place, const PointPath& path);
};

/// Reads a point scene from an XML file and applies overrides "Path.To.Entry=value". Throws one Error with a line for
/// each mistake. Collective.
PointScene read_point_scene(const Comm& comm, const std::string& path, const std::vector<std::string>& overrides = {});
/// Builds a point scene from entries like those of a file; `origin` is the prefix of messages. Not collective.
PointScene point_scene_of(Teuchos::ParameterList entries, const std::string& origin,
                          const std::vector<std::string>& overrides = {});

/// State of the point: at the start, at the end of a step, or before and after a slip jump in a step.
struct PointState {
  Real t = 0;
  laws::ContactState contact = laws::ContactState::open;
  std::vector<Real> jump = {}, elastic = {}, plastic = {}, traction = {};  ///< n, t[, t2]
  Real strength = 0;                  ///< bound of |lambda_t| for this normal traction and slip, Pa
  Real aperture = 0;                  ///< mechanical aperture (15), m
  std::vector<Real> quantities = {};  ///< of laws that depend on the slip rate, see PointCurve
  std::string remark = {};            ///< description of a slip jump for users, or empty
  bool slip_jumps = false;            ///< slip jumped since the previous state
  laws::StepDefect defect = {};       ///< error of the step by friction that depends on the slip rate
};

/// States along a path, up to the first step without a state.
struct PointCurve {
  PointState initial = {};
  std::vector<PointState> states = {};
  std::string failure = {};                  ///< file, place, step and reason, if a step has no state
  std::string specimen = {};                 ///< name of the specimen, if the scene has several
  std::vector<std::string> quantities = {};  ///< names of PointState::quantities
};

/// Integrates the path with implicit Euler, one state per step. With friction that depends on the slip rate, the order
/// is 2, and Time > tolerance selects the steps by the errors of slip rate and state. A step has no state if the
/// prescribed values admit none. Examples are a jump impossible for a rigid joint, and a shear traction above the
/// friction bound. If the bound decreases with slip faster than the loading system unloads, slip jumps. The step is
/// then divided and has states just before and after the jump.
std::vector<PointCurve> drive_points(const PointScene& scene);

/// Returns the states of a scene with one point, at the ends of steps and at jumps. Throws an Error if a step has no
/// state.
std::vector<PointState> drive_point(const PointScene& scene);

/// Writes all states as CSV with 17 digits. Columns: specimen (if several), t, contact state (0 open, 1 stick, 2 slip),
/// then jump, elastic jump, plastic jump and traction by component, strength, aperture, and the quantities of laws.
void write_csv(std::ostream& out, const std::vector<PointCurve>& curves);

}  // namespace sprekk::laboratory
