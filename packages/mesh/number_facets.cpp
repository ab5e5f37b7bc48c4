#include "mesh/number_facets.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "base/check.hpp"
#include "mesh/exchange.hpp"

namespace sprekk::mesh {
namespace {

/// The nodes at a face's corners, sorted; -1 where there are fewer than four. `free`: of tied ones those that they are
/// tied to.
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

/// Faces by their corners: hashed by the lowest one, a chain per node, first[node] -> next[face] -> ... -> -1.
class FaceTable {
 public:
  FaceTable(const Mesh& mesh, bool free)
      : mesh_(mesh), free_(free), first_(mesh.n_nodes(), -1), next_(mesh.n_cells() * n_faces(mesh.shape), -1) {}
  void add(LocalIndex face) { next_[face] = std::exchange(first_[corners_of(mesh_, face, free_)[0]], face); }
  /// The next face after `from` (-1: the first) with the corners of this one; -1 for none.
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

/// Pairs faces that lie on tied sides with those that they are tied to.
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

/// For each face of a local cell [cell * n_faces + local face] the same face of the local cell across it, -1 for none;
/// across tied sides, too.
std::vector<LocalIndex> faces_across(const Mesh& mesh) {
  const int n_faces = mesh::n_faces(mesh.shape);
  std::vector<LocalIndex> across(static_cast<std::size_t>(mesh.n_cells()) * n_faces, -1), alone;
  std::vector<char> on_fracture(across.size(), 0);
  for (const auto& face : mesh.fracture_faces)
    for (int side : {minus, plus})
      if (face.cell[side] >= 0) on_fracture[face.cell[side] * n_faces + face.local_face[side]] = 1;
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

/// Whether a cell is the one that numbers and owns its face: it has the lower number of the two.
std::vector<char> find_givers(const Mesh& mesh, const std::vector<LocalIndex>& across) {
  const int n_faces = mesh::n_faces(mesh.shape);
  std::vector<char> gives(across.size());
  for (std::size_t face = 0; face < across.size(); ++face) {
    const GlobalIndex here = mesh.cell_id[face / n_faces],
                      there = across[face] < 0 ? here : mesh.cell_id[across[face] / n_faces];
    gives[face] = here < there || (here == there && static_cast<LocalIndex>(face) >= across[face]);
  }
  return gives;
}

/// Global numbers of the facets of all local cells: those that a cell gives follow those that the cells before it give.
std::vector<GlobalIndex> facet_ids(const Mesh& mesh, const std::vector<LocalIndex>& across,
                                   const std::vector<char>& gives) {
  const int n_faces = mesh::n_faces(mesh.shape);
  const LocalIndex n_owned = mesh.n_owned_cells * n_faces;
  std::vector<GlobalIndex> counts(mesh.n_owned_cells, 0);
  for (LocalIndex face = 0; face < n_owned; ++face) counts[face / n_faces] += gives[face];
  auto next = sums_before({mesh.cell_id.begin(), mesh.cell_id.begin() + mesh.n_owned_cells}, counts, mesh.comm);
  std::vector<GlobalIndex> ids(across.size(), -1);
  for (LocalIndex face = 0; face < n_owned; ++face)
    if (gives[face]) ids[face] = next[face / n_faces]++;
  const GhostExchange exchange(mesh.cell_id, mesh.n_owned_cells, mesh.comm);
  exchange(ids, n_faces);  // the cells around an owned one are local, so what they give is now at hand
  for (LocalIndex face = 0; face < n_owned; ++face)
    if (!gives[face]) ids[face] = ids[across[face]];
  exchange(ids, n_faces);
  return ids;
}

}  // namespace

RCP<const Mesh> with_facets(const RCP<const Mesh>& mesh) {
  std::vector<LocalIndex> across;
  base::collectively(*mesh->comm, [&] { across = faces_across(*mesh); });
  const auto gives = find_givers(*mesh, across);
  const auto ids = facet_ids(*mesh, across, gives);
  const auto facets = rcp(new Facets);
  for (LocalIndex face = 0; face < mesh->n_owned_cells * n_faces(mesh->shape); ++face)
    if (gives[face]) facets->id.push_back(ids[face]);  // ascending, as cells are
  facets->n_owned = static_cast<LocalIndex>(facets->id.size());
  const auto owned = [&] { return std::pair(facets->id.begin(), facets->id.begin() + facets->n_owned); };
  std::vector<GlobalIndex> ghosts;
  for (GlobalIndex id : ids)
    if (!std::binary_search(owned().first, owned().second, id)) ghosts.push_back(id);
  std::sort(ghosts.begin(), ghosts.end());
  ghosts.erase(std::unique(ghosts.begin(), ghosts.end()), ghosts.end());
  facets->id.insert(facets->id.end(), ghosts.begin(), ghosts.end());
  for (GlobalIndex id : ids) {
    const auto [begin, end] = owned();
    const auto found = std::lower_bound(begin, end, id);
    const bool is_owned = found != end && *found == id;
    facets->of_cell.push_back(
        static_cast<LocalIndex>((is_owned ? found : std::lower_bound(end, facets->id.end(), id)) - facets->id.begin()));
  }
  const auto result = rcp(new Mesh(*mesh));
  result->facets = facets;
  return result;
}

}  // namespace sprekk::mesh
