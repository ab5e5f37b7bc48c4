#include "mesh/bisect.hpp"

#include "base/check.hpp"
#include "mesh/facets.hpp"
#include "mesh/raise_order.hpp"
#include "mesh/split.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>
#include <unordered_map>

namespace sprekk::mesh {

namespace {

/// opposite() returns the corner opposite to a face of a simplex, face_opposite() the face opposite to a corner.
int opposite(int dim, int local_face) { return dim == 2 ? (local_face + 2) % 3 : local_face; }
int face_opposite(int dim, int corner) { return dim == 2 ? (corner + 1) % 3 : corner; }

}  // namespace

/// Nodes at the midpoints of edges.
class Bisection::Middles {
 public:
  Middles(std::vector<Real>& coordinates, int dim) : coordinates_(coordinates), dim_(dim) {}

  bool has(GlobalIndex a, GlobalIndex b) const { return known_.count(key(a, b)) > 0; }

  /// Returns the midpoint node; adds it if necessary.
  GlobalIndex at(GlobalIndex a, GlobalIndex b) {
    const auto n = static_cast<GlobalIndex>(coordinates_.size()) / dim_;
    const auto [found, is_new] = known_.emplace(key(a, b), n);
    for (int i = 0; i < dim_ && is_new; ++i)
      coordinates_.push_back((coordinates_[a * dim_ + i] + coordinates_[b * dim_ + i]) / 2);
    return found->second;
  }

 private:
  std::vector<Real>& coordinates_;
  int dim_;
  std::unordered_map<SortedCorners, GlobalIndex, SortedCornersHash> known_;

  static SortedCorners key(GlobalIndex a, GlobalIndex b) { return {std::min(a, b), std::max(a, b), -1, -1}; }
};

/// Selects the longest of some edges of a cell. Among edges of equal length (up to rounding), the coordinates of the
/// midpoint decide. The selection thus depends on positions, not on numbers.
class Bisection::Longest {
 public:
  Longest(const std::vector<Real>& coordinates, int dim) : coordinates_(coordinates), dim_(dim) {
    Real size = 0;
    for (const Real x : coordinates) size = std::max(size, std::abs(x));
    scale_ = size > 0 ? std::ldexp(1, 30 - std::ilogb(size)) : 1;
  }

  Edge operator()(const Cell& cell, std::initializer_list<Edge> edges) const {
    return *std::max_element(edges.begin(), edges.end(),
                             [&](const Edge& a, const Edge& b) { return key(cell, a) < key(cell, b); });
  }

 private:
  using Key = std::array<long long, 4>;

  const std::vector<Real>& coordinates_;
  int dim_;
  Real scale_;

  Key key(const Cell& cell, const Edge& edge) const {
    Key key{};
    Real square = 0;
    for (int i = 0; i < dim_; ++i) {
      const Real a = coordinates_[cell.node[edge[0]] * dim_ + i], b = coordinates_[cell.node[edge[1]] * dim_ + i];
      square += (a - b) * (a - b);
      key[i + 1] = std::llround((a + b) / 2 * scale_);
    }
    key[0] = std::llround(std::sqrt(square) * scale_);
    return key;
  }
};

Bisection::Bisection(const GlobalMesh& mesh) : dim_(mesh.dim()) {
  SPREKK_CHECK(is_simplex(mesh.shape) && order(mesh.shape) == 1 && mesh.tied_to.empty(),
               "bisection: needs triangles or tetrahedra of order 1 without periodic sides");
  empty_.shape = mesh.shape;
  empty_.region_names = mesh.region_names;
  empty_.boundary_names = mesh.boundary_names;
  empty_.fracture_names = mesh.fracture_names;
  empty_.single_fractures = mesh.single_fractures;
  const int n = n_corners(mesh.shape);
  std::vector<GlobalIndex> number(mesh.n_nodes(), -1);  // numbers of points, in the order of their nodes
  for (GlobalIndex node = 0; node < mesh.n_nodes(); ++node) {
    if (mesh.point_of(node) != node) continue;
    number[node] = static_cast<GlobalIndex>(coordinates_.size()) / dim_;
    coordinates_.insert(coordinates_.end(), &mesh.coordinates[node * dim_], &mesh.coordinates[node * dim_] + dim_);
  }
  for (GlobalIndex c = 0; c < mesh.n_cells(); ++c) {
    Cell cell{{-1, -1, -1, -1}, {-1, -1, -1, -1}, mesh.cell_region[c], {}, {}, false};
    for (int k = 0; k < n; ++k) cell.node[k] = number[mesh.point_of(mesh.cells[c * n + k])];
    cells_.push_back(cell);
  }
  take_faces(mesh);
  mark_edges();
}

void Bisection::take_faces(const GlobalMesh& mesh) {
  std::map<std::tuple<int, int, int, int>, int> known;
  const auto put = [&](GlobalIndex cell, int local_face, const Label& label) {
    const auto [found, is_new] = known.emplace(std::tuple(label.boundary, label.fracture, label.single, label.side),
                                               static_cast<int>(labels_.size()));
    if (is_new) labels_.push_back(label);
    cells_[cell].label[opposite(dim_, local_face)] = found->second;
  };
  for (const auto& face : mesh.boundary_faces) put(face.cell, face.local_face, {face.boundary});
  for (const auto& face : mesh.fracture_faces)
    for (int side : {minus, plus}) put(face.cell[side], face.local_face[side], {-1, face.fracture, face.single, side});
}

void Bisection::mark_edges() {
  const Longest longest(coordinates_, dim_);
  for (auto& cell : cells_) {
    if (dim_ == 2) {
      cell.edge = longest(cell, {{0, 1}, {1, 2}, {0, 2}});
      continue;
    }
    cell.edge = longest(cell, {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}});
    for (int end : {0, 1}) {
      signed char corner[3];
      for (signed char k = 0, n = 0; k < 4; ++k)
        if (k != cell.edge[end]) corner[n++] = k;
      cell.marked[end] = longest(cell, {{corner[0], corner[1]}, {corner[0], corner[2]}, {corner[1], corner[2]}});
    }
  }
}

/// Child that contains the end `keeps` of the refinement edge; the midpoint replaces the other end.
Bisection::Cell Bisection::child(const Cell& parent, int keeps, GlobalIndex middle) const {
  const signed char a = parent.edge[keeps], n = parent.edge[1 - keeps];
  Cell child = parent;
  child.node[n] = middle;
  child.label[a] = -1;  // new face between the children
  if (dim_ == 2) {
    child.edge = {a, static_cast<signed char>(3 - a - n)};
    return child;
  }
  const auto is_end = [&](signed char k) { return k == a || k == n; };
  signed char third = -1;  // corner of a marked edge that is not on the refinement edge; unique if coplanar
  bool planar = true;
  for (const auto& edge : parent.marked)
    for (const signed char k : edge)
      if (!is_end(k)) planar = planar && (third < 0 || third == k), third = k;
  child.edge = parent.marked[1 - keeps];
  child.flag = planar && !parent.flag;
  for (int end : {0, 1}) {  // the opposite face contains the other end, the last corner and the new node
    const signed char other = child.edge[1 - end];
    const auto last = static_cast<signed char>(6 - n - child.edge[0] - child.edge[1]);
    const bool is_new = child.edge[end] == a;
    child.marked[end] = is_new && planar && parent.flag ? Edge{n, third} : Edge{other, last};
  }
  return child;
}

std::vector<GlobalIndex> Bisection::refine(const std::vector<GlobalIndex>& cells, int times) {
  Middles middles(coordinates_, dim_);
  std::vector<int> wanted(cells_.size(), 0);
  for (const GlobalIndex cell : cells) {
    SPREKK_CHECK(cell >= 0 && cell < static_cast<GlobalIndex>(cells_.size()),
                 "cell {} cannot be bisected: the mesh has {} cells; has the mesh changed since the checkpoint?", cell,
                 cells_.size());
    wanted[cell] = times;
  }
  std::vector<GlobalIndex> parent(cells_.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto hangs = [&](const Cell& cell) {
    for (int b = 0; b <= dim_; ++b)
      for (int a = 0; a < b; ++a)
        if (middles.has(cell.node[a], cell.node[b])) return true;
    return false;
  };
  for (bool any = true; any;) {
    any = false;
    std::vector<Cell> next;
    std::vector<int> next_wanted;
    std::vector<GlobalIndex> next_parent;
    next.reserve(cells_.size());
    for (std::size_t c = 0; c < cells_.size(); ++c) {
      const auto& cell = cells_[c];
      const bool cut = wanted[c] > 0 || hangs(cell);
      any = any || cut;
      if (cut) {
        const auto middle = middles.at(cell.node[cell.edge[0]], cell.node[cell.edge[1]]);
        for (int end : {0, 1}) next.push_back(child(cell, end, middle));
      } else {
        next.push_back(cell);
      }
      next_wanted.resize(next.size(), std::max(wanted[c] - 1, 0));
      next_parent.resize(next.size(), parent[c]);
    }
    cells_ = std::move(next);
    wanted = std::move(next_wanted);
    parent = std::move(next_parent);
  }
  return parent;
}

GlobalMesh Bisection::mesh(int order) const {
  GlobalMesh mesh = empty_;
  mesh.coordinates = coordinates_;
  for (const auto& cell : cells_) {
    mesh.cells.insert(mesh.cells.end(), cell.node.begin(), cell.node.begin() + dim_ + 1);
    mesh.cell_region.push_back(cell.region);
  }
  if (order == 2) mesh = raise_order(std::move(mesh));
  add_faces(mesh);
  return split_along_faces(std::move(mesh));
}

/// Adds the boundary and fracture faces. Fracture faces are in the order of their minus cells.
void Bisection::add_faces(GlobalMesh& mesh) const {
  using Face = std::pair<GlobalIndex, int>;
  std::unordered_map<SortedCorners, Face, SortedCornersHash> on_plus;
  const auto for_side = [&](int side, const auto& use) {
    for (GlobalIndex c = 0; c < n_cells(); ++c)
      for (int k = 0; k <= dim_; ++k)
        if (const int label = cells_[c].label[k]; label >= 0 && labels_[label].side == side)
          use(labels_[label], c, face_opposite(dim_, k));
  };
  for_side(plus, [&](const Label&, GlobalIndex cell, int face) {
    on_plus[sorted_corners(mesh, cell, face)] = {cell, face};
  });
  for_side(minus, [&](const Label& label, GlobalIndex cell, int face) {
    if (label.boundary >= 0) {
      mesh.boundary_faces.push_back({label.boundary, cell, face});
      return;
    }
    const auto [other, other_face] = on_plus.at(sorted_corners(mesh, cell, face));
    mesh.fracture_faces.push_back({label.fracture, {cell, other}, {face, other_face}, label.single});
  });
}

}  // namespace sprekk::mesh
