// Material entries for the deformation, slip and closure of a joint.
#pragma once

#include "base/expression.hpp"
#include "base/parameters.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::laws {

// declared only: a new law does not recompile all users of scenes
struct HydraulicAperture;
struct JointParameters;

/// Names of the joint laws with the values of their entries, see laws/joint_kinds.hpp. Every value may be an expression
/// of x, y, z.
struct JointMaterial {
  using Value = base::Expression;
  using Point = std::array<Real, 3>;

  /// Names of the laws. Default: the first law of each list.
  std::string tangential_elasticity, friction, dilation, closure, bond, damage, damage_driver, hydraulic_aperture;

  std::optional<Value> tangential_stiffness, friction_coefficient, friction_angle, dilation_angle, maximum_closure,
      normal_stiffness;
  std::map<std::string, std::optional<Value>> more;  ///< [name] all other entries of laws
  Value initial_gap = 0, initial_aperture = 0;
  std::string reference_state = "unloaded";  ///< state with the initial aperture, see is_in_situ()
  Real strength_reduction = 1;               ///< F: divides the friction bound and the bond strength

  JointMaterial();
  std::optional<Value>& entry(const std::string& name);  ///< entry of a law, e.g. "friction angle"
  const std::optional<Value>& entry(const std::string& name) const;

  /// Declares the entries of the selected laws, or of all laws if the selection is not known yet.
  void describe(base::Section& section, bool of_all_kinds);
  /// Reports inconsistent entries. Called after the last entry of a section without errors.
  void compare_entries(base::Section& section) const;
  /// Missing entries of a joint of deformable rock, as pairs (entry, message). The entry is empty if one of several
  /// would suffice. `role`: restricts the result to one law, e.g. "friction".
  std::vector<std::array<std::string, 2>> missing(const std::string& role = "") const;
  /// Laws that are not available in 3D, as pairs (entry, message).
  std::vector<std::array<std::string, 2>> only_in_2d() const;
  bool is_uniform() const;       ///< no value depends on the position
  bool depends_on_rate() const;  ///< friction depends on the slip rate; false if friction is incomplete
  /// Laws at a point. Throws an Error with entry, value and point if a value is out of range. For a joint in situ the
  /// aperture is that under the initial traction, see laws::unloaded().
  JointParameters joint(const Point& x) const;
  bool is_in_situ() const { return reference_state != "unloaded"; }
  Real aperture(const Point& x) const;  ///< mechanical aperture of the reference state, m; throws the same errors
  void check(const Point& x) const;     ///< throws the same errors
  /// Hydraulic aperture as a function of the mechanical aperture, at a point. Throws the same errors.
  HydraulicAperture walls(const Point& x) const;

  /// Slope of the shear bound as a function of the compression, from the derivative of the law.
  struct Slope {
    Real largest;   ///< largest slope between two compressions
    bool constant;  ///< the slope is constant between them
    Real up_to;     ///< largest of these compressions with a slope above 1, Pa; 0: none
  };
  /// Slope of the friction bound; none if friction is incomplete or depends on the position.
  std::optional<Slope> friction_slope(Real min_compression, Real largest_compression) const;
};

}  // namespace sprekk::laws
