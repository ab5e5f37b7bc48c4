#include "mesh/number_facets.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "base/check.hpp"
#include "base/over_ranks.hpp"
#include "mesh/exchange.hpp"
#include "mesh/facets.hpp"

namespace sprekk::mesh {
namespace {

/// Nodes at the corners of a face, sorted; -1 fills arrays of fewer than four. With `free`, tied nodes are replaced by
/// their free nodes.
std::array<LocalIndex, 4> corners_of(const Mesh& mesh, LocalIndex face, bool free) {
  const auto& nodes = face_nodes(mesh.shape)[face % n_faces(mesh.shape)];
  const LocalIndex first = face / n_faces(mesh.shape) * mesh.nodes_per_cell();
  std::array<LocalIndex, 4> corners{-1, -1, -1, -1};
  const int n = n_face_corners(mesh.shape);
  for (int k = 0; k < n; ++k) {
    const LocalIndex node = mesh.cells[first + nodes[k]];
    corners[k] = free ? mesh.free_node(node) : node;
  }
  std::sort(corners.begin(), corners.begin() + n);
  return corners;
}

/// Hash table of faces by their lowest corner, with one chain per node: first[node] -> next[face] -> ... -> -1.
class FaceTable {
 public:
  FaceTable(const Mesh& mesh, bool free)
      : mesh_(mesh), free_(free), first_(mesh.n_nodes(), -1), next_(mesh.n_cells() * n_faces(mesh.shape), -1) {}
  void add(LocalIndex face) { next_[face] = std::exchange(first_[corners_of(mesh_, face, free_)[0]], face); }
  /// Returns the next face after `from` (-1: the first) with the same corners as `face`; -1 if there is none.
  LocalIndex find(LocalIndex face, LocalIndex from = -1) const {
    const auto corners = corners_of(mesh_, face, free_);
    LocalIndex other = from < 0 ? first_[corners[0]] : next_[from];
    while (other >= 0 && corners_of(mesh_, other, free_) != corners) other = next_[other];
    return other;
  }

 private:
  const Mesh& mesh_;
  bool free_;
  std::vector<LocalIndex> first_, next_;
};

/// Pairs faces on tied sides with the faces to which they are tied.
void pair_tied(const Mesh& mesh, const std::vector<LocalIndex>& faces, std::vector<LocalIndex>& across) {
  const auto is_tied = [&](LocalIndex face) {
    const auto corners = corners_of(mesh, face, false);
    return *std::min_element(corners.begin(), corners.begin() + n_face_corners(mesh.shape)) >= mesh.n_free_nodes;
  };
  FaceTable table(mesh, true);
  for (const LocalIndex face : faces)
    if (!is_tied(face)) table.add(face);
  for (const LocalIndex face : faces) {
    if (!is_tied(face)) continue;
    const LocalIndex other = table.find(face);
    if (other < 0) continue;
    SPREKK_CHECK(table.find(face, other) < 0,
                 "mesh: faces of a periodic side have the same corners; it needs three cells "
                 "or more in each direction");
    across[face] = other;
    across[other] = face;
  }
}

/// Calls visit(fracture face, cell * n_faces + local face) for the sides of fracture faces with a local cell.
template <class Visit>
void for_fracture_sides(const Mesh& mesh, const Visit& visit) {
  for (LocalIndex f = 0; f < mesh.n_fracture_faces(); ++f)
    for (int side : {minus, plus}) {
      const auto& face = mesh.fracture_faces[f];
      if (face.cell[side] >= 0) visit(f, face.cell[side] * n_faces(mesh.shape) + face.local_face[side]);
    }
}

/// Returns for each face of a local cell [cell * n_faces + local face] the same face of the adjacent local cell, also
/// across tied sides; -1 if there is none.
std::vector<LocalIndex> faces_across(const Mesh& mesh) {
  const int n_faces = mesh::n_faces(mesh.shape);
  std::vector<LocalIndex> across(static_cast<std::size_t>(mesh.n_cells()) * n_faces, -1), alone;
  std::vector<char> on_fracture(across.size(), 0);
  for_fracture_sides(mesh, [&](LocalIndex, LocalIndex face) { on_fracture[face] = 1; });
  FaceTable table(mesh, false);
  for (LocalIndex face = 0; face < static_cast<LocalIndex>(across.size()); ++face) {
    if (on_fracture[face]) continue;
    const LocalIndex other = table.find(face);
    if (other < 0) {
      table.add(face);
      continue;
    }
    across[face] = other;
    across[other] = face;
  }
  for (LocalIndex face = 0; face < static_cast<LocalIndex>(across.size()) && !mesh.tied_to.empty(); ++face)
    if (across[face] < 0 && !on_fracture[face]) alone.push_back(face);
  pair_tied(mesh, alone, across);
  return across;
}

/// Returns for each face [cell * n_faces + local face] the face that numbers and owns the facet. It is the one of the
/// cell with the lower number. Faces on fractures get -1, because fracture faces have their own numbers.
std::vector<LocalIndex> face_givers(const Mesh& mesh, std::vector<LocalIndex> across) {
  const int n_faces = mesh::n_faces(mesh.shape);
  for (LocalIndex face = 0; face < static_cast<LocalIndex>(across.size()); ++face) {
    const LocalIndex other = across[face];
    const auto number = [&](LocalIndex f) { return std::pair(mesh.cell_id[f / n_faces], -f); };
    if (other < 0 || number(face) < number(other)) across[face] = face;
  }
  for_fracture_sides(mesh, [&](LocalIndex, LocalIndex face) { across[face] = -1; });
  return across;
}

/// Returns for each ridge [fracture face * n_face_corners + k] the same ridge of the local face with the lowest number.
std::vector<LocalIndex> ridge_givers(const Mesh& mesh) {
  const int n = n_face_corners(mesh.shape);
  std::map<std::array<GlobalIndex, 2>, LocalIndex> lowest;
  const auto points = [&](LocalIndex ridge) {
    return ridge_points(mesh.fracture_faces[ridge / n].corners, mesh.shape, ridge % n);
  };
  const LocalIndex n_ridges = mesh.n_fracture_faces() * n;
  for (LocalIndex ridge = 0; ridge < n_ridges; ++ridge) {
    LocalIndex& giver = lowest.try_emplace(points(ridge), ridge).first->second;
    if (mesh.fracture_faces[ridge / n].id < mesh.fracture_faces[giver / n].id) giver = ridge;
  }
  std::vector<LocalIndex> givers;
  for (LocalIndex ridge = 0; ridge < n_ridges; ++ridge) givers.push_back(lowest.at(points(ridge)));
  return givers;
}

/// Returns the global numbers of facets or ridges, [entity * width + k]. An entity numbers those for which it is the
/// giver, after the numbers given by the entities before it; -1 without a giver. The givers for owned entities must be
/// local. Collective.
std::vector<GlobalIndex> numbers(const std::vector<GlobalIndex>& entity_id, LocalIndex n_entities, int width,
                                 const std::vector<LocalIndex>& giver, const RCP<const Comm>& comm) {
  const LocalIndex n_owned = n_entities * width;
  std::vector<GlobalIndex> counts(n_entities, 0);
  for (LocalIndex end = 0; end < n_owned; ++end) counts[end / width] += giver[end] == end;
  auto next = sums_before({entity_id.begin(), entity_id.begin() + n_entities}, counts, comm);
  std::vector<GlobalIndex> ids(giver.size(), -1);
  for (LocalIndex end = 0; end < n_owned; ++end)
    if (giver[end] == end) ids[end] = next[end / width]++;
  const GhostExchange exchange(entity_id, n_entities, comm);
  exchange(ids, width);
  for (LocalIndex end = 0; end < n_owned; ++end)
    if (giver[end] >= 0) ids[end] = ids[giver[end]];
  exchange(ids, width);
  return ids;
}

std::vector<GlobalIndex> face_ids(const Mesh& mesh) {
  std::vector<GlobalIndex> ids;
  for (const auto& face : mesh.fracture_faces) ids.push_back(face.id);
  return ids;
}

/// Finds ridges of fracture faces on the boundary: a boundary face has a ridge with the same points, on either side.
std::vector<Facets::Rim> find_rims(const Mesh& mesh) {
  const int n = n_face_corners(mesh.shape);
  std::vector<GlobalIndex> point(mesh.n_nodes(), -1);  // [node] point of a node on fractures
  for (const auto& face : mesh.fracture_faces)
    for (int side : {minus, plus})
      for (int k = 0; k < n && face.cell[side] >= 0; ++k) point[face.nodes[side][k]] = face.corners[k];
  std::map<std::array<GlobalIndex, 2>, std::set<int>> boundaries;
  for (const auto& face : mesh.boundary_faces) {
    std::array<GlobalIndex, 4> corners{-1, -1, -1, -1};
    for (int k = 0; k < n; ++k)
      corners[k] = point[mesh.cells[face.cell * mesh.nodes_per_cell() + face_nodes(mesh.shape)[face.local_face][k]]];
    for (int k = 0; k < n; ++k)
      if (corners[k] >= 0 && (mesh.dim() == 2 || corners[(k + 1) % n] >= 0))
        boundaries[ridge_points(corners, mesh.shape, k)].insert(face.boundary);
  }
  std::vector<Facets::Rim> rims;
  for (LocalIndex f = 0; f < mesh.n_fracture_faces(); ++f)
    for (int k = 0; k < n && mesh.fracture_faces[f].cell[minus] >= 0; ++k)
      if (const auto found = boundaries.find(ridge_points(mesh.fracture_faces[f].corners, mesh.shape, k));
          found != boundaries.end())
        for (const int boundary : found->second) rims.push_back({f, k, boundary});
  return rims;
}

/// Throws an Error if a periodic side identifies edges of faces that are not adjacent.
void check_ridges(const Mesh& mesh, const std::vector<LocalIndex>& giver) {
  const int n = n_face_corners(mesh.shape);
  std::map<LocalIndex, std::vector<LocalIndex>> faces;  // by the giver of the ridge
  std::set<std::array<LocalIndex, 2>> neighbours;
  for (LocalIndex ridge = 0; ridge < static_cast<LocalIndex>(giver.size()) && mesh.dim() == 3; ++ridge) {
    auto& around = faces[giver[ridge]];
    for (const LocalIndex other : around)
      SPREKK_CHECK(other != ridge / n && neighbours.insert({other, ridge / n}).second,
                   "mesh: faces of fracture \"{}\" on a periodic side have the same corners; it needs three cells or "
                   "more in each direction",
                   mesh.fracture_names[mesh.fracture_faces[other].fracture]);
    around.push_back(ridge / n);
  }
}

/// Returns the local numbers of `ids` in `all`; the first n_owned entries and the other ones are each sorted. -1
/// remains -1.
std::vector<LocalIndex> local_numbers(const std::vector<GlobalIndex>& ids, const std::vector<GlobalIndex>& all,
                                      LocalIndex n_owned) {
  const auto middle = all.begin() + n_owned;
  std::vector<LocalIndex> result;
  for (const GlobalIndex id : ids) {
    if (id < 0) {
      result.push_back(-1);
      continue;
    }
    auto found = std::lower_bound(all.begin(), middle, id);
    if (found == middle || *found != id) found = std::lower_bound(middle, all.end(), id);
    result.push_back(static_cast<LocalIndex>(found - all.begin()));
  }
  return result;
}

}  // namespace

std::vector<GlobalIndex> ridge_ids(const Mesh& mesh) {
  return numbers(face_ids(mesh), mesh.n_owned_fracture_faces, n_face_corners(mesh.shape), ridge_givers(mesh),
                 mesh.comm);
}

RCP<const Mesh> with_facets(const RCP<const Mesh>& mesh, bool in_rock) {
  const int n_faces = mesh::n_faces(mesh->shape), n_ridges = n_face_corners(mesh->shape);
  std::vector<LocalIndex> of_cells(static_cast<std::size_t>(mesh->n_cells()) * n_faces, -1);
  base::collectively(*mesh->comm, [&] {
    if (in_rock) of_cells = face_givers(*mesh, faces_across(*mesh));
  });
  const auto of_faces = ridge_givers(*mesh);
  base::collectively(*mesh->comm, [&] { check_ridges(*mesh, of_faces); });
  auto cells = numbers(mesh->cell_id, mesh->n_owned_cells, n_faces, of_cells, mesh->comm);
  auto ridges = numbers(face_ids(*mesh), mesh->n_owned_fracture_faces, n_ridges, of_faces, mesh->comm);
  auto faces = face_ids(*mesh);
  const auto facets = rcp(new Facets);
  facets->in_rock = in_rock;
  const auto own = [&](const auto& ids, LocalIndex n, const auto& is_own) {  // numbers ascend with the entities
    const auto before = facets->id.size();
    for (LocalIndex k = 0; k < n; ++k)
      if (is_own(k)) facets->id.push_back(ids[k]);
    return base::sum_over_ranks(*mesh->comm, static_cast<GlobalIndex>(facets->id.size() - before));
  };
  GlobalIndex n = own(cells, mesh->n_owned_cells * n_faces, [&](LocalIndex k) { return of_cells[k] == k; });
  for (GlobalIndex& id : ridges) id += n;
  n += own(ridges, mesh->n_owned_fracture_faces * n_ridges, [&](LocalIndex k) { return of_faces[k] == k; });
  for (GlobalIndex& id : faces) id += n;
  own(faces, mesh->n_owned_fracture_faces, [](LocalIndex) { return true; });
  facets->n_owned = static_cast<LocalIndex>(facets->id.size());
  for_fracture_sides(*mesh, [&](LocalIndex f, LocalIndex face) { cells[face] = faces[f]; });
  std::vector<GlobalIndex> ghosts;
  for (const auto* ids : std::array<const std::vector<GlobalIndex>*, 3>{&cells, &ridges, &faces})
    for (const GlobalIndex id : *ids)
      if (id >= 0 && !std::binary_search(facets->id.begin(), facets->id.begin() + facets->n_owned, id))
        ghosts.push_back(id);
  std::sort(ghosts.begin(), ghosts.end());
  ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
  facets->id.insert(facets->id.end(), ghosts.begin(), ghosts.end());
  const auto local = [&](const auto& ids) { return local_numbers(ids, facets->id, facets->n_owned); };
  facets->of_cell = local(cells);
  facets->ridge = local(ridges);
  facets->fracture_face = local(faces);
  facets->rims = find_rims(*mesh);
  const auto result = rcp(new Mesh(*mesh));
  result->facets = facets;
  return result;
}

}  // namespace sprekk::mesh
