#include "mesh/without_regions.hpp"

#include <algorithm>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "base/check.hpp"
#include "base/over_ranks.hpp"
#include "mesh/exchange.hpp"
#include "mesh/facets.hpp"
#include "mesh/number_facets.hpp"
#include "mesh/union_find.hpp"

namespace sprekk::mesh {
namespace {

/// Remaining entities of one kind, owned ones first.
struct Left {
  std::vector<LocalIndex> old;  ///< [entity] local number in the whole mesh
  std::vector<LocalIndex> now;  ///< [entity of the whole mesh] local number; -1 if removed
  LocalIndex n_owned = 0;

  explicit Left(LocalIndex n = 0) : now(n, -1) {}
  void add(LocalIndex entity) {
    now[entity] = static_cast<LocalIndex>(old.size());
    old.push_back(entity);
  }
  template <class T>
  std::vector<T> of(const std::vector<T>& all, int width = 1) const {
    std::vector<T> part;
    for (const LocalIndex entity : old)
      for (int k = 0; k < width; ++k) part.push_back(all[entity * width + k]);
    return part;
  }
};

class Excavation {
 public:
  Excavation(const Mesh& whole, const std::vector<std::string>& regions) : whole_(whole), mesh_(whole) {
    boundary_of_.assign(whole.region_names.size(), -1);
    for (const auto& name : regions) {
      const auto region = std::find(whole.region_names.begin(), whole.region_names.end(), name);
      SPREKK_CHECK(region != whole.region_names.end(), "the mesh has no region \"{}\" to be excavated", name);
      auto& names = mesh_.boundary_names;
      const auto found = std::find(names.begin(), names.end(), name);
      boundary_of_[region - whole.region_names.begin()] = static_cast<int>(found - names.begin());
      if (found == names.end()) names.push_back(name);
    }
    SPREKK_CHECK(!base::any_rank(*whole.comm, [&] { return !whole.tied_to.empty(); }),
                 "regions cannot be excavated in a mesh with periodic sides");
  }

  RCP<const Mesh> mesh() {
    find_cells();
    find_nodes();
    find_fracture_faces();
    find_boundary_faces();
    find_enriched();
    find_pieces();
    mesh_.facets = Teuchos::null;
    mesh_.origin = origin_;
    const auto result = rcp(new const Mesh(std::move(mesh_)));
    return whole_.facets.is_null() ? result : with_origin_of_facets(with_facets(result, whole_.facets->in_rock));
  }

 private:
  bool is_gone(LocalIndex cell) const { return boundary_of_[whole_.cell_region[cell]] >= 0; }

  /// Returns numbers 0, 1, ... in the order of the old numbers. Collective.
  std::vector<GlobalIndex> renumbered(const std::vector<GlobalIndex>& old, LocalIndex n_owned) const {
    const std::vector<GlobalIndex> owned(old.begin(), old.begin() + n_owned);
    auto numbers = sums_before(owned, std::vector<GlobalIndex>(n_owned, 1), whole_.comm);
    numbers.resize(old.size(), -1);
    GhostExchange(old, n_owned, whole_.comm)(numbers);
    return numbers;
  }
  GlobalIndex count(LocalIndex n_owned) const {
    return base::sum_over_ranks(*whole_.comm, static_cast<GlobalIndex>(n_owned));
  }

  void find_cells() {
    cells_ = Left(whole_.n_cells());
    for (LocalIndex cell = 0; cell < whole_.n_cells(); ++cell) {
      if (cell == whole_.n_owned_cells) cells_.n_owned = static_cast<LocalIndex>(cells_.old.size());
      if (!is_gone(cell)) cells_.add(cell);
    }
    if (whole_.n_cells() == whole_.n_owned_cells) cells_.n_owned = static_cast<LocalIndex>(cells_.old.size());
    mesh_.n_owned_cells = cells_.n_owned;
    mesh_.n_global_cells = count(cells_.n_owned);
    SPREKK_CHECK(mesh_.n_global_cells > 0, "all cells of the mesh would be excavated");
    origin_->cells = cells_.of(whole_.cell_id);
    mesh_.cell_id = renumbered(origin_->cells, cells_.n_owned);
    mesh_.cell_owner = cells_.of(whole_.cell_owner);
    mesh_.cell_region = cells_.of(whole_.cell_region);
    mesh_.cells = cells_.of(whole_.cells, whole_.nodes_per_cell());
  }

  /// Selects the remaining nodes. A node belongs to the lowest rank that owns a cell at the node. All cells at the
  /// nodes of owned cells are local.
  void find_nodes() {
    const int n = whole_.nodes_per_cell(), rank = whole_.comm->getRank(), none = whole_.comm->getSize();
    std::vector<int> owner(whole_.n_nodes(), none);
    for (std::size_t k = 0; k < mesh_.cells.size(); ++k)
      owner[mesh_.cells[k]] = std::min(owner[mesh_.cells[k]], mesh_.cell_owner[k / n]);
    std::vector<LocalIndex> by_number(whole_.n_nodes());
    std::iota(by_number.begin(), by_number.end(), 0);
    std::sort(by_number.begin(), by_number.end(),
              [&](LocalIndex a, LocalIndex b) { return whole_.node_id[a] < whole_.node_id[b]; });
    nodes_ = Left(whole_.n_nodes());
    for (const bool owned : {true, false}) {
      for (const LocalIndex node : by_number)
        if (owner[node] != none && (owner[node] == rank) == owned) nodes_.add(node);
      if (owned) nodes_.n_owned = static_cast<LocalIndex>(nodes_.old.size());
    }
    mesh_.n_owned_nodes = nodes_.n_owned;
    mesh_.n_free_nodes = static_cast<LocalIndex>(nodes_.old.size());
    mesh_.n_global_nodes = count(nodes_.n_owned);
    origin_->nodes = nodes_.of(whole_.node_id);
    mesh_.node_id = renumbered(origin_->nodes, nodes_.n_owned);
    mesh_.coordinates = nodes_.of(whole_.coordinates, whole_.dim());
    if (!whole_.tip.empty()) mesh_.tip = nodes_.of(whole_.tip);
    for (auto& node : mesh_.cells) node = nodes_.now[node];
  }

  /// Returns for each fracture face the new boundary at its remaining side; -1 if both sides remain. If both are
  /// removed, it is the boundary of the minus side. The owner, which has both cells, sends the result to the other
  /// ranks.
  std::vector<int> lost_to() const {
    std::vector<int> lost;
    std::vector<GlobalIndex> ids;
    for (const auto& face : whole_.fracture_faces) {
      ids.push_back(face.id);
      lost.push_back(-1);
      for (const int side : {plus, minus})
        if (face.cell[side] >= 0 && is_gone(face.cell[side]))
          lost.back() = boundary_of_[whole_.cell_region[face.cell[side]]];
    }
    GhostExchange(ids, whole_.n_owned_fracture_faces, whole_.comm)(lost);
    return lost;
  }

  void find_fracture_faces() {
    lost_to_ = lost_to();
    std::vector<Mesh::FractureFace> faces;
    for (LocalIndex f = 0; f < whole_.n_fracture_faces(); ++f) {
      if (f == whole_.n_owned_fracture_faces) mesh_.n_owned_fracture_faces = static_cast<LocalIndex>(faces.size());
      if (lost_to_[f] >= 0) continue;
      auto face = whole_.fracture_faces[f];
      for (const int side : {minus, plus}) {
        if (face.cell[side] >= 0) face.cell[side] = cells_.now[face.cell[side]];
        for (auto& node : face.nodes[side])
          if (node >= 0) node = nodes_.now[node];
      }
      faces.push_back(face);
      old_faces_.push_back(f);
      origin_->fracture_faces.push_back(face.id);
    }
    if (whole_.n_fracture_faces() == whole_.n_owned_fracture_faces)
      mesh_.n_owned_fracture_faces = static_cast<LocalIndex>(faces.size());
    mesh_.n_global_fracture_faces = count(mesh_.n_owned_fracture_faces);
    const auto ids = renumbered(origin_->fracture_faces, mesh_.n_owned_fracture_faces);
    for (std::size_t f = 0; f < faces.size(); ++f) faces[f].id = ids[f];
    mesh_.fracture_faces = std::move(faces);
  }

  /// Nodes at the corners of a face [cell * n_faces + local face] of the whole mesh, sorted.
  SortedCorners corners(LocalIndex face) const {
    const int n_faces = mesh::n_faces(whole_.shape), n = n_face_corners(whole_.shape);
    SortedCorners sorted{-1, -1, -1, -1};
    for (int k = 0; k < n; ++k)
      sorted[k] = whole_.cells[face / n_faces * whole_.nodes_per_cell() + face_nodes(whole_.shape)[face % n_faces][k]];
    std::sort(sorted.begin(), sorted.begin() + n);
    return sorted;
  }

  /// [cell * n_faces + local face] local fracture face there, or -1.
  std::vector<LocalIndex> fracture_face_at() const {
    const int n_faces = mesh::n_faces(whole_.shape);
    std::vector<LocalIndex> at(std::size_t(whole_.n_cells()) * n_faces, -1);
    for (LocalIndex f = 0; f < whole_.n_fracture_faces(); ++f)
      for (const int side : {minus, plus}) {
        const auto& face = whole_.fracture_faces[f];
        if (face.cell[side] >= 0) at[face.cell[side] * n_faces + face.local_face[side]] = f;
      }
    return at;
  }

  void find_boundary_faces() {
    const int n_faces = mesh::n_faces(whole_.shape);
    const auto fracture_face = fracture_face_at();
    std::unordered_map<SortedCorners, int, SortedCornersHash> walls;  // boundaries by corners of faces
    std::vector<Mesh::BoundaryFace> faces;
    const auto add = [&](int boundary, LocalIndex cell, int local_face) {
      faces.push_back({boundary, cells_.now[cell], local_face, cell < whole_.n_owned_cells});
    };
    for (const auto& face : whole_.boundary_faces)
      if (!is_gone(face.cell)) add(face.boundary, face.cell, face.local_face);
    for (LocalIndex face = 0; face < whole_.n_cells() * n_faces; ++face)
      if (is_gone(face / n_faces) && fracture_face[face] < 0)
        walls.emplace(corners(face), boundary_of_[whole_.cell_region[face / n_faces]]);
    for (LocalIndex face = 0; face < whole_.n_cells() * n_faces; ++face) {
      const LocalIndex cell = face / n_faces, f = fracture_face[face];
      if (is_gone(cell)) continue;
      if (f >= 0) {
        if (lost_to_[f] >= 0) add(lost_to_[f], cell, face % n_faces);
      } else if (const auto wall = walls.find(corners(face)); wall != walls.end()) {
        add(wall->second, cell, face % n_faces);
      }
    }
    std::stable_partition(faces.begin(), faces.end(), [](const auto& face) { return face.owned; });
    mesh_.boundary_faces = std::move(faces);
  }

  /// Finds the nodes that are not tips but belong to a remaining cell with a tip.
  void find_enriched() {
    if (whole_.enriched.empty()) return;
    const int n = whole_.nodes_per_cell();
    std::vector<char> near(mesh_.n_nodes(), 0);
    for (LocalIndex cell = 0; cell < mesh_.n_cells(); ++cell) {
      const auto first = mesh_.cells.begin() + cell * n;
      if (std::any_of(first, first + n, [&](LocalIndex node) { return mesh_.tip[node]; }))
        std::for_each(first, first + n, [&](LocalIndex node) { near[node] = !mesh_.tip[node]; });
    }
    std::vector<LocalIndex> numbers(mesh_.n_nodes(), -1);
    mesh_.n_owned_enriched = 0;
    for (LocalIndex node = 0; node < mesh_.n_nodes(); ++node) {
      const LocalIndex old = whole_.enriched[nodes_.old[node]];
      if (!near[node] || old < 0) continue;
      numbers[node] = static_cast<LocalIndex>(origin_->enriched.size());
      origin_->enriched.push_back(whole_.enriched_id[old]);
      if (node < mesh_.n_owned_nodes) ++mesh_.n_owned_enriched;
    }
    mesh_.enriched = std::move(numbers);
    mesh_.enriched_id = renumbered(origin_->enriched, mesh_.n_owned_enriched);
    mesh_.n_global_enriched = count(mesh_.n_owned_enriched);
  }

  /// Numbers the pieces. The cells of a piece get their lowest number, exchanged between ranks until no value changes.
  void find_pieces() {
    const int n_faces = mesh::n_faces(whole_.shape);
    const auto fracture_face = fracture_face_at();
    UnionFind sets(mesh_.n_cells());
    std::unordered_map<SortedCorners, LocalIndex, SortedCornersHash> seen;
    for (LocalIndex face = 0; face < whole_.n_cells() * n_faces; ++face) {
      const LocalIndex cell = cells_.now[face / n_faces];
      if (cell < 0 || fracture_face[face] >= 0) continue;
      const auto [other, is_new] = seen.emplace(corners(face), cell);
      if (!is_new) sets.join(other->second, cell);
    }
    const GhostExchange exchange(mesh_.cell_id, mesh_.n_owned_cells, whole_.comm);
    auto lowest = mesh_.cell_id;
    for (bool changes = true; changes;) {
      const auto before = lowest;
      for (LocalIndex cell = 0; cell < mesh_.n_cells(); ++cell) {
        auto& of_set = lowest[sets.find(cell)];
        of_set = std::min(of_set, lowest[cell]);
      }
      for (LocalIndex cell = 0; cell < mesh_.n_cells(); ++cell) lowest[cell] = lowest[sets.find(cell)];
      exchange(lowest);
      changes = base::on_any_rank(*whole_.comm, lowest != before);
    }
    std::vector<GlobalIndex> first;  // cells with the lowest number in a piece
    for (LocalIndex cell = 0; cell < mesh_.n_owned_cells; ++cell)
      if (lowest[cell] == mesh_.cell_id[cell]) first.push_back(lowest[cell]);
    first = base::gather_over_ranks(*whole_.comm, first);
    std::sort(first.begin(), first.end());
    mesh_.n_pieces = static_cast<int>(first.size());
    mesh_.cell_piece.clear();
    for (const GlobalIndex number : lowest)
      mesh_.cell_piece.push_back(
          static_cast<int>(std::lower_bound(first.begin(), first.end(), number) - first.begin()));
  }

  /// Sets the numbers of facets in the whole mesh, from those of cells, fracture faces and ridges.
  RCP<const Mesh> with_origin_of_facets(const RCP<const Mesh>& mesh) {
    auto& numbers = origin_->facets;
    numbers.assign(mesh->facets->id.size(), -1);
    const auto take = [&](const std::vector<LocalIndex>& of, const std::vector<LocalIndex>& old,
                          const std::vector<LocalIndex>& whole_of, int width) {
      for (std::size_t k = 0; k < of.size(); ++k)
        if (of[k] >= 0) numbers[of[k]] = whole_.facets->id[whole_of[old[k / width] * width + k % width]];
    };
    take(mesh->facets->of_cell, cells_.old, whole_.facets->of_cell, n_faces(whole_.shape));
    take(mesh->facets->ridge, old_faces_, whole_.facets->ridge, n_face_corners(whole_.shape));
    take(mesh->facets->fracture_face, old_faces_, whole_.facets->fracture_face, 1);
    return mesh;
  }

  const Mesh& whole_;
  Mesh mesh_;
  RCP<Mesh::Origin> origin_ = rcp(new Mesh::Origin);
  std::vector<int> boundary_of_;  // [region] boundary of the walls; -1 for remaining regions
  Left cells_, nodes_;
  std::vector<LocalIndex> old_faces_;  // [fracture face] local number in the whole mesh
  std::vector<int> lost_to_;           // [fracture face of the whole mesh] see lost_to()
};

}  // namespace

RCP<const Mesh> without_regions(const RCP<const Mesh>& whole, const std::vector<std::string>& regions) {
  return regions.empty() ? whole : Excavation(*whole, regions).mesh();
}

}  // namespace sprekk::mesh
