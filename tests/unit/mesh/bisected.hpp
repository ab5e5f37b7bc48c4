// Sizes and checks of bisected meshes.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "mesh/bisect.hpp"
#include "mesh/cell_geometry.hpp"
#include "places.hpp"

namespace sprekk::mesh::testing {

/// Returns the volumes of regions, the areas of boundaries and of fractures, and the sums of their area vectors, by
/// name.
inline std::map<std::string, std::array<Real, 4>> sizes_of(const GlobalMesh& mesh) {
  std::map<std::string, std::array<Real, 4>> sizes;
  const auto add = [&](const std::string& name, Real size, const Vector& vector) {
    auto& sum = sizes[name];
    sum[0] += size;
    for (int i = 0; i < 3; ++i) sum[i + 1] += vector[i];
  };
  for (GlobalIndex c = 0; c < mesh.n_cells(); ++c)
    add("region " + mesh.region_names[mesh.cell_region[c]], cell_volume(mesh, c), {});
  for (const auto& face : mesh.boundary_faces) {
    const Vector area = area_vector(mesh, face.cell, face.local_face);
    add("boundary " + mesh.boundary_names[face.boundary], norm(area), area);
  }
  for (const auto& face : mesh.fracture_faces)
    for (int side : {minus, plus}) {
      const Vector area = area_vector(mesh, face.cell[side], face.local_face[side]);
      add(std::string(side == minus ? "minus " : "plus ") + mesh.single_fractures[face.single].name, norm(area), area);
    }
  return sizes;
}

/// Numbers of the cells, the parents before any change.
inline std::vector<GlobalIndex> cells_of(const Bisection& bisection) {
  std::vector<GlobalIndex> cells(bisection.n_cells());
  std::iota(cells.begin(), cells.end(), 0);
  return cells;
}

/// Checks that every face of a cell is shared with one other cell, or lies on one boundary or one side of a fracture.
/// Both sides of a fracture face have the same corners. No cell is inverted.
inline void expect_conforming(const GlobalMesh& mesh) {
  const int n = n_faces(mesh.shape);
  std::vector<int> known(mesh.n_cells() * n, 0);
  const auto neighbour = face_neighbours(mesh);
  for (std::size_t face = 0; face < known.size(); ++face) known[face] = neighbour[face] >= 0;
  for (const auto& face : mesh.boundary_faces) ++known[face.cell * n + face.local_face];
  for (const auto& face : mesh.fracture_faces) {
    std::array<SortedCorners, 2> points{};
    for (int side : {minus, plus}) {
      const auto at = face.cell[side] * n + face.local_face[side];
      if (neighbour[at] < 0) ++known[at];  // a fracture of one face splits no node
      points[side] = sorted_corners(mesh, face.cell[side], face.local_face[side]);
      for (auto& node : points[side]) node = node < 0 ? node : mesh.parent_node[node];
      std::sort(points[side].begin(), points[side].end());
    }
    EXPECT_EQ(points[minus], points[plus]);
  }
  EXPECT_EQ(known, std::vector<int>(known.size(), 1));
  for (GlobalIndex c = 0; c < mesh.n_cells(); ++c) ASSERT_GT(cell_volume(mesh, c), 0);
}

GlobalIndex n_tips(const GlobalMesh& mesh) {
  const auto tips = tip_nodes(mesh);
  return std::accumulate(tips.begin(), tips.end(), GlobalIndex{0});
}

}  // namespace sprekk::mesh::testing
