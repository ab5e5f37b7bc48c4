#include "assembly/quarter_points.hpp"

#include "assembly/reference_cell.hpp"
#include "mesh/cell_geometry.hpp"
#include "mesh/tips.hpp"
#include "mesh/union_find.hpp"

#include <algorithm>
#include <vector>

namespace sprekk::assembly {
namespace {

using mesh::GlobalMesh;
using mesh::operator+;
using mesh::operator-;
using mesh::operator*;
using mesh::Vector;

template <Shape shape>
class QuarterPoints {
 public:
  using Cell = ReferenceCell<shape>;
  static constexpr int dim = Cell::dim, n = Cell::n_nodes, n_corners = Cell::n_corners;

  explicit QuarterPoints(GlobalMesh& mesh)
      : mesh_(mesh), before_(mesh.coordinates), edges_(mesh::CellGeometry(shape).edges()), alike_(mesh.n_nodes()) {
    for (std::size_t node = 0; node < mesh.parent_node.size(); ++node)
      alike_.join(static_cast<GlobalIndex>(node), mesh.parent_node[node]);
    for (GlobalIndex node = mesh.n_free_nodes(); node < mesh.n_nodes(); ++node) alike_.join(node, mesh.free_node(node));
  }

  void move() {
    mark();
    do {
      mesh_.coordinates = before_;
      for (GlobalIndex cell : cells_) move_edges(cell);
      if constexpr (!is_simplex(shape))
        for (GlobalIndex cell : cells_) move_inside(cell);
    } while (keep_where_invalid());
  }

 private:
  using Edge = mesh::CellGeometry::Edge;
  enum : char { stays, moves, kept };

  GlobalIndex node(GlobalIndex cell, int k) const { return mesh_.cells[cell * n + k]; }
  char& state(GlobalIndex cell, const Edge& edge) { return state_[alike_.find(node(cell, edge.middle))]; }

  /// Finds the edges that are to move, and the cells that have some.
  void mark() {
    const auto is_tip = mesh::tip_nodes(mesh_);
    if (std::find(is_tip.begin(), is_tip.end(), 1) == is_tip.end()) return;
    state_.assign(mesh_.n_nodes(), stays);
    end_.assign(mesh_.n_nodes(), -1);
    const auto tip = [&](GlobalIndex cell, int corner) { return is_tip[node(cell, corner)] == 1; };
    for (GlobalIndex cell = 0; cell < mesh_.n_cells(); ++cell) {
      const bool collapses = has_face_of_tips([&](int corner) { return tip(cell, corner); });
      for (const auto& edge : edges_) {
        if (collapses) state(cell, edge) = kept;
        if (tip(cell, edge.from) == tip(cell, edge.to) || state(cell, edge) == kept) continue;
        state(cell, edge) = moves;
        end_[alike_.find(node(cell, edge.middle))] =
            alike_.find(node(cell, tip(cell, edge.from) ? edge.from : edge.to));
      }
    }
    for (GlobalIndex cell = 0; cell < mesh_.n_cells(); ++cell)
      if (is_moved(cell)) cells_.push_back(cell);
  }

  template <class Tip>
  static bool has_face_of_tips(const Tip& tip) {
    const auto faces = mesh::face_nodes(shape);
    return std::any_of(faces.begin(), faces.begin() + mesh::n_faces(shape), [&](const auto& face) {
      return std::all_of(face.begin(), face.begin() + mesh::n_face_corners(shape), tip);
    });
  }

  bool is_moved(GlobalIndex cell) {
    return std::any_of(edges_.begin(), edges_.end(), [&](const Edge& edge) { return state(cell, edge) == moves; });
  }

  void move_edges(GlobalIndex cell) {
    for (const auto& edge : edges_) {
      if (state(cell, edge) != moves) continue;
      const GlobalIndex middle = node(cell, edge.middle), from = node(cell, edge.from), to = node(cell, edge.to);
      const bool starts = alike_.find(from) == end_[alike_.find(middle)];
      const Vector tip = point(mesh_, starts ? from : to), other = point(mesh_, starts ? to : from);
      put(middle, tip + 0.25 * (other - tip));
    }
  }

  /// Nodes inside of faces with an edge that moved, and inside of the cell.
  void move_inside(GlobalIndex cell) {
    if (!is_moved(cell)) return;
    std::vector<int> all(n_corners);
    for (int k = 0; k < n_corners; ++k) all[k] = k;
    for (const auto& edge : edges_) all.push_back(edge.middle);
    put_inside(cell, all, n - 1);
    if constexpr (dim == 3)
      for (const auto& face : mesh::face_nodes(shape))
        if (std::any_of(edges_.begin(), edges_.end(), [&](const Edge& edge) {
              return state(cell, edge) == moves &&
                     std::find(face.begin() + 4, face.end() - 1, edge.middle) != face.end() - 1;
            }))
          put_inside(cell, {face.begin(), face.end() - 1}, face.back());
  }

  /// Puts node `inside` at -1/4 of the sum of the corners plus 1/2 (1/4 in a cell of 3D) of that of the nodes on edges.
  void put_inside(GlobalIndex cell, const std::vector<int>& around, int inside) {
    const std::size_t corners = around.size() == 8 ? 4 : 8;
    const Real share = corners == 4 ? 0.5 : 0.25;
    Vector sum{};
    for (std::size_t k = 0; k < around.size(); ++k)
      sum = sum + (k < corners ? -0.25 : share) * point(mesh_, node(cell, around[k]));
    put(node(cell, inside), sum);
  }

  void put(GlobalIndex node, const Vector& x) { std::copy_n(x.begin(), dim, mesh_.coordinates.begin() + node * dim); }

  /// Keeps the edges of cells that are not valid; whether there are any.
  bool keep_where_invalid() {
    bool any = false;
    for (GlobalIndex cell : cells_) {
      if (!is_moved(cell) || is_valid(cell)) continue;
      any = true;
      for (const auto& edge : edges_) state(cell, edge) = kept;
    }
    return any;
  }

  bool is_valid(GlobalIndex cell) const {
    Real X[n][dim], X_before[n][dim], xi[dim], dN[n][dim];
    for (int a = 0; a < n; ++a)
      for (int i = 0; i < dim; ++i) {
        X[a][i] = mesh_.coordinates[node(cell, a) * dim + i];
        X_before[a][i] = before_[node(cell, a) * dim + i];
      }
    const CurvedQuadrature<shape> rule(X);
    for (int q = 0; q < rule.n; ++q) {
      rule.at(q, xi);
      Cell::gradients(xi, dN);
      if (!(CellPoint<shape>(X, dN).determinant * CellPoint<shape>(X_before, dN).determinant > 0)) return false;
    }
    return true;
  }

  GlobalMesh& mesh_;
  const std::vector<Real> before_;  // coordinates
  const std::vector<Edge> edges_;
  mesh::UnionFind alike_;           // nodes: copies of one another, or tied
  std::vector<char> state_;         // [node on an edge, the first of those alike]
  std::vector<GlobalIndex> end_;    // [node on an edge, the first of those alike] the tip, the first of those alike
  std::vector<GlobalIndex> cells_;  // that have edges to move
};

}  // namespace

void move_to_quarter_points(GlobalMesh& mesh) {
  mesh::for_shape(mesh.shape, [&](auto shape) {
    if constexpr (mesh::order(shape()) == 2) QuarterPoints<shape()>(mesh).move();
  });
}

}  // namespace sprekk::assembly
