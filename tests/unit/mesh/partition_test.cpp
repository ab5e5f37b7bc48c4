#include "mesh/partition.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "meshes.hpp"

namespace sprekk::mesh::testing {
namespace {

using ::testing::HasSubstr;

TEST(Partition, UsesEveryPart) {
  for (const auto& cell : all_cells) {
    const auto mesh = make_box(crossed(cell));
    for (int n : {1, 2, 3, 7, 12}) {
      const auto part = partition(mesh, n);
      ASSERT_EQ(static_cast<GlobalIndex>(part.size()), mesh.n_cells());
      const std::set<int> used(part.begin(), part.end());
      EXPECT_EQ(static_cast<int>(used.size()), n) << cell;
      EXPECT_EQ(*used.begin(), 0);
      EXPECT_EQ(*used.rbegin(), n - 1);
      EXPECT_EQ(part, partition(mesh, n));
    }
  }
}

TEST(Partition, LeavesPartsEmptyWhereCellsAreFew) {
  const auto mesh = make_box(unit_steps("quadrilateral", {2, 1}));
  const auto part = partition(mesh, 5);
  ASSERT_EQ(part.size(), 2u);
  EXPECT_NE(part[0], part[1]);
  for (int p : part) EXPECT_TRUE(0 <= p && p < 5);
  EXPECT_THAT(error_of([&] { partition(mesh, 0); }), HasSubstr("at least one"));
}

TEST(Partition, UsesEveryPartWhereCellsAreHardlyMoreThanParts) {
  for (int n_cells = 3; n_cells < 12; ++n_cells)
    for (int n = 2; n < n_cells; ++n) {
      auto box = unit_steps("quadrilateral", {n_cells, 2});
      box.fractures["f"] = fracture({0, 1}, {static_cast<Real>(n_cells), 1});
      const auto part = partition(make_box(box), 2 * n);
      EXPECT_EQ(static_cast<int>(std::set<int>(part.begin(), part.end()).size()), 2 * n) << n_cells;
    }
}

/// Returns a square or cube of at least 500 cells: with a crossing, with several almost parallel fractures in one
/// corner, or without fractures.
BoxMesh balanced_case(const std::string& cell, const std::string& kind) {
  const bool flat = dim_of(cell) == 2;
  const int n = flat ? 24 : 8;
  auto box = unit_steps(cell, std::vector<int>(flat ? 2 : 3, n));
  const auto add = [&](const std::string& name, std::vector<Real> lower, std::vector<Real> upper) {
    if (!flat) lower.push_back(0), upper.push_back(n);
    box.fractures[name] = fracture(lower, upper);
  };
  const Real quarter = n / 4, half = n / 2, end = n;
  if (kind == "crossing") {
    add("a", {quarter, half}, {3 * quarter, half});
    add("b", {half, quarter}, {half, 3 * quarter});
  } else if (kind == "bundle") {
    for (int k = 0; k < 4; ++k) add("f" + std::to_string(k), {0, 1.0 + k}, {end, 1.0 + k});
  } else if (kind == "short") {
    add("a", {quarter, half}, {half, half});
  }
  return box;
}

TEST(Partition, BalancesCellsAndFractureFaces) {
  for (const auto& cell : all_cells)
    for (const std::string kind : {"crossing", "bundle", "short", "none"}) {
      auto box = balanced_case(cell, kind);
      for (const auto& seed : {std::optional<int>(), std::optional<int>(4)}) {
        box.renumbering_seed = seed;
        const auto mesh = make_box(box);
        ASSERT_GE(mesh.n_cells(), 500);
        for (int n : {2, 3, 5, 8}) {
          const auto part = partition(mesh, n);
          const auto result = report(mesh, part, n);
          const auto n_faces = static_cast<GlobalIndex>(mesh.fracture_faces.size());
          EXPECT_LE(result.cell_imbalance, 1.1) << cell << " " << kind << " " << n;
          if (n_faces >= 20 * n) {
            EXPECT_LE(result.fracture_face_imbalance, 1.5) << cell << " " << kind << " " << n;
          }
          EXPECT_LE(result.separated_faces, n_faces / 10 + 4) << cell << " " << kind << " " << n;
        }
      }
    }
}

TEST(Partition, ReportCounts) {
  // Two rows of four cells with the fracture between them. Parts: 0 0 1 1 below, 0 0 0 2 above.
  auto box = unit_steps("quadrilateral", {4, 2});
  box.fractures["f"] = fracture({0, 1}, {4, 1});
  const auto mesh = make_box(box);
  for (const auto& face : mesh.fracture_faces) ASSERT_LT(face.cell[minus], 4);
  const auto result = report(mesh, {0, 0, 1, 1, 0, 0, 0, 2}, 3);
  EXPECT_DOUBLE_EQ(result.cell_imbalance, 5 / (8 / 3.0));
  EXPECT_DOUBLE_EQ(result.fracture_face_imbalance, 2 / (4 / 3.0));
  EXPECT_EQ(result.cells, (std::array<GlobalIndex, 2>{1, 5}));
  EXPECT_EQ(result.fracture_faces, (std::array<GlobalIndex, 2>{0, 2}));
  EXPECT_EQ(result.edge_cut, 1 + 1 + 2);
  EXPECT_EQ(result.separated_faces, 2);
  const auto whole = report(make_box(unit_steps("triangle", {2, 2})), std::vector<int>(8, 0), 1);
  EXPECT_EQ(whole.cell_imbalance, 1);
  EXPECT_EQ(whole.fracture_face_imbalance, 1);
  EXPECT_EQ(whole.edge_cut, 0);
}

TEST(Partition, SeesTheFracture) {
  auto box = unit_steps("quadrilateral", {16, 2});
  box.fractures["f"] = fracture({0, 1}, {16, 1});
  const auto mesh = make_box(box);
  const auto part = partition(mesh, 2);  // two edges are cut across the fracture; sixteen would be cut along it
  for (const auto& face : mesh.fracture_faces) EXPECT_EQ(part[face.cell[minus]], part[face.cell[plus]]);
}

}  // namespace
}  // namespace sprekk::mesh::testing
