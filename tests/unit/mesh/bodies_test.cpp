#include "mesh/bodies.hpp"

#include <gtest/gtest.h>

#include "mesh/periodic.hpp"
#include "msh_meshes.hpp"

namespace sprekk::mesh::testing {
namespace {

TEST(Bodies, FracturesJoin) {
  for (const auto& cell : all_cells) {
    auto box = crossed(cell);
    const auto bodies = find_bodies(make_box(box));
    ASSERT_EQ(bodies.n(), 1) << cell;
    EXPECT_EQ(bodies.n_cells[0], make_box(box).n_cells());
  }
  EXPECT_EQ(find_bodies(parse_msh(two_squares, "two", fractures(1))).n(), 1);
}

/// Returns a mesh of unit squares at the given columns and rows (lower left corners). Squares share nodes at common
/// corners.
GlobalMesh squares(const std::vector<std::array<int, 2>>& places) {
  GlobalMesh mesh;
  mesh.shape = Shape::quadrilateral;
  std::vector<std::array<int, 2>> nodes;
  for (const auto& [i, j] : places) {
    for (const auto& corner : {std::array<int, 2>{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}) {
      const auto found = std::find(nodes.begin(), nodes.end(), corner);
      mesh.cells.push_back(found - nodes.begin());
      if (found == nodes.end()) nodes.push_back(corner);
    }
    mesh.cell_region.push_back(0);
  }
  for (const auto& [x, y] : nodes)
    mesh.coordinates.insert(mesh.coordinates.end(), {static_cast<Real>(x), static_cast<Real>(y)});
  return mesh;
}

TEST(Bodies, ApartOrTouchingInACorner) {
  const auto apart = find_bodies(squares({{0, 0}, {5, 0}, {1, 0}, {6, 0}, {5, 1}}));
  EXPECT_EQ(apart.n(), 2);
  EXPECT_EQ(apart.of_cell, (std::vector<int>{0, 1, 0, 1, 1}));
  EXPECT_EQ(apart.n_cells, (std::vector<GlobalIndex>{2, 3}));
  EXPECT_EQ(find_bodies(squares({{0, 0}, {1, 1}})).n(), 2);
  EXPECT_EQ(find_bodies(squares({{0, 0}, {1, 1}, {1, 0}})).n(), 1);
}

TEST(Bodies, TiesDoNotJoin) {
  auto mesh = squares({{0, 0}, {5, 0}});
  mesh.region_names = {"rock"};
  mesh.boundary_names = {"a", "b"};
  mesh.boundary_faces = {{0, 0, 3}, {1, 1, 1}};
  EXPECT_EQ(find_bodies(tie_periodic(mesh, {{"a", "b"}})).n(), 2);
}

}  // namespace
}  // namespace sprekk::mesh::testing
