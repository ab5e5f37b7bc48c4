// The entries of a material that say how a joint deforms, slides and closes.
#pragma once

#include "base/expression.hpp"
#include "base/parameters.hpp"

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::laws {
struct HydraulicAperture;
}

namespace sprekk::physics {

struct JointParameters;  // every scene includes this, and is not compiled again for a new law of joints

/// A joint's laws by their names, with the values of their entries; see laws/joint_kinds.hpp. Every number may be an
/// expression of x, y, z.
struct JointMaterial {
  using Value = base::Expression;
  using Point = std::array<Real, 3>;

  /// Kinds; at first the first ones of their lists.
  std::string tangential_elasticity, friction, dilation, closure, bond, damage, damage_driver, hydraulic_aperture;

  std::optional<Value> tangential_stiffness, friction_coefficient, friction_angle, dilation_angle, maximum_closure,
      normal_stiffness;
  std::map<std::string, std::optional<Value>> more;  ///< of all other entries of kinds, by their names
  Value initial_gap = 0, initial_aperture = 0;
  Real strength_reduction = 1;  ///< F: friction and bond bear 1/F of what they would

  JointMaterial();
  std::optional<Value>& entry(const std::string& name);  ///< of a kind, e.g. "friction angle"
  const std::optional<Value>& entry(const std::string& name) const;

  /// The entries of the kinds that are named; of all kinds, where it is not known yet which the material has.
  void describe(base::Section& section, bool of_all_kinds);
  /// Reports what entries tell together, after the last entry of a section without errors.
  void compare_entries(base::Section& section) const;
  /// What is missing for a joint of rock that deforms, as pairs (entry, what is wrong), the entry empty if there are
  /// several that would do; or for the laws of one role alone.
  std::vector<std::array<std::string, 2>> missing(const std::string& role = "") const;
  /// The laws that it cannot have in 3D, as pairs (entry, what is wrong).
  std::vector<std::array<std::string, 2>> only_in_2d() const;
  bool is_uniform() const;  ///< no value depends on the place
  /// The laws at a point. Throws an Error that names the entry, the value and the point where a value is out of range.
  JointParameters joint(const Point& x) const;
  void check(const Point& x) const;  ///< throws the same
  /// The hydraulic aperture by the mechanical one at a point. Throws the same.
  laws::HydraulicAperture walls(const Point& x) const;

  /// How much faster than the compression the bound on the shear traction rises, by the law's derivative.
  struct Slope {
    Real largest;   ///< for compressions between two
    bool constant;  ///< the same for all of them
    Real up_to;     ///< the largest of these compressions at which it exceeds 1, Pa; 0: none
  };
  /// Nothing if friction is not complete or depends on the place.
  std::optional<Slope> friction_slope(Real least_compression, Real largest_compression) const;
};

}  // namespace sprekk::physics
