#include "assembly/free_motion.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/check.hpp"
#include "unit/mesh/meshes.hpp"

namespace sprekk::assembly {
namespace {

using mesh::GlobalMesh;
using mesh::Vector;
using mesh::testing::all_cells;
using mesh::testing::crossed;
using mesh::testing::dim_of;
using mesh::testing::unit_steps;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::UnorderedElementsAre;

/// Returns a condition that constrains the components in `constrained`, e.g. "xz".
DirichletCondition constrain(const GlobalMesh& mesh, const std::string& boundary, const std::string& constrained,
                             int region = -1) {
  const auto found = std::find(mesh.boundary_names.begin(), mesh.boundary_names.end(), boundary);
  DirichletCondition condition{boundary, "displacement", static_cast<int>(found - mesh.boundary_names.begin()), {}};
  for (int i = 0; i < mesh.dim(); ++i)
    condition.values.push_back(
        constrained.find("xyz"[i]) == constrained.npos ? std::nullopt : std::make_optional(base::Expression(0.0)));
  condition.region = region;
  return condition;
}

std::vector<std::string> texts(const GlobalMesh& mesh, const std::vector<DirichletCondition>& conditions) {
  std::vector<std::string> result;
  for (const auto& motion : free_motions(mesh, conditions)) result.push_back(to_text(motion, mesh.dim()));
  return result;
}

/// Returns the union of both meshes, the second displaced by `shift` in x.
GlobalMesh both(GlobalMesh mesh, const GlobalMesh& other, Real shift) {
  const GlobalIndex n_nodes = mesh.n_nodes(), n_cells = mesh.n_cells();
  for (std::size_t k = 0; k < other.coordinates.size(); ++k)
    mesh.coordinates.push_back(other.coordinates[k] + (k % mesh.dim() == 0 ? shift : 0));
  for (GlobalIndex node : other.cells) mesh.cells.push_back(node + n_nodes);
  for (GlobalIndex node : other.parent_node) mesh.parent_node.push_back(node + n_nodes);
  const int region = static_cast<int>(mesh.region_names.size());
  mesh.region_names.push_back("second");
  mesh.cell_region.insert(mesh.cell_region.end(), other.cell_region.size(), region);
  for (auto face : other.boundary_faces) {
    face.cell += n_cells;
    mesh.boundary_faces.push_back(face);
  }
  for (auto face : other.fracture_faces) {
    for (auto& cell : face.cell) cell += n_cells;
    mesh.fracture_faces.push_back(face);
  }
  return mesh;
}

/// Checks that free motions satisfy the conditions: the largest displacement of a constrained component, or difference
/// between tied nodes, relative to the displacement of the body.
void expect_compatible(const GlobalMesh& mesh, const std::vector<DirichletCondition>& conditions) {
  const auto at = [](const FreeMotion& m, const Vector& x) {
    const Vector d{x[0] - m.centre[0], x[1] - m.centre[1], x[2] - m.centre[2]};
    const auto turned = mesh::cross(m.rotation, d);
    return Vector{m.translation[0] + turned[0], m.translation[1] + turned[1], m.translation[2] + turned[2]};
  };
  for (const auto& motion : free_motions(mesh, conditions)) {
    for (const auto& condition : conditions)
      for (const auto& face : mesh.boundary_faces)
        if (face.boundary == condition.boundary)
          for (int k = 0; k < mesh::n_face_nodes(mesh.shape); ++k) {
            const auto v = at(motion, mesh::point(mesh, mesh::nodes_of_face(mesh, face.cell, face.local_face)[k]));
            for (int i = 0; i < mesh.dim(); ++i) EXPECT_NEAR(condition.values[i] ? v[i] : 0, 0, 1e-9);
          }
    for (GlobalIndex node = mesh.n_free_nodes(); node < mesh.n_nodes(); ++node) {
      const auto a = at(motion, mesh::point(mesh, node)), b = at(motion, mesh::point(mesh, mesh.free_node(node)));
      for (int i = 0; i < mesh.dim(); ++i) EXPECT_NEAR(a[i], b[i], 1e-9);
    }
  }
}

TEST(FreeMotion, ConstrainedOnOneSideIsConstrained) {
  for (const auto& cell : all_cells)
    for (int order : {1, 2}) {
      auto box = crossed(cell);
      box.order = order;
      for (Real degrees : {0.0, 25.0}) {
        box.rotation = degrees;
        const auto mesh = make_box(box);
        EXPECT_THAT(texts(mesh, {constrain(mesh, "south", "xyz")}), ElementsAre()) << cell;
        EXPECT_THAT(texts(mesh, {constrain(mesh, "south", "xyz"), constrain(mesh, "north", "y")}), ElementsAre())
            << cell;
      }
    }
}

TEST(FreeMotion, NothingConstrained) {
  for (const auto& cell : all_cells) {
    const auto mesh = make_box(crossed(cell));  // 6 x 4 [x 2]
    if (dim_of(cell) == 2)
      EXPECT_THAT(texts(mesh, {}),
                  UnorderedElementsAre("can move along (1, 0)", "can move along (0, 1)", "can rotate about (3, 2)"));
    else
      EXPECT_THAT(texts(mesh, {}), UnorderedElementsAre("can move along (1, 0, 0)", "can move along (0, 1, 0)",
                                                        "can move along (0, 0, 1)",
                                                        "can rotate about the axis (1, 0, 0) through (3, 2, 1)",
                                                        "can rotate about the axis (0, 1, 0) through (3, 2, 1)",
                                                        "can rotate about the axis (0, 0, 1) through (3, 2, 1)"));
  }
}

TEST(FreeMotion, Rollers) {
  for (const auto& cell : all_cells) {
    const auto mesh = make_box(crossed(cell));
    std::vector<DirichletCondition> rollers{constrain(mesh, "west", "x")};
    if (dim_of(cell) == 2) {
      EXPECT_THAT(texts(mesh, rollers), ElementsAre("can move along (0, 1)"));
      rollers.push_back(constrain(mesh, "south", "y"));
    } else {
      rollers.push_back(constrain(mesh, "bottom", "z"));
      EXPECT_THAT(texts(mesh, rollers), ElementsAre("can move along (0, 1, 0)"));
      EXPECT_THAT(texts(mesh, {rollers[1]}),
                  UnorderedElementsAre("can move along (1, 0, 0)", "can move along (0, 1, 0)",
                                       "can rotate about the axis (0, 0, 1) through (3, 2, 1)"));
      rollers.push_back(constrain(mesh, "south", "y"));
    }
    EXPECT_THAT(texts(mesh, rollers), ElementsAre()) << cell;
  }
}

/// A roller constrains global components, for any orientation of its side.
TEST(FreeMotion, ObliqueRollers) {
  auto box = unit_steps("quadrilateral", {2, 2});
  box.rotation = 30;
  const auto mesh = make_box(box);
  const std::vector<DirichletCondition> rollers{constrain(mesh, "south", "y")};
  EXPECT_THAT(texts(mesh, rollers), ElementsAre("can move along (1, 0)"));
  const std::vector<DirichletCondition> two{constrain(mesh, "south", "y"), constrain(mesh, "west", "y")};
  EXPECT_THAT(texts(mesh, two), ElementsAre("can move along (1, 0)"));
}

/// Tetrahedra with a common edge, or a common corner: a body supported only by the other one can rotate.
TEST(FreeMotion, Hinges) {
  GlobalMesh hinge;
  hinge.shape = mesh::Shape::tetrahedron;
  hinge.coordinates = {0, 0, 0, 0, 0, 2, 1, 0, 0, 0, 1, 0, -1, 0, 0, 0, -1, 0};
  hinge.cells = {0, 2, 3, 1, 0, 4, 5, 1};
  hinge.cell_region = {0, 0};
  hinge.region_names = {"rock"};
  hinge.boundary_names = {"held"};
  hinge.boundary_faces = {{0, 0, 0}};
  EXPECT_THAT(texts(hinge, {constrain(hinge, "held", "xyz")}),
              ElementsAre("can rotate about the axis (0, 0, 1) through (0, 0, 1)"));
  EXPECT_EQ(free_motions(hinge, {constrain(hinge, "held", "xyz")}).front().body, 1);
  hinge.coordinates.insert(hinge.coordinates.end(), {0, 0, 3});
  hinge.cells = {0, 2, 3, 1, 6, 4, 5, 1};
  EXPECT_THAT(texts(hinge, {constrain(hinge, "held", "xyz")}),
              UnorderedElementsAre("can rotate about the axis (1, 0, 0) through (-0.5, 0, 2)",
                                   "can rotate about the axis (0, 1, 0) through (0, -0.5, 2)",
                                   "can rotate about the axis (0, 0, 1) through (0, 0, 1.5)"));
}

/// A triangle whose lower nodes, (0, 0) and (1, 0), are fixed in x: it can rotate, because these nodes move
/// vertically.
TEST(FreeMotion, RotationAboutAPoint) {
  GlobalMesh mesh;
  mesh.shape = mesh::Shape::triangle;
  mesh.coordinates = {0, 0, 1, 0, 0, 1};
  mesh.cells = {0, 1, 2};
  mesh.cell_region = {0};
  mesh.region_names = {"rock"};
  mesh.boundary_names = {"bottom"};
  mesh.boundary_faces = {{0, 0, 0}};
  const std::vector<DirichletCondition> in_x{constrain(mesh, "bottom", "x")};
  EXPECT_THAT(texts(mesh, in_x), UnorderedElementsAre("can move along (0, 1)", "can rotate about (0.5, 0)"));
  expect_compatible(mesh, in_x);
}

TEST(FreeMotion, DisconnectedBodies) {
  for (const auto& cell : all_cells) {
    const auto one = make_box(crossed(cell));
    const auto mesh = both(one, one, 10);
    EXPECT_THAT(texts(mesh, {constrain(mesh, "south", "xyz")}), ElementsAre()) << cell;
    const auto first_only = constrain(mesh, "south", "xyz", 0);
    const std::size_t n_free = dim_of(cell) == 2 ? 3 : 6;
    EXPECT_EQ(free_motions(mesh, {first_only}).size(), n_free) << cell;
    EXPECT_EQ(free_motions(mesh, {}).size(), 2 * n_free) << cell;
    const auto message = unconstrained(mesh, {first_only, constrain(mesh, "west", "x")});
    EXPECT_THAT(
        message,
        AllOf(HasSubstr("\"second\""), HasSubstr(fmt::format("{} cells of {}", one.n_cells(), 2 * one.n_cells())),
              HasSubstr(dim_of(cell) == 2 ? "it can move along (0, 1)" : "it can move along (0, 1, 0)"),
              HasSubstr("around (10.")));
    EXPECT_EQ(unconstrained(mesh, {first_only, constrain(mesh, "west", "xyz")}), "");
    EXPECT_THAT(unconstrained(mesh, {}), HasSubstr("and 1 more bodies"));
  }
}

/// Rock held only by contact is accepted: the half of a box above a fracture.
TEST(FreeMotion, ContactHolds) {
  for (const auto& cell : all_cells) {
    auto box = unit_steps(cell, dim_of(cell) == 2 ? std::vector<int>{2, 2} : std::vector<int>{2, 2, 1});
    box.fractures["f"] =
        dim_of(cell) == 2 ? mesh::testing::fracture({0, 1}, {2, 1}) : mesh::testing::fracture({0, 1, 0}, {2, 1, 1});
    const auto mesh = make_box(box);
    EXPECT_EQ(unconstrained(mesh, {constrain(mesh, "south", "xyz")}), "") << cell;
  }
}

TEST(FreeMotion, PeriodicSides) {
  auto box = unit_steps("quadrilateral", {3, 2});
  box.fractures["f"] = mesh::testing::fracture({0, 1}, {3, 1});
  box.periodic = {"x"};
  auto mesh = make_box(box);
  EXPECT_THAT(texts(mesh, {}), UnorderedElementsAre("can move along (1, 0)", "can move along (0, 1)"));
  EXPECT_THAT(texts(mesh, {constrain(mesh, "south", "y")}), ElementsAre("can move along (1, 0)"));
  EXPECT_THAT(texts(mesh, {constrain(mesh, "south", "xy")}), ElementsAre());
  for (const std::string cell : {"tetrahedron", "hexahedron"}) {
    auto cube = unit_steps(cell, {2, 2, 2});
    cube.periodic = {"y"};
    mesh = make_box(cube);
    EXPECT_THAT(texts(mesh, {constrain(mesh, "bottom", "z")}),
                UnorderedElementsAre("can move along (1, 0, 0)", "can move along (0, 1, 0)"));
    EXPECT_THAT(texts(mesh, {constrain(mesh, "west", "xy")}), UnorderedElementsAre("can move along (0, 0, 1)"));
    EXPECT_THAT(texts(mesh, {constrain(mesh, "bottom", "y")}),
                UnorderedElementsAre("can move along (1, 0, 0)", "can move along (0, 0, 1)",
                                     "can rotate about the axis (0, 1, 0) through (1, 1, 1)"));
    cube.periodic = {"x", "y"};
    mesh = make_box(cube);
    EXPECT_THAT(texts(mesh, {constrain(mesh, "top", "z")}),
                UnorderedElementsAre("can move along (1, 0, 0)", "can move along (0, 1, 0)"));
    expect_compatible(mesh, {constrain(mesh, "top", "z")});
  }
}

/// Very small and very large bodies, far from the origin, and a support that is small compared with the body.
TEST(FreeMotion, DoesNotDependOnUnitsOrOrigin) {
  for (Real size : {1e-6, 1e6})
    for (Real shift : {0.0, 1e4}) {
      auto box = unit_steps("hexahedron", {40, 40, 1});
      for (int i = 0; i < 3; ++i) {
        box.lower_corner[i] = shift * size;
        box.upper_corner[i] = shift * size + size * (i == 2 ? 0.1 : 1);
      }
      auto mesh = make_box(box);
      EXPECT_EQ(free_motions(mesh, {constrain(mesh, "bottom", "z")}).size(), 3u);
      EXPECT_EQ(free_motions(mesh, {constrain(mesh, "bottom", "xz")}).size(), 1u);
      EXPECT_EQ(free_motions(mesh, {constrain(mesh, "bottom", "xyz")}).size(), 0u);
      auto& faces = mesh.boundary_faces;
      const auto bottom =
          std::find(mesh.boundary_names.begin(), mesh.boundary_names.end(), "bottom") - mesh.boundary_names.begin();
      const auto one =
          *std::find_if(faces.begin(), faces.end(), [&](const auto& face) { return face.boundary == bottom; });
      faces = {one};  // one fortieth of the size
      EXPECT_EQ(free_motions(mesh, {constrain(mesh, "bottom", "xyz")}).size(), 0u);
    }
}

}  // namespace
}  // namespace sprekk::assembly
