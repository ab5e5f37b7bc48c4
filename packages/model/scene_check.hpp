// Consistency checks of a scene: of its parts, and with its mesh.
#pragma once

#include "model/scene.hpp"
#include "physics/comparison.hpp"

#include <string>
#include <vector>

namespace sprekk::model {

/// Returns the names and the dimension of the mesh as far as the scene itself contains them.
physics::MeshNames names_in_scene(const base::Draft<Scene>& draft);

/// Returns inconsistent names and lengths within the scene or with its mesh, one line each. Entries that could not be
/// read are ignored.
std::vector<std::string> misfits(const base::Draft<Scene>& draft, const physics::MeshNames& names);

/// Makes the mesh of the scene. Throws one Error with a line for each mistake. These are the report of the draft,
/// mistakes of the mesh, and inconsistencies. Contradictory conditions at the end of the first step and rock without
/// support are mistakes too. If unsupported rock is the only mistake and `unconstrained` is given, the message is
/// stored there instead. Not collective.
mesh::GlobalMesh checked_mesh(const base::Draft<Scene>& draft, std::string* unconstrained = nullptr);

}  // namespace sprekk::model
