#include "assembly/quarter_points.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "assembly/geometry.hpp"
#include "base/check.hpp"
#include "mesh/box.hpp"
#include "mesh/cell_geometry.hpp"
#include "mesh/distribute.hpp"
#include "mesh/raise_order.hpp"
#include "mesh/refine.hpp"
#include "mesh/tips.hpp"

namespace sprekk::assembly {
namespace {

using mesh::dot;
using mesh::GlobalMesh;
using mesh::norm;
using mesh::Vector;
using mesh::operator+;
using mesh::operator-;
using mesh::operator*;

bool is_flat(const std::string& cell) { return cell == "triangle" || cell == "quadrilateral"; }

/// Returns a box of unit steps, of order 2, with fractures {lowest x, y, greatest x, y} over the full third direction.
mesh::BoxMesh box(const std::string& cell, std::vector<int> n, const std::vector<std::array<Real, 4>>& fractures) {
  mesh::BoxMesh result;
  result.cell = cell;
  result.order = 2;
  if (is_flat(cell)) n.resize(2);
  result.lower_corner.assign(n.size(), 0);
  result.upper_corner.assign(n.begin(), n.end());
  result.cells = n;
  for (const auto& f : fractures) {
    auto& fracture = result.fractures["f" + std::to_string(result.fractures.size())];
    fracture.lower_corner = {f[0], f[1]};
    fracture.upper_corner = {f[2], f[3]};
    if (is_flat(cell)) continue;
    fracture.lower_corner.push_back(0);
    fracture.upper_corner.push_back(n[2]);
  }
  return result;
}

/// Returns the position of a node on an edge as a fraction of the edge from its first corner; NaN if not on the edge.
Real place_on_edge(const GlobalMesh& mesh, GlobalIndex cell, const mesh::CellGeometry::Edge& edge) {
  const auto x = [&](int k) { return point(mesh, mesh.cells[cell * mesh::n_nodes(mesh.shape) + k]); };
  const Vector along = x(edge.to) - x(edge.from), off = x(edge.middle) - x(edge.from);
  const Real place = dot(off, along) / dot(along, along);
  return norm(off - place * along) < 1e-14 * norm(along) ? place : NAN;
}

/// Visits every edge of every cell: visit(cell, edge, whether its ends are tips, position of its node).
template <class Visit>
void for_each_edge(const GlobalMesh& mesh, const Visit& visit) {
  const auto is_tip = mesh::tip_nodes(mesh);
  const mesh::CellGeometry geometry(mesh.shape);
  for (GlobalIndex cell = 0; cell < mesh.n_cells(); ++cell)
    for (const auto& edge : geometry.edges()) {
      const auto tip = [&](int k) { return is_tip[mesh.cells[cell * mesh::n_nodes(mesh.shape) + k]] == 1; };
      visit(cell, edge, std::array<bool, 2>{tip(edge.from), tip(edge.to)}, place_on_edge(mesh, cell, edge));
    }
}

/// Returns the smallest Jacobian determinant at the points of CurvedQuadrature, and the volume.
std::array<Real, 2> min_determinant_and_volume(const GlobalMesh& mesh) {
  return mesh::for_shape(mesh.shape, [&](auto s) {
    constexpr Shape shape = s();
    constexpr int dim = mesh::dimension(shape), n = mesh::n_nodes(shape);
    std::array<Real, 2> result{1e300, 0};
    for (GlobalIndex cell = 0; cell < mesh.n_cells(); ++cell) {
      Real X[n][dim], xi[dim], dN[n][dim];
      for (int a = 0; a < n; ++a)
        for (int i = 0; i < dim; ++i) X[a][i] = mesh.coordinates[mesh.cells[cell * n + a] * dim + i];
      const CurvedQuadrature<shape> rule(X);
      for (int q = 0; q < rule.n; ++q) {
        const Real weight = rule.at(q, xi);
        ReferenceCell<shape>::gradients(xi, dN);
        const Real determinant = CellPoint<shape>(X, dN).determinant;
        result = {std::min(result[0], determinant), result[1] + weight * determinant};
      }
    }
    return result;
  });
}

TEST(QuarterPoints, OfEdgesFromTips) {
  for (const auto& cell : mesh::testing::all_cells) {
    SCOPED_TRACE(cell);
    auto mesh = make_box(box(cell, {6, 4, 2}, {{1, 2, 4, 2}, {3, 0, 3, 2}}));
    const auto before = mesh;
    move_to_quarter_points(mesh);
    int moved = 0;
    for_each_edge(mesh, [&](GlobalIndex c, const auto& edge, const auto& tip, Real place) {
      EXPECT_NEAR(place, tip[0] == tip[1] ? 0.5 : tip[0] ? 0.25 : 0.75, 1e-14) << "cell " << c;
      moved += tip[0] != tip[1];
    });
    EXPECT_GE(moved, 2 * 4 * (is_flat(cell) ? 1 : 3));
    const auto [minimum, volume] = min_determinant_and_volume(mesh);
    EXPECT_GT(minimum, 0);
    EXPECT_NEAR(volume, is_flat(cell) ? 24 : 48, 1e-11);
    for (std::size_t node = 0; node < mesh.parent_node.size(); ++node)  // both sides of fractures move equally
      EXPECT_LE(norm(point(mesh, static_cast<GlobalIndex>(node)) - point(mesh, mesh.parent_node[node])), 1e-14);
    EXPECT_EQ(mesh.cells, before.cells);
  }
}

/// Cell [0, 1]^2 x [0, 1] with the tip at its origin, or along its third direction.
TEST(QuarterPoints, NodesInside) {
  auto square = make_box(box("quadrilateral", {2, 2}, {{0, 1, 1, 1}}));
  move_to_quarter_points(square);
  const auto of = [](const GlobalMesh& mesh, Vector corner, int k) {  // node k of the cell with this lowest corner
    const int n = mesh::n_nodes(mesh.shape);
    for (GlobalIndex cell = 0; cell < mesh.n_cells(); ++cell)
      if (norm(point(mesh, mesh.cells[cell * n]) - corner) < 1e-12) return point(mesh, mesh.cells[cell * n + k]);
    throw Error("there is no such cell");
  };
  const auto near = [](const Vector& x, const Vector& y) { return norm(x - y) < 1e-14; };
  EXPECT_TRUE(near(of(square, {1, 1}, 8), {1.375, 1.375}));
  EXPECT_TRUE(near(of(square, {0, 1}, 8), {0.625, 1.375}));
  auto cube = make_box(box("hexahedron", {2, 2, 1}, {{0, 1, 1, 1}}));
  move_to_quarter_points(cube);
  EXPECT_TRUE(near(of(cube, {1, 1, 0}, 26), {1.375, 1.375, 0.5}));
  EXPECT_TRUE(near(of(cube, {1, 1, 0}, 24), {1.375, 1.375, 0}));
  EXPECT_TRUE(near(of(cube, {1, 1, 0}, 20), {1, 1.25, 0.5}));
  EXPECT_TRUE(near(of(cube, {1, 1, 0}, 21), {2, 1.5, 0.5}));
}

/// Both ends of a fracture of one face are tips: quarter points would make the adjacent cells degenerate.
TEST(QuarterPoints, NotInCellsWithAFaceOfTips) {
  for (const auto& cell : mesh::testing::all_cells) {
    SCOPED_TRACE(cell);
    auto mesh = make_box(box(cell, {5, 4, 1}, {{2, 2, 3, 2}}));
    move_to_quarter_points(mesh);
    const int n = mesh::n_nodes(mesh.shape);
    std::vector<GlobalIndex> still;  // nodes of cells that contain the corners of the fracture
    for (const auto& face : mesh.fracture_faces)
      for (int side : {0, 1})
        still.insert(still.end(), mesh.cells.begin() + face.cell[side] * n,
                     mesh.cells.begin() + (face.cell[side] + 1) * n);
    int moved = 0;
    for_each_edge(mesh, [&](GlobalIndex c, const auto& edge, const auto&, Real place) {
      const GlobalIndex node = mesh.cells[c * n + edge.middle];
      if (std::find(still.begin(), still.end(), node) != still.end()) {
        EXPECT_NEAR(place, 0.5, 1e-14);
      }
      moved += std::abs(place - 0.5) > 0.1;
    });
    EXPECT_GT(moved, 0);
    EXPECT_GT(min_determinant_and_volume(mesh)[0], 0);
  }
}

/// A cell with curved edges: with one edge straightened, the edges would cross. This cell keeps its nodes.
TEST(QuarterPoints, NotWhereTheMapWouldTurn) {
  const auto straight = make_box(box("triangle", {4, 4}, {{0, 2, 2, 2}}));
  auto mesh = straight, curved = straight;
  move_to_quarter_points(mesh);
  const auto is_tip = mesh::tip_nodes(straight);
  const auto x = [&](GlobalIndex cell, int k) { return point(straight, straight.cells[cell * 6 + k]); };
  GlobalIndex bent = -1;
  for (GlobalIndex cell = 0; cell < straight.n_cells() && bent < 0; ++cell)
    for (int t = 0; t < 3; ++t) {
      const int p = (t + 1) % 3, q = (t + 2) % 3;  // node 3 + t is between t and p, 3 + p between p and q
      if (!is_tip[straight.cells[cell * 6 + t]] || x(cell, 3 + t)[1] == 2 || x(cell, 3 + q)[1] == 2) continue;
      bent = cell;
      const auto bend = [&](int k, Real by) {
        const Vector to = x(cell, k) + by * (x(cell, t) - x(cell, q));
        std::copy_n(to.begin(), 2, curved.coordinates.begin() + straight.cells[cell * 6 + k] * 2);
      };
      bend(3 + t, 0.15);
      bend(3 + p, 0.3);
    }
  ASSERT_GE(bent, 0);
  const auto original = curved;
  ASSERT_GT(min_determinant_and_volume(curved)[0], 0);
  move_to_quarter_points(curved);
  EXPECT_GT(min_determinant_and_volume(curved)[0], 0);
  const auto differ = [&](const GlobalMesh& a, const GlobalMesh& b, GlobalIndex node) {
    return norm(point(a, node) - point(b, node)) > 1e-12;
  };
  int still = 0, moved = 0;
  for (GlobalIndex node = 0; node < curved.n_nodes(); ++node) {
    const auto begin = curved.cells.begin() + bent * 6;
    if (std::find(begin, begin + 6, node) != begin + 6) {
      EXPECT_FALSE(differ(curved, original, node));
      still += differ(mesh, straight, node);
    } else {
      EXPECT_LE(differ(curved, original, node), differ(mesh, straight, node));  // fewer nodes move next to the curved
                                                                                // edges
      moved += differ(curved, original, node);
    }
  }
  EXPECT_EQ(still, 2);
  EXPECT_GT(moved, 0);
}

/// Front of a fracture that ends at another fracture. The two sides of the other fracture keep equal node positions,
/// although its far side has no tip.
TEST(QuarterPoints, OfAFrontThatEndsAtAFracture) {
  for (const char* cell : {"tetrahedron", "hexahedron"}) {
    SCOPED_TRACE(cell);
    auto parameters = box(cell, {4, 4, 4}, {{0, 2, 4, 2}});
    auto& other = parameters.fractures["other"];
    other.lower_corner = {2, 2, 0};
    other.upper_corner = {2, 4, 2};
    auto mesh = make_box(parameters);
    const auto before = mesh;
    move_to_quarter_points(mesh);
    int moved_copies = 0;
    for (GlobalIndex node = 0; node < mesh.n_nodes(); ++node) {
      EXPECT_LE(norm(point(mesh, node) - point(mesh, mesh.parent_node[node])), 1e-14);
      moved_copies += mesh.parent_node[node] != node && norm(point(mesh, node) - point(before, node)) > 0.1;
    }
    EXPECT_GT(moved_copies, 0);
    EXPECT_GT(min_determinant_and_volume(mesh)[0], 0);
  }
}

/// A refined distributed mesh has as many nodes, at the same coordinates, as the box with twice the cells, on any
/// number of ranks.
TEST(QuarterPoints, OfPartsThatWereRefined) {
  const auto comm = Tpetra::getDefaultComm();
  for (const auto& cell : mesh::testing::all_cells) {
    auto parameters = box(cell, {6, 4, 2}, {{1, 2, 4, 2}, {3, 1, 3, 3}});
    if (!is_flat(cell)) {  // the front ends at the other fracture, whose far side has no tips
      parameters.fractures["f1"].lower_corner = {2, 1, 1};
      parameters.fractures["f1"].upper_corner = {3, 2, 1};
    }
    auto fine = parameters;
    for (int& n : fine.cells) n *= 2;
    auto at_once = make_box(fine);
    move_to_quarter_points(at_once);
    parameters.order = 1;
    auto coarse = make_box(parameters);
    turn_for_refinement(coarse);
    std::vector<int> part;
    for (GlobalIndex c = 0; c < coarse.n_cells(); ++c) part.push_back(static_cast<int>(c * c % 7) % comm->getSize());
    const auto mesh = mesh::raise_order(*mesh::refined(*distribute(coarse, part, comm), 1));
    move_to_quarter_points(*mesh);
    EXPECT_EQ(mesh->n_global_nodes, at_once.n_nodes());
    if (cell == "triangle") continue;  // diagonals of boxes alternate
    std::map<std::array<long long, 3>, int> here, all;
    const auto add = [&](auto& places, const Real* x) {
      std::array<long long, 3> key{};
      for (int i = 0; i < mesh->dim(); ++i) key[i] = std::llround(1e6 * x[i]);
      ++places[key];
    };
    for (GlobalIndex node = 0; node < at_once.n_nodes(); ++node) add(all, &at_once.coordinates[node * at_once.dim()]);
    for (LocalIndex node = 0; node < mesh->n_nodes(); ++node) add(here, &mesh->coordinates[node * mesh->dim()]);
    for (const auto& [place, n] : here) {
      ASSERT_TRUE(all.count(place)) << cell << " " << place[0] << " " << place[1] << " " << place[2];
      EXPECT_LE(n, all[place]);
    }
    EXPECT_TRUE(comm->getSize() > 1 || here == all) << cell;
  }
}

TEST(QuarterPoints, ThroughPeriodicSides) {
  auto parameters = box("triangle", {6, 4}, {{0, 2, 2, 2}});
  parameters.periodic = {"x"};
  auto mesh = make_box(parameters);
  const auto before = mesh;
  move_to_quarter_points(mesh);
  int moved = 0;
  for (GlobalIndex node = 0; node < mesh.n_nodes(); ++node) {
    const auto shift = [&](GlobalIndex k) { return point(mesh, k) - point(before, k); };
    EXPECT_LE(norm(shift(node) - shift(mesh.free_node(node))), 1e-14);
    moved += mesh.free_node(node) != node && norm(shift(node)) > 0.1;
  }
  EXPECT_GT(moved, 0);
}

/// Manual result: l are the barycentric coordinates of the corners, rho is the sum over corners that are not tips. The
/// mean of 27 l1 l2 l3 is 3/7 with the area element 2 rho^2 (one tip) or 2 rho (1 + rho) (two tips).
TEST(QuarterPoints, MeansOfBubblesOnTriangles) {
  const auto parameters = box("tetrahedron", {4, 4, 2}, {{1, 2, 4, 2}});
  const auto mesh = mesh::make_distributed(
      [&] {
        auto global = make_box(parameters);
        move_to_quarter_points(global);
        return global;
      },
      Tpetra::getDefaultComm());
  for (LocalIndex f = 0; f < mesh->n_owned_fracture_faces; ++f) {
    const auto& face = mesh->fracture_faces[f];
    int n_tips = 0;
    for (int k = 0; k < 3; ++k) n_tips += mesh->coordinates[face.nodes[0][k] * 3] == 1;
    for (int side : {0, 1})
      EXPECT_NEAR(bubble_mean(*mesh, face.cell[side], face.local_face[side]), n_tips == 0 ? 0.45 : 3.0 / 7, 1e-14);
  }
}

/// Returns the mean over a simplex of 1/R, with the sum R of the barycentric coordinates of corners that are not tips.
template <Shape shape>
Real mean_of_inverse(const std::vector<int>& tips) {
  constexpr int dim = mesh::dimension(shape), n = mesh::n_nodes(shape);
  using Cell = ReferenceCell<shape>;
  const auto tip = [&](int k) { return std::find(tips.begin(), tips.end(), k) != tips.end(); };
  Real X[n][dim] = {}, N[n], dN[n][dim], xi[dim];
  for (int i = 0; i < dim; ++i) X[i + 1][i] = 1;
  for (int e = 0; e < n - Cell::n_corners; ++e) {
    constexpr int ends[][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
    const auto [a, b] = ends[e];
    const Real share = tip(a) == tip(b) ? 0.5 : tip(a) ? 0.25 : 0.75;
    for (int i = 0; i < dim; ++i) X[Cell::n_corners + e][i] = X[a][i] + share * (X[b][i] - X[a][i]);
  }
  const CurvedQuadrature<shape> rule(X);
  Real sum = 0, volume = 0;
  for (int q = 0; q < rule.n; ++q) {
    const Real weight = rule.at(q, xi);
    Cell::shape_functions(xi, N);
    Cell::gradients(xi, dN);
    const CellPoint<shape> point(X, dN);
    Real others = tip(0) ? 0 : 1;
    for (int i = 0; i < dim; ++i) {
      Real x = 0;
      for (int a = 0; a < n; ++a) x += N[a] * X[a][i];
      if (tip(0) != tip(i + 1)) others += tip(0) ? x : -x;
    }
    sum += weight * point.volume / others;
    volume += weight * point.volume;
  }
  EXPECT_NEAR(volume, dim == 2 ? 1.0 / 2 : 1.0 / 6, 1e-14);
  return sum / volume;
}

/// The density of R is 2 R (triangles), 3 R^2 (tetrahedra, one tip) and 6 R (1 - R) (tetrahedra, two tips).
TEST(CurvedRule, IsExactForTheSquareOfAFieldThatGrowsWithTheRoot) {
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(mean_of_inverse<Shape::triangle6>({a}), 2, 1e-13) << a;
  for (int a = 0; a < 4; ++a) {
    EXPECT_NEAR(mean_of_inverse<Shape::tetrahedron10>({a}), 1.5, 1e-13) << a;
    for (int b = 0; b < a; ++b) EXPECT_NEAR(mean_of_inverse<Shape::tetrahedron10>({a, b}), 3, 1e-13) << a << b;
  }
}

/// Mean of 1/(x + y) on a square with its tip at one corner, with the map (s (s + t - s t), t (s + t - s t)) from
/// there.
TEST(CurvedRule, OfSquares) {
  const Real corners[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  for (int tip = 0; tip < 4; ++tip) {
    Real X[9][2], N[9], dN[9][2], xi[2];
    for (int i = 0; i < 2; ++i) {
      for (int a = 0; a < 4; ++a) X[a][i] = corners[(a + 4 - tip) % 4][i];
      for (int a = 0; a < 4; ++a) {
        const int b = (a + 1) % 4;
        const Real share = a == tip ? 0.25 : b == tip ? 0.75 : 0.5;
        X[4 + a][i] = X[a][i] + share * (X[b][i] - X[a][i]);
      }
      X[8][i] = 0;
      for (int a = 0; a < 4; ++a) X[8][i] += X[4 + a][i] / 2 - X[a][i] / 4;
    }
    const CurvedQuadrature<Shape::quadrilateral9> rule(X);
    Real sum = 0, area = 0;
    for (int q = 0; q < rule.n; ++q) {
      const Real weight = rule.at(q, xi);
      ReferenceCell<Shape::quadrilateral9>::shape_functions(xi, N);
      ReferenceCell<Shape::quadrilateral9>::gradients(xi, dN);
      const CellPoint<Shape::quadrilateral9> point(X, dN);
      Real x = 0;
      for (int a = 0; a < 9; ++a) x += N[a] * (X[a][0] + X[a][1]);
      sum += weight * point.volume / x;
      area += weight * point.volume;
    }
    EXPECT_NEAR(area, 1, 1e-13);
    EXPECT_NEAR(sum, 2 * std::log(2), 1e-5);  // the integral of 1/(x + y) over [0, 1]^2
  }
}

}  // namespace
}  // namespace sprekk::assembly
