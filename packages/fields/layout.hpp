// Where a field lives: which entities carry it and how its unknowns are numbered on the ranks.
#pragma once

#include "fields/types.hpp"
#include "mesh/mesh.hpp"

#include <string>

namespace sprekk::fields {

enum class Entity {
  node,
  cell,
  fracture_face,
  enriched_node,  ///< nodes around crack tips, see mesh::Mesh::enriched
  facet           ///< what cells and fracture faces end in, see mesh::Facets
};

std::string name_of(Entity entity);

struct Field {
  std::string name;
  Entity entity;
  int n_components;  ///< per entity, adjacent in the numbering
  std::string unit;
};

/// The unknowns of one field on this rank: owned ones first, ghosts after them, so that an index below n_owned() is a
/// row of this rank. Unknown = entity * n_components + component, locally and globally. Construction is collective.
class Layout {
 public:
  Layout(const Field& field, const mesh::Mesh& mesh);

  const Field& field() const { return field_; }
  const RCP<const Map>& owned() const { return owned_; }
  const RCP<const Map>& ghosted() const { return ghosted_; }
  const RCP<const Import>& import() const { return import_; }
  LocalIndex n_owned_entities() const { return n_owned_entities_; }
  LocalIndex n_owned() const { return n_owned_entities_ * field_.n_components; }
  /// Bytes that this rank receives when the field's ghosts are updated once.
  std::size_t halo_bytes() const { return import_->getNumRemoteIDs() * sizeof(Real); }
  /// In how many messages they come: the other ranks that own some of them.
  std::size_t halo_messages() const;

 private:
  Field field_;
  LocalIndex n_owned_entities_;
  RCP<const Map> owned_, ghosted_;
  RCP<const Import> import_;
};

/// The numbers of a field's unknowns on owned entities. Collective.
RCP<const Map> owned_map(const Field& field, const mesh::Mesh& mesh);

/// The same by their numbers in the mesh that this one is a part of, see mesh::Mesh::origin. Collective.
RCP<const Map> whole_map(const Field& field, const mesh::Mesh& mesh);

/// Number of entities of a kind with unknowns of their own on this rank, owned only or with ghosts.
LocalIndex n_entities(const mesh::Mesh& mesh, Entity entity, bool with_ghosts);

/// The values of a vector on the device, [entity, component]: a view of the vector's own memory.
View<Real**> by_entity(Vector& vector, int n_components);

}  // namespace sprekk::fields
