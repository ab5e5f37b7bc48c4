// Changes of the scene during a run, and transfer of the state to the changed equations.
#pragma once

#include "assembly/system.hpp"
#include "model/scene.hpp"

#include <string>
#include <vector>

namespace sprekk::model {

/// Returns true if both scenes are equal except for stages, results and the prefix of messages.
bool same_entries(const Scene& before, const Scene& after);

/// Returns the reasons why a state of one scene is invalid in the other, one line each. An empty list permits the
/// change.
std::vector<std::string> refused_changes(const Scene& before, const Scene& after);

/// Storage of the state in modules: fields and histories with their entities and components.
struct Storage {
  struct Place {
    fields::Entity entity;
    int n_components;
    bool operator==(const Place&) const = default;
  };
  std::map<std::string, Place> fields, histories;
};

/// Returns the storage of modules before they are bound; a System of these modules has the same. Collective.
Storage storage_of(const std::vector<std::unique_ptr<assembly::Module>>& modules, const mesh::Mesh& mesh);

/// Returns the reasons why a state cannot be transferred, one line each. New histories and the removal of fields at
/// crack tips are permitted.
std::vector<std::string> misfits(const Storage& before, const Storage& after);

/// Copies unknowns and histories between two systems by the numbers of their entities. The meshes of both are parts of
/// `whole`. New entries have their initial values. The next step is an implicit Euler step. Collective.
void carry_over(const mesh::Mesh& whole, assembly::System& from, const fields::BlockVector& x, assembly::System& to,
                fields::BlockVector& carried);

}  // namespace sprekk::model
