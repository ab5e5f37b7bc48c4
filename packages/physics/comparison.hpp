// Consistency checks of a whole scene: between its parts and with its mesh.
#pragma once

#include "assembly/constraints.hpp"
#include "base/text.hpp"
#include "physics/scene.hpp"
#include "transport/outflow.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::physics {

using Names = std::vector<std::string>;

inline bool has(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Names of the mesh that the scene refers to, as far as they are known.
struct MeshNames {
  std::optional<int> dim;
  std::optional<Names> regions, boundaries, fractures;
};

template <class AnyMesh>
MeshNames names_of(const AnyMesh& mesh) {
  return {mesh.dim(), mesh.region_names, mesh.boundary_names, mesh.fracture_names};
}

/// Compares the parts of a scene and collects errors. Ignores parts that could not be read.
class Comparison {
 public:
  /// `tied`: periodic boundaries. `begin`: end of the first step if known, s.
  Comparison(const Scene& scene, const base::Report& report, const MeshNames& names, const Names& tied,
             const std::optional<Real>& begin)
      : scene_(scene), report_(report), names_(names), tied_(tied), begin_(begin) {}

  const Scene& scene() const { return scene_; }
  const MeshNames& names() const { return names_; }
  const std::optional<Real>& begin() const { return begin_; }

  /// Returns whether a section was read without errors.
  bool is_sound(const std::string& section) const { return report_.is_sound("Sprekk > " + section); }
  /// Returns whether the section is certainly missing. It may exist with an unreadable or misspelt name otherwise.
  bool is_absent(const std::string& section) const {
    return is_sound(section) && !report_.with_unknown_names.count("Sprekk");
  }

  void fail(const std::string& place, const std::string& what);
  /// Adds an error without a location of its own.
  void add(const std::string& what) { errors_.push_back(scene_.origin + ": " + what); }
  /// Sets a message about unsupported rock. It is an error unless modules that are not known yet support the rock.
  void fail_unconstrained(const std::string& what) { unconstrained_ = what; }
  /// Returns whether the name used in `section` is one of the allowed names. Reports an error otherwise.
  bool check_name(const std::string& section, const std::string& place, const std::string& name,
                  const std::optional<Names>& allowed);
  /// Reports a list of wrong length. A missing list (n = 0) is valid.
  void check_length(const std::string& place, std::size_t n, const std::optional<int>& wanted);

  /// Material of a region if it is a rock; null otherwise.
  const Material* rock_of(const std::string& region) const;
  /// Material of a fracture if it is a joint without errors; null otherwise.
  const Material* joint_of(const Fracture& fracture) const;
  std::string name_of(const Material& material) const;
  /// Calls use(material) once for the rock of each region of the mesh, as far as the regions are known.
  template <class Use>
  void for_each_rock(const Use& use) const {
    std::vector<const Material*> done;
    for (const auto& name : names_.regions.value_or(Names()))
      if (const auto* rock = rock_of(name); rock && std::find(done.begin(), done.end(), rock) == done.end()) {
        done.push_back(rock);
        use(*rock);
      }
  }

  /// Compares the whole scene; with a mesh, only those conditions that match the mesh.
  void compare();
  void compare(const mesh::GlobalMesh& mesh);
  const Names& errors() const { return errors_; }
  const std::string& unconstrained() const { return unconstrained_; }

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
  std::string unconstrained_;
};

/// Conditions that prescribe unknowns of `field` ("": all fields) on a mesh with all names. Conditions of boundaries
/// precede those of regions, and these those of fractures.
std::vector<assembly::DirichletCondition> dirichlet_conditions(
    const std::map<std::string, BoundaryCondition>& conditions, const std::map<std::string, Region>& regions,
    const MeshNames& names, const std::string& field = "", const std::map<std::string, Fracture>& fractures = {});

/// Entries of a boundary condition that define a FluxCondition: a flux, or a coefficient and the exterior value.
struct FluxEntries {
  std::optional<base::Expression> BoundaryCondition::*flux, BoundaryCondition::*beyond, BoundaryCondition::*coefficient;
};

/// Flux conditions of a scene on rock, or on ends of fractures.
std::vector<transport::FluxCondition> flux_conditions(const Scene& scene, const mesh::Mesh& mesh,
                                                      const FluxEntries& entries, bool of_fractures = false);

/// Returns a line for each boundary condition whose region does not touch its boundary. Collective.
std::vector<std::string> conditions_without_effect(const Scene& scene, const mesh::Mesh& mesh);

}  // namespace sprekk::physics
