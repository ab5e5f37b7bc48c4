// What is wrong with a scene as a whole: its parts among each other and with its mesh.
#pragma once

#include "model/scene.hpp"
#include "physics/comparison.hpp"

#include <string>
#include <vector>

namespace sprekk::model {

/// What a scene itself tells about its mesh.
physics::MeshNames names_in_scene(const base::Draft<Scene>& draft);

/// What names and lengths do not fit together or to a mesh, a line each; empty if nothing. What could not be read is
/// no misfit.
std::vector<std::string> misfits(const base::Draft<Scene>& draft, const physics::MeshNames& names);

/// The scene's mesh. Throws one Error with a line for each thing that is wrong: all in the draft's report, the mesh,
/// the misfits, conditions that conflict at the end of the first step, and rock that nothing holds; the last is told by
/// `unheld` instead, if it is given and nothing else is wrong. Not collective.
mesh::GlobalMesh checked_mesh(const base::Draft<Scene>& draft, std::string* unheld = nullptr);

}  // namespace sprekk::model
