// Crack tips with order 2.
#include "verification/tips/crack.hpp"

namespace sprekk::tests {
namespace {

/// 1,422 triangles. Without quarter points the errors are 1.9e-2 and 3.2e-2; the bounds are less than a sixth of
/// these.
TEST(QuarterPoints, OpeningAndSlidingOfACrack) {
  EXPECT_LE(jump_error(crack("opening", {"Mesh file.order=2"}), 1), 3.0e-3);
  EXPECT_LE(jump_error(crack("sliding", {"Mesh file.order=2"}), 0), 4.0e-3);
  EXPECT_GE(jump_error(crack("opening", {"Mesh file.order=2", "Mesh file.tips=plain"}), 1), 1.5e-2);
}

/// Four faces, or four by two triangles, along the crack.
TEST(QuarterPoints, OfAllCells) {
  for (const std::string cell : {"triangle", "quadrilateral", "tetrahedron", "hexahedron"})
    for (const auto& [name, direction] : {std::pair{"opening", 1}, std::pair{"sliding", 0}}) {
      SCOPED_TRACE(fmt::format("{} of {}", name, cell));
      const Real error = jump_error(crack_in_box(name, cell, 2, 8, "enriched"), direction),
                 plain = jump_error(crack_in_box(name, cell, 2, 8, "plain"), direction);
      EXPECT_LE(error, plain / 3.5);
      EXPECT_LE(error, 2.5e-2);
    }
}

/// Linear displacements are exact on meshes with tips: a sticking crack under uniform stress.
TEST(QuarterPoints, PatchAroundTips) {
  for (const std::string cell : {"triangle", "quadrilateral", "tetrahedron", "hexahedron"}) {
    SCOPED_TRACE(cell);
    auto scene = crack_in_box("opening", cell, 2, 4, "enriched");
    scene.bulk.initial_stress.clear();
    const int dim = static_cast<int>(scene.mesh.cells.size());
    auto patch = dim == 2 ? uniform_patch(2, {{{-0.8, 0.15, 0}, {0.15, -0.5, 0}, {0, 0, 0}}})
                          : uniform_patch(3, {{{-0.8, 0.15, -0.1}, {0.15, -0.5, 0.1}, {-0.1, 0.1, -0.6}}});
    patch.offset["bulk"] = {};
    patch.joints["crack"] = at_stress({std::numeric_limits<Real>::infinity(), 0, 0, 0, 1}, {0, 1, 0}, patch.stress, {});
    for (auto& [name, condition] : scene.boundary_conditions)
      condition.displacement = displacement_expressions(patch, "bulk");
    model::Model model(scene, Tpetra::getDefaultComm());
    const auto report = model.step_to(1);
    ASSERT_TRUE(report.converged) << report.reason;
    expect_patch(model, patch, 1e-11);
  }
}

}  // namespace
}  // namespace sprekk::tests
