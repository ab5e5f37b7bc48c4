// Which changes of its scene a live model can follow, and how its state gets to the changed equations.
#pragma once

#include "assembly/system.hpp"
#include "model/scene.hpp"

#include <string>
#include <vector>

namespace sprekk::model {

/// Whether both say the same of all but stages, results and what opens messages.
bool same_entries(const Scene& before, const Scene& after);

/// Why a state of one scene means nothing in the other, a line each; empty: it goes on there.
std::vector<std::string> refused_changes(const Scene& before, const Scene& after);

/// What modules keep a state in: fields and histories with their entities and components.
struct Storage {
  struct Place {
    fields::Entity entity;
    int n_components;
    bool operator==(const Place&) const = default;
  };
  std::map<std::string, Place> fields, histories;
};

/// Of modules before they are bound; those of a System tell the same. Collective.
Storage storage_of(const std::vector<std::unique_ptr<assembly::Module>>& modules, const mesh::Mesh& mesh);

/// Why a state cannot go from one storage to another, a line each. Histories may begin, and fields at crack tips end.
std::vector<std::string> misfits(const Storage& before, const Storage& after);

/// Unknowns and histories of one system, by the numbers of their entities, in another; the meshes of both are parts of
/// `whole`. What is new there is as it is at the start. The next step is one of implicit Euler. Collective.
void carry_over(const mesh::Mesh& whole, assembly::System& from, const fields::BlockVector& x, assembly::System& to,
                fields::BlockVector& carried);

}  // namespace sprekk::model
