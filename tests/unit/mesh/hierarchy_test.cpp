#include "mesh/hierarchy.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "mesh/raise_order.hpp"
#include "mesh/renumber.hpp"
#include "meshes.hpp"

namespace sprekk::mesh::testing {
namespace {

using ::testing::HasSubstr;

/// Axis-parallel segment (3D: rectangle) of a fracture; a fracture may have several.
struct Piece {
  std::string fracture;
  Vector lower, upper;
};

struct Meeting {
  std::string name;
  int dimension, n_cells;
  Real measure;
  std::vector<int> facets;  ///< per cell, from each neighbouring subdomain of one dimension more
};

struct HierarchyCase {
  std::string name;
  std::vector<Piece> pieces;
  std::vector<Meeting> meetings;
  std::vector<int> tips;  ///< number of tips of each fracture
};

/// Splits a mesh along all faces whose centre satisfies `on(fracture, centre)`.
template <class Predicate>
GlobalMesh split_along(const std::string& cell, std::vector<int> n, int order, std::vector<std::string> fractures,
                       const Predicate& on) {
  auto mesh = make_box(unit_steps(cell, std::move(n)));
  mesh.fracture_names = fractures;
  if (order == 2) mesh = raise_order(std::move(mesh));
  std::vector<MarkedFace> marked;
  for (int f = 0; f < static_cast<int>(fractures.size()); ++f)
    for (const auto& face : mark(mesh, f, [&](const Vector& x) { return on(fractures[f], x); })) marked.push_back(face);
  return split(std::move(mesh), marked);
}

GlobalMesh mesh_of(const HierarchyCase& c, const std::string& cell, int order) {
  std::set<std::string> names;
  for (const auto& piece : c.pieces) names.insert(piece.fracture);
  const auto is_on = [&](const std::string& fracture, const Vector& x) {
    return std::any_of(c.pieces.begin(), c.pieces.end(), [&](const Piece& p) {
      bool inside = p.fracture == fracture;
      for (int i = 0; i < 3; ++i) inside = inside && p.lower[i] - 1e-9 <= x[i] && x[i] <= p.upper[i] + 1e-9;
      return inside;
    });
  };
  return split_along(cell, dim_of(cell) == 2 ? std::vector<int>{6, 4} : std::vector<int>{6, 4, 4}, order,
                     {names.begin(), names.end()}, is_on);
}

// 6 x 4 box, counted by hand.
const std::vector<HierarchyCase> plane_cases{
    {"immersed", {{"a", {1, 2, 0}, {5, 2, 0}}}, {}, {2}},
    {"to the boundary", {{"a", {0, 2, 0}, {4, 2, 0}}}, {}, {1}},
    {"one face", {{"a", {2, 2, 0}, {3, 2, 0}}}, {}, {2}},
    {"parallel", {{"a", {1, 1, 0}, {5, 1, 0}}, {"b", {0, 2, 0}, {6, 2, 0}}}, {}, {2, 0}},
    {"X", {{"a", {1, 2, 0}, {5, 2, 0}}, {"b", {3, 1, 0}, {3, 3, 0}}}, {{"a*b", 0, 1, 1, {2, 2}}}, {2, 2}},
    {"X of two through",
     {{"a", {0, 2, 0}, {6, 2, 0}}, {"b", {3, 0, 0}, {3, 4, 0}}},
     {{"a*b", 0, 1, 1, {2, 2}}},
     {0, 0}},
    {"T", {{"a", {0, 2, 0}, {6, 2, 0}}, {"b", {3, 2, 0}, {3, 3, 0}}}, {{"a*b", 0, 1, 1, {2, 1}}}, {0, 1}},
    {"L", {{"a", {1, 2, 0}, {3, 2, 0}}, {"b", {3, 2, 0}, {3, 3, 0}}}, {{"a*b", 0, 1, 1, {1, 1}}}, {1, 1}},
    {"Y",
     {{"a", {1, 2, 0}, {3, 2, 0}}, {"b", {3, 2, 0}, {5, 2, 0}}, {"c", {3, 2, 0}, {3, 4, 0}}},
     {{"a*b*c", 0, 1, 1, {1, 1, 1}}},
     {1, 1, 0}},
    {"meeting twice",
     {{"a", {0, 2, 0}, {6, 2, 0}},
      {"b", {2, 1, 0}, {2, 3, 0}},
      {"b", {4, 2, 0}, {4, 4, 0}},
      {"c", {5, 0, 0}, {5, 4, 0}}},
     {{"a*b", 0, 1, 1, {2, 2}}, {"a*b#2", 0, 1, 1, {2, 1}}, {"a*c", 0, 1, 1, {2, 2}}},
     {0, 2, 0}},
    {"a fracture that crosses itself", {{"a", {1, 2, 0}, {5, 2, 0}}, {"a", {3, 1, 0}, {3, 3, 0}}}, {}, {4}}};

// 6 x 4 x 4 box, counted by hand.
const std::vector<HierarchyCase> space_cases{
    {"triple point of planes through",
     {{"a", {0, 0, 2}, {6, 4, 2}}, {"b", {0, 2, 0}, {6, 2, 4}}, {"c", {3, 0, 0}, {3, 4, 4}}},
     {{"a*b", 1, 6, 6, {2, 2}}, {"a*c", 1, 4, 4, {2, 2}}, {"b*c", 1, 4, 4, {2, 2}}, {"a*b*c", 0, 1, 1, {2, 2, 2}}},
     {0, 0, 0}},
    {"triple point of immersed planes",
     {{"a", {2, 1, 2}, {4, 3, 2}}, {"b", {2, 2, 1}, {4, 2, 3}}, {"c", {3, 1, 1}, {3, 3, 3}}},
     {{"a*b", 1, 2, 2, {2, 2}}, {"a*c", 1, 2, 2, {2, 2}}, {"b*c", 1, 2, 2, {2, 2}}, {"a*b*c", 0, 1, 1, {2, 2, 2}}},
     {8, 8, 8}},
    {"three planes end at each other",
     {{"a", {3, 2, 2}, {6, 4, 2}}, {"b", {3, 2, 2}, {6, 2, 4}}, {"c", {3, 2, 2}, {3, 4, 4}}},
     {{"a*b", 1, 3, 3, {1, 1}}, {"a*c", 1, 2, 2, {1, 1}}, {"b*c", 1, 2, 2, {1, 1}}, {"a*b*c", 0, 1, 1, {1, 1, 1}}},
     {0, 0, 0}},
    {"a plane ends at a crossing of two",
     {{"a", {0, 0, 2}, {6, 4, 2}}, {"b", {0, 2, 0}, {6, 2, 4}}, {"c", {3, 2, 2}, {3, 4, 4}}},
     {{"a*b", 1, 6, 6, {2, 2}}, {"a*c", 1, 2, 2, {2, 1}}, {"b*c", 1, 2, 2, {2, 1}}, {"a*b*c", 0, 1, 1, {2, 1, 1}}},
     {0, 0, 0}},
    {"a third fracture joins halfway along a line",
     {{"a", {0, 2, 0}, {3, 2, 4}}, {"b", {3, 2, 0}, {6, 2, 4}}, {"c", {3, 2, 0}, {3, 4, 2}}},
     {{"a*b", 1, 2, 2, {1, 1}}, {"a*b*c", 1, 2, 2, {1, 1, 1}}, {"a*b*c#2", 0, 1, 1, {1, 1}}},
     {0, 0, 2}},
    {"two points on a line",
     {{"a", {0, 0, 1}, {6, 4, 1}},
      {"b", {0, 0, 3}, {6, 4, 3}},
      {"c", {3, 0, 0}, {3, 4, 4}},
      {"d", {0, 2, 0}, {6, 2, 4}}},
     {{"a*c", 1, 4, 4, {2, 2}},
      {"a*d", 1, 6, 6, {2, 2}},
      {"b*c", 1, 4, 4, {2, 2}},
      {"b*d", 1, 6, 6, {2, 2}},
      {"c*d", 1, 4, 4, {2, 2}},
      {"a*c*d", 0, 1, 1, {2, 2, 2}},
      {"b*c*d", 0, 1, 1, {2, 2, 2}}},
     {0, 0, 0, 0}},
    {"L of immersed planes",
     {{"a", {1, 1, 2}, {3, 3, 2}}, {"b", {3, 1, 2}, {3, 3, 3}}},
     {{"a*b", 1, 2, 2, {1, 1}}},
     {6, 4}},
    {"touching in one node only", {{"a", {1, 1, 2}, {3, 2, 2}}, {"b", {3, 2, 2}, {3, 4, 4}}}, {}, {6, 4}}};

/// Returns the 2D case extruded to the height 4.
HierarchyCase extruded(HierarchyCase c) {
  for (auto& piece : c.pieces) piece.upper[2] = 4;
  for (auto& meeting : c.meetings) meeting.dimension = 1, meeting.n_cells *= 4, meeting.measure *= 4;
  for (int& n : c.tips) n *= 4;
  return c;
}

/// Calls use(case, cell, mesh) for all types of cells, with orders 1 and 2.
template <class Use>
void for_all_cases(const Use& use) {
  for (const auto& cell : all_cells)
    for (int order : {1, 2}) {
      std::vector<HierarchyCase> cases = dim_of(cell) == 2 ? plane_cases : space_cases;
      for (const auto& c : plane_cases)
        if (dim_of(cell) == 3) cases.push_back(extruded(c));
      for (const auto& c : cases) {
        SCOPED_TRACE(c.name + ", " + cell + " of order " + std::to_string(order));
        use(c, mesh_of(c, cell, order));
      }
    }
}

TEST(ParentNode, OfEachCopyIsAtTheSamePlaceAndThereIsOneForEachPlace) {
  for_all_cases([](const HierarchyCase&, const GlobalMesh& split) {
    for (const auto& mesh : {split, renumbered(split, 3)}) {
      ASSERT_EQ(static_cast<GlobalIndex>(mesh.parent_node.size()), mesh.n_nodes());
      std::map<Vector, std::set<GlobalIndex>> parents;
      for (GlobalIndex node = 0; node < mesh.n_nodes(); ++node) {
        const GlobalIndex parent = mesh.parent_node[node];
        EXPECT_EQ(point(mesh, node), point(mesh, parent));
        EXPECT_EQ(mesh.parent_node[parent], parent);
        parents[point(mesh, node)].insert(parent);
      }
      for (const auto& [x, here] : parents) EXPECT_EQ(here.size(), 1u);
    }
  });
}

TEST(Hierarchy, HasTheEntitiesCountedByHand) {
  for_all_cases([](const HierarchyCase& c, const GlobalMesh& mesh) {
    const auto h = make_hierarchy(mesh);
    const int n_fractures = static_cast<int>(mesh.fracture_names.size()), dim = mesh.dim();
    ASSERT_EQ(h.subdomains.size(), 1 + n_fractures + c.meetings.size());
    EXPECT_EQ(h.subdomains[0].name, "bulk");
    EXPECT_EQ(h.subdomains[0].dimension, dim);
    EXPECT_EQ(h.subdomains[0].n_cells(), mesh.n_cells());
    EXPECT_NEAR(h.subdomains[0].measure(), dim == 2 ? 24 : 96, 1e-12);
    std::size_t n_interfaces = 2 * n_fractures, n_tips = 0;
    for (int f = 0; f < n_fractures; ++f) {
      EXPECT_EQ(h.subdomains[1 + f].name, mesh.fracture_names[f]);
      EXPECT_EQ(h.subdomains[1 + f].dimension, dim - 1);
      EXPECT_EQ(static_cast<int>(h.tips[f].size()), c.tips[f]);
      for (GlobalIndex tip : h.tips[f]) {
        ASSERT_EQ(h.ridges[tip].faces.size(), 1u);
        EXPECT_EQ(mesh.fracture_faces[h.ridges[tip].faces[0].face].fracture, f);
      }
      n_tips += h.tips[f].size();
    }
    for (std::size_t m = 0; m < c.meetings.size(); ++m) {
      const auto& expected = c.meetings[m];
      const auto& found = h.subdomains[1 + n_fractures + m];
      EXPECT_EQ(found.name, expected.name);
      EXPECT_EQ(found.dimension, expected.dimension);
      EXPECT_EQ(found.n_cells(), expected.n_cells);
      EXPECT_NEAR(found.measure(), expected.measure, 1e-13);
      for (int facets : expected.facets) {
        ASSERT_LT(n_interfaces, h.interfaces.size());
        const auto& interface = h.interfaces[n_interfaces++];
        EXPECT_EQ(&h.subdomains[interface.lower], &found);
        EXPECT_EQ(h.subdomains[interface.higher].dimension, found.dimension + 1);
        EXPECT_FALSE(interface.side);
        EXPECT_EQ(static_cast<int>(interface.facets.size()), facets * expected.n_cells);
      }
    }
    EXPECT_EQ(n_interfaces, h.interfaces.size());
    EXPECT_EQ(h.count(dim), 1);
    EXPECT_EQ(h.count(dim - 1), n_fractures);
  });
}

/// Returns the mean of the corners of a cell of a subdomain.
Vector centre(const GlobalMesh& mesh, const Hierarchy& h, const Subdomain& s, GlobalIndex cell) {
  const GlobalIndex id = s.cells[cell];
  if (s.dimension == mesh.dim() - 1)
    return face_centre(mesh, mesh.fracture_faces[id].cell[plus], mesh.fracture_faces[id].local_face[plus]);
  if (s.dimension == mesh.dim() - 3) return point(mesh, id);
  const auto& [a, b] = h.ridges[id].nodes;
  return b < 0 ? point(mesh, a) : 0.5 * (point(mesh, a) + point(mesh, b));
}

/// Returns the mean of the corners of a facet, from its higher-dimensional cell.
Vector centre(const GlobalMesh& mesh, const Hierarchy& h, const Interface& interface, int facet) {
  const auto& higher = h.subdomains[interface.higher];
  const auto [cell, local] = interface.facets[facet];
  if (higher.dimension == mesh.dim()) return face_centre(mesh, cell, local);
  const GlobalIndex id = higher.cells[cell];
  if (higher.dimension == mesh.dim() - 2) return point(mesh, h.ridges[id].nodes[local]);
  const auto& face = mesh.fracture_faces[id];
  const auto nodes = nodes_of_face(mesh, face.cell[minus], face.local_face[minus]);
  const int next = mesh.dim() == 2 ? local : (local + 1) % n_face_corners(mesh.shape);
  return 0.5 * (point(mesh, nodes[local]) + point(mesh, nodes[next]));
}

/// Checks that averages preserve constants and coordinates (facets and cells coincide) and that integrals preserve
/// totals.
void expect_projects(const GlobalMesh& mesh, const Hierarchy& h, const Interface& interface) {
  const auto& lower = h.subdomains[interface.lower];
  const std::size_t n_facets = interface.facets.size(), n_cells = lower.cells.size();
  ASSERT_EQ(interface.measures.size(), n_facets);
  std::vector<std::vector<Real>> facets(4), cells(4);  // x, y, z, one
  for (std::size_t i = 0; i < n_facets; ++i) {
    const Vector x = centre(mesh, h, interface, static_cast<int>(i));
    for (int k = 0; k < 4; ++k) facets[k].push_back(k < 3 ? x[k] : 1);
  }
  for (std::size_t j = 0; j < n_cells; ++j) {
    const Vector x = centre(mesh, h, lower, static_cast<GlobalIndex>(j));
    for (int k = 0; k < 4; ++k) cells[k].push_back(k < 3 ? x[k] : 1);
  }
  for (int k = 0; k < 4; ++k) {
    const auto averaged = interface.to_lower.average(facets[k]), back = interface.to_higher.average(cells[k]);
    ASSERT_EQ(averaged.size(), n_cells);
    ASSERT_EQ(back.size(), n_facets);
    for (std::size_t j = 0; j < n_cells; ++j) EXPECT_NEAR(averaged[j], cells[k][j], 1e-14);
    for (std::size_t i = 0; i < n_facets; ++i) EXPECT_NEAR(back[i], facets[k][i], 1e-14);
  }
  const auto total = [](const std::vector<Real>& values) { return std::accumulate(values.begin(), values.end(), 0.0); };
  std::vector<Real> on_facets, on_cells;
  for (std::size_t i = 0; i < n_facets; ++i) on_facets.push_back(std::sin(1.0 + static_cast<Real>(i)));
  for (std::size_t j = 0; j < n_cells; ++j) on_cells.push_back(std::cos(2.0 * static_cast<Real>(j)));
  EXPECT_NEAR(total(interface.to_lower.integrate(on_facets)), total(on_facets), 1e-12);
  EXPECT_NEAR(total(interface.to_higher.integrate(on_cells)), total(on_cells), 1e-12);
  const auto shared = interface.to_higher.integrate(lower.measures);  // each side has an equal part of the cell
  const Real n_on_cell = static_cast<Real>(n_facets) / static_cast<Real>(n_cells);
  for (std::size_t i = 0; i < n_facets; ++i) EXPECT_NEAR(shared[i], interface.measures[i] / n_on_cell, 1e-14);
}

TEST(Hierarchy, ProjectionsKeepConstantsPlacesAndIntegrals) {
  for_all_cases([](const HierarchyCase&, const GlobalMesh& split) {
    for (const auto& mesh : {split, renumbered(split, 11)}) {
      const auto h = make_hierarchy(mesh);
      for (const auto& interface : h.interfaces) {
        SCOPED_TRACE(h.subdomains[interface.higher].name + " to " + h.subdomains[interface.lower].name);
        expect_projects(mesh, h, interface);
        if (!interface.side) continue;
        for (const auto& map : {interface.to_lower.average, interface.to_lower.integrate, interface.to_higher.average,
                                interface.to_higher.integrate})
          for (const auto& entry : map.entries) EXPECT_EQ(entry.weight, 1);
      }
    }
  });
}

TEST(Hierarchy, SidesOfTheBulkAreThoseOfTheFractureFaces) {
  for (const auto& cell : all_cells) {
    const auto mesh = make_box(crossed(cell));
    const auto h = make_hierarchy(mesh);
    for (int f = 0; f < 3; ++f)
      for (Side side : {minus, plus}) {
        const auto& interface = h.interfaces[2 * f + side];
        EXPECT_EQ(interface.higher, 0);
        EXPECT_EQ(interface.lower, 1 + f);
        EXPECT_EQ(interface.side, side);
        const auto& fracture = h.subdomains[1 + f];
        ASSERT_EQ(interface.facets.size(), fracture.cells.size());
        for (std::size_t i = 0; i < fracture.cells.size(); ++i) {
          const auto& face = mesh.fracture_faces[fracture.cells[i]];
          EXPECT_EQ(face.fracture, f);
          EXPECT_EQ(interface.facets[i].cell, face.cell[side]);
          EXPECT_EQ(interface.facets[i].local, face.local_face[side]);
        }
      }
  }
}

TEST(Hierarchy, ObliqueLinesThroughOnePoint) {
  // Four lines through the middle of a 4 x 4 box; two are diagonals along edges of triangles.
  for (int order : {1, 2}) {
    const auto mesh =
        split_along("triangle", {4, 4}, order, {"a", "b", "c", "d"}, [](const std::string& f, const Vector& x) {
          return f == "a" ? x[1] == 2 : f == "b" ? x[0] == 2 : f == "c" ? x[0] == x[1] : x[0] + x[1] == 4;
        });
    const auto h = make_hierarchy(mesh);
    ASSERT_EQ(h.subdomains.size(), 6u);
    EXPECT_EQ(h.subdomains[5].name, "a*b*c*d");
    EXPECT_NEAR(h.subdomains[3].measure(), 4 * std::sqrt(2), 1e-14);
    EXPECT_EQ(h.ridges[h.subdomains[5].cells[0]].faces.size(), 8u);
    for (const auto& interface : h.interfaces) expect_projects(mesh, h, interface);
  }
}

TEST(Hierarchy, ObliquePlanesThroughOneLine) {
  // The planes x = y, y = z, z = x through the diagonal of a cube; Kuhn's tetrahedra have faces on all of them.
  for (int order : {1, 2}) {
    const auto mesh =
        split_along("tetrahedron", {3, 3, 3}, order, {"a", "b", "c"}, [](const std::string& f, const Vector& x) {
          const int i = f[0] - 'a';
          return std::abs(x[i] - x[(i + 1) % 3]) < 1e-9;
        });
    const auto h = make_hierarchy(mesh);
    ASSERT_EQ(h.subdomains.size(), 5u);
    const auto& line = h.subdomains[4];
    EXPECT_EQ(line.name, "a*b*c");
    EXPECT_EQ(line.n_cells(), 3);
    EXPECT_NEAR(line.measure(), 3 * std::sqrt(3), 1e-14);
    for (GlobalIndex ridge : line.cells) EXPECT_EQ(h.ridges[ridge].faces.size(), 6u);
    for (const auto& tips : h.tips) EXPECT_TRUE(tips.empty());
    for (const auto& interface : h.interfaces) expect_projects(mesh, h, interface);
  }
}

TEST(Hierarchy, DoesNotDependOnTheNumbering) {
  for_all_cases([](const HierarchyCase&, const GlobalMesh& mesh) {
    const auto a = make_hierarchy(mesh), b = make_hierarchy(renumbered(mesh, 7));
    EXPECT_EQ(a.tips, b.tips);
    ASSERT_EQ(a.ridges.size(), b.ridges.size());
    for (std::size_t r = 0; r < a.ridges.size(); ++r) {
      ASSERT_EQ(a.ridges[r].faces.size(), b.ridges[r].faces.size());
      for (std::size_t k = 0; k < a.ridges[r].faces.size(); ++k) {
        EXPECT_EQ(a.ridges[r].faces[k].face, b.ridges[r].faces[k].face);
        EXPECT_EQ(a.ridges[r].faces[k].corner, b.ridges[r].faces[k].corner);
      }
    }
    ASSERT_EQ(a.subdomains.size(), b.subdomains.size());
    for (std::size_t s = 0; s < a.subdomains.size(); ++s) {
      const auto &left = a.subdomains[s], &right = b.subdomains[s];
      EXPECT_EQ(left.name, right.name);
      EXPECT_EQ(left.fractures, right.fractures);
      EXPECT_EQ(left.n_cells(), right.n_cells());
      if (s > 0) {
        EXPECT_EQ(left.measures, right.measures);
      }
      if (left.dimension >= mesh.dim() - 2) {
        EXPECT_EQ(left.cells, right.cells);
      }
    }
    ASSERT_EQ(a.interfaces.size(), b.interfaces.size());
    for (std::size_t i = 0; i < a.interfaces.size(); ++i) {
      ASSERT_EQ(a.interfaces[i].facets.size(), b.interfaces[i].facets.size());
      for (std::size_t k = 0; k < a.interfaces[i].facets.size(); ++k) {
        EXPECT_EQ(a.interfaces[i].facets[k].local, b.interfaces[i].facets[k].local);
        if (!a.interfaces[i].side) {
          EXPECT_EQ(a.interfaces[i].facets[k].cell, b.interfaces[i].facets[k].cell);
        }
      }
    }
  });
}

TEST(Hierarchy, OfAMeshWithoutFracturesIsTheBulk) {
  for (const auto& cell : all_cells) {
    const auto h = make_hierarchy(
        make_box(unit_steps(cell, dim_of(cell) == 2 ? std::vector<int>{3, 2} : std::vector<int>{3, 2, 1})));
    ASSERT_EQ(h.subdomains.size(), 1u);
    EXPECT_NEAR(h.subdomains[0].measure(), 6, 1e-14);
    EXPECT_TRUE(h.interfaces.empty() && h.ridges.empty() && h.tips.empty());
  }
}

TEST(Hierarchy, NeedsParentNodes) {
  auto mesh = make_box(crossed("triangle"));
  mesh.parent_node.pop_back();
  EXPECT_THAT(error_of([&] { make_hierarchy(mesh); }), HasSubstr("parent nodes"));
}

}  // namespace
}  // namespace sprekk::mesh::testing
