#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

#include "base/parameters.hpp"
#include "mesh/renumber.hpp"
#include "meshes.hpp"

namespace sprekk::mesh::testing {
namespace {

using ::testing::HasSubstr;

TEST(Box, CellsHavePositiveVolumesThatFillTheBox) {
  for (const auto& cell : all_cells) {
    const bool flat = dim_of(cell) == 2;
    BoxMesh box;
    box.cell = cell;
    box.lower_corner = flat ? std::vector<Real>{-1, 2} : std::vector<Real>{-1, 2, 0.5};
    box.upper_corner = flat ? std::vector<Real>{2, 2.5} : std::vector<Real>{2, 2.5, 1.5};
    box.cells = flat ? std::vector<int>{5, 3} : std::vector<int>{5, 3, 2};
    box.rotation = 25;
    box.rotation_axis = {1, 2, -1};
    const auto mesh = make_box(box);
    Real volume = 0;
    for (GlobalIndex c = 0; c < mesh.n_cells(); ++c) {
      EXPECT_GT(cell_volume(mesh, c), 0) << cell << c;
      volume += cell_volume(mesh, c);
    }
    EXPECT_NEAR(volume, 1.5, 1e-13) << cell;
    const std::map<std::string, int> cells_per_block{
        {"triangle", 2}, {"quadrilateral", 1}, {"tetrahedron", 6}, {"hexahedron", 1}};
    EXPECT_EQ(mesh.n_cells(), (flat ? 15 : 30) * cells_per_block.at(cell)) << cell;
    EXPECT_EQ(mesh.n_nodes(), flat ? 24 : 72) << cell;
  }
}

TEST(Box, BoundariesCoverTheSurfaceOnce) {
  for (const auto& cell : all_cells) {
    const bool flat = dim_of(cell) == 2;
    const auto mesh = make_box(unit_steps(cell, flat ? std::vector<int>{4, 3} : std::vector<int>{4, 3, 2}));
    const std::vector<std::string> names{"west", "east", "south", "north", "bottom", "top"};
    ASSERT_EQ(mesh.boundary_names, std::vector<std::string>(names.begin(), names.begin() + 2 * mesh.dim()));
    std::vector<Vector> area(mesh.boundary_names.size());
    for (const auto& face : mesh.boundary_faces)
      area[face.boundary] = area[face.boundary] + area_vector(mesh, face.cell, face.local_face);
    const std::vector<Real> expected = flat ? std::vector<Real>{3, 4} : std::vector<Real>{6, 8, 12};
    for (int i = 0; i < mesh.dim(); ++i)
      for (int end : {0, 1})
        for (int j = 0; j < 3; ++j)
          EXPECT_NEAR(area[2 * i + end][j], i == j ? (end ? 1 : -1) * expected[i] : 0, 1e-13) << cell << i << end;
    const auto neighbour = face_neighbours(mesh);
    EXPECT_EQ(static_cast<std::size_t>(std::count(neighbour.begin(), neighbour.end(), -1)), mesh.boundary_faces.size());
  }
}

TEST(Box, DiagonalsAlternate) {
  const auto mesh = make_box(unit_steps("triangle", {2, 2}));
  std::vector<int> valence(9, 0);
  for (auto node : mesh.cells) ++valence[node];
  EXPECT_EQ(valence, (std::vector<int>{2, 2, 2, 2, 8, 2, 2, 2, 2}));
}

TEST(Box, RotationTurnsAboutTheOrigin) {
  auto box = unit_steps("quadrilateral", {1, 1});
  box.lower_corner = {1, 0};
  box.upper_corner = {2, 1};
  box.rotation = 90;
  const auto mesh = make_box(box);
  const std::vector<Real> expected{0, 1, 0, 2, -1, 1, -1, 2};
  for (int i = 0; i < 8; ++i) EXPECT_NEAR(mesh.coordinates[i], expected[i], 1e-15);
}

TEST(Box, RenumberingAndRotationKeepCountsAndMeasures) {
  for (const auto& cell : all_cells) {
    auto box = crossed(cell);
    const auto plain = make_box(box);
    box.rotation = 33;
    box.rotation_axis = {1, 1, 1};
    box.renumbering_seed = 7;
    const auto other = make_box(box);
    EXPECT_NE(plain.cells, other.cells);
    EXPECT_EQ(plain.n_nodes(), other.n_nodes());
    EXPECT_EQ(plain.boundary_faces.size(), other.boundary_faces.size());
    const auto measures = [](const GlobalMesh& mesh) {
      std::vector<Real> fractures(mesh.fracture_names.size()), boundaries(mesh.boundary_names.size()), volumes;
      for (const auto& f : mesh.fracture_faces)
        fractures[f.fracture] += norm(area_vector(mesh, f.cell[minus], f.local_face[minus]));
      for (const auto& f : mesh.boundary_faces) boundaries[f.boundary] += norm(area_vector(mesh, f.cell, f.local_face));
      for (GlobalIndex c = 0; c < mesh.n_cells(); ++c) volumes.push_back(cell_volume(mesh, c));
      fractures.insert(fractures.end(), boundaries.begin(), boundaries.end());
      fractures.insert(fractures.end(), volumes.begin(), volumes.end());
      return fractures;
    };
    const auto a = measures(plain), b = measures(other);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-12) << cell << i;
    for (const auto& f : other.fracture_faces) {
      const auto x = face_centre(other, f.cell[minus], f.local_face[minus]);
      EXPECT_LT(norm(x - face_centre(other, f.cell[plus], f.local_face[plus])), 1e-14);
    }
  }
}

TEST(Box, RenumberingDrawsAPermutation) {
  const auto mesh = make_box(unit_steps("hexahedron", {3, 2, 2}));
  const auto other = renumbered(mesh, 1);
  const auto points = [](const GlobalMesh& m) {
    std::multiset<std::vector<Real>> result;
    for (std::size_t i = 0; i < m.coordinates.size(); i += 3)
      result.insert({m.coordinates[i], m.coordinates[i + 1], m.coordinates[i + 2]});
    return result;
  };
  EXPECT_EQ(points(mesh), points(other));
  EXPECT_EQ(other.cells, renumbered(mesh, 1).cells);
  EXPECT_NE(other.cells, renumbered(mesh, 2).cells);
}

TEST(Box, IsReadFromParameters) {
  Teuchos::ParameterList list;
  list.set("cell", "triangle");
  list.set("lower corner", Teuchos::Array<double>(Teuchos::tuple<double>(0, 0)));
  list.set("upper corner", Teuchos::Array<double>(Teuchos::tuple<double>(6, 4)));
  list.set("cells", Teuchos::Array<int>(Teuchos::tuple<int>(6, 4)));
  list.set("rotation", 30.0);
  list.set("renumbering seed", 3);
  auto& joint = list.sublist("fractures").sublist("joint");
  joint.set("lower corner", Teuchos::Array<double>(Teuchos::tuple<double>(1, 2)));
  joint.set("upper corner", Teuchos::Array<double>(Teuchos::tuple<double>(5, 2)));
  joint.set("reference normal", Teuchos::Array<double>(Teuchos::tuple<double>(0, -1)));
  joint.set("swap sides", true);
  auto expected = unit_steps("triangle", {6, 4});
  expected.rotation = 30;
  expected.renumbering_seed = 3;
  expected.fractures["joint"] = fracture({1, 2}, {5, 2});
  expected.fractures["joint"].reference_normal = std::vector<Real>{0, -1};
  expected.fractures["joint"].swap_sides = true;
  const auto mesh = make_box(base::read<BoxMesh>(list, "box.xml", "Mesh")), same = make_box(expected);
  EXPECT_EQ(mesh.coordinates, same.coordinates);
  EXPECT_EQ(mesh.cells, same.cells);
  ASSERT_EQ(mesh.fracture_faces.size(), 4u);
  for (int f = 0; f < 4; ++f) EXPECT_EQ(mesh.fracture_faces[f].cell, same.fracture_faces[f].cell);
  list.set("cells", Teuchos::Array<int>(Teuchos::tuple<int>(6, 0)));
  EXPECT_THAT(error_of([&] { base::read<BoxMesh>(list, "box.xml", "Mesh"); }), HasSubstr("\"cells\""));
}

TEST(Box, ErrorsNameTheEntryAndWhatIsAllowed) {
  auto box = unit_steps("quadrilateral", {4, 4});
  box.upper_corner = {2, 2};
  const auto error_with = [&](BoxMesh::Fracture f) {
    auto copy = box;
    copy.fractures["joint"] = f;
    return error_of([&] { make_box(copy); });
  };
  EXPECT_EQ(error_with(fracture({0.5, 1}, {1.5, 1})), "");
  auto message = error_with(fracture({0.5, 1.2}, {1.5, 1.2}));
  for (auto part : {"\"joint\"", "y = 1.2", "1 and 1.5"}) EXPECT_THAT(message, HasSubstr(part));
  message = error_with(fracture({0.5, 1}, {1.7, 1}));
  for (auto part : {"\"joint\"", "x = 1.7", "1.5 and 2"}) EXPECT_THAT(message, HasSubstr(part));
  message = error_with(fracture({0.5, 1}, {2.5, 1}));
  for (auto part : {"\"joint\"", "x = 2.5", "1.5 and 2"}) EXPECT_THAT(message, HasSubstr(part));
  EXPECT_THAT(error_with(fracture({0.5, 1}, {0.5, 1})), HasSubstr("agree in 2 directions"));
  EXPECT_THAT(error_with(fracture({0.5, 1}, {1, 1.5})), HasSubstr("agree in 0 directions"));
  EXPECT_THAT(error_with(fracture({0.5, 2}, {1.5, 2})), HasSubstr("no interior face: y = 2 is the north boundary"));
  EXPECT_THAT(error_with(fracture({0, 0}, {0, 2})), HasSubstr("x = 0 is the west boundary"));
  EXPECT_THAT(error_with(fracture({1.5, 1}, {0.5, 1})), HasSubstr("below its lower corner"));
  EXPECT_THAT(error_with(fracture({1, 1, 1}, {0.5, 1})), HasSubstr("3 components"));

  auto overlapping = box;
  overlapping.fractures["first"] = fracture({0.5, 1}, {1.5, 1});
  overlapping.fractures["second"] = fracture({1, 1}, {2, 1});
  message = error_of([&] { make_box(overlapping); });
  for (auto part : {"\"first\"", "\"second\"", "overlap"}) EXPECT_THAT(message, HasSubstr(part));

  auto wrong = box;
  wrong.cell = "prism";
  EXPECT_THAT(error_of([&] { make_box(wrong); }), HasSubstr("\"prism\""));
  wrong = box;
  wrong.cell = "hexahedron";
  EXPECT_THAT(error_of([&] { make_box(wrong); }), HasSubstr("needs 3"));
  wrong = box;
  wrong.upper_corner = {2, 0};
  EXPECT_THAT(error_of([&] { make_box(wrong); }), HasSubstr("must exceed"));
  wrong = box;
  wrong.cells = {4, 0};
  EXPECT_THAT(error_of([&] { make_box(wrong); }), HasSubstr("must be positive"));
}

}  // namespace
}  // namespace sprekk::mesh::testing
