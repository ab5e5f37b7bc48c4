// What is wrong with a scene as a whole: its parts among each other and with its mesh.
#pragma once

#include "assembly/constraints.hpp"
#include "base/text.hpp"
#include "physics/scene.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::physics {

using Names = std::vector<std::string>;

inline bool has(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// What a scene must fit to, as far as it is known.
struct MeshNames {
  std::optional<int> dim;
  std::optional<Names> regions, boundaries, fractures;
};

template <class AnyMesh>
MeshNames names_of(const AnyMesh& mesh) {
  return {mesh.dim(), mesh.region_names, mesh.boundary_names, mesh.fracture_names};
}

/// Compares the parts of a scene and collects what does not fit; what could not be read is passed over.
class Comparison {
 public:
  /// `tied`: boundaries that are periodic; `begin`: the end of the first step, if it is known.
  Comparison(const Scene& scene, const base::Report& report, const MeshNames& names, const Names& tied,
             const std::optional<Real>& begin)
      : scene_(scene), report_(report), names_(names), tied_(tied), begin_(begin) {}

  const Scene& scene() const { return scene_; }
  const MeshNames& names() const { return names_; }
  const std::optional<Real>& begin() const { return begin_; }

  /// Whether a section was read without an error in it.
  bool is_sound(const std::string& section) const { return report_.is_sound("Sprekk > " + section); }
  /// Whether the scene has no such section; else it may have one that could not be read, or with a misspelt name.
  bool is_absent(const std::string& section) const {
    return is_sound(section) && !report_.with_unknown_names.count("Sprekk");
  }

  void fail(const std::string& place, const std::string& what);
  /// The same of what has no place of its own.
  void add(const std::string& what) { errors_.push_back(scene_.origin + ": " + what); }
  /// What nothing holds: an error, unless modules that are not known yet hold it.
  void fail_unheld(const std::string& what) { unheld_ = what; }
  /// Whether a name in `section` may be one of those allowed.
  bool check_name(const std::string& section, const std::string& place, const std::string& name,
                  const std::optional<Names>& allowed);
  /// Nothing given has no length.
  void check_length(const std::string& place, std::size_t n, const std::optional<int>& wanted);

  /// The material of a region, if it is rock.
  const Material* rock_of(const std::string& region) const;
  /// The material of a fracture, if it is a joint and was read without an error.
  const Material* joint_of(const Fracture& fracture) const;
  std::string name_of(const Material& material) const;
  /// Calls use(material) for the rock of each region of the mesh, once, if they are known.
  template <class Use>
  void for_each_rock(const Use& use) const {
    std::vector<const Material*> done;
    for (const auto& name : names_.regions.value_or(Names()))
      if (const auto* rock = rock_of(name); rock && std::find(done.begin(), done.end(), rock) == done.end()) {
        done.push_back(rock);
        use(*rock);
      }
  }

  /// Everything of the scene alone; of the conditions that fit to a mesh on this mesh.
  void compare();
  void compare(const mesh::GlobalMesh& mesh);
  const Names& errors() const { return errors_; }
  const std::string& unheld() const { return unheld_; }

 private:
  void check_material(const std::string& section, const std::string& name, const std::string& type);
  void compare_regions();
  void compare_fractures();
  void compare_boundary_conditions();
  void compare_probes();

  const Scene& scene_;
  const base::Report& report_;
  MeshNames names_;
  Names tied_;
  std::optional<Real> begin_;
  Names errors_;
  std::string unheld_;
};

/// The conditions that hold unknowns of `field` (all of "") on a mesh that has all names, those of regions after those
/// of boundaries.
std::vector<assembly::DirichletCondition> dirichlet_conditions(
    const std::map<std::string, BoundaryCondition>& conditions, const std::map<std::string, Region>& regions,
    const MeshNames& names, const std::string& field = "");

/// A line for each boundary condition whose region is nowhere beside its boundary. Collective.
std::vector<std::string> conditions_that_hold_nowhere(const Scene& scene, const mesh::Mesh& mesh);

}  // namespace sprekk::physics
