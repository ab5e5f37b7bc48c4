// Inclined fracture through a box under uniform stress, on Gmsh meshes with faces on the fracture.
#include "verification/patch/inclined.hpp"

namespace sprekk::tests {
namespace {

/// Independent values of the formulas.
TEST(InclinedPatch, Formulas) {
  struct Example {
    bool slips;
    Vector3 n;
    Real xx, xy, yy, j_x, j_y;
  };
  const Example examples[] = {
      {false, {0, 1, 0}, -0.15, 0.05, -0.05, 0.05, -0.0275},
      {false,
       {-0.5, std::sqrt(0.75), 0},
       -0.168301270189,
       -0.018301270189,
       -0.031698729811,
       0.05705127018922,
       0.00118430139593},
      {true,
       {-0.5, std::sqrt(0.75), 0},
       -0.202942286341,
       0.001698729811,
       0.002942286341,
       0.28615776469815,
       0.18436021256246},
      {true, {0.31, -0.95, 0}, -0.193460845183, 0.043186461045, -0.006539154817, -0.31808239465614, -0.12123755393002}};
  for (const auto& e : examples) {
    const auto patch = inclined_patch(2, e.n, e.slips);
    EXPECT_NEAR(patch.strain[0][0], e.xx, 1e-12);
    EXPECT_NEAR(patch.strain[0][1], e.xy, 1e-12);
    EXPECT_NEAR(patch.strain[1][1], e.yy, 1e-12);
    EXPECT_NEAR(patch.strain[2][2], 0, 1e-15);
    EXPECT_NEAR(patch.joints.at("f1").jump()[0], e.j_x, 1e-13);
    EXPECT_NEAR(patch.joints.at("f1").jump()[1], e.j_y, 1e-13);
  }
  for (const int dim : {2, 3})
    for (const auto& n : inclined_normals(dim))
      for (const bool slips : {false, true}) {
        const auto joint = inclined_patch(dim, n, slips).joints.at("f1");
        const Real j_n = dot(joint.jump(), joint.n), j = norm(joint.jump());
        EXPECT_NEAR(j_n, slips ? 0.016581745177 : -0.0275, 1e-12);
        EXPECT_NEAR(std::sqrt(j * j - j_n * j_n), slips ? 0.34 : 0.05, 1e-14);
        EXPECT_NEAR(joint.N, 0.3, 1e-15);
      }
}

/// The scenes themselves, and with cells of order 2.
TEST(InclinedPatch, Scenes) {
  for (const int order : {1, 2}) {
    const auto set_order = fmt::format("Mesh file.order={}", order);
    expect_solves(read_scene("verification/inclined_2d.xml", {set_order}),
                  inclined_patch(2, inclined_normals(2)[1], true), tolerance);
    expect_solves(read_scene("verification/inclined_3d.xml", {set_order}),
                  inclined_patch(3, inclined_normals(3)[0], false), tolerance);
  }
}

TEST(InclinedPatch, EveryNormalAndCell) {
  for (const int dim : {2, 3})
    for (const auto& cell : cells_of(dim))
      for (std::size_t k = 0; k < inclined_normals(dim).size(); ++k)
        for (const int order : {1, 2})
          for (const bool slips : {false, true}) {
            const auto mesh = fmt::format("cut_{}{}_{}.msh", dim == 2 ? "lines" : "plane", k + 1, cell);
            SCOPED_TRACE(fmt::format("{}, order {}, {}", mesh, order, slips ? "slip" : "stick"));
            auto scene =
                read_scene(fmt::format("verification/inclined_{}d.xml", dim),
                           {"Mesh file.path=../../tests/data/meshes/" + mesh, fmt::format("Mesh file.order={}", order),
                            fmt::format("Mesh file.fractures.f1.swap sides={}", k % 2 == 1)});
            const auto patch = inclined_patch(dim, inclined_normals(dim)[k], slips);
            prescribe(scene, patch);
            expect_solves(scene, patch, tolerance);
          }
}

}  // namespace
}  // namespace sprekk::tests
