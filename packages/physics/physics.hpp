// Interface of a physics: its scene entries, its modules, and the data it shares with other physics.
#pragma once

#include "assembly/module.hpp"
#include "base/expression.hpp"
#include "base/parameters.hpp"
#include "estimate/mesh_error.hpp"
#include "mesh/mesh.hpp"
#include "transport/carried.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace sprekk::assembly {
class System;
}

namespace sprekk::physics {

struct Material;
struct Region;
struct BoundaryCondition;
struct Scene;
class Comparison;

using Modules = std::vector<std::unique_ptr<assembly::Module>>;

/// Data from which modules are created.
struct Setting {
  const Scene& scene;
  const mesh::Mesh& mesh;
  Real start;  ///< time of the initial state, s
};

/// Returns the text of a warning about valid but implausible input: location, value, reason and advice.
inline std::string implausible(const std::string& where, const std::string& what, const std::string& why,
                               const std::string& advice) {
  return where + ": " + what + ": " + why + "; " + advice;
}

/// Values that a condition prescribes for a field, one per component. The text "free" leaves a component free.
struct Prescribed {
  std::string field;
  std::vector<base::Expression> values;
  std::vector<Real> lower_corner = {}, upper_corner = {};  ///< only nodes in this box; empty: all nodes
};

/// Quantity transported by the fluid of Flow.
struct CarriedQuantity : transport::Carried {
  /// Second-order transport (see transport::Antidiffusion): storage capacity, per unit of u, of local cells (per
  /// volume) and of the filling of local fracture faces.
  std::function<std::vector<Real>(const Setting&)> stored_in_cells = {}, stored_in_fractures = {};
};

/// Base class of each physics, with defaults for all members. A physics is a folder of packages/physics and a line in
/// list.hpp. It hides the members that it needs:
///
/// - Parts of existing sections: Rock and Joint (of a material), Bulk, Region, Fracture, BoundaryCondition and Probe.
///   Their members become members of physics::Material and so on. `Sections` contains the sections of the physics;
///   its members become members of physics::Scene. describe() declares the entries. check() compares the entries after
///   the whole section has been read.
/// - Functions. They are called for each physics in the order of the list.
template <class Self>
struct Physics {
  template <int>
  struct Part {
    void describe(base::Section&) {}
    void check(base::Section&) const {}
    bool is_given() const { return false; }                    ///< regions, boundary conditions: an entry is given
    std::vector<Prescribed> prescribed() const { return {}; }  ///< the same: fields with prescribed unknowns
  };
  using Rock = Part<0>;
  using Joint = Part<1>;
  using Bulk = Part<2>;
  using Region = Part<3>;
  using Fracture = Part<4>;
  struct BoundaryCondition : Part<5> {
    static constexpr const char* kinds = "";  ///< for error messages: `"pressure" or "flux"`
  };
  struct Probe : Part<7> {
    static constexpr const char* kinds = "";
    std::vector<std::string> totals() const { return {}; }  ///< first names of the assembly::Totals at this probe
  };
  struct Sections : Part<6> {
    void keep(const Sections&) {}  ///< copies from another scene the data that are not entries
  };

  /// Returns whether the scene uses this physics.
  static bool is_in(const Scene&) { return false; }
  /// Returns whether this physics has unknowns on facets.
  static bool needs_facets(const Scene&) { return false; }
  /// Returns whether this physics stores a quantity and therefore uses the time integration scheme.
  static bool has_rates(const Scene&) { return false; }
  /// Returns whether the scene defines the initial unknowns. Otherwise they have no meaning before the first step.
  static bool has_initial_state(const Scene&) { return true; }
  /// Names of the sections that require the time integration scheme.
  static std::vector<std::string> sections_with_rates() { return {}; }
  /// Name of the entry that requires implicit Euler as time integration scheme; empty: none.
  static std::string needs_implicit_euler(const Scene&) { return ""; }
  /// Reason why an error estimate is not available; empty: it is available.
  static std::string no_error_estimate(const Scene&) { return ""; }
  /// Quantities with an error estimate; their names are values of Functional::what.
  static std::vector<estimate::QuantityKind> quantities() { return {}; }
  /// Reason why a quantity has no error estimate, preceded by the location of the entry if there is one; empty: it has
  /// one.
  static std::string refuses(const Scene&, const estimate::Functional&) { return ""; }
  /// Creates the spatial error estimator; null: none. The result holds a reference to the system. Collective.
  static std::unique_ptr<estimate::MeshError> mesh_error(const Setting&, assembly::System&) { return nullptr; }
  /// Quantities that the fluid transports for this physics.
  static std::vector<CarriedQuantity> carried(const Scene&) { return {}; }
  /// Facet field whose fracture balance receives the power dissipated by sliding; empty: none.
  static std::string takes_friction_power(const Scene&) { return ""; }
  /// Names of entries that must not change when the scene of a live model changes. The state is measured relative to
  /// these entries, or would have another meaning with other values.
  static std::vector<std::string> fixed_entries() { return {}; }
  /// Further reasons why a live model cannot adopt a changed scene, beyond fixed_entries(), one per line.
  static std::vector<std::string> refuses_change(const Scene& before, const Scene& after) { return {}; }
  /// Further reasons that depend on the mesh of the changed scene. Collective.
  static std::vector<std::string> refuses_change_in(const mesh::Mesh&, const Scene& before, const Scene& after) {
    return {};
  }
  /// Copies data that are not entries into the scene with which a live model continues. Collective.
  static void prepare_change(const mesh::Mesh& whole, const Scene& before, Scene& after) {}
  /// Reports inconsistencies of the scene.
  static void compare(Comparison&) {}
  /// Reports inconsistencies of conditions on a mesh that has all of their names. Not collective.
  static void compare_mesh(Comparison&, const mesh::GlobalMesh&) {}
  /// Appends the modules of this physics. Collective.
  static void add_modules(const Setting&, Modules&) {}
  /// Returns possible errors of a scene with a mesh, one per line. Collective.
  static std::vector<std::string> warnings(const Setting&) { return {}; }
  /// Returns warnings about implausible input, one per line; see implausible(). `times`: end times of all steps.
  /// Collective.
  static std::vector<std::string> plausibility(const Setting&, const std::vector<Real>& times) { return {}; }
  /// Returns warnings about the state at the end of a step, given its outputs. The text is the same in each step.
  /// `times`: start time and end times of the steps so far, s. Collective.
  static std::vector<std::string> warnings_of_state(const Setting&, const std::vector<Real>& times,
                                                    const std::vector<assembly::OutputField>&) {
    return {};
  }
  /// Returns reasons why a solution may not exist or may not be unique. `oscillates`: contact states of faces alternate
  /// between iterates of Newton's method. Collective.
  static std::vector<std::string> doubts(const Setting&, bool oscillates) { return {}; }
};

}  // namespace sprekk::physics
