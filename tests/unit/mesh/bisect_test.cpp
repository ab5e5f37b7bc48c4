#include "mesh/bisect.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <numeric>

#include "mesh/cell_geometry.hpp"
#include "places.hpp"

namespace sprekk::mesh::testing {
namespace {

using ::testing::HasSubstr;

const std::vector<std::string> simplices{"triangle", "tetrahedron"};

using Front = std::function<Real(const Vector&)>;  ///< distance from the front

/// Bisects the cells that the front may cross, once per pass, in `times` passes.
void refine_towards(const Front& front, int times, Bisection& bisection) {
  for (int pass = 0; pass < times; ++pass) {
    const auto mesh = bisection.mesh();
    const int n = n_corners(mesh.shape);
    std::vector<GlobalIndex> marked;
    for (GlobalIndex c = 0; c < mesh.n_cells(); ++c) {
      const Vector centre = cell_centre(mesh, c);
      Real radius = 0;
      for (int k = 0; k < n; ++k) radius = std::max(radius, norm(point(mesh, mesh.cells[c * n + k]) - centre));
      if (front(centre) < 1.01 * radius) marked.push_back(c);
    }
    bisection.refine(marked);
  }
}

/// Returns the distance from a point (radius 0) or from a circle (3D).
Front ring(const Vector& middle, Real radius) {
  return [=](const Vector& x) {
    const Vector r = x - middle;
    return radius == 0 ? norm(r) : std::hypot(std::hypot(r[0], r[1]) - radius, r[2]);
  };
}

/// Returns a front around the lower corner of the first fracture, else around an inner point.
Front front_in(const BoxMesh& box) {
  Vector middle{0.6, 0.45, box.cells.size() == 2 ? 0 : 0.3};
  if (!box.fractures.empty())
    std::copy_n(box.fractures.begin()->second.lower_corner.begin(), box.cells.size(), middle.begin());
  return ring(middle, box.cells.size() == 2 ? 0 : 0.4);
}

/// Returns the volumes of regions, the areas of boundaries and of fractures, and the sums of their area vectors, by
/// name.
std::map<std::string, std::array<Real, 4>> sizes_of(const GlobalMesh& mesh) {
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

/// Checks that every face of a cell is shared with one other cell, or lies on one boundary or one side of a fracture.
/// Both sides of a fracture face have the same corners. No cell is inverted.
void expect_conforming(const GlobalMesh& mesh) {
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

TEST(Bisect, BeginsWithTheMeshThatItIsGiven) {
  for (const auto& cell : simplices)
    for (auto box : boxes(cell))
      for (int order : {1, 2}) {
        const Bisection bisection(make_box(box));
        auto same = box;
        same.order = order;
        EXPECT_TRUE(places_of(bisection.mesh(order)) == places_of(make_box(same))) << cell << " " << order;
      }
}

TEST(Bisect, ConformsAndKeepsRegionsBoundariesAndFractures) {
  for (const auto& cell : simplices)
    for (const auto& box : boxes(cell)) {
      const auto coarse = make_box(box);
      Bisection bisection(coarse);
      refine_towards(front_in(box), 7, bisection);
      const auto fine = bisection.mesh();
      EXPECT_GT(fine.n_cells(), coarse.n_cells() + 5);
      EXPECT_EQ(fine.n_cells(), bisection.n_cells());
      expect_conforming(fine);
      const auto sizes = sizes_of(fine);
      for (const auto& [name, size] : sizes_of(coarse))
        for (int i = 0; i < 4; ++i) EXPECT_NEAR(sizes.at(name)[i], size[i], 1e-10) << cell << " " << name;
      if (coarse.dim() == 2) {  // no fracture became longer or was divided
        EXPECT_EQ(n_tips(fine), n_tips(coarse));
      }
    }
}

/// Returns a box of 3 steps with displaced inner nodes.
GlobalMesh shaken(GlobalMesh mesh) {
  const int dim = mesh.dim();
  for (GlobalIndex node = 0; node < mesh.n_nodes(); ++node) {
    auto* const x = &mesh.coordinates[node * dim];
    if (std::any_of(x, x + dim, [](Real c) { return c == 0 || c == 3; })) continue;
    for (int i = 0; i < dim; ++i) x[i] += 0.15 * std::sin(12.9 * static_cast<Real>(node) + 78.2 * i);
  }
  return mesh;
}

/// Bisection towards a front produces a bounded number of shapes: the worst shape occurs in the first 6 passes.
TEST(Bisect, KeepsShapesTowardsAFront) {
  for (const auto& cell : simplices) {
    const auto box = unit_steps(cell, std::vector<int>(dim_of(cell), 3));
    const auto mesh = shaken(make_box(box));
    const CellGeometry geometry(mesh.shape);
    const auto worst = [&](const GlobalMesh& of) {
      Real minimum = 1;
      for (GlobalIndex c = 0; c < of.n_cells(); ++c) minimum = std::min(minimum, geometry.scaled_jacobian(of, c)[0]);
      return minimum;
    };
    Bisection bisection(mesh);
    refine_towards(front_in(box), 6, bisection);
    const Real early = worst(bisection.mesh());
    refine_towards(front_in(box), 12, bisection);
    const auto fine = bisection.mesh();
    expect_conforming(fine);
    EXPECT_GT(early, 0.25 * worst(mesh)) << cell;
    EXPECT_GT(worst(fine), 0.99 * early) << cell;
  }
}

/// Compresses the mesh along the diagonal until each cell has several longest edges.
GlobalMesh pressed(GlobalMesh mesh) {
  const int dim = mesh.dim();
  const Real less = (1 - (dim == 2 ? std::sqrt(1.0 / 3) : 0.5)) / dim;
  for (auto x = mesh.coordinates.begin(); x != mesh.coordinates.end(); x += dim) {
    const Real sum = std::accumulate(x, x + dim, Real{0});
    for (int i = 0; i < dim; ++i) x[i] -= less * sum;
  }
  return mesh;
}

/// Rotates the local node numbers of every second cell.
GlobalMesh turned(GlobalMesh mesh) {
  const int n = n_corners(mesh.shape);
  for (GlobalIndex c = 0; c < mesh.n_cells(); c += 2)
    std::rotate(&mesh.cells[c * n], &mesh.cells[c * n] + 1, &mesh.cells[c * n] + 3);
  const auto turn = [](GlobalIndex cell, int& face) {
    if (cell % 2 == 0 && face < 3) face = (face + 2) % 3;
  };
  for (auto& face : mesh.boundary_faces) turn(face.cell, face.local_face);
  for (auto& face : mesh.fracture_faces)
    for (int side : {minus, plus}) turn(face.cell[side], face.local_face[side]);
  return mesh;
}

/// The choice between edges of equal length, too, depends on coordinates only.
TEST(Bisect, DoesNotDependOnNumbers) {
  for (const auto& cell : simplices)
    for (auto box : boxes(cell)) {
      Bisection bisection(pressed(make_box(box)));
      box.renumbering_seed = 5;
      Bisection other(turned(pressed(make_box(box))));
      for (auto* one : {&bisection, &other}) refine_towards(front_in(box), 5, *one);
      EXPECT_TRUE(places_of(bisection.mesh()) == places_of(other.mesh())) << cell;
    }
}

/// As many bisections as dimensions halve the width of a cell. Both sides cut a face equally, so no cell needs more
/// bisections. Cells of boxes keep their shape.
TEST(Bisect, HalvesChildrenToo) {
  for (const auto& cell : simplices)
    for (const bool shakes : {false, true}) {
      auto mesh = make_box(unit_steps(cell, std::vector<int>(dim_of(cell), 3)));
      if (shakes) mesh = shaken(mesh);
      std::vector<GlobalIndex> all(mesh.n_cells());
      std::iota(all.begin(), all.end(), GlobalIndex{0});
      Bisection bisection(mesh);
      bisection.refine(all, mesh.dim());
      EXPECT_EQ(bisection.n_cells(), mesh.n_cells() << mesh.dim()) << cell << " " << shakes;
      expect_conforming(bisection.mesh());
      if (!shakes) {
        EXPECT_EQ(shapes_of(bisection.mesh()), shapes_of(mesh)) << cell;
      }
    }
}

/// The cells with the same parent have its volume and region, and the first moments of the volume.
TEST(Bisect, ReturnsTheParents) {
  for (const auto& cell : simplices) {
    const auto mesh = shaken(make_box(unit_steps(cell, std::vector<int>(dim_of(cell), 3))));
    Bisection bisection(mesh);
    const auto parent = bisection.refine({0, 1, 5}, 2);
    const auto fine = bisection.mesh();
    ASSERT_EQ(static_cast<GlobalIndex>(parent.size()), fine.n_cells());
    std::vector<Real> volume(mesh.n_cells(), 0);
    std::vector<Vector> moment(mesh.n_cells());
    for (GlobalIndex c = 0; c < fine.n_cells(); ++c) {
      volume[parent[c]] += cell_volume(fine, c);
      moment[parent[c]] = moment[parent[c]] + cell_volume(fine, c) * cell_centre(fine, c);
      EXPECT_EQ(fine.cell_region[c], mesh.cell_region[parent[c]]);
    }
    for (GlobalIndex c = 0; c < mesh.n_cells(); ++c) {
      EXPECT_NEAR(volume[c], cell_volume(mesh, c), 1e-13);
      EXPECT_LT(norm(moment[c] - cell_volume(mesh, c) * cell_centre(mesh, c)), 1e-12);
    }
  }
}

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
      std::vector<GlobalIndex> parent(bisection.n_cells());
      std::iota(parent.begin(), parent.end(), 0);
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

/// The rotation of an extension leaves the rest of the fracture where it is.
TEST(Extension, TurnsAboutItsBeginning) {
  for (const int degrees : {-14, -5, 3, 14}) {
    Bisection bisection(make_box(with_crack()));
    std::vector<GlobalIndex> parent(bisection.n_cells());
    std::iota(parent.begin(), parent.end(), 0);
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
  std::vector<GlobalIndex> parent(bisection.n_cells());
  std::iota(parent.begin(), parent.end(), 0);
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
    std::vector<GlobalIndex> parent(bisection.n_cells());
    std::iota(parent.begin(), parent.end(), 0);
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
  std::vector<GlobalIndex> parent(bisection.n_cells());
  std::iota(parent.begin(), parent.end(), 0);
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
      std::vector<GlobalIndex> parent(bisection.n_cells());
      std::iota(parent.begin(), parent.end(), 0);
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
      std::vector<GlobalIndex> parent(bisection.n_cells());
      std::iota(parent.begin(), parent.end(), 0);
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

/// A fracture whose end is beside the line is met, but not crossed: its margin of crossing is unknown.
TEST(Extension, EndsAtAFractureBesideTheLine) {
  for (const Real slope : {-0.05, 0.05}) {
    auto box = with_crack();
    box.fractures["wall"] = fracture({6, 4}, {6, 6});
    Bisection bisection(make_box(box));
    std::vector<GlobalIndex> parent(bisection.n_cells());
    std::iota(parent.begin(), parent.end(), 0);
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
  std::vector<GlobalIndex> parent(bisection.n_cells());
  std::iota(parent.begin(), parent.end(), 0);
  EXPECT_EQ(bisection.extend({{5, 4}, {1, 0}, 1, 0.3, 0.7}, parent), Extended::junction);
  EXPECT_NEAR(sizes_of(bisection.mesh()).at("minus crack")[0], 3, 0.1);
}

/// Two tips of one round of growth that meet: the second one has no tip any more.
TEST(Extension, OfATipThatAnotherHasJoinedIsAJunction) {
  auto box = with_crack();
  box.fractures["other"] = fracture({6, 4}, {7, 4});
  Bisection bisection(make_box(box));
  std::vector<GlobalIndex> parent(bisection.n_cells());
  std::iota(parent.begin(), parent.end(), 0);
  EXPECT_EQ(bisection.extend({{5, 4}, {1, 0}, 1, 0.3}, parent), Extended::junction);
  EXPECT_EQ(bisection.extend({{6, 4}, {-1, 0}, 1, 0.3}, parent), Extended::junction);
  expect_conforming(bisection.mesh());
  EXPECT_EQ(n_tips(bisection.mesh()), 2);
}

TEST(Bisect, RefusesOtherCells) {
  const auto of = [](BoxMesh box) { return error_of([&] { Bisection{make_box(box)}; }); };
  EXPECT_THAT(of(unit_steps("hexahedron", {2, 2, 2})), HasSubstr("needs triangles or tetrahedra"));
  auto tied = unit_steps("triangle", {3, 3});
  tied.periodic = {"x"};
  EXPECT_THAT(of(tied), HasSubstr("without periodic sides"));
}

}  // namespace
}  // namespace sprekk::mesh::testing
