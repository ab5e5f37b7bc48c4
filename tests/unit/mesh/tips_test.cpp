#include "mesh/tips.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <algorithm>

#include "mesh/distribute.hpp"
#include "meshes.hpp"
#include "parts.hpp"

namespace sprekk::mesh::testing {
namespace {

/// Returns the coordinates of the tips of a mesh, sorted, without duplicates.
std::vector<Vector> places_of_tips(const GlobalMesh& mesh) {
  std::vector<Vector> result;
  const auto is_tip = tip_nodes(mesh);
  EXPECT_EQ(static_cast<GlobalIndex>(is_tip.size()), mesh.n_nodes());
  for (GlobalIndex node = 0; node < mesh.n_nodes(); ++node)
    if (is_tip[node]) result.push_back(point(mesh, node));
  std::sort(result.begin(), result.end());
  result.erase(std::unique(result.begin(), result.end()), result.end());
  return result;
}

/// Returns a fracture of a 6 x 4 (x 2) box, in 3D over the full third direction.
BoxMesh::Fracture line(bool flat, std::array<Real, 2> a, std::array<Real, 2> b) {
  return flat ? fracture({a[0], a[1]}, {b[0], b[1]}) : fracture({a[0], a[1], 0}, {b[0], b[1], 2});
}

TEST(Tips, EndsInsideOfTheRock) {
  for (const auto& cell : all_cells)
    for (int order : {1, 2}) {
      const bool flat = dim_of(cell) == 2;
      auto box = unit_steps(cell, flat ? std::vector<int>{6, 4} : std::vector<int>{6, 4, 2});
      box.order = order;
      const auto expect = [&](std::vector<Vector> places) {
        std::vector<Vector> all;
        for (const auto& x : places)
          for (int z = 0; z <= (flat ? 0 : 2); ++z) all.push_back({x[0], x[1], static_cast<Real>(z)});
        EXPECT_EQ(places_of_tips(make_box(box)), all) << cell << " of order " << order;
      };
      expect({});
      box.fractures["a"] = line(flat, {1, 2}, {5, 2});
      expect({{1, 2}, {5, 2}});
      box.fractures["b"] = line(flat, {3, 2}, {3, 3});  // ends on the first
      expect({{1, 2}, {3, 3}, {5, 2}});
      box.fractures["a"] = line(flat, {0, 2}, {6, 2});
      expect({{3, 3}});
      box.fractures["b"] = line(flat, {3, 1}, {3, 4});  // crosses the first, ends on the boundary
      expect({{3, 1}});
    }
}

TEST(Tips, OfASquareAreItsRim) {
  for (const char* cell : {"tetrahedron", "hexahedron"}) {
    auto box = unit_steps(cell, {5, 5, 4});
    box.fractures["a"] = fracture({1, 1, 2}, {4, 4, 2});
    EXPECT_EQ(places_of_tips(make_box(box)).size(), 12u) << cell;
  }
}

/// The cells between two fractures at a distance of one cell have faces whose nodes are all tips.
TEST(Tips, OnPartsAsOnTheWhole) {
  const auto comm = Tpetra::getDefaultComm();
  for (const auto& cell : all_cells) {
    const bool flat = dim_of(cell) == 2;
    auto box = unit_steps(cell, flat ? std::vector<int>{6, 4} : std::vector<int>{6, 4, 2});
    box.fractures["a"] = line(flat, {1, 2}, {3, 2});
    box.fractures["b"] = line(flat, {4, 2}, {5, 2});
    for (const auto& global : {make_box(crossed(cell)), make_box(box)}) {
      auto marked = global;
      mark_tips(marked);
      std::vector<int> part;
      for (GlobalIndex c = 0; c < global.n_cells(); ++c) part.push_back(static_cast<int>(c * c % 7) % comm->getSize());
      auto mesh = *distribute(global, part, comm);
      mark_tips(mesh);
      expect_identical(mesh, *distribute(marked, part, comm));
    }
  }
}

TEST(Tips, ThroughPeriodicSides) {
  auto box = unit_steps("triangle", {6, 4});
  box.periodic = {"x"};
  box.fractures["a"] = fracture({0, 2}, {2, 2});
  EXPECT_EQ(places_of_tips(make_box(box)), (std::vector<Vector>{{0, 2}, {2, 2}, {6, 2}}));
  box.fractures["a"] = fracture({0, 2}, {6, 2});
  EXPECT_EQ(places_of_tips(make_box(box)), std::vector<Vector>{});
}

}  // namespace
}  // namespace sprekk::mesh::testing
