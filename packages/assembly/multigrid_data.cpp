#include "assembly/multigrid_data.hpp"

#include "assembly/facet_corners.hpp"
#include "assembly/order_one.hpp"
#include "contact/rigid_motion.hpp"
#include "mesh/facets.hpp"
#include "mesh/flat_cells.hpp"

#include <cmath>
#include <vector>

namespace sprekk::assembly {

using fields::Entity;
using fields::MultiVector;

namespace {

/// Returns the positions of this rank's owned nodes or facets (mean of the corners), [entity, component]. Collective.
RCP<MultiVector> owned_coordinates(const mesh::Mesh& mesh, const fields::Layout& layout) {
  const bool on_facets = layout.field().entity == Entity::facet;
  const auto& all = on_facets ? mesh.facets->id : mesh.node_id;
  const std::vector<GlobalIndex> ids(all.begin(), all.begin() + layout.n_owned_entities());
  auto coordinates = rcp(new MultiVector(fields::make_map(ids, mesh.comm), mesh.dim()));
  auto view = coordinates->getLocalViewHost(Tpetra::Access::OverwriteAll);
  for (LocalIndex n = 0; n < layout.n_owned_entities() && !on_facets; ++n)
    for (int i = 0; i < mesh.dim(); ++i) view(n, i) = mesh.coordinates[n * mesh.dim() + i];
  const int n_faces = mesh::n_faces(mesh.shape);
  for (LocalIndex face = 0; face < mesh.n_owned_cells * n_faces && on_facets; ++face)
    if (const LocalIndex facet = mesh.facets->of_cell[face]; facet >= 0 && facet < layout.n_owned_entities()) {
      const auto x = mesh::face_centre(mesh::face_corners(mesh, face / n_faces, face % n_faces));
      for (int i = 0; i < mesh.dim(); ++i) view(facet, i) = x[i];
    }
  const int n_ridges = mesh::n_face_corners(mesh.shape);
  for (LocalIndex ridge = 0; ridge < mesh.n_owned_fracture_faces * n_ridges && on_facets; ++ridge)
    if (const LocalIndex facet = mesh.facets->ridge[ridge]; facet < layout.n_owned_entities()) {
      const auto x = mesh::ridge_centre(mesh, ridge / n_ridges, ridge % n_ridges);
      for (int i = 0; i < mesh.dim(); ++i) view(facet, i) = x[i];
    }
  return coordinates;
}

/// Returns translations and rotations [unknown, mode] for positions [entity, dim]. The rotations are about a point that
/// is not a node. A node at the centre would give an aggregate of this node a zero column. Collective.
RCP<MultiVector> rigid_body_modes(const RCP<const fields::Map>& map, const MultiVector& coordinates) {
  const int dim = static_cast<int>(coordinates.getNumVectors()), n_rotations = dim == 2 ? 1 : 3;
  Teuchos::Array<Real> centre(dim);
  coordinates.meanValue(centre());
  for (int i = 0; i < dim; ++i) centre[i] += 0.0123456789 * (1 + 0.37 * i) * (1 + std::abs(centre[i]));
  auto modes = rcp(new MultiVector(map, dim + n_rotations));
  const auto X = coordinates.getLocalViewHost(Tpetra::Access::ReadOnly);
  auto view = modes->getLocalViewHost(Tpetra::Access::ReadWrite);
  for (std::size_t n = 0; n < X.extent(0); ++n) {
    for (int i = 0; i < dim; ++i) view(n * dim + i, i) = 1;
    for (int k = 0; k < n_rotations; ++k) {  // rotation in the plane of axes a, b
      const int a = dim == 2 ? 0 : (k + 1) % 3, b = dim == 2 ? 1 : (k + 2) % 3;
      view(n * dim + a, dim + k) = -(X(n, b) - centre[b]);
      view(n * dim + b, dim + k) = X(n, a) - centre[a];
    }
  }
  return modes;
}

}  // namespace

void set_multigrid(const mesh::Mesh& mesh, NearNullSpace near_null_space, const fields::Layout& layout,
                   fields::Block& block) {
  if (layout.field().entity == Entity::facet && layout.field().n_components == 1) {
    const auto corners = facet_corners(mesh, layout);
    block.interpolation = corners.interpolation;
    block.coordinates = corners.places;
    block.patches = mesh::facets_of_flat_cells(mesh);
    return;
  }
  block.coordinates = owned_coordinates(mesh, layout);
  if (near_null_space == NearNullSpace::constants) return;  // default of multigrid
  if (mesh::order(mesh.shape) == 2) {
    block.interpolation = interpolation_from_corners(mesh, layout);
    block.coordinates = at_corners(mesh, *block.coordinates);
  }
  const auto map = block.interpolation.is_null() ? layout.owned() : block.interpolation->getDomainMap();
  block.near_null_space = {static_cast<int>(contact::rigid_modes(mesh.dim()).size()),
                           [map, places = block.coordinates] { return rigid_body_modes(map, *places); }};
}

}  // namespace sprekk::assembly
