#include "assembly/quarter_points.hpp"

#include "assembly/reference_cell.hpp"
#include "mesh/alike_nodes.hpp"
#include "mesh/cell_geometry.hpp"
#include "mesh/tips.hpp"

#include <algorithm>
#include <limits>
#include <vector>

namespace sprekk::assembly {
namespace {

using mesh::operator+;
using mesh::operator-;
using mesh::operator*;
using mesh::Vector;

/// Algorithm for a whole mesh, or collectively for the parts of all ranks.
template <Shape shape, class AnyMesh>
class QuarterPoints {
 public:
  using Cell = ReferenceCell<shape>;
  static constexpr int dim = Cell::dim, n = Cell::n_nodes, n_corners = Cell::n_corners;

  explicit QuarterPoints(AnyMesh& mesh)
      : mesh_(mesh), before_(mesh.coordinates), edges_(mesh::CellGeometry(shape).edges()), alike_(mesh) {}

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
  static constexpr GlobalIndex stays = 0, fixed = std::numeric_limits<GlobalIndex>::max();

  GlobalIndex node(GlobalIndex cell, int k) const { return mesh_.cells[cell * n + k]; }
  GlobalIndex& state(GlobalIndex cell, const Edge& edge) { return state_[node(cell, edge.middle)]; }
  bool moves(GlobalIndex cell, const Edge& edge) { return state(cell, edge) != stays && state(cell, edge) != fixed; }
  Vector at(GlobalIndex node) const {
    Vector x{};
    std::copy_n(&mesh_.coordinates[node * dim], dim, x.begin());
    return x;
  }

  /// Finds the edges to move, and the cells with such edges.
  void mark() {
    const auto is_tip = mesh::tip_nodes(mesh_);
    state_.assign(mesh_.n_nodes(), stays);
    const auto tip = [&](GlobalIndex cell, int corner) { return is_tip[node(cell, corner)] == 1; };
    for (GlobalIndex cell = 0; cell < mesh_.n_cells(); ++cell) {
      const bool collapses = has_face_of_tips([&](int corner) { return tip(cell, corner); });
      for (const auto& edge : edges_) {
        if (collapses) state(cell, edge) = fixed;
        if (tip(cell, edge.from) == tip(cell, edge.to) || state(cell, edge) == fixed) continue;
        state(cell, edge) = 1 + alike_[node(cell, tip(cell, edge.from) ? edge.from : edge.to)];
      }
    }
    alike_.to_largest(state_);
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
    return std::any_of(edges_.begin(), edges_.end(), [&](const Edge& edge) { return moves(cell, edge); });
  }

  void move_edges(GlobalIndex cell) {
    for (const auto& edge : edges_) {
      if (!moves(cell, edge)) continue;
      const GlobalIndex middle = node(cell, edge.middle), from = node(cell, edge.from), to = node(cell, edge.to);
      const bool starts = state(cell, edge) == 1 + alike_[from];
      const Vector tip = at(starts ? from : to), other = at(starts ? to : from);
      put(middle, tip + 0.25 * (other - tip));
    }
  }

  /// Moves the nodes inside the cell and inside faces with a moved edge.
  void move_inside(GlobalIndex cell) {
    if (!is_moved(cell)) return;
    std::vector<int> all(n_corners);
    for (int k = 0; k < n_corners; ++k) all[k] = k;
    for (const auto& edge : edges_) all.push_back(edge.middle);
    put_inside(cell, all, n - 1);
    if constexpr (dim == 3)
      for (const auto& face : mesh::face_nodes(shape))
        if (std::any_of(edges_.begin(), edges_.end(), [&](const Edge& edge) {
              return moves(cell, edge) && std::find(face.begin() + 4, face.end() - 1, edge.middle) != face.end() - 1;
            }))
          put_inside(cell, {face.begin(), face.end() - 1}, face.back());
  }

  /// Sets node `inside` to -1/4 of the sum of the corners plus 1/2 of the sum of the edge nodes (1/4 for 3D cells).
  void put_inside(GlobalIndex cell, const std::vector<int>& around, int inside) {
    const std::size_t corners = around.size() == 8 ? 4 : 8;
    const Real share = corners == 4 ? 0.5 : 0.25;
    Vector sum{};
    for (std::size_t k = 0; k < around.size(); ++k)
      sum = sum + (k < corners ? -0.25 : share) * at(node(cell, around[k]));
    put(node(cell, inside), sum);
  }

  void put(GlobalIndex node, const Vector& x) { std::copy_n(x.begin(), dim, mesh_.coordinates.begin() + node * dim); }

  /// Restores the edges of invalid cells. Returns whether any cell was invalid.
  bool keep_where_invalid() {
    bool any = false;
    for (GlobalIndex cell : cells_) {
      if (!is_moved(cell) || is_valid(cell)) continue;
      any = true;
      for (const auto& edge : edges_) state(cell, edge) = fixed;
    }
    if (!alike_.any(any)) return false;
    alike_.to_largest(state_);
    return true;
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

  AnyMesh& mesh_;
  const std::vector<Real> before_;  // original coordinates
  const std::vector<Edge> edges_;
  mesh::AlikeNodes alike_;
  std::vector<GlobalIndex> state_;  // [node on an edge] stays, fixed, or 1 + the set of the tip to which it moves
  std::vector<GlobalIndex> cells_;  // cells with moved edges
};

template <class AnyMesh>
void move_in(AnyMesh& mesh) {
  mesh::for_shape(mesh.shape, [&](auto shape) {
    if constexpr (mesh::order(shape()) == 2) QuarterPoints<shape(), AnyMesh>(mesh).move();
  });
}

}  // namespace

void move_to_quarter_points(mesh::GlobalMesh& mesh) { move_in(mesh); }
void move_to_quarter_points(mesh::Mesh& mesh) { move_in(mesh); }

}  // namespace sprekk::assembly
