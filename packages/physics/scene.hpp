// What a scene says of physics: its sections are made of the parts that each physics has in them.
#pragma once

#include "base/check.hpp"
#include "base/table.hpp"
#include "mesh/facets.hpp"
#include "physics/list.hpp"
#include "physics/properties.hpp"

#include <algorithm>
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
  /// What all of them hold.
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
  /// Of the totals that one part shows.
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
  template <class Call>
  static void call(const Call& call) {
    (call(P()), ...);
  }
};

}  // namespace detail

/// Calls call(P()) for each physics P.
template <class Call>
void for_each_physics(const Call& call) {
  OfAll<detail::Each>::call(call);
}

/// Rock, or the surface of a fracture.
struct Material : OfAll<detail::Materials> {
  std::string type;                   ///< "elastic" or "joint"
  std::optional<std::string> source;  ///< where the values come from
  void describe(base::Section& section);
};

/// The rock as a whole.
struct Bulk : OfAll<detail::Bulks> {
  std::string material;       ///< of all regions that have none of their own
  std::vector<Real> gravity;  ///< m/s^2; its force is the density times this
  void describe(base::Section& section);
};

/// What a part of the rock has of its own, in place of what Bulk says.
struct Region : OfAll<detail::Regions> {
  std::optional<std::string> material;
  bool excavated = false;  ///< its cells are not there; its walls are a boundary of the same name
  void describe(base::Section& section);
};

struct Fracture : OfAll<detail::Fractures> {
  std::string material;
  void describe(base::Section& section);
};

struct BoundaryCondition : OfAll<detail::BoundaryConditions> {
  std::string boundary;
  std::optional<std::string> region;    ///< only where the boundary touches this region
  std::optional<std::string> fracture;  ///< only where this fracture ends on the boundary
  void describe(base::Section& section);
};

/// Where a run looks at what, in each step.
struct Probe : OfAll<detail::Probes> {
  std::vector<std::string> outputs;  ///< names of them
  std::vector<Real> point, line;     ///< coordinates; of the line's ends
  int points = 11;                   ///< of a line, its ends among them
  std::optional<std::string> boundary, region, fracture;
  std::string value = "mean";  ///< over a boundary, a region or a fracture: "mean", "maximum", "minimum", "integral"
  bool is_extended() const { return boundary || region || fracture; }
  void describe(base::Section& section);
};

struct Scene : OfAll<detail::Sections> {
  std::string origin = "scene";  ///< opens messages about it: the file that it was read from
  base::Tables tables;
  base::Expression::Named expressions;  ///< that others call by name
  std::map<std::string, Material> materials;
  Bulk bulk;
  std::map<std::string, Region> regions;
  std::optional<std::string> default_joint;  ///< the material of fractures that name none
  std::map<std::string, Fracture> fractures;
  std::map<int, Material> own_joints;  ///< [single fracture] of those with properties of their own; see own_joints()
  std::map<std::string, BoundaryCondition> boundary_conditions;
  std::map<std::string, Probe> probes;

  /// Tables and named expressions, which all later entries may call.
  void describe_expressions(base::Section& section);
  /// All others; adds materials of the library that are named.
  void describe_physics(base::Section& section);
  /// Takes over from another scene what is no entry.
  void keep(const Scene& other) { keep_parts(other); }
  const Material& material_of(const std::string& region) const;
  std::vector<std::string> excavated() const;  ///< regions that are
};

/// Materials of the single fractures of a mesh that have properties of their own: that of the set, or the one that
/// their property "material" names, with these entries in place. Properties that are no entries of a joint are passed
/// over. Error: an entry is wrong, or misspelt; all are told.
std::map<int, Material> own_joints(const Scene& scene, const mesh::Mesh& mesh);
/// Of the joint that a single fracture has of its own: `material`, the one that it is made of, and the entries that
/// differ from those of that, as effective_input.xml would have them. Empty of others.
std::map<std::string, std::string> own_entries(const Scene& scene, const mesh::Mesh& mesh, int single);
/// A line for the names of properties that were passed over, if there are any.
std::vector<std::string> properties_passed_over(const Scene& scene, const mesh::Mesh& mesh);
/// The material of a single fracture.
const Material& joint_of(const Scene& scene, const mesh::Mesh& mesh, int single);
/// "SCENE: Sprekk > Materials > NAME" of one of its materials.
std::string place_of(const Scene& scene, const Material& material);

/// What `find` finds of a material; its errors get the place of the material in the scene.
template <class Find>
auto at_place(const Scene& scene, const Material& material, const Find& find) {
  try {
    return find();
  } catch (const Error& error) {
    throw Error(place_of(scene, material) + ": " + error.what());
  }
}

/// What of(material, x) finds of local cells, at their centres; once for each region where uniform(material).
template <class Uniform, class Of>
auto by_cell(const Scene& scene, const mesh::Mesh& mesh, const Uniform& uniform, const Of& of) {
  const auto material = [&](int region) -> const Material& { return scene.material_of(mesh.region_names[region]); };
  return properties<decltype(of(material(0), mesh::Vector()))>(
      static_cast<int>(mesh.region_names.size()), mesh.cell_region,
      [&](int region) { return uniform(material(region)); },
      [&](int region, int cell) {
        const auto x = cell < 0 ? mesh::Vector{} : mesh::cell_centre(mesh, cell);
        return at_place(scene, material(region), [&] { return of(material(region), x); });
      });
}

}  // namespace sprekk::physics
