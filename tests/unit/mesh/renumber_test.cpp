#include "mesh/renumber.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "meshes.hpp"

namespace sprekk::mesh::testing {
namespace {

/// Median over all cells of the difference between their largest and smallest node number.
GlobalIndex median_spread(const GlobalMesh& mesh) {
  const int n = n_nodes(mesh.shape);
  std::vector<GlobalIndex> spreads;
  for (auto cell = mesh.cells.begin(); cell != mesh.cells.end(); cell += n) {
    const auto [low, high] = std::minmax_element(cell, cell + n);
    spreads.push_back(*high - *low);
  }
  std::nth_element(spreads.begin(), spreads.begin() + spreads.size() / 2, spreads.end());
  return spreads[spreads.size() / 2];
}

TEST(SpatialOrder, IsIndependentOfTheOrderBefore) {
  for (const auto& cell : all_cells) {
    const auto steps = dim_of(cell) == 2 ? std::vector<int>{7, 5} : std::vector<int>{7, 5, 6};
    const auto mesh = make_box(unit_steps(cell, steps));
    const auto first = in_spatial_order(renumbered(mesh, 1)), second = in_spatial_order(renumbered(mesh, 2));
    EXPECT_EQ(first.coordinates, second.coordinates) << cell;
    EXPECT_EQ(first.cells, second.cells) << cell;
  }
}

TEST(SpatialOrder, NeighboursHaveCloseNumbers) {
  for (const auto& cell : all_cells) {
    const auto steps = dim_of(cell) == 2 ? std::vector<int>{64, 64} : std::vector<int>{16, 16, 16};
    const auto random = renumbered(make_box(unit_steps(cell, steps)), 1);
    EXPECT_LT(median_spread(in_spatial_order(random)), median_spread(random) / 5) << cell;
  }
}

TEST(SpatialOrder, FracturesAndBoundariesAreUnchanged) {
  for (const auto& cell : all_cells) {
    const auto mesh = make_box(crossed(cell));
    const auto ordered = in_spatial_order(renumbered(mesh, 3));
    ASSERT_EQ(ordered.fracture_faces.size(), mesh.fracture_faces.size());
    EXPECT_TRUE(std::is_sorted(ordered.fracture_faces.begin(), ordered.fracture_faces.end(),
                               [](const auto& a, const auto& b) { return a.cell[minus] < b.cell[minus]; }));
    for (GlobalIndex node = 0; node < ordered.n_nodes(); ++node)
      EXPECT_EQ(norm(point(ordered, node) - point(ordered, ordered.parent_node[node])), 0) << cell;
    for (const auto& face : ordered.fracture_faces) {
      const auto on_side = [&](Side side) { return face_centre(ordered, face.cell[side], face.local_face[side]); };
      EXPECT_LT(norm(on_side(minus) - on_side(plus)), 1e-14) << cell;
    }
    const auto boundary_area = [](const GlobalMesh& m) {
      Real area = 0;
      for (const auto& face : m.boundary_faces) area += norm(area_vector(m, face.cell, face.local_face));
      return area;
    };
    EXPECT_NEAR(boundary_area(ordered), boundary_area(mesh), 1e-12 * boundary_area(mesh)) << cell;
  }
}

}  // namespace
}  // namespace sprekk::mesh::testing
