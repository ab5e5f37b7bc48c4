// Extensions of fractures in 2D.
#include <gtest/gtest.h>

#include "bisected.hpp"

namespace sprekk::mesh::testing {
namespace {

/// Returns a box of 8 x 8 steps with a fracture from (3, 4) to (5, 4).
BoxMesh with_crack(Real rotation = 0) {
  auto box = unit_steps("triangle", {8, 8});
  box.fractures["crack"] = fracture({3, 4}, {5, 4});
  box.rotation = rotation;
  return box;
}

/// Smallest 4 sqrt(3) area/sum of squared edges of the cells.
Real flattest(const GlobalMesh& mesh) {
  Real least = 1;
  for (GlobalIndex c = 0; c < mesh.n_cells(); ++c) {
    Real squares = 0;
    for (int k = 0; k < 3; ++k) {
      const Vector edge = point(mesh, mesh.cells[3 * c + k]) - point(mesh, mesh.cells[3 * c + (k + 1) % 3]);
      squares += dot(edge, edge);
    }
    least = std::min(least, 4 * std::sqrt(3.0) * cell_volume(mesh, c) / squares);
  }
  return least;
}

/// Checks the mesh, its area 64, its two tips, one at `tip`, and the length and area vector of the fracture.
void expect_crack(const GlobalMesh& mesh, const std::array<Real, 2>& tip, Real length, const Vector& vector) {
  expect_conforming(mesh);
  EXPECT_GE(flattest(mesh), 0.15);
  const auto sizes = sizes_of(mesh);
  EXPECT_NEAR(sizes.at("region bulk")[0], 64, 1e-10);
  EXPECT_NEAR(sizes.at("minus crack")[0], length, 1e-12);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(sizes.at("minus crack")[i + 1], vector[i], 1e-12);
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(sizes.at("plus crack")[i + 1], -vector[i], 1e-12);
  const auto tips = tip_nodes(mesh);
  EXPECT_EQ(n_tips(mesh), 2);
  Real nearest = 1;
  for (GlobalIndex node = 0; node < mesh.n_nodes(); ++node)
    if (tips[node]) nearest = std::min(nearest, norm(point(mesh, node) - Vector{tip[0], tip[1], 0}));
  EXPECT_LT(nearest, 1e-12);
}

/// A fracture gets straight faces in any direction, then further ones from its new tip. Its normals remain consistent.
TEST(Extension, IsStraightInAnyDirection) {
  for (const Real rotation : {0, 20}) {
    const auto mesh = make_box(with_crack(rotation));
    const auto sizes = sizes_of(mesh);
    const Real turn = rotation * M_PI / 180;
    Real sign = 0;  // of the area vector of side minus relative to the direction turned by 90 degrees
    for (int degrees = -75; degrees <= 75; degrees += 7) {
      Bisection bisection(mesh);
      std::array<Real, 2> tip{5 * std::cos(turn) - 4 * std::sin(turn), 5 * std::sin(turn) + 4 * std::cos(turn)};
      const auto& old = sizes.at("minus crack");
      sign = old[1] * -std::sin(turn) + old[2] * std::cos(turn) > 0 ? 1 : -1;
      Vector vector{old[1], old[2], old[3]};
      auto parent = cells_of(bisection);
      Real angle = turn + degrees * M_PI / 180, length = 2;
      for (int pass = 0; pass < 3; ++pass) {
        const Real c = std::cos(angle), s = std::sin(angle);
        ASSERT_EQ(bisection.extend({tip, {c, s}, 0.7, 0.25}, parent), Extended::tip) << degrees << " " << pass;
        tip = {tip[0] + 0.7 * c, tip[1] + 0.7 * s};
        vector = vector + sign * 0.7 * Vector{-s, c, 0};
        length += 0.7;
        angle -= 0.5 * degrees * M_PI / 180;
        expect_crack(bisection.mesh(), tip, length, vector);
      }
      EXPECT_EQ(static_cast<GlobalIndex>(parent.size()), bisection.n_cells());
      for (const auto p : parent) EXPECT_TRUE(p >= 0 && p < mesh.n_cells());
      bisection.refine({0, 100}, 2);
      expect_crack(bisection.mesh(), tip, length, vector);
    }
  }
}

/// The intersections of changed cells with those before fill both, and have their centroids.
TEST(Extension, OverlapsFillTheCellsOfBothMeshes) {
  const auto mesh = make_box(with_crack());
  const Bisection before(mesh);
  Bisection bisection = before;
  auto parent = cells_of(bisection);
  const Real c = std::cos(0.6), s = std::sin(0.6);
  ASSERT_EQ(bisection.extend({{5, 4}, {c, s}, 0.7, 0.25}, parent), Extended::tip);
  ASSERT_TRUE(bisection.turn({{5, 4}, {5 + 0.7 * c, 4 + 0.7 * s}, 0.2}));
  const auto after = bisection.mesh();
  std::map<GlobalIndex, std::array<Real, 3>> of_old, of_new;  // area, first moments
  for (const auto& one : bisection.overlaps(before, parent)) {
    EXPECT_GT(one.area, 0);
    for (auto* sums : {&of_old[one.before], &of_new[one.cell]})
      for (int i = 0; i < 3; ++i) (*sums)[i] += one.area * (i == 0 ? 1 : one.centre[i - 1]);
  }
  EXPECT_GT(of_new.size(), of_old.size());
  for (const auto& [sums, of] : {std::pair(&of_old, &mesh), std::pair(&of_new, &after)})
    for (const auto& [cell, sum] : *sums) {
      Vector centre{};
      for (int k = 0; k < 3; ++k) centre = centre + (Real(1) / 3) * point(*of, of->cells[3 * cell + k]);
      const Real area = cell_volume(*of, cell);
      EXPECT_NEAR(sum[0], area, 1e-12 * area);
      for (int i = 0; i < 2; ++i) EXPECT_NEAR(sum[i + 1], area * centre[i], 1e-11 * area);
    }
  for (GlobalIndex cell = 0; cell < after.n_cells(); ++cell) {  // all others are unchanged
    if (of_new.count(cell)) continue;
    for (int k = 0; k < 3; ++k)
      EXPECT_EQ(point(after, after.cells[3 * cell + k]), point(mesh, mesh.cells[3 * parent[cell] + k]));
  }
}

/// The rotation of an extension leaves the rest of the fracture where it is.
TEST(Extension, TurnsAboutItsBeginning) {
  for (const int degrees : {-14, -5, 3, 14}) {
    Bisection bisection(make_box(with_crack()));
    auto parent = cells_of(bisection);
    const auto old = sizes_of(bisection.mesh()).at("minus crack");
    const Real sign = old[2] > 0 ? 1 : -1;
    Real angle = 1.2;
    ASSERT_EQ(bisection.extend({{5, 4}, {std::cos(angle), std::sin(angle)}, 0.8, 0.3}, parent), Extended::tip);
    for (int pass = 0; pass < 2; ++pass) {
      const std::array<Real, 2> tip{5 + 0.8 * std::cos(angle), 4 + 0.8 * std::sin(angle)};
      ASSERT_TRUE(bisection.turn({{5, 4}, tip, degrees * M_PI / 180})) << degrees;
      angle += degrees * M_PI / 180;
      const Real c = std::cos(angle), s = std::sin(angle);
      expect_crack(bisection.mesh(), {5 + 0.8 * c, 4 + 0.8 * s}, 2.8, sign * Vector{-0.8 * s, 2 + 0.8 * c, 0});
    }
  }
}

/// An extension turns near a fracture ahead, which remains where it is.
TEST(Extension, TurnsBeforeAnotherFracture) {
  auto box = with_crack();
  box.fractures["wall"] = fracture({7, 2}, {7, 6});
  Bisection bisection(make_box(box));
  auto parent = cells_of(bisection);
  ASSERT_EQ(bisection.extend({{5, 4}, {1, 0}, 1, 0.25}, parent), Extended::tip);
  const auto wall = sizes_of(bisection.mesh()).at("minus wall");
  ASSERT_TRUE(bisection.turn({{5, 4}, {6, 4}, 0.1}));
  const auto mesh = bisection.mesh();
  EXPECT_GE(flattest(mesh), 0.15);
  EXPECT_EQ(sizes_of(mesh).at("minus wall"), wall);
  EXPECT_NEAR(std::abs(sizes_of(mesh).at("minus crack")[1]), std::sin(0.1), 1e-12);
}

/// Paths of seven extensions with bends and turns, in both directions.
TEST(Extension, FollowsCurvedPaths) {
  for (int path = 0; path < 24; ++path) {
    Bisection bisection(make_box(with_crack()));
    auto parent = cells_of(bisection);
    const auto bend = [&](int k) { return 0.5 * std::sin(7.3 * path + 2.7 * k); };
    std::array<std::array<Real, 2>, 2> tips{{{3, 4}, {5, 4}}};
    std::array<Real, 2> angles{M_PI + 2 * bend(0), 2 * bend(11)};
    for (int k = 0; k < 7; ++k)
      for (int end : {0, 1}) {
        auto& tip = tips[end];
        Real& angle = angles[end];
        const auto begin = tip;
        const auto ahead = [&] {
          return std::array<Real, 2>{begin[0] + 0.25 * std::cos(angle), begin[1] + 0.25 * std::sin(angle)};
        };
        ASSERT_EQ(bisection.extend({begin, {std::cos(angle), std::sin(angle)}, 0.25, 0.09}, parent), Extended::tip)
            << path << " " << k;
        const Real turned = bend(3 * k + end) / 3;
        if (bisection.turn({begin, ahead(), turned})) angle += turned;
        tip = ahead();
        angle += bend(k + 20 * end);
      }
    const auto mesh = bisection.mesh();
    expect_conforming(mesh);
    EXPECT_GE(flattest(mesh), 0.15);
    EXPECT_NEAR(sizes_of(mesh).at("minus crack")[0], 2 + 14 * 0.25, 1e-12);
    EXPECT_EQ(n_tips(mesh), 2);
  }
}

/// Near a boundary, or along another fracture, cells are bisected, but the fracture remains as it was.
TEST(Extension, NeedsRoom) {
  auto box = with_crack();
  box.fractures["wall"] = fracture({6, 2}, {6, 6});
  Bisection bisection(make_box(box));
  auto parent = cells_of(bisection);
  EXPECT_EQ(bisection.extend({{5, 4}, {0, 1}, 3.4, 0.6}, parent), Extended::none);
  EXPECT_EQ(bisection.extend({{5, 4}, {0.3, std::sqrt(0.91)}, 1.8, 0.3}, parent), Extended::none);
  const auto sizes = sizes_of(bisection.mesh());
  EXPECT_NEAR(sizes.at("minus crack")[0], 2, 1e-12);
  EXPECT_NEAR(sizes.at("minus wall")[0], 4, 1e-12);
  expect_conforming(bisection.mesh());
  EXPECT_EQ(bisection.extend({{5, 4}, {-0.1, -std::sqrt(0.99)}, 0.8, 0.3}, parent), Extended::tip);
  EXPECT_NEAR(sizes_of(bisection.mesh()).at("minus crack")[0], 2.8, 1e-12);
}

/// An extension that meets another fracture ends at one of its nodes, shorter or longer than the given length.
TEST(Extension, EndsAtAnotherFracture) {
  for (const Real length : {0.8, 1.2, 1.7})
    for (const Real slope : {-0.4, 0.0, 0.3}) {
      auto box = with_crack();
      box.fractures["wall"] = fracture({6, 2}, {6, 6});
      Bisection bisection(make_box(box));
      auto parent = cells_of(bisection);
      const Real c = 1 / std::hypot(1, slope);
      ASSERT_EQ(bisection.extend({{5, 4}, {c, c * slope}, length, length / 3}, parent), Extended::junction)
          << length << " " << slope;
      const auto mesh = bisection.mesh();
      expect_conforming(mesh);
      EXPECT_GE(flattest(mesh), 0.15);
      const auto sizes = sizes_of(mesh);
      EXPECT_NEAR(sizes.at("minus wall")[0], 4, 1e-12);
      EXPECT_NEAR(std::abs(sizes.at("minus crack")[2]), 3, 1e-12);
      EXPECT_NEAR(std::abs(sizes.at("minus crack")[1]), std::abs(slope), 0.75 * length / 3 + 1e-12);
      EXPECT_EQ(n_tips(mesh), 3);
    }
}

/// An extension that crosses another fracture continues from one of its nodes. The fracture is complete and has four
/// sides there.
TEST(Extension, CrossesAnotherFracture) {
  for (const Real lean : {-1.0, 0.0, 0.6, 1.0})
    for (const Real length : {0.8, 1.2}) {
      auto box = with_crack();
      box.fractures["wall"] = fracture({6, 2}, {6, 6});
      auto leaning = make_box(box);
      for (GlobalIndex n = 0; n < leaning.n_nodes(); ++n)
        leaning.coordinates[2 * n] += lean * (point(leaning, n)[1] - 4);
      Bisection bisection(leaning);
      const auto before = sizes_of(bisection.mesh());
      auto parent = cells_of(bisection);
      const auto made = bisection.extend({{5, 4}, {1, 0}, length, length / 3, 0.7}, parent);
      ASSERT_EQ(made, Extended::crossing) << lean << " " << length;
      const auto mesh = bisection.mesh();
      EXPECT_EQ(mesh.single_fractures[made.met].name, "wall");
      EXPECT_NEAR(made.begin[0] - 6 - lean * (made.begin[1] - 4), 0, 1e-12);
      EXPECT_NEAR(std::hypot(made.begin[0] - 6, made.begin[1] - 4), 0, 1.1 * length / 3);
      EXPECT_NEAR(made.end[0], made.begin[0] + 0.7, 1e-12);
      EXPECT_NEAR(made.end[1], made.begin[1], 1e-12);
      expect_conforming(mesh);
      EXPECT_GE(flattest(mesh), 0.15);
      const auto sizes = sizes_of(mesh);
      EXPECT_NEAR(sizes.at("minus wall")[0], before.at("minus wall")[0], 1e-12);
      EXPECT_NEAR(sizes.at("minus crack")[0], 2.7 + std::hypot(made.begin[0] - 5, made.begin[1] - 4), 1e-12);
      EXPECT_EQ(n_tips(mesh), 4);
      GlobalIndex copies = 0;
      for (GlobalIndex n = 0; n < mesh.n_nodes(); ++n) {
        const auto x = point(mesh, n);
        copies += std::hypot(x[0] - made.begin[0], x[1] - made.begin[1]) < 1e-12;
      }
      EXPECT_EQ(copies, 4);
    }
}

/// An extension that passes the end of a fracture within the size of a face ends at this fracture. It does not cross,
/// because the margin of crossing belongs to a fracture on the line.
TEST(Extension, EndsAtAFractureBesideTheLine) {
  for (const Real slope : {-0.05, 0.05}) {
    auto box = with_crack();
    box.fractures["wall"] = fracture({6, 4}, {6, 6});
    Bisection bisection(make_box(box));
    auto parent = cells_of(bisection);
    const auto made = bisection.extend({{5, 4}, {std::sqrt(1 - slope * slope), slope}, 1.2, 0.3, 0.7}, parent);
    EXPECT_GE(made.met, 0);
    EXPECT_EQ(made.is_ahead, slope > 0);
    if (slope < 0) EXPECT_EQ(made, Extended::junction);
  }
}

/// Without room beyond, the extension ends at the other fracture.
TEST(Extension, EndsAtAFractureBeforeAnother) {
  auto box = with_crack();
  box.fractures["wall"] = fracture({6, 2}, {6, 6});
  box.fractures["second"] = fracture({7, 2}, {7, 6});
  Bisection bisection(make_box(box));
  auto parent = cells_of(bisection);
  EXPECT_EQ(bisection.extend({{5, 4}, {1, 0}, 1, 0.3, 0.7}, parent), Extended::junction);
  EXPECT_NEAR(sizes_of(bisection.mesh()).at("minus crack")[0], 3, 0.1);
}

/// Two tips of one round of growth that meet: the second one has no tip any more.
TEST(Extension, OfATipThatAnotherHasJoinedIsAJunction) {
  auto box = with_crack();
  box.fractures["other"] = fracture({6, 4}, {7, 4});
  Bisection bisection(make_box(box));
  auto parent = cells_of(bisection);
  EXPECT_EQ(bisection.extend({{5, 4}, {1, 0}, 1, 0.3}, parent), Extended::junction);
  EXPECT_EQ(bisection.extend({{6, 4}, {-1, 0}, 1, 0.3}, parent), Extended::junction);
  expect_conforming(bisection.mesh());
  EXPECT_EQ(n_tips(bisection.mesh()), 2);
}

}  // namespace
}  // namespace sprekk::mesh::testing
