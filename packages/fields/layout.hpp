// Layout of a field: its entities and the numbering of its unknowns on the ranks.
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
  facet           ///< boundaries of cells and fracture faces, see mesh::Facets
};

std::string name_of(Entity entity);

/// Field with unknowns on the entities of one kind.
struct Field {
  std::string name;
  Entity entity;
  int n_components;  ///< per entity, adjacent in the numbering
  std::string unit;
  bool is_amount = false;  ///< amounts in entities; the amount in an entity is the sum of those in its parts
};

/// Unknowns of one field on this rank: owned ones first, then ghosts. Unknown = entity * n_components + component,
/// locally and globally. An index below n_owned() is a row of this rank. Construction is collective.
class Layout {
 public:
  Layout(const Field& field, const mesh::Mesh& mesh);

  const Field& field() const { return field_; }
  const RCP<const Map>& owned() const { return owned_; }
  const RCP<const Map>& ghosted() const { return ghosted_; }
  const RCP<const Import>& import() const { return import_; }
  LocalIndex n_owned_entities() const { return n_owned_entities_; }
  LocalIndex n_owned() const { return n_owned_entities_ * field_.n_components; }
  /// Bytes received by this rank in one update of the ghosts.
  std::size_t halo_bytes() const { return import_->getNumRemoteIDs() * sizeof(Real); }
  /// Number of messages of such an update, i.e. of ranks that own ghosts of this rank.
  std::size_t halo_messages() const;

 private:
  Field field_;
  LocalIndex n_owned_entities_;
  RCP<const Map> owned_, ghosted_;
  RCP<const Import> import_;
};

/// Map of the global numbers of the unknowns on owned entities. Collective.
RCP<const Map> owned_map(const Field& field, const mesh::Mesh& mesh);

/// Map of their numbers in the mesh that this one is a part of, see mesh::Mesh::origin. Collective.
RCP<const Map> whole_map(const Field& field, const mesh::Mesh& mesh);

/// Number of entities of a kind with unknowns on this rank, owned only or with ghosts.
LocalIndex n_entities(const mesh::Mesh& mesh, Entity entity, bool with_ghosts);

/// Values of a vector on the device, [entity, component]. The view shares the memory of the vector.
View<Real**> by_entity(Vector& vector, int n_components);

}  // namespace sprekk::fields
