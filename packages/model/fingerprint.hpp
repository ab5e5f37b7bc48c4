// By what a checkpoint is known to belong to a scene.
#pragma once

#include "assembly/system.hpp"
#include "model/scene.hpp"

#include <nlohmann/json.hpp>

namespace sprekk::model {

/// What a state means something for: the mesh, on any number of ranks; the unknowns and histories; the modules with
/// their fingerprints; the beginning of time; all sections of the scene but Time, Solver, Output, Probes and Stages,
/// whose part up to now the other sections have in them. Collective.
nlohmann::json fingerprint(const Scene& scene, const assembly::System& system);

/// Throws an Error that names what differs. A table may have got more points at its end.
void check_fingerprint(const nlohmann::json& of_checkpoint, const nlohmann::json& of_scene);

}  // namespace sprekk::model
