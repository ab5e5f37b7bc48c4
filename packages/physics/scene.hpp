// Scene data of all physics. Each section consists of one part per physics.
#pragma once

#include "base/check.hpp"
#include "base/table.hpp"
#include "fields/properties.hpp"
#include "mesh/facets.hpp"
#include "physics/list.hpp"

#include <concepts>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::physics {

namespace detail {

template <class... P>
struct Materials : P::Rock..., P::Joint... {
 protected:
  void describe_rock(base::Section& s) { (P::Rock::describe(s), ...); }
  void describe_joint(base::Section& s) { (P::Joint::describe(s), ...); }
  void check_rock(base::Section& s) const { (P::Rock::check(s), ...); }
  void check_joint(base::Section& s) const { (P::Joint::check(s), ...); }
};

/// Parts of a section, one of each physics.
template <class... Part>
struct Parts : Part... {
  /// Concatenates the prescribed fields of all parts.
  std::vector<Prescribed> prescribed() const {
    std::vector<Prescribed> all;
    const auto add = [&](const auto& some) { all.insert(all.end(), some.begin(), some.end()); };
    (add(Part::prescribed()), ...);
    return all;
  }

 protected:
  void describe_parts(base::Section& s) { (Part::describe(s), ...); }
  void check_parts(base::Section& s) const { (Part::check(s), ...); }
  bool is_any_given() const { return (Part::is_given() || ...); }
};

template <class... P>
using Bulks = Parts<typename P::Bulk...>;
template <class... P>
using Regions = Parts<typename P::Region...>;
template <class... P>
using Fractures = Parts<typename P::Fracture...>;

template <class... P>
struct BoundaryConditions : Parts<typename P::BoundaryCondition...> {
 protected:
  static std::vector<std::string> kinds() { return {P::BoundaryCondition::kinds...}; }
};

template <class... P>
struct Probes : Parts<typename P::Probe...> {
  /// Concatenates the totals of all parts.
  std::vector<std::string> totals() const {
    std::vector<std::string> names;
    const auto add = [&](const auto& some) { names.insert(names.end(), some.begin(), some.end()); };
    (add(P::Probe::totals()), ...);
    return names;
  }

 protected:
  static std::vector<std::string> kinds() { return {P::Probe::kinds...}; }
};

template <class... P>
struct Sections : P::Sections... {
 protected:
  void describe_parts(base::Section& s) { (P::Sections::describe(s), ...); }
  template <class Other>
  void keep_parts(const Other& other) {
    (P::Sections::keep(other), ...);
  }
};

template <class... P>
struct Each {
  static_assert((has_complete_groups<P>() && ...));
  template <class Call>
  static void call(const Call& call) {
    static_assert((std::invocable<const Call&, P> || ...), "no physics accepts this call");
    const auto call_if_accepted = [&](auto physics) {
      if constexpr (std::invocable<const Call&, decltype(physics)>) call(physics);
    };
    (call_if_accepted(P()), ...);
  }
};

}  // namespace detail

/// Calls call(P()) for each physics P that `call` accepts, for example `[&]<HasRates P>(P) { ... }`. Does not compile
/// if a group of a physics lacks a function or has one with a wrong signature.
template <class Call>
void for_each_physics(const Call& call) {
  OfAll<detail::Each>::call(call);
}

/// Properties of a rock or of a joint (fracture).
struct Material : OfAll<detail::Materials> {
  std::string type;                   ///< "elastic" or "joint"
  std::optional<std::string> source;  ///< reference for the values
  void describe(base::Section& section);
};

/// Properties of the whole rock.
struct Bulk : OfAll<detail::Bulks> {
  std::string material;       ///< default material of regions
  std::vector<Real> gravity;  ///< m/s^2; body force: density times gravity
  void describe(base::Section& section);
};

/// Properties of a region. They replace those of Bulk.
struct Region : OfAll<detail::Regions> {
  std::optional<std::string> material;
  bool excavated = false;  ///< cells are removed; the walls form a boundary with the name of the region
  void describe(base::Section& section);
};

struct Fracture : OfAll<detail::Fractures> {
  std::string material;
  void describe(base::Section& section);
};

struct BoundaryCondition : OfAll<detail::BoundaryConditions> {
  std::string boundary;
  std::optional<std::string> region;    ///< restricts the condition to faces of this region
  std::optional<std::string> fracture;  ///< restricts the condition to the ends of this fracture
  void describe(base::Section& section);
};

/// Location and outputs that a run records in each step.
struct Probe : OfAll<detail::Probes> {
  std::vector<std::string> outputs;  ///< names of outputs
  std::vector<Real> point, line;     ///< coordinates of the point, or of both ends of the line
  int points = 11;                   ///< number of points on the line, including both ends
  std::optional<std::string> boundary, region, fracture;
  std::string value = "mean";  ///< over boundary, region or fracture: "mean", "maximum", "minimum", "integral"
  bool is_extended() const { return boundary || region || fracture; }
  void describe(base::Section& section);
};

struct Scene : OfAll<detail::Sections> {
  std::string origin = "scene";  ///< prefix of messages about the scene: the file name
  base::Tables tables;
  base::Expression::Named expressions;  ///< callable by name
  std::map<std::string, Material> materials;
  Bulk bulk;
  std::map<std::string, Region> regions;
  std::optional<std::string> default_joint;  ///< default material of fractures
  std::map<std::string, Fracture> fractures;
  std::map<int, Material> own_joints;  ///< [single fracture] with individual properties; see own_joints()
  std::map<std::string, BoundaryCondition> boundary_conditions;
  std::map<std::string, Probe> probes;
  bool is_continued = false;  ///< not an entry: the scene changes a live model, which began with another one

  /// Declares tables and named expressions, which all later entries may call.
  void describe_expressions(base::Section& section);
  /// Declares all other sections. Adds the library materials that the scene names.
  void describe_physics(base::Section& section);
  /// Copies from another scene the data that are not entries.
  void keep(const Scene& other) {
    is_continued = other.is_continued;
    keep_parts(other);
  }
  const Material& material_of(const std::string& region) const;
  std::vector<std::string> excavated() const;  ///< names of the excavated regions
};

/// Materials of the single fractures with individual mesh properties. The base is the material of the fracture set, or
/// the one named by the property "material"; the other properties replace its entries. Ignores properties that are not
/// joint entries. Throws an Error that lists all invalid or misspelt entries.
std::map<int, Material> own_joints(const Scene& scene, const mesh::Mesh& mesh);
/// Individual joint entries of a single fracture: its base `material` and the entries that differ from that material,
/// formatted as in effective_input.xml. Empty for other fractures.
std::map<std::string, std::string> own_entries(const Scene& scene, const mesh::Mesh& mesh, int single);
/// Message with the names of ignored properties; empty: none.
std::vector<std::string> properties_passed_over(const Scene& scene, const mesh::Mesh& mesh);
/// Material of a single fracture.
const Material& joint_of(const Scene& scene, const mesh::Mesh& mesh, int single);
/// Location of a material in the scene: "SCENE: Sprekk > Materials > NAME".
std::string place_of(const Scene& scene, const Material& material);

/// Returns find(). Adds the location of the material in the scene to its errors.
template <class Find>
auto at_place(const Scene& scene, const Material& material, const Find& find) {
  try {
    return find();
  } catch (const Error& error) {
    throw Error(place_of(scene, material) + ": " + error.what());
  }
}

/// Properties of(material, x) of local cells at their centres; one value per region where uniform(material).
template <class Uniform, class Of>
auto by_cell(const Scene& scene, const mesh::Mesh& mesh, const Uniform& uniform, const Of& of) {
  const auto material = [&](int region) -> const Material& { return scene.material_of(mesh.region_names[region]); };
  return fields::properties<decltype(of(material(0), mesh::Vector()))>(
      static_cast<int>(mesh.region_names.size()), mesh.cell_region,
      [&](int region) { return uniform(material(region)); },
      [&](int region, int cell) {
        const auto x = cell < 0 ? mesh::Vector{} : mesh::cell_centre(mesh, cell);
        return at_place(scene, material(region), [&] { return of(material(region), x); });
      });
}

}  // namespace sprekk::physics
