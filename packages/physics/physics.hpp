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
namespace sprekk::estimate {
class TableOfStates;
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
  std::string section = "";                                ///< of fractures: section within that of the fracture
};

/// Facets (see mesh::Facets) with unknowns: none, those of fractures, all.
enum class Facets { none, of_fractures, all };

/// Quantity transported by the fluid of Flow.
struct CarriedQuantity : transport::Carried {
  /// Second-order transport (see transport::Antidiffusion): storage capacity, per unit of u, of local cells (per
  /// volume) and of the filling of local fracture faces.
  std::function<std::vector<Real>(const Setting&)> stored_in_cells = {}, stored_in_fractures = {};
};

/// Groups of optional functions. A physics offers a group by a nested struct, for example `Rates`, that defines all
/// functions of the group as static functions. RatesFunctions lists their signatures, IsRates compares a struct with
/// them, and HasRates is true for a physics with this struct.

/// Rates: storage of quantities, which uses the time integration scheme.
struct RatesFunctions {
  /// The scene has such quantities
  bool (*exist)(const Scene&);
  /// Names of the sections that require the scheme
  std::vector<std::string> (*sections)();
  /// Name of the entry that requires implicit Euler as scheme; empty: none
  std::string (*implicit_euler)(const Scene&);
};
template <class Group>
concept IsRates = requires {
  RatesFunctions{&Group::exist, &Group::sections, &Group::implicit_euler};
};
template <class P>
concept HasRates = requires {
  typename P::Rates;
};

/// Transport: transport by the fluid of Flow, and sources of the transported quantity.
struct TransportFunctions {
  /// Transported quantities
  std::vector<CarriedQuantity> (*carried)(const Scene&);
  /// Facet field whose fracture balance receives the power dissipated by sliding; empty: none
  std::string (*friction_power)(const Scene&);
};
template <class Group>
concept IsTransport = requires {
  TransportFunctions{&Group::carried, &Group::friction_power};
};
template <class P>
concept HasTransport = requires {
  typename P::Transport;
};

/// Estimate: error estimates of unknowns and of quantities.
struct EstimateFunctions {
  /// Reason why the estimate is not available; empty: it is available
  std::string (*missing)(const Scene&);
  /// Quantities with an estimate; their names are values of Functional::what
  std::vector<estimate::QuantityKind> (*quantities)();
  /// Reason why a quantity has no estimate, preceded by the location of the entry if there is one; empty: it has one
  std::string (*refuses)(const Scene&, const estimate::Functional&);
  /// Spatial error estimator, which holds a reference to the system; null: none. Collective.
  std::unique_ptr<estimate::MeshError> (*mesh_error)(const Setting&, assembly::System&);
};
template <class Group>
concept IsEstimate = requires {
  EstimateFunctions{&Group::missing, &Group::quantities, &Group::refuses, &Group::mesh_error};
};
template <class P>
concept HasEstimate = requires {
  typename P::Estimate;
};

/// Change: change of the scene of a live model, beyond fixed_entries(). Reasons against it are one per line.
struct ChangeFunctions {
  /// Reasons that follow from the scenes alone
  std::vector<std::string> (*refuses)(const Scene& before, const Scene& after);
  /// Reasons that depend on the mesh of the changed scene. Collective.
  std::vector<std::string> (*refuses_in)(const mesh::Mesh&, const Scene& before, const Scene& after);
  /// Copies data that are not entries; `whole`: mesh with excavated regions. Collective.
  void (*prepare)(const mesh::Mesh& whole, const Scene& before, Scene& after);
};
template <class Group>
concept IsChange = requires {
  ChangeFunctions{&Group::refuses, &Group::refuses_in, &Group::prepare};
};
template <class P>
concept HasChange = requires {
  typename P::Change;
};

/// Warnings: implausible input and states, one warning per line; see implausible(). Collective.
struct WarningsFunctions {
  /// Input of a scene. `times`: end times of all steps, s
  std::vector<std::string> (*of_input)(const Setting&, const std::vector<Real>& times);
  /// State at the end of a step, with the same text in each step. `times`: start time and end times of the steps so
  /// far, s
  std::vector<std::string> (*of_state)(const Setting&, const std::vector<Real>& times,
                                       const std::vector<assembly::OutputField>& outputs);
};
template <class Group>
concept IsWarnings = requires {
  WarningsFunctions{&Group::of_input, &Group::of_state};
};
template <class P>
concept HasWarnings = requires {
  typename P::Warnings;
};

/// Log: columns of the table of steps in the log of a run. Each is the largest value of a result over the members of a
/// section of a step in results.json, for example `max_slip` over `fractures`.
struct LogColumn {
  std::string title, section, result;
};
struct LogFunctions {
  std::vector<LogColumn> (*columns)(const Setting&);
};
template <class Group>
concept IsLog = requires {
  LogFunctions{&Group::columns};
};
template <class P>
concept HasLog = requires {
  typename P::Log;
};

/// Tables: table of quantities at points of fractures, see estimate::StateTable.
struct TablesFunctions {
  /// Name of the entry in results.json and of the CSV file; spaces become underscores
  std::string (*name)();
  /// Table that the scene requests, which refers to the setting and the system; null: none. Collective.
  std::unique_ptr<estimate::TableOfStates> (*table)(const Setting&, assembly::System&);
};
template <class Group>
concept IsTables = requires {
  TablesFunctions{&Group::name, &Group::table};
};
template <class P>
concept HasTables = requires {
  typename P::Tables;
};

/// Solvability: existence and uniqueness of solutions.
struct SolvabilityFunctions {
  /// Reasons against them. `oscillates`: contact states of faces alternate between iterates of Newton's method.
  /// Collective.
  std::vector<std::string> (*doubts)(const Setting&, bool oscillates);
};
template <class Group>
concept IsSolvability = requires {
  SolvabilityFunctions{&Group::doubts};
};
template <class P>
concept HasSolvability = requires {
  typename P::Solvability;
};

/// Outputs from which a catalogue of events is computed, see model/event_catalogue.hpp. The fracture faces have a
/// vector in their frame that changes during an event, the conjugate force, and a density whose integral has
/// assembly::Events.
struct EventSource {
  std::string path, force, density;  ///< names of outputs; the components along the face count
  std::string drop, drop_unit;       ///< name of the decrease of the force along the path
};
struct EventsFunctions {
  EventSource (*source)();
};
template <class Group>
concept IsEvents = requires {
  EventsFunctions{&Group::source};
};
template <class P>
concept HasEvents = requires {
  typename P::Events;
};

/// Compiles only if each group of a physics has all of its functions, with these signatures.
template <class P>
constexpr bool has_complete_groups() {
  if constexpr (HasRates<P>) static_assert(IsRates<typename P::Rates>);
  if constexpr (HasTransport<P>) static_assert(IsTransport<typename P::Transport>);
  if constexpr (HasEstimate<P>) static_assert(IsEstimate<typename P::Estimate>);
  if constexpr (HasChange<P>) static_assert(IsChange<typename P::Change>);
  if constexpr (HasWarnings<P>) static_assert(IsWarnings<typename P::Warnings>);
  if constexpr (HasLog<P>) static_assert(IsLog<typename P::Log>);
  if constexpr (HasEvents<P>) static_assert(IsEvents<typename P::Events>);
  if constexpr (HasTables<P>) static_assert(IsTables<typename P::Tables>);
  if constexpr (HasSolvability<P>) static_assert(IsSolvability<typename P::Solvability>);
  return true;
}

/// Base class of each physics, with defaults for all members except groups. A physics is a folder of packages/physics
/// and a line in list.hpp. It hides the members that it needs:
///
/// - Parts of existing sections: Rock and Joint (of a material), Bulk, Region, Fracture, BoundaryCondition and Probe.
///   Their members become members of physics::Material and so on. `Sections` contains the sections of the physics;
///   its members become members of physics::Scene. describe() declares the entries. check() compares the entries after
///   the whole section has been read.
/// - Functions, and groups of functions (see above). They are called for each physics in the order of the list.
template <class Self>
struct Physics {
  template <int>
  struct Part {
    void describe(base::Section&) {}
    void check(base::Section&) const {}
    bool is_given() const { return false; }  ///< regions, boundary conditions: an entry is given
    /// The same, and fractures, with a box for each field: fields with prescribed unknowns.
    std::vector<Prescribed> prescribed() const { return {}; }
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
  /// Returns the facets on which this physics has unknowns.
  static Facets needs_facets(const Scene&) { return Facets::none; }
  /// Returns whether the scene defines the initial unknowns. Otherwise they have no meaning before the first step.
  static bool has_initial_state(const Scene&) { return true; }
  /// Names of entries that must not change when the scene of a live model changes. The state is measured relative to
  /// these entries, or would have another meaning with other values.
  static std::vector<std::string> fixed_entries() { return {}; }
  /// Reports inconsistencies of the scene.
  static void compare(Comparison&) {}
  /// Reports inconsistencies of conditions on a mesh that has all of their names. Not collective.
  static void compare_mesh(Comparison&, const mesh::GlobalMesh&) {}
  /// Appends the modules of this physics. Collective.
  static void add_modules(const Setting&, Modules&) {}
  /// Returns possible errors of a scene with a mesh, one per line. Collective.
  static std::vector<std::string> warnings(const Setting&) { return {}; }
};

}  // namespace sprekk::physics
