// What is wrong with a scene as a whole: its parts among each other and with its mesh.
#pragma once

#include "assembly/constraints.hpp"
#include "model/scene.hpp"

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace sprekk::model {

/// What a scene must fit to, as far as it is known.
struct MeshNames {
  std::optional<int> dim;
  std::optional<std::vector<std::string>> regions, boundaries, fractures;
};

/// What a scene itself tells about its mesh.
MeshNames names_in_scene(const base::Draft<Scene>& draft);

/// What names and lengths do not fit together or to a mesh, a line each; empty if nothing. What could not be read is
/// no misfit.
std::vector<std::string> misfits(const base::Draft<Scene>& draft, const MeshNames& names);

/// The groups of a mesh, by their numbers.
struct GroupNames {
  std::vector<std::string> regions, boundaries, fractures;
};

template <class AnyMesh>
GroupNames group_names(const AnyMesh& mesh) {
  return {mesh.region_names, mesh.boundary_names, mesh.fracture_names};
}

/// The prescribed displacements, or values of "face pressure", on a mesh that has all names of the conditions.
std::vector<assembly::DirichletCondition> dirichlet_conditions(const std::map<std::string, BoundaryCondition>& given,
                                                               const GroupNames& names,
                                                               const std::string& field = "displacement");

/// The scene's mesh. Throws one Error with a line for each thing that is wrong: all in the draft's report, the mesh,
/// the misfits, conditions that conflict at the end of the first step, and rock that nothing holds; the last is told by
/// `unheld` instead, if it is given and nothing else is wrong. Not collective.
mesh::GlobalMesh checked_mesh(const base::Draft<Scene>& draft, std::string* unheld = nullptr);

}  // namespace sprekk::model
