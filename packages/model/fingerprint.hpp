// Fingerprint of a scene, for the check of checkpoints.
#pragma once

#include "assembly/system.hpp"
#include "model/scene.hpp"

#include <nlohmann/json.hpp>

namespace sprekk::model {

/// Returns the data on which the meaning of a state depends. These are the mesh (for any number of ranks), unknowns and
/// histories, modules with their fingerprints, the start time, and sections of the scene. The sections Time, Solver,
/// Output, Probes and Stages are excluded; the other sections already contain the stages up to now. Collective.
nlohmann::json fingerprint(const Scene& scene, const assembly::System& system);

/// Throws an Error that names the differences. Additional points at the end of a table are permitted.
void check_fingerprint(const nlohmann::json& of_checkpoint, const nlohmann::json& of_scene);

}  // namespace sprekk::model
