#include "mesh/fronts.hpp"

#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <cmath>
#include <functional>

#include "base/over_ranks.hpp"
#include "mesh/ahead.hpp"
#include "mesh/distribute.hpp"
#include "meshes.hpp"

namespace sprekk::mesh::testing {
namespace {

using Rock = std::function<std::array<Real, 3>(const Vector& centre)>;

RCP<const Mesh> scattered(const BoxMesh& box) {
  const auto global = make_box(box);
  const int ranks = Tpetra::getDefaultComm()->getSize();
  std::vector<int> part(global.n_cells());
  for (std::size_t c = 0; c < part.size(); ++c) part[c] = static_cast<int>(c) % ranks;
  return distribute(global, part, Tpetra::getDefaultComm());
}

std::vector<FrontPoint> fronts_of(const BoxMesh& box, const Rock& rock) {
  const auto mesh = scattered(box);
  return find_fronts(*mesh, std::vector<char>(mesh->fracture_names.size(), 1),
                     [&](LocalIndex c) { return rock(cell_centre(*mesh, c)); });
}
std::array<Real, 3> uniform(const Vector&) { return {1, 2, 0}; }

void expect_equal(const Vector& a, const Vector& b) { EXPECT_NEAR(norm(a - b), 0, 1e-14); }

TEST(Fronts, OfALineInTheRockAreItsEndsWithFrames) {
  for (const char* cell : {"triangle", "quadrilateral"}) {
    auto box = unit_steps(cell, {16, 12});
    box.fractures["a"] = fracture({6, 6}, {10, 6});
    const auto points = fronts_of(box, uniform);
    ASSERT_EQ(points.size(), 2u) << cell;
    for (const auto& point : points) {
      const Real sign = point.x[0] > 8 ? 1 : -1;
      expect_equal(point.x, {8 + 2 * sign, 6, 0});
      expect_equal(point.ahead, {sign, 0, 0});
      EXPECT_NEAR(std::abs(point.normal[1]), 1, 1e-14);
      expect_equal(point.along, cross(point.ahead, point.normal));
      EXPECT_DOUBLE_EQ(point.size, 1);
      EXPECT_DOUBLE_EQ(point.radius, 0.9 * 4) << "0.9 of the distance to the other front";
      EXPECT_DOUBLE_EQ(point.length, 1);
    }
  }
}

TEST(Ahead, IsTheFirstOtherFractureOnTheLine) {
  auto box = unit_steps("triangle", {20, 20});
  box.fractures["a"] = fracture({2, 10}, {10, 10});
  box.fractures["far"] = fracture({17, 2}, {17, 18});
  box.fractures["near"] = fracture({14, 5}, {14, 15});
  const auto mesh = scattered(box);
  const auto name = [&](const FaceAhead& one) { return mesh->single_fractures[one.single].name; };
  const auto sum = [&](Real here) { return base::sum_over_ranks(*mesh->comm, here); };
  for (const Real slope : {-0.1, 0.0, 0.1}) {
    const auto found = first_face_ahead(*mesh, {10, 10, 0}, {1 / std::hypot(1, slope), slope / std::hypot(1, slope), 0},
                                        fronts_of(box, uniform).at(0).single);
    ASSERT_TRUE(found);
    EXPECT_EQ(name(*found), "near");
    expect_equal(found->along, {0, 1, 0});
    EXPECT_EQ(sum(found->face >= 0), 1);
    EXPECT_EQ(sum(found->cell >= 0), 1);
    if (found->face >= 0) {
      EXPECT_NEAR(mesh->fracture_faces[found->face].centre[1], 10 + 4 * slope, 0.5);
    }
    if (found->cell >= 0) {
      EXPECT_NEAR(cell_centre(*mesh, found->cell)[0], 14.33, 0.01);
    }
  }
  const auto back = first_face_ahead(*mesh, {18, 10.3, 0}, {-1, 0, 0}, -1);
  ASSERT_TRUE(back);
  EXPECT_EQ(name(*back), "far");
  expect_equal(back->along, {0, -1, 0});
  if (back->cell >= 0) {
    EXPECT_NEAR(cell_centre(*mesh, back->cell)[0], 16.67, 0.01);
  }
  EXPECT_FALSE(first_face_ahead(*mesh, {10, 10, 0}, {0, 1, 0}, -1));
}

TEST(Fronts, DomainsEndAtOtherRockAndOtherFractures) {
  auto box = unit_steps("triangle", {20, 20});
  box.fractures["a"] = fracture({0, 10}, {10, 10});
  const auto expect = [&](const Rock& rock, Real radius, const std::string& nearest) {
    const auto point = fronts_of(box, rock).at(0);
    EXPECT_DOUBLE_EQ(point.radius, 0.9 * radius);
    EXPECT_EQ(point.nearest, nearest);
  };
  expect(uniform, 10, "a boundary");
  for (int k = 0; k < 3; ++k)  // any of the constants differs from x = 15 on
    expect(
        [k](const Vector& x) {
          std::array<Real, 3> rock{1, 2, 0};
          if (x[0] > 15) rock[k] += 1;
          return rock;
        },
        5, "another rock");
  box.fractures["b"] = fracture({16, 0}, {16, 20});
  expect(uniform, 6, "a fracture");
}

TEST(Fronts, StraightFrontIn3DHasTheExactIntegralOfItsWeight) {
  for (const char* cell : {"tetrahedron", "hexahedron"}) {
    auto box = unit_steps(cell, {12, 10, 14});
    box.fractures["a"] = fracture({0, 5, 0}, {6, 5, 14});
    const auto points = fronts_of(box, uniform);
    ASSERT_EQ(points.size(), 15u) << cell;
    for (const auto& point : points) {
      expect_equal(point.ahead, {1, 0, 0});
      EXPECT_NEAR(point.curvature, 0, 1e-14);
      EXPECT_NEAR(point.radius, 0.9 * 5, 1e-14) << "sides at a right angle to the front do not count";
      // The weight is 1 to 0.4 radii and falls to 0 with mean 1/2: 2 radius (0.4 + 0.6/2) inside of the box
      const Real z = point.x[2];
      if (z < 5 || z > 9) continue;
      EXPECT_NEAR(point.length, 1.4 * point.radius, 1e-3 * point.radius) << cell << " at " << z;
    }
  }
}

TEST(Fronts, CornersOfARectangleHaveNoDomain) {
  auto box = unit_steps("hexahedron", {16, 16, 16});
  box.fractures["a"] = fracture({4, 4, 8}, {12, 12, 8});
  int corners = 0;
  for (const auto& point : fronts_of(box, uniform)) {
    const bool is_corner = std::abs(point.x[0] - 8) == 4 && std::abs(point.x[1] - 8) == 4;
    corners += is_corner;
    if (is_corner) {
      EXPECT_EQ(point.radius, 0);
    }
  }
  EXPECT_EQ(corners, 4);
}

TEST(Fronts, CoordinatesOfACircleAndGradientOfTheWeight) {
  FrontPoint front{};
  front.x = {2, 0, 0};
  front.ahead = {1, 0, 0};
  front.normal = {0, 0, 1};
  front.along = cross(front.ahead, front.normal);
  front.curvature = 0.5;  // circle of radius 2 around the origin
  front.radius = 1;
  const Real angle = 0.3, rho = 2.25, z = 0.1;
  const Vector x{rho * std::cos(angle), rho * std::sin(angle), z};
  const auto local = front.at(x);
  EXPECT_NEAR(local.x1, 0.25, 1e-14);
  EXPECT_NEAR(local.x2, z, 1e-14);
  EXPECT_NEAR(local.curvature, 1 / rho, 1e-14);
  expect_equal(local.ahead, {std::cos(angle), std::sin(angle), 0});
  Vector gradient, unused;
  front.weight(x, gradient);
  for (int i = 0; i < 3; ++i) {
    const Real h = 1e-5;
    Vector up = x, down = x;
    up[i] += h;
    down[i] -= h;
    EXPECT_NEAR(gradient[i], (front.weight(up, unused) - front.weight(down, unused)) / (2 * h), 1e-8);
  }
}

}  // namespace
}  // namespace sprekk::mesh::testing
