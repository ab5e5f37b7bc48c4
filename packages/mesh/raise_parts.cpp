#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <utility>

#include "base/check.hpp"
#include "base/over_ranks.hpp"
#include "mesh/cell_geometry.hpp"
#include "mesh/exchange.hpp"
#include "mesh/raise_order.hpp"
#include "mesh/union_find.hpp"

namespace sprekk::mesh {
namespace {

/// Finder of common nodes. Places for added nodes have the numbers [cell * n_added + k]. Places with the same corners
/// form one node. In fractures, this requires cells connected through faces outside fractures. All places of a node of
/// an owned cell are on this rank, so all ranks with an owned cell at the node agree. Ghosts get their nodes from their
/// owners.
class PlaceFinder {
 public:
  explicit PlaceFinder(const Mesh& mesh)
      : mesh_(mesh),
        shape_(quadratic(mesh.shape)),
        n_before_(n_corners(mesh.shape)),
        n_added_(n_nodes(shape_) - n_before_),
        corners_(corners_of_nodes(shape_)),
        first_(mesh.n_cells() * n_added_),
        sets_(mesh.n_cells() * n_added_) {}

  /// Returns the sets of places that form one node.
  UnionFind find() {
    find_same_corners();
    find_in_fractures();
    for (LocalIndex place = 0; place < n_places(); ++place)
      if (!in_fracture_[first_[place]]) sets_.join(place, first_[place]);
    join_around_fractures();
    return std::move(sets_);
  }

 private:
  using Corners = std::array<LocalIndex, 4>;  ///< sorted; unused entries have the largest number

  const Mesh& mesh_;
  const Shape shape_;
  const int n_before_, n_added_;
  const std::vector<unsigned> corners_;
  std::vector<LocalIndex> first_;  // [place] first place with the same corners
  std::vector<char> in_fracture_;  // [first place]
  UnionFind sets_;

  LocalIndex n_places() const { return static_cast<LocalIndex>(first_.size()); }
  LocalIndex node(LocalIndex cell, int k) const { return mesh_.cells[cell * n_before_ + k]; }

  Corners corners_of(LocalIndex place) const {
    Corners result;
    result.fill(std::numeric_limits<LocalIndex>::max());
    int n = 0;
    for (int k = 0; k < n_before_; ++k)
      if (corners_[n_before_ + place % n_added_] >> k & 1) result[n++] = node(place / n_added_, k);
    std::sort(result.begin(), result.end());
    return result;
  }

  bool is_inside_cell(LocalIndex place) const {
    return corners_[n_before_ + place % n_added_] == (1u << n_before_) - 1;
  }

  /// Finds places with equal corners; places are hashed by their lowest corner, with one chain per node.
  void find_same_corners() {
    std::vector<LocalIndex> chain(mesh_.n_nodes(), -1), next(first_.size(), -1);
    for (LocalIndex place = 0; place < n_places(); ++place) {
      first_[place] = place;
      if (is_inside_cell(place)) continue;
      const auto corners = corners_of(place);
      LocalIndex other = chain[corners[0]];
      while (other >= 0 && corners_of(other) != corners) other = next[other];
      if (other >= 0)
        first_[place] = other;
      else
        next[place] = std::exchange(chain[corners[0]], place);
    }
  }

  /// Calls use(place) for the places on a face of a cell.
  template <class Use>
  void for_places(LocalIndex cell, int local_face, const Use& use) const {
    for (int k = n_face_corners(shape_); k < n_face_nodes(shape_); ++k)
      use(cell * n_added_ + face_nodes(shape_)[local_face][k] - n_before_);
  }

  template <class Use>
  void for_fracture_sides(const Use& use) const {
    for (const auto& face : mesh_.fracture_faces)
      for (int side : {minus, plus})
        if (face.cell[side] >= 0) use(face.cell[side], face.local_face[side]);
  }

  void find_in_fractures() {
    in_fracture_.assign(first_.size(), 0);
    for_fracture_sides([&](LocalIndex cell, int local_face) {
      for_places(cell, local_face, [&](LocalIndex place) { in_fracture_[first_[place]] = 1; });
    });
  }

  void join_around_fractures() {
    const int faces_per_cell = n_faces(shape_);
    std::vector<bool> is_side(static_cast<std::size_t>(mesh_.n_cells()) * faces_per_cell, false);
    for_fracture_sides([&](LocalIndex cell, int local_face) { is_side[cell * faces_per_cell + local_face] = true; });
    std::map<Corners, std::pair<LocalIndex, int>> open;  // faces whose adjacent cell is not found yet
    for (LocalIndex cell = 0; cell < mesh_.n_cells(); ++cell)
      for (int f = 0; f < faces_per_cell; ++f) {
        bool touches = false;
        for_places(cell, f, [&](LocalIndex place) { touches = touches || in_fracture_[first_[place]]; });
        if (!touches || is_side[cell * faces_per_cell + f]) continue;
        const auto [found, is_new] = open.emplace(face_corners(cell, f), std::make_pair(cell, f));
        if (!is_new) join(found->second, {cell, f});
      }
  }

  Corners face_corners(LocalIndex cell, int local_face) const {
    Corners result;
    result.fill(std::numeric_limits<LocalIndex>::max());
    for (int k = 0; k < n_face_corners(shape_); ++k) result[k] = node(cell, face_nodes(shape_)[local_face][k]);
    std::sort(result.begin(), result.end());
    return result;
  }

  void join(const std::pair<LocalIndex, int>& face, const std::pair<LocalIndex, int>& across) {
    for_places(face.first, face.second, [&](LocalIndex a) {
      for_places(across.first, across.second, [&](LocalIndex b) {
        if (first_[a] == first_[b]) sets_.join(a, b);
      });
    });
  }
};

/// Raises the order of a part. Added nodes are numbered in the order of their lowest cells, independent of the
/// distribution.
class PartRaiser {
 public:
  explicit PartRaiser(const Mesh& mesh)
      : mesh_(mesh),
        shape_(quadratic(mesh.shape)),
        n_before_(n_corners(mesh.shape)),
        n_added_(n_nodes(shape_) - n_before_),
        sets_(PlaceFinder(mesh).find()) {}

  RCP<Mesh> raise() {
    find_lowest_cells();
    number();
    list_nodes();
    auto result = rcp(new Mesh(mesh_));
    result->shape = shape_;
    result->n_global_nodes += n_global_added_;
    fill_nodes(*result);
    fill_cells(*result);
    for (auto& face : result->fracture_faces) fill_face(*result, face);
    return result;
  }

 private:
  const Mesh& mesh_;
  const Shape shape_;
  const int n_before_, n_added_;
  UnionFind sets_;
  std::vector<LocalIndex> lowest_;           // [first place of a node] its place in the cell with the lowest number
  std::vector<int> owner_;                   // [first place of a node] rank
  std::vector<GlobalIndex> ids_;             // [place] number of its node
  std::vector<GlobalIndex> owned_, ghosts_;  // numbers of added nodes, ascending
  GlobalIndex n_global_added_ = 0;

  LocalIndex n_places() const { return mesh_.n_cells() * n_added_; }
  LocalIndex n_owned_places() const { return mesh_.n_owned_cells * n_added_; }
  LocalIndex root(LocalIndex place) { return static_cast<LocalIndex>(sets_.find(place)); }

  void find_lowest_cells() {
    lowest_.assign(n_places(), -1);
    owner_.assign(n_places(), std::numeric_limits<int>::max());
    for (LocalIndex place = 0; place < n_places(); ++place) {
      const LocalIndex first = root(place), cell = place / n_added_;
      owner_[first] = std::min(owner_[first], mesh_.cell_owner[cell]);
      if (lowest_[first] < 0 || mesh_.cell_id[cell] < mesh_.cell_id[lowest_[first] / n_added_]) lowest_[first] = place;
    }
  }

  void number() {
    const auto is_new = [&](LocalIndex place) { return lowest_[root(place)] == place; };
    std::vector<GlobalIndex> n_new(mesh_.n_owned_cells, 0);
    for (LocalIndex place = 0; place < n_owned_places(); ++place) n_new[place / n_added_] += is_new(place);
    n_global_added_ = base::sum_over_ranks(*mesh_.comm, std::accumulate(n_new.begin(), n_new.end(), GlobalIndex{0}));
    auto next = sums_before({mesh_.cell_id.begin(), mesh_.cell_id.begin() + mesh_.n_owned_cells}, n_new, mesh_.comm);
    ids_.assign(n_places(), -1);
    for (LocalIndex place = 0; place < n_owned_places(); ++place)
      if (is_new(place)) ids_[place] = mesh_.n_global_nodes + next[place / n_added_]++;
    const GhostExchange exchange(mesh_.cell_id, mesh_.n_owned_cells, mesh_.comm);
    exchange(ids_, n_added_);
    for (LocalIndex place = 0; place < n_owned_places(); ++place) ids_[place] = ids_[lowest_[root(place)]];
    exchange(ids_, n_added_);
  }

  void list_nodes() {
    std::vector<GlobalIndex> all = ids_;
    for (LocalIndex place = 0; place < n_owned_places(); ++place)
      if (root(place) == place && owner_[place] == mesh_.comm->getRank()) owned_.push_back(ids_[place]);
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    std::sort(owned_.begin(), owned_.end());
    std::set_difference(all.begin(), all.end(), owned_.begin(), owned_.end(), std::back_inserter(ghosts_));
  }

  /// New local number of a node: added owned nodes follow the owned ones and precede the ghosts.
  LocalIndex moved(LocalIndex node) const {
    return node < mesh_.n_owned_nodes ? node : node + static_cast<LocalIndex>(owned_.size());
  }

  LocalIndex node_at(LocalIndex place) const {
    const auto owned = std::lower_bound(owned_.begin(), owned_.end(), ids_[place]);
    if (owned != owned_.end() && *owned == ids_[place])
      return mesh_.n_owned_nodes + static_cast<LocalIndex>(owned - owned_.begin());
    const auto ghost = std::lower_bound(ghosts_.begin(), ghosts_.end(), ids_[place]);
    return mesh_.n_nodes() + static_cast<LocalIndex>(owned_.size() + (ghost - ghosts_.begin()));
  }

  void fill_nodes(Mesh& result) const {
    const int dim = mesh_.dim();
    result.n_owned_nodes += static_cast<LocalIndex>(owned_.size());
    result.node_id.insert(result.node_id.begin() + mesh_.n_owned_nodes, owned_.begin(), owned_.end());
    result.node_id.insert(result.node_id.end(), ghosts_.begin(), ghosts_.end());
    result.n_free_nodes = result.n_nodes();
    result.coordinates.insert(result.coordinates.begin() + mesh_.n_owned_nodes * dim, owned_.size() * dim, 0);
    result.coordinates.resize(result.node_id.size() * dim);
  }

  void fill_cells(Mesh& result) const {
    const auto corners = corners_of_nodes(shape_);
    result.cells.clear();
    result.cells.reserve(static_cast<std::size_t>(mesh_.n_cells()) * n_nodes(shape_));
    for (LocalIndex cell = 0; cell < mesh_.n_cells(); ++cell) {
      for (int k = 0; k < n_before_; ++k) result.cells.push_back(moved(mesh_.cells[cell * n_before_ + k]));
      for (int k = 0; k < n_added_; ++k) {
        const LocalIndex node = node_at(cell * n_added_ + k);
        result.cells.push_back(node);
        for (int i = 0; i < mesh_.dim(); ++i)
          result.coordinates[node * mesh_.dim() + i] = mean(cell, corners[n_before_ + k], i);
      }
    }
  }

  /// Mean coordinate of corners, bitwise identical for any order of the corners.
  Real mean(LocalIndex cell, unsigned corners, int component) const {
    std::array<Real, 8> x;
    x.fill(std::numeric_limits<Real>::infinity());
    int n = 0;
    for (int k = 0; k < n_before_; ++k)
      if (corners >> k & 1) x[n++] = mesh_.coordinates[mesh_.cells[cell * n_before_ + k] * mesh_.dim() + component];
    std::sort(x.begin(), x.end());
    return std::accumulate(x.begin(), x.begin() + n, Real{0}) / n;
  }

  /// Sets the nodes of both sides in the order of the minus cell. Added nodes are identified by their corners.
  void fill_face(const Mesh& result, Mesh::FractureFace& face) const {
    const auto before = face.nodes;
    const int n = n_face_corners(shape_);
    for (int side : {minus, plus}) {
      if (face.cell[side] < 0) continue;
      const auto& all = face_nodes(shape_)[face.local_face[side]];
      const auto node = [&](int k) { return result.cells[face.cell[side] * n_nodes(shape_) + all[k]]; };
      std::array<int, 4> corner{};  // for each corner of side minus, the corner of the cell's face
      for (int k = 0; k < n; ++k) {
        face.nodes[side][k] = moved(before[side][k]);
        while (corner[k] < n && node(corner[k]) != face.nodes[side][k]) ++corner[k];
        SPREKK_CHECK(corner[k] < n, "mesh: a corner of fracture face {} is none of its cell", face.id);
      }
      for (int k = n; k < n_face_nodes(shape_); ++k) face.nodes[side][k] = node(partner(corner, k));
    }
  }

  /// Node of a face between the images of the two corners of node k.
  int partner(const std::array<int, 4>& image, int k) const {
    const int n = n_face_corners(shape_);
    if (dimension(shape_) == 2 || k == 2 * n) return k;
    const int a = image[k - n], b = image[(k - n + 1) % n];
    return n + ((a + 1) % n == b ? a : b);
  }
};

}  // namespace

RCP<Mesh> raise_order(const Mesh& mesh) {
  SPREKK_CHECK(order(mesh.shape) == 1 && mesh.tied_to.empty() && mesh.tip.empty(),
               "raise order: needs a mesh of order 1 without periodic sides and crack tips");
  return PartRaiser(mesh).raise();
}

}  // namespace sprekk::mesh
