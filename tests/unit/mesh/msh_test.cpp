#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "mesh/cell_geometry.hpp"
#include "mesh/mesh_info.hpp"
#include "mesh/raise_order.hpp"
#include "msh_meshes.hpp"

namespace sprekk::mesh::testing {
namespace {

using ::testing::HasSubstr;

struct MshCase {
  const char* name;
  int n_fractures;
  int copies;              ///< number of nodes added by the fractures, counted by hand
  std::vector<int> faces;  ///< number of faces of each fracture
  std::vector<Real> area;
  int tips, intersections, points;  ///< see MeshInfo
  Real volume;
};

const Real slanted = std::hypot(1, 0.8), diagonal = 2 * std::hypot(0.8, 1);

/// A fracture of two segments without others adds one corner, and for order 2 two middle nodes. A point where n arms
/// of fractures meet adds n - 1 nodes. Nodes on tips add none.
const std::vector<MshCase> msh_cases{
    {"immersed", 1, 3, {4}, {2}, 2, 0, 0, 16},
    {"immersed_order2", 1, 3 + 4, {4}, {2}, 2, 0, 0, 16},
    {"x_order1_v22", 2, 3 + 4, {4, 4}, {3.2, 3.2}, 4, 1, 1, 16},
    {"x_order1_v22_binary", 2, 3 + 4, {4, 4}, {3.2, 3.2}, 4, 1, 1, 16},
    {"x_order1_v41", 2, 3 + 4, {4, 4}, {3.2, 3.2}, 4, 1, 1, 16},
    {"x_order1_v41_binary", 2, 3 + 4, {4, 4}, {3.2, 3.2}, 4, 1, 1, 16},
    {"x_order2_v22", 2, 3 + 4 * 3, {4, 4}, {3.2, 3.2}, 4, 1, 1, 16},
    {"x_order2_v22_binary", 2, 3 + 4 * 3, {4, 4}, {3.2, 3.2}, 4, 1, 1, 16},
    {"x_order2_v41", 2, 3 + 4 * 3, {4, 4}, {3.2, 3.2}, 4, 1, 1, 16},
    {"x_order2_v41_binary", 2, 3 + 4 * 3, {4, 4}, {3.2, 3.2}, 4, 1, 1, 16},
    {"t", 2, 2 + 3, {4, 2}, {3.2, 1.6}, 3, 1, 1, 16},
    {"t_order2", 2, 2 + 3 * 3, {4, 2}, {3.2, 1.6}, 3, 1, 1, 16},
    {"l", 2, 1 + 2, {2, 2}, {1.6, 1.6}, 2, 1, 1, 16},
    {"l_order2", 2, 1 + 2 * 3, {2, 2}, {1.6, 1.6}, 2, 1, 1, 16},
    {"y", 3, 2 + 3, {2, 2, 2}, {1.6, slanted, slanted}, 3, 1, 1, 16},
    {"y_order2", 3, 2 + 3 * 3, {2, 2, 2}, {1.6, slanted, slanted}, 3, 1, 1, 16},
    {"star", 3, 5 + 6, {4, 4, 4}, {3.2, diagonal, diagonal}, 6, 1, 1, 16},
    {"star_order2", 3, 5 + 6 * 3, {4, 4, 4}, {3.2, diagonal, diagonal}, 6, 1, 1, 16},
    {"reach", 1, 2, {2}, {2}, 1, 0, 0, 16},
    {"reach_order2", 1, 4, {2}, {2}, 1, 0, 0, 16},
    {"triangles", 2, 5 + 3, {4, 2}, {4, 2}, 0, 1, 1, 16},
    {"triangles_order2", 2, 9 + 5, {4, 2}, {4, 2}, 0, 1, 1, 16},
    {"squares", 2, 5 + 3, {4, 2}, {4, 2}, 0, 1, 1, 16},
    {"squares_order2", 2, 9 + 5, {4, 2}, {4, 2}, 0, 1, 1, 16},
    {"hexahedra", 2, 3 * 3, {4, 4}, {4, 4}, 4 * 2, 2, 0, 32},  // three layers of corners
    {"hexahedra_order2", 2, 5 * (3 + 4), {4, 4}, {4, 4}, 4 * 2, 2, 0, 32},
    {"cubes", 2, 4 * 12 - 27, {4, 4}, {4, 4}, 0, 2, 0, 8},  // four separate blocks
    {"cubes_order2", 2, 4 * 45 - 125, {4, 4}, {4, 4}, 0, 2, 0, 8},
    {"patch", 1, 0, {2}, {0.5625}, 4, 0, 0, 8},                                  // all corners on the tip line
    {"patch_order2", 1, 1, {2}, {0.5625}, 4, 0, 0, 8},                           // the middle of the diagonal is split
    {"planes", 2, 3, {8, 8}, {2.25, 2.25}, 16, 2, 0, 8},                         // middle of the intersection line
    {"planes_order2", 2, 3 + 2 * 3 + 4 + 8, {8, 8}, {2.25, 2.25}, 16, 2, 0, 8},  // and of its edges, sides, diagonals
    {"triple", 3, 7, {8, 8, 8}, {2.25, 2.25, 2.25}, 24, 6, 1, 8},                // eight octants
    {"triple_order2", 3, 7 + 6 * 3 + 12, {8, 8, 8}, {2.25, 2.25, 2.25}, 24, 6, 1, 8}};

Real volume(const GlobalMesh& mesh) {
  Real sum = 0;
  const CellGeometry geometry(mesh.shape);
  for (GlobalIndex cell = 0; cell < mesh.n_cells(); ++cell) {
    EXPECT_GT(geometry.scaled_jacobian(mesh, cell)[0], 0.05) << "cell " << cell;
    sum += geometry.volume(mesh, cell);
  }
  return sum;
}

/// Returns the largest distance of the nodes of order 2 from their positions in straight cells, numbered as in
/// raise_order().
Real misplacement(const GlobalMesh& mesh) {
  GlobalMesh straight;
  straight.shape = linear(mesh.shape);
  straight.coordinates = mesh.coordinates;
  straight.cell_region = mesh.cell_region;
  const int n = n_nodes(mesh.shape);
  for (GlobalIndex cell = 0; cell < mesh.n_cells(); ++cell)
    straight.cells.insert(straight.cells.end(), &mesh.cells[cell * n], &mesh.cells[cell * n] + n_corners(mesh.shape));
  straight = raise_order(straight);
  Real largest = 0;
  for (std::size_t k = 0; k < mesh.cells.size(); ++k)
    largest = std::max(largest, norm(point(mesh, mesh.cells[k]) - point(straight, straight.cells[k])));
  return largest;
}

void check(const MshCase& c, const GlobalMesh& mesh) {
  const auto info = describe(mesh);
  EXPECT_EQ(info.n_copies, c.copies);
  EXPECT_NEAR(volume(mesh), c.volume, 1e-10);
  ASSERT_EQ(info.fractures.size(), c.faces.size());
  for (std::size_t f = 0; f < c.faces.size(); ++f) {
    EXPECT_EQ(info.fractures[f].n, c.faces[f]);
    EXPECT_NEAR(info.fractures[f].measure, c.area[f], 1e-10);
  }
  EXPECT_EQ(info.n_tips, c.tips);
  EXPECT_EQ(info.n_intersections, c.intersections);
  EXPECT_EQ(info.n_intersection_points, c.points);
  if (order(mesh.shape) == 2) {
    EXPECT_LT(misplacement(mesh), 1e-10);
  }
}

TEST(Msh, CopiesAreasAndNodes) {
  for (const auto& c : msh_cases) {
    SCOPED_TRACE(c.name);
    check(c, read_msh(path_of(c.name), fractures(c.n_fractures)));
  }
}

/// A file of order 1, raised to order 2, is split like the file of order 2.
TEST(Msh, OrderRaised) {
  for (const auto& c : msh_cases) {
    const std::string name = c.name, suffix = "_order2";
    if (name.size() < suffix.size() || name.substr(name.size() - suffix.size()) != suffix) continue;
    SCOPED_TRACE(name);
    auto options = fractures(c.n_fractures);
    options.order = 2;
    const auto raised = read_msh(path_of(name.substr(0, name.size() - suffix.size())), options);
    EXPECT_EQ(order(raised.shape), 2);
    check(c, raised);
    check(c, read_msh(path_of(name), options));
    options.order = 1;
    try {
      read_msh(path_of(name), options);
      ADD_FAILURE();
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("has cells of order 2; the scene requires order 1"), std::string::npos);
    }
  }
}

TEST(Msh, CopiesAreWhatFracturesAdd) {
  for (const char* name : {"x_order1_v41", "cubes_order2", "triple_order2"}) {
    const int n = std::string(name) == "triple_order2" ? 3 : 2;
    auto without = content_of(name);
    const auto mesh = parse_msh(without, name, fractures(n));
    std::vector<bool> taken(mesh.n_nodes(), false);
    for (GlobalIndex node : mesh.cells) taken[node] = true;
    EXPECT_EQ(std::count(taken.begin(), taken.end(), false), 0) << name;
    for (GlobalIndex node = 0; node < mesh.n_nodes(); ++node)
      EXPECT_EQ(norm(point(mesh, node) - point(mesh, mesh.parent_node[node])), 0) << name;
  }
}

TEST(Msh, FormatsGiveTheSameMesh) {
  for (const char* order : {"1", "2"}) {
    const auto reference = read_msh(path_of(std::string("x_order") + order + "_v22"), fractures(2));
    for (const char* format : {"_v22_binary", "_v41", "_v41_binary"}) {
      const auto mesh = read_msh(path_of(std::string("x_order") + order + format), fractures(2));
      EXPECT_EQ(mesh.shape, order[0] == '1' ? Shape::triangle : Shape::triangle6);
      EXPECT_EQ(mesh.n_cells(), reference.n_cells());
      EXPECT_EQ(mesh.boundary_names, reference.boundary_names);
      ASSERT_EQ(mesh.cells.size(), reference.cells.size());
      for (std::size_t k = 0; k < mesh.cells.size(); ++k)
        ASSERT_LT(norm(point(mesh, mesh.cells[k]) - point(reference, reference.cells[k])), 1e-10) << format;
    }
  }
}

TEST(Msh, NamesAndBoundaries) {
  const auto info = describe(read_msh(path_of("squares"), fractures(2)));
  ASSERT_EQ(info.regions.size(), 2u);
  EXPECT_EQ(info.regions[0].name, "south rock");
  EXPECT_EQ(info.regions[1].n, 8);
  ASSERT_EQ(info.boundaries.size(), 1u);  // the other sides have no group
  EXPECT_EQ(info.boundaries[0].name, "west");
  EXPECT_EQ(info.boundaries[0].n, 4);
  EXPECT_DOUBLE_EQ(info.boundaries[0].measure, 4);
}

/// Returns the file with x negated for all nodes.
std::string mirrored(const std::string& text) {
  std::istringstream in(text);
  std::string result, line, section;
  while (std::getline(in, line)) {
    if (line[0] == '$') section = line;
    std::istringstream words(line);
    std::vector<std::string> word;
    for (std::string w; words >> w;) word.push_back(w);
    const bool is_version_2 = text.find("2.2 0 8") != std::string::npos;
    if (section == "$Nodes" && word.size() == (is_version_2 ? 4 : 3)) {
      auto& x = word[is_version_2 ? 1 : 0];
      x = x[0] == '-' ? x.substr(1) : "-" + x;
      line.clear();
      for (const auto& w : word) line += w + " ";
    }
    result += line + "\n";
  }
  return result;
}

TEST(Msh, InvertedCellsAreMirrored) {
  for (const char* name :
       {"l", "l_order2", "squares", "squares_order2", "planes", "planes_order2", "cubes", "cubes_order2"}) {
    SCOPED_TRACE(name);
    const auto found =
        std::find_if(msh_cases.begin(), msh_cases.end(), [&](const MshCase& c) { return c.name == std::string(name); });
    const auto mesh = parse_msh(mirrored(content_of(name)), name, fractures(2));
    EXPECT_LT(*std::min_element(mesh.coordinates.begin(), mesh.coordinates.end()), -1);
    check(*found, mesh);
  }
}

TEST(Msh, SmallMeshes) {
  for (const auto& text : {two_squares, two_squares_4}) {
    const auto whole = parse_msh(replaced(text, "20 ", "19 "), "small", fractures(1));
    EXPECT_EQ(whole.n_nodes(), 8);
    EXPECT_EQ(whole.fracture_faces.size(), 1u);
    EXPECT_EQ(whole.region_names, std::vector<std::string>{"old rock"});
    EXPECT_EQ(whole.boundary_names, std::vector<std::string>{"west"});
    EXPECT_GT(normal(whole, whole.fracture_faces[0])[0], 0.99);
    MshOptions options;
    options.fractures["f1"] = {Vector{-1, 0, 0}, false};
    const auto turned = parse_msh(text, "small", options);
    EXPECT_LT(normal(turned, turned.fracture_faces[0])[0], -0.99);
  }
}

TEST(Msh, SparseNumbersUnusedNodesAndOtherSections) {
  auto text = replaced(two_squares, "6\n1 0 0 0", "7\n99 5 5 5\n9000000000000000000 0 0 0");
  text = replaced(text, "2 1 4\n", "2 9000000000000000000 4\n");
  text = replaced(text, "1 1 2 5 4", "1 9000000000000000000 2 5 4");
  text = replaced(text, "$Nodes", "$Comments\n$Nodes nothing\n$EndComments\n\n$Nodes");
  text += "$Periodic\n1\n0 1 2\n$EndPeriodic\n";
  const auto mesh = parse_msh(replaced(text, "\n20 1 2 1 1", "\n8000000000000000000 1 2 -1 1"), "sparse", fractures(1));
  EXPECT_EQ(mesh.n_nodes(), 8);
  EXPECT_EQ(mesh.n_cells(), 2);
}

TEST(Msh, BoundsOfEntitiesDoNotMatter) {
  const auto text = replaced(two_squares_4, "7 0 0 0 2 1 0", "7 1e308 1e308 1e308 -1e308 -1e308 -1e308");
  EXPECT_EQ(parse_msh(text, "unbounded", fractures(1)).n_nodes(), 8);
}

TEST(Msh, GroupsWithoutNamesAndCellsWithoutGroups) {
  auto text = replaced(two_squares, "3\n1 1 \"f1\"\n1 2 \"west\"\n2 3 \"old rock\"", "0");
  text = replaced(replaced(text, "10 3 2 3 1", "10 3 2 0 1"), "11 3 2 3 1", "11 3 0");
  MshOptions options;
  options.fractures["1"] = {};
  const auto mesh = parse_msh(text, "unnamed", options);
  EXPECT_EQ(mesh.region_names, std::vector<std::string>{"bulk"});
  EXPECT_EQ(mesh.boundary_names, std::vector<std::string>{"2"});
  EXPECT_EQ(mesh.fracture_faces.size(), 1u);
}

TEST(Msh, NodesInMshOrder) {
  // Documentation of gmsh: the 27-node hexahedron has a node at the middle of each of these edges and faces.
  const auto mesh = read_msh(path_of("cubes_order2"), fractures(2));
  for (GlobalIndex cell = 0; cell < mesh.n_cells(); ++cell) {
    const auto x = [&](int k) { return point(mesh, mesh.cells[cell * 27 + k]) - point(mesh, mesh.cells[cell * 27]); };
    const Vector a = x(1), b = x(3), c = x(4);
    const auto is_at = [&](int k, Real i, Real j, Real l) {
      EXPECT_LT(norm(x(k) - (i * a + j * b + l * c)), 1e-10) << "node " << k;
    };
    is_at(8, 0.5, 0, 0), is_at(9, 1, 0.5, 0), is_at(11, 0, 0.5, 0), is_at(12, 0.5, 0, 1), is_at(14, 0.5, 1, 1);
    is_at(16, 0, 0, 0.5), is_at(17, 1, 0, 0.5), is_at(18, 1, 1, 0.5), is_at(19, 0, 1, 0.5);
    is_at(20, 0, 0.5, 0.5), is_at(21, 1, 0.5, 0.5), is_at(22, 0.5, 0, 0.5), is_at(23, 0.5, 1, 0.5);
    is_at(24, 0.5, 0.5, 0), is_at(25, 0.5, 0.5, 1), is_at(26, 0.5, 0.5, 0.5);
  }
}

TEST(MeshInfo, Measures) {
  const auto info = describe(make_box(crossed("quadrilateral")));
  EXPECT_EQ(info.n_cells, 24);
  EXPECT_EQ(info.n_copies, info.n_nodes - 35);
  EXPECT_EQ(info.n_fracture_faces, 4 + 2 + 2);
  EXPECT_EQ(info.n_tips, 2 + 2);
  EXPECT_EQ(info.n_intersections, 2);
  EXPECT_EQ(info.n_of_nodes, 2 * info.n_nodes);
  EXPECT_EQ(info.n_of_bubbles, 4 * 8);
  EXPECT_EQ(info.n_of_faces, 2 * 8);
  EXPECT_DOUBLE_EQ(info.mean_edge, 1);
  EXPECT_DOUBLE_EQ(info.smallest_scaled_jacobian, 1);

  auto box = unit_steps("triangle", {2, 1});
  box.upper_corner = {6, 1};  // legs 3 and 1
  const auto long_triangles = describe(make_box(box));
  EXPECT_DOUBLE_EQ(long_triangles.shortest_edge, 1);
  EXPECT_DOUBLE_EQ(long_triangles.longest_edge, std::sqrt(10.0));
  EXPECT_DOUBLE_EQ(long_triangles.mean_edge, (3 + 1 + std::sqrt(10.0)) / 3);
  EXPECT_DOUBLE_EQ(long_triangles.largest_edge_ratio, std::sqrt(10.0));
  EXPECT_DOUBLE_EQ(long_triangles.smallest_scaled_jacobian, 2 / std::sqrt(3.0) / std::sqrt(10.0));
}

TEST(MeshInfo, Text) {
  const auto text = to_text(describe(read_msh(path_of("triple"), fractures(3))));
  EXPECT_THAT(text, HasSubstr("tetrahedra of order 1"));
  EXPECT_THAT(text, HasSubstr("7 of them copies"));
  EXPECT_THAT(text, HasSubstr("\"f2\": 8 faces, area 2.25"));
  EXPECT_THAT(text, HasSubstr("6 edges, which meet in 1 point"));
}

TEST(Msh, SingleFractures) {
  const auto of = [](const std::string& lines) {
    return parse_msh(replaced(two_squares, "$Nodes", lines + "$Nodes"), "a.msh", fractures(1));
  };
  const auto plain = of("");
  ASSERT_EQ(plain.single_fractures.size(), 1u);
  EXPECT_EQ(plain.single_fractures[0].name, "f1");
  const auto reported = of(
      "$Fractures\n3\n2 1 \"no fracture\"\n1 4 \"absent here\"\n1 1 \"joint A\" \"angle\" \"30 deg\"\n$EndFractures\n");
  ASSERT_EQ(reported.single_fractures.size(), 2u);
  EXPECT_EQ(reported.single_fractures[1].name, "joint A");
  EXPECT_EQ(reported.single_fractures[1].set, 0);
  EXPECT_EQ(reported.single_fractures[1].properties.at("angle"), "30 deg");
  ASSERT_EQ(reported.fracture_faces.size(), 1u);
  EXPECT_EQ(reported.fracture_faces[0].single, 1);
}

}  // namespace
}  // namespace sprekk::mesh::testing
