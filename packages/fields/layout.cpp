#include "fields/layout.hpp"

#include "base/check.hpp"

#include <Tpetra_Distributor.hpp>

namespace sprekk::fields {

std::string name_of(Entity entity) {
  switch (entity) {
    case Entity::node:
      return "node";
    case Entity::cell:
      return "cell";
    case Entity::enriched_node:
      return "enriched node";
    case Entity::facet:
      return "facet";
    default:
      return "fracture face";
  }
}

LocalIndex n_entities(const mesh::Mesh& mesh, Entity entity, bool with_ghosts) {
  switch (entity) {
    case Entity::node:
      return with_ghosts ? mesh.n_free_nodes : mesh.n_owned_nodes;
    case Entity::cell:
      return with_ghosts ? mesh.n_cells() : mesh.n_owned_cells;
    case Entity::enriched_node:
      return with_ghosts ? static_cast<LocalIndex>(mesh.enriched_id.size()) : mesh.n_owned_enriched;
    case Entity::facet:
      SPREKK_CHECK(!mesh.facets.is_null(), "a field lives on facets, which the mesh does not have");
      return with_ghosts ? static_cast<LocalIndex>(mesh.facets->id.size()) : mesh.facets->n_owned;
    default:
      return with_ghosts ? mesh.n_fracture_faces() : mesh.n_owned_fracture_faces;
  }
}

namespace {

GlobalIndex global_id(const mesh::Mesh& mesh, Entity entity, LocalIndex i) {
  switch (entity) {
    case Entity::node:
      return mesh.node_id[i];
    case Entity::cell:
      return mesh.cell_id[i];
    case Entity::enriched_node:
      return mesh.enriched_id[i];
    case Entity::facet:
      return mesh.facets->id[i];
    default:
      return mesh.fracture_faces[i].id;
  }
}

GlobalIndex whole_id(const mesh::Mesh& mesh, Entity entity, LocalIndex i) {
  if (mesh.origin.is_null()) return global_id(mesh, entity, i);
  switch (entity) {
    case Entity::node:
      return mesh.origin->nodes[i];
    case Entity::cell:
      return mesh.origin->cells[i];
    case Entity::enriched_node:
      return mesh.origin->enriched[i];
    case Entity::facet:
      return mesh.origin->facets[i];
    default:
      return mesh.origin->fracture_faces[i];
  }
}

using Numbers = GlobalIndex (*)(const mesh::Mesh&, Entity, LocalIndex);

RCP<const Map> map_of(const Field& field, const mesh::Mesh& mesh, LocalIndex n, Numbers id = global_id) {
  std::vector<GlobalIndex> ids;
  ids.reserve(static_cast<std::size_t>(n) * field.n_components);
  for (LocalIndex i = 0; i < n; ++i)
    for (int c = 0; c < field.n_components; ++c) ids.push_back(id(mesh, field.entity, i) * field.n_components + c);
  return make_map(ids, mesh.comm);
}

/// Returns the owned map itself if no rank has ghosts.
RCP<const Map> map_with_ghosts(const Field& field, const mesh::Mesh& mesh, const RCP<const Map>& owned) {
  const auto all = map_of(field, mesh, n_entities(mesh, field.entity, true));
  return all->getGlobalNumElements() == owned->getGlobalNumElements() ? owned : all;
}

}  // namespace

RCP<const Map> owned_map(const Field& field, const mesh::Mesh& mesh) {
  return map_of(field, mesh, n_entities(mesh, field.entity, false));
}

RCP<const Map> whole_map(const Field& field, const mesh::Mesh& mesh) {
  return map_of(field, mesh, n_entities(mesh, field.entity, false), whole_id);
}

Layout::Layout(const Field& field, const mesh::Mesh& mesh)
    : field_(field),
      n_owned_entities_(n_entities(mesh, field.entity, false)),
      owned_(map_of(field, mesh, n_owned_entities_)),
      ghosted_(map_with_ghosts(field, mesh, owned_)),
      import_(rcp(new const Import(owned_, ghosted_))) {}

std::size_t Layout::halo_messages() const { return import_->getDistributor().getNumReceives(); }

View<Real**> by_entity(Vector& vector, int n_components) {
  const auto local = vector.getLocalViewDevice(Tpetra::Access::ReadWrite);
  return View<Real**>(local.data(), local.extent(0) / n_components, n_components);
}

}  // namespace sprekk::fields
