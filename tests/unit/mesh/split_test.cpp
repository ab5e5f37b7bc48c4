#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "meshes.hpp"

namespace sprekk::mesh::testing {
namespace {

using ::testing::HasSubstr;

/// Returns the number of nodes that the fractures add.
GlobalIndex copies(const BoxMesh& box) {
  auto whole = box;
  whole.fractures.clear();
  return make_box(box).n_nodes() - make_box(whole).n_nodes();
}

struct SplitCase {
  const char* name;
  std::vector<std::array<std::array<Real, 2>, 2>> fractures;
  int copies, faces;  ///< in 2D; three times the copies and twice the faces when extruded
};

// 6 x 4 box. Copies are counted by hand: one per node that is not a tip, two more at a T, three more at a crossing.
const std::vector<SplitCase> split_cases{{"immersed", {{{{1, 2}, {5, 2}}}}, 3, 4},
                                         {"one face", {{{{2, 2}, {3, 2}}}}, 0, 1},
                                         {"to the boundary", {{{{0, 2}, {4, 2}}}}, 4, 4},
                                         {"through", {{{{0, 2}, {6, 2}}}}, 7, 6},
                                         {"X of two through", {{{{0, 2}, {6, 2}}}, {{{3, 0}, {3, 4}}}}, 6 + 4 + 3, 10},
                                         {"X of two immersed", {{{{1, 2}, {5, 2}}}, {{{3, 1}, {3, 3}}}}, 2 + 3, 6},
                                         {"T", {{{{0, 2}, {6, 2}}}, {{{3, 2}, {3, 4}}}}, 6 + 2 + 2, 8},
                                         {"L at two tips", {{{{1, 2}, {3, 2}}}, {{{3, 2}, {3, 3}}}}, 2, 3},
                                         {"in line at a tip", {{{{1, 2}, {3, 2}}}, {{{3, 2}, {5, 2}}}}, 3, 4},
                                         {"parallel", {{{{1, 1}, {5, 1}}}, {{{1, 2}, {5, 2}}}}, 6, 8}};

TEST(Split, CopiesOfNodes) {
  for (const auto& cell : all_cells)
    for (const auto& c : split_cases) {
      const bool flat = dim_of(cell) == 2;
      auto box = unit_steps(cell, flat ? std::vector<int>{6, 4} : std::vector<int>{6, 4, 2});
      for (std::size_t f = 0; f < c.fractures.size(); ++f) {
        const auto& [a, b] = c.fractures[f];
        box.fractures["f" + std::to_string(f)] =
            flat ? fracture({a[0], a[1]}, {b[0], b[1]}) : fracture({a[0], a[1], 0}, {b[0], b[1], 2});
      }
      EXPECT_EQ(copies(box), flat ? c.copies : 3 * c.copies) << c.name << " " << cell;
      const int triangles = cell == "tetrahedron" ? 2 : 1;
      EXPECT_EQ(static_cast<int>(make_box(box).fracture_faces.size()), flat ? c.faces : 2 * c.faces * triangles)
          << c.name << " " << cell;
    }
}

TEST(Split, CopiesOfNodesIn3D) {
  for (const char* cell : {"tetrahedron", "hexahedron"}) {
    auto box = unit_steps(cell, {5, 4, 4});
    box.fractures["a"] = fracture({1, 1, 2}, {4, 3, 2});  // inner nodes 2 x 1
    EXPECT_EQ(copies(box), 2) << cell;
    box.fractures["a"] = fracture({0, 0, 2}, {5, 4, 2});
    EXPECT_EQ(copies(box), 30) << cell;
    box.fractures["b"] = fracture({0, 2, 0}, {5, 2, 4});  // crosses along 6 nodes
    EXPECT_EQ(copies(box), 2 * 30 + 6) << cell;
    box.fractures["c"] = fracture({2, 0, 0}, {2, 4, 4});  // 8 octants meet in one node; 4 copies along six half lines
    const int lines = 5 + 4 + 4, planes = 5 * 4 + 5 * 4 + 4 * 4;
    EXPECT_EQ(copies(box), 7 + 3 * lines + planes) << cell;
  }
}

TEST(Split, TwoSidesLieApartAndCoincide) {
  for (const auto& cell : all_cells) {
    const auto mesh = make_box(crossed(cell));
    EXPECT_EQ(mesh.fracture_names, (std::vector<std::string>{"a", "b", "c"}));
    for (const auto& face : mesh.fracture_faces) {
      const Vector n = normal(mesh, face);
      const Vector opposite = area_vector(mesh, face.cell[plus], face.local_face[plus]);
      EXPECT_NEAR(dot(n, opposite), -norm(opposite), 1e-14);
      const Vector centre = face_centre(mesh, face.cell[minus], face.local_face[minus]);
      EXPECT_LT(norm(centre - face_centre(mesh, face.cell[plus], face.local_face[plus])), 1e-14);
      EXPECT_LT(dot(n, cell_centre(mesh, face.cell[minus]) - centre), 0);
      EXPECT_GT(dot(n, cell_centre(mesh, face.cell[plus]) - centre), 0);
    }
  }
}

Vector normal_of(const BoxMesh& box) {
  const auto mesh = make_box(box);
  const Vector first = normal(mesh, mesh.fracture_faces.front());
  for (const auto& face : mesh.fracture_faces) EXPECT_LT(norm(normal(mesh, face) - first), 1e-14);
  return first;
}

void expect_equal(const Vector& a, const Vector& b) {
  EXPECT_LT(norm(a - b), 1e-14) << a[0] << ' ' << a[1] << ' ' << a[2];
}

TEST(Orientation, RuleIn2D) {
  for (const char* cell : {"triangle", "quadrilateral"}) {
    auto box = unit_steps(cell, {4, 4});
    auto& f = box.fractures["f"] = fracture({1, 2}, {3, 2});
    expect_equal(normal_of(box), {0, 1, 0});
    box.rotation = 180;
    expect_equal(normal_of(box), {0, 1, 0});
    box.rotation = 90;  // the normal is (-1, 0) up to round-off: x decides
    expect_equal(normal_of(box), {1, 0, 0});
    box.rotation = 30;
    expect_equal(normal_of(box), {-0.5, std::sqrt(0.75), 0});
    f.swap_sides = true;
    expect_equal(normal_of(box), {0.5, -std::sqrt(0.75), 0});
    box.rotation = 0;
    expect_equal(normal_of(box), {0, -1, 0});
    f.reference_normal = std::vector<Real>{5, -1e-6};
    expect_equal(normal_of(box), {0, 1, 0});
    f.swap_sides = false;
    expect_equal(normal_of(box), {0, -1, 0});
    box.rotation = 90;  // the reference normal is rotated with the box
    expect_equal(normal_of(box), {1, 0, 0});
    f.reference_normal = std::vector<Real>{0, 1};
    expect_equal(normal_of(box), {-1, 0, 0});
    box.renumbering_seed = 3;
    expect_equal(normal_of(box), {-1, 0, 0});
    f.reference_normal = std::vector<Real>{1, 0};
    EXPECT_THAT(error_of([&] { make_box(box); }), HasSubstr("perpendicular"));
    f.reference_normal = std::vector<Real>{1, 0, 0};
    EXPECT_THAT(error_of([&] { make_box(box); }), HasSubstr("reference normal"));
  }
}

TEST(Orientation, RuleIn3D) {
  for (const char* cell : {"tetrahedron", "hexahedron"}) {
    auto box = unit_steps(cell, {4, 4, 4});
    box.fractures["f"] = fracture({1, 1, 2}, {3, 3, 2});
    expect_equal(normal_of(box), {0, 0, 1});
    box.rotation_axis = {2, 0, 0};
    box.rotation = 90;
    expect_equal(normal_of(box), {0, 1, 0});
    box.rotation_axis = {0, 1, 0};
    box.rotation = -90;
    expect_equal(normal_of(box), {1, 0, 0});
    box.rotation = 120;
    expect_equal(normal_of(box), {-std::sqrt(0.75), 0, 0.5});
    box.fractures["f"].swap_sides = true;
    expect_equal(normal_of(box), {std::sqrt(0.75), 0, -0.5});
  }
}

/// Returns an unsplit box with names of fractures, for mark().
GlobalMesh plain(const std::string& cell, std::vector<int> n, std::vector<std::string> fractures) {
  auto mesh = make_box(unit_steps(cell, std::move(n)));
  mesh.fracture_names = std::move(fractures);
  return mesh;
}

TEST(Orientation, ClosedFracturePointsOutward) {
  auto mesh = plain("quadrilateral", {3, 3}, {"ring"});
  const Vector middle{1.5, 1.5, 0};
  auto ring = split(mesh, mark(mesh, 0, [&](const Vector& x) { return norm(x - middle) < 0.6; }));
  EXPECT_EQ(ring.n_nodes(), 16 + 4);
  ASSERT_EQ(ring.fracture_faces.size(), 4u);
  for (const auto& face : ring.fracture_faces) EXPECT_EQ(face.cell[minus], 4);

  mesh = plain("hexahedron", {3, 3, 3}, {"shell"});
  const Vector centre{1.5, 1.5, 1.5};
  auto shell = split(mesh, mark(mesh, 0, [&](const Vector& x) { return norm(x - centre) < 0.6; }));
  EXPECT_EQ(shell.n_nodes(), 64 + 8);
  ASSERT_EQ(shell.fracture_faces.size(), 6u);
  for (const auto& face : shell.fracture_faces) EXPECT_EQ(face.cell[minus], 13);
  shell = split(mesh, mark(mesh, 0, [&](const Vector& x) { return norm(x - centre) < 0.6; }), {{std::nullopt, true}});
  for (const auto& face : shell.fracture_faces) EXPECT_EQ(face.cell[plus], 13);
}

TEST(Orientation, StaircaseIsConsistent) {
  // Stairs with three steps: (0,1)-(1,1)-(1,2)-(2,2)-(2,3)-(3,3). One side is above left, the other below right.
  const auto mesh = plain("quadrilateral", {3, 4}, {"stairs"});
  const auto stairs = split(mesh, mark(mesh, 0, [](const Vector& x) { return x[1] - x[0] == 0.5; }));
  ASSERT_EQ(stairs.fracture_faces.size(), 5u);
  for (const auto& face : stairs.fracture_faces) {
    const Vector n = normal(stairs, face);
    EXPECT_TRUE(n == (Vector{0, 1, 0}) || n == (Vector{-1, 0, 0})) << n[0] << ' ' << n[1];
  }
}

TEST(Orientation, PiecesOfOneFractureEachObeyTheRule) {
  const auto mesh = plain("triangle", {6, 4}, {"pieces"});
  auto marks = mark(mesh, 0, [](const Vector& x) { return x[1] == 1 && x[0] < 2; });
  const auto more = mark(mesh, 0, [](const Vector& x) { return x[0] == 4 && x[1] < 3; });
  marks.insert(marks.end(), more.begin(), more.end());
  const auto pieces = split(mesh, marks);
  ASSERT_EQ(pieces.fracture_faces.size(), 5u);
  for (int f = 0; f < 5; ++f)
    expect_equal(normal(pieces, pieces.fracture_faces[f]), f < 2 ? Vector{0, 1, 0} : Vector{1, 0, 0});
}

TEST(Orientation, OneSidedSurfaceIsAnError) {
  // Moebius strip of the triangles (i, i+1, i+2) mod 5; each is the base of a tetrahedron.
  GlobalMesh mesh;
  mesh.shape = Shape::tetrahedron;
  mesh.fracture_names = {"strip"};
  std::vector<GlobalMesh::FractureFace> faces;
  for (GlobalIndex i = 0; i < 5; ++i) {
    for (GlobalIndex node : {i, (i + 1) % 5, (i + 2) % 5, GlobalIndex{5}}) mesh.cells.push_back(node);
    faces.push_back({0, {i, i}, {3, 3}});
  }
  for (int i = 0; i < 6; ++i)
    mesh.coordinates.insert(mesh.coordinates.end(), {std::cos(i * 1.2), std::sin(i * 1.2), 0.1 * i});
  EXPECT_THAT(error_of([&] { orient(mesh, faces, {}); }), HasSubstr("one-sided"));
  faces.pop_back();
  EXPECT_EQ(error_of([&] { orient(mesh, faces, {}); }), "");
}

TEST(Split, Errors) {
  const auto mesh = plain("quadrilateral", {2, 1}, {"a", "b"});
  const MarkedFace from_left{0, 0, 1}, from_right{1, 1, 3}, outer{0, 0, 3};
  EXPECT_THAT(error_of([&] { split(mesh, {from_left, from_right}); }), HasSubstr("\"a\" and \"b\" overlap"));
  EXPECT_THAT(error_of([&] { split(mesh, {outer}); }), HasSubstr("boundary"));
  EXPECT_THAT(error_of([&] { split(mesh, {from_left}); }), HasSubstr("\"b\": has no interior face"));
  EXPECT_THAT(error_of([&] { split(mesh, {from_left}, {Orientation{}}); }), HasSubstr("orientations"));
  auto same = from_right;
  same.fracture = 0;
  auto one = mesh;
  one.fracture_names = {"a"};
  const auto done = split(one, {from_left, same});
  EXPECT_EQ(done.fracture_faces.size(), 1u);
  EXPECT_EQ(done.n_nodes(), 8);
  EXPECT_THAT(error_of([&] { split(done, {from_left}); }), HasSubstr("unsplit"));

  GlobalMesh book;  // three triangles on one edge
  book.shape = Shape::triangle;
  book.coordinates = {0, 0, 1, 0, 0, 1, 1, 1, 2, 2};
  book.cells = {0, 1, 2, 0, 1, 3, 0, 1, 4};
  book.cell_region = {0, 0, 0};
  EXPECT_THAT(error_of([&] { face_neighbours(book); }), HasSubstr("share one face"));
}

}  // namespace
}  // namespace sprekk::mesh::testing
