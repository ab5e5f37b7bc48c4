// Floating blocks: an error message without equilibrium, or rest without a load.
#include "verification/contact/states.hpp"

#include <gmock/gmock.h>

namespace sprekk::tests {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

/// The slope is steeper than the angle of friction.
TEST(Floating, SlidesDown) {
  for (const int dim : {2, 3}) {
    auto scene =
        read_scene(fmt::format("contact/incline_{}d.xml", dim), {fmt::format("Mesh.rotation={}", dim == 2 ? 45 : -45)});
    model::Model model(scene, Tpetra::getDefaultComm());
    const auto report = model.step_to(1);
    EXPECT_FALSE(report.converged);
    EXPECT_EQ(model.time(), 0);
    EXPECT_THAT(report.reason, HasSubstr("no equilibrium"));
    EXPECT_THAT(report.reason, HasSubstr("a piece of rock around ("));
    const std::string other = dim == 3 ? ", 0" : "";
    EXPECT_THAT(report.reason, AnyOf(HasSubstr(fmt::format("can move along (0.707107{}, 0.707107)", other)),
                                     HasSubstr(fmt::format("can move along (-0.707107{}, -0.707107)", other))));
  }
}

/// The body force lifts the block.
TEST(Floating, LiftedWithoutEnd) {
  for (const int dim : {2, 3}) {
    auto scene =
        read_scene(fmt::format("contact/incline_{}d.xml", dim),
                   {"Mesh.rotation=0", dim == 2 ? "Bulk.body force={0, 0.01}" : "Bulk.body force={0, 0, 0.01}"});
    model::Model model(scene, Tpetra::getDefaultComm());
    const auto report = model.step_to(1);
    EXPECT_FALSE(report.converged);
    EXPECT_THAT(report.reason, HasSubstr("no equilibrium"));
    EXPECT_THAT(report.reason, HasSubstr("a piece of rock around ("));
    EXPECT_THAT(report.reason, HasSubstr("can move along ("));
  }
}

/// A block under compression and shear is then lifted at its upper side, without tangential force.
TEST(Floating, LiftedRestsWhereItIs) {
  for (const int dim : {2, 3}) {
    auto scene =
        read_scene(fmt::format("verification/stack_{}d.xml", dim),
                   {dim == 2 ? "Boundary conditions.moved.displacement={free, -0.1 + 0.4*max(t - 1, 0)}"
                             : "Boundary conditions.moved.displacement={free, free, -0.1 + 0.4*max(t - 1, 0)}"});
    scene.fractures.erase("upper"), scene.mesh.fractures.erase("upper");
    scene.fractures.erase("lower"), scene.mesh.fractures.erase("lower");
    model::Model model(scene, Tpetra::getDefaultComm());
    auto report = model.step_to(1);
    ASSERT_TRUE(report.converged) << report.reason;
    EXPECT_EQ(report.floating, "");
    report = model.step_to(2);
    ASSERT_TRUE(report.converged) << report.reason;
    EXPECT_THAT(report.floating, HasSubstr("a piece of rock around ("));
    EXPECT_THAT(report.floating, HasSubstr("can move along ("));
    const Outputs out(model);
    for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
      const auto jump = out.vector("jump", f), traction = out.vector("traction", f);
      const Real sign = model.mesh().fracture_faces[f].frame[0][dim - 1] > 0 ? 1 : -1;
      EXPECT_NEAR(sign * jump[dim - 1], 0.3, 1e-10);
      for (int i = 0; i < dim - 1; ++i) EXPECT_NEAR(jump[i], 0, 1e-10);
      for (int i = 0; i < dim; ++i) EXPECT_NEAR(traction[i], 0, 1e-10);
    }
  }
}

}  // namespace
}  // namespace sprekk::tests
