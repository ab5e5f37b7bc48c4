// What a physics states of itself: entries of a scene, modules, and what they need to know of each other.
#pragma once

#include "assembly/module.hpp"
#include "base/expression.hpp"
#include "base/parameters.hpp"
#include "mesh/mesh.hpp"
#include "physics/fluid_change.hpp"
#include "physics/mesh_error.hpp"

#include <functional>
#include <map>
#include <memory>
#include <optional>
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

/// What modules are made for.
struct Setting {
  const Scene& scene;
  const mesh::Mesh& mesh;
  Real start;  ///< time of the initial state, s
};

/// A warning of input that is allowed and yet hardly meant: where and what it is, why that is doubted, what to do.
inline std::string implausible(const std::string& where, const std::string& what, const std::string& why,
                               const std::string& advice) {
  return where + ": " + what + ": " + why + "; " + advice;
}

/// The values of a field that a condition prescribes, per component; the text "free" leaves one free.
struct Prescribed {
  std::string field;
  std::vector<base::Expression> values;
  std::vector<Real> lower_corner = {}, upper_corner = {};  ///< only at nodes in this box; empty: everywhere
};

/// What the fluid of Flow carries along: `capacity` times u in each volume of it at reference conditions.
struct Carried {
  std::string field;  ///< u on cells; on facets "face " before it
  Real capacity;
  std::string total, unit;                           ///< what results.json calls the rate at which wells bring it
  std::map<std::string, base::Expression> in_wells;  ///< u of what these put in, of t; others bring what is there
  std::optional<FluidChange> change = {};            ///< what it does to the fluid; of one physics at most
  /// Where it is carried with second order, see Antidiffusion: what cells store of it per volume and u, and what fills
  /// fracture faces, of local ones.
  std::function<std::vector<Real>(const Setting&)> stored_in_cells = {}, stored_in_fractures = {};
};

/// Base of each physics, of what it has nothing to say about. A physics is one room of packages/physics and a line in
/// list.hpp. It hides those of the following that it has:
///
/// - parts of sections that are there without it: Rock and Joint of a material, Bulk, Region, Fracture,
///   BoundaryCondition and Probe, whose members become members of physics::Material, ..., and Sections of its own,
///   whose members become members of physics::Scene. describe() describes their entries, check() compares them after
///   all of the section have been read;
/// - functions, which are called for each physics in the order of the list.
template <class Self>
struct Physics {
  template <int>
  struct Part {
    void describe(base::Section&) {}
    void check(base::Section&) const {}
    bool is_given() const { return false; }  ///< of a region or a boundary condition: it says something
    std::vector<Prescribed> prescribed() const { return {}; }  ///< of these: fields whose unknowns it holds
  };
  using Rock = Part<0>;
  using Joint = Part<1>;
  using Bulk = Part<2>;
  using Region = Part<3>;
  using Fracture = Part<4>;
  struct BoundaryCondition : Part<5> {
    static constexpr const char* kinds = "";  ///< for a message: `"pressure" or "flux"`
  };
  struct Probe : Part<7> {
    static constexpr const char* kinds = "";
    std::vector<std::string> totals() const { return {}; }  ///< the first names of the assembly::Totals that it shows
  };
  struct Sections : Part<6> {
    void keep(const Sections&) {}  ///< takes over from another scene what is no entry
  };

  /// Whether the scene has it.
  static bool is_in(const Scene&) { return false; }
  /// Whether it has unknowns on facets.
  static bool needs_facets(const Scene&) { return false; }
  /// Whether it has rates of what it stores, which the scheme in time is of.
  static bool has_rates(const Scene&) { return false; }
  /// Whether the scene says what its unknowns are at the start; else they mean nothing before the first step.
  static bool has_initial_state(const Scene&) { return true; }
  /// Names of the sections that bring such rates.
  static std::vector<std::string> sections_with_rates() { return {}; }
  /// The entry that asks for implicit Euler as the scheme in time; empty: any will do.
  static std::string needs_implicit_euler(const Scene&) { return ""; }
  /// Why there is no error estimate with it; empty if there is.
  static std::string no_error_estimate(const Scene&) { return ""; }
  /// What it can be asked for with an error, by Functional::what.
  static std::vector<QuantityKind> quantities() { return {}; }
  /// Why it cannot be asked for one of these, after the place of the entry if it has one; empty: it can.
  static std::string refuses(const Scene&, const Functional&) { return ""; }
  /// The error of its unknowns; null: it has none. Refers to the system. Collective.
  static std::unique_ptr<MeshError> mesh_error(const Setting&, assembly::System&) { return nullptr; }
  /// What the fluid carries for it.
  static std::vector<Carried> carried(const Scene&) { return {}; }
  /// The field on facets whose balance in fractures gets the power that their sliding dissipates; empty: none.
  static std::string takes_friction_power(const Scene&) { return ""; }
  /// Names of entries that stay what they are where the scene of a live model changes: its state is measured from what
  /// they say of the start, or would mean something else with other values.
  static std::vector<std::string> fixed_entries() { return {}; }
  /// Why a live model cannot follow a change of its scene, a line for each reason that fixed_entries() do not tell.
  static std::vector<std::string> refuses_change(const Scene& before, const Scene& after) { return {}; }
  /// The same on the mesh of the changed scene. Collective.
  static std::vector<std::string> refuses_change_in(const mesh::Mesh&, const Scene& before, const Scene& after) {
    return {};
  }
  /// Takes over from a scene into one that a live model goes on with what is no entry. Collective.
  static void prepare_change(const mesh::Mesh& whole, const Scene& before, Scene& after) {}
  /// Reports what does not fit together.
  static void compare(Comparison&) {}
  /// The same of conditions on a mesh that has all of their names; not collective.
  static void compare_mesh(Comparison&, const mesh::GlobalMesh&) {}
  /// Appends its modules. Collective.
  static void add_modules(const Setting&, Modules&) {}
  /// What may be wrong with a scene that has a mesh, a line each. Collective.
  static std::vector<std::string> warnings(const Setting&) { return {}; }
  /// What a scene may ask and hardly means, a line each, see implausible(); `times`: the ends of all steps. Collective.
  static std::vector<std::string> plausibility(const Setting&, const std::vector<Real>& times) { return {}; }
  /// What may be wrong with a state that a step has reached, whose outputs these are: the same text in each. `times`:
  /// the start and the ends of the steps until then, s. Collective.
  static std::vector<std::string> warnings_of_state(const Setting&, const std::vector<Real>& times,
                                                    const std::vector<assembly::OutputField>&) {
    return {};
  }
  /// Why there may be no solution, or more than one; `oscillates`: faces change their contact state from one iterate of
  /// Newton's method to the next. Collective.
  static std::vector<std::string> doubts(const Setting&, bool oscillates) { return {}; }
};

}  // namespace sprekk::physics
