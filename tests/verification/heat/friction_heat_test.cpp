// Frictional heat of slipping fractures.
#include "../uniform/states.hpp"
#include "assembly/jacobian_check.hpp"
#include "base/over_ranks.hpp"
#include "unit/assembly/dense.hpp"
#include "warm_boxes.hpp"

namespace sprekk::tests {
namespace {

/// Returns the block of regimes_2d or 3d between tied sides: compressed by 0.2 m, and sheared by 0.3 m per second from
/// t = 1.
model::Scene sliding_block(int dim, Real dilation_angle, const std::vector<std::string>& law = {}) {
  auto scene = read_scene(fmt::format("verification/regimes_{}d.xml", dim), law);
  tie_sides(scene);
  for (int k = 0; k < dim - 1; ++k) scene.mesh.cells[k] = 3;
  auto& joint = scene.materials.at("joint");
  joint.dilation_angle = Expression(dilation_angle);
  joint.filling_heat_capacity = Expression(0);
  warm(scene, 10, 0.5, 3, 0);
  scene.heat->of_friction = true;
  auto& moved = scene.boundary_conditions.at("moved").displacement;
  moved.assign(dim, Expression(0));
  moved[0] = Expression("t > 1 ? 0.3*(t - 1) : 0");
  moved[dim - 1] = Expression(-0.2);
  return scene;
}

/// Returns the heat stored in the rock, over all ranks. Collective.
Real heat_of(model::Model& model) {
  const auto T = model.output("temperature").values;
  const auto volumes = assembly::cell_volumes(model.mesh());
  Real here = 0;
  for (LocalIndex c = 0; c < model.mesh().n_owned_cells; ++c) here += 3 * volumes[c] * T[c];
  return base::sum_over_ranks(*model.mesh().comm, here);
}

/// Returns the work of the traction on the change of the plastic jump since `plastic`, and updates `plastic`.
Real work_on(model::Model& model, std::vector<Real>& plastic) {
  const auto now = model.output("plastic jump local").values, traction = model.output("traction local").values;
  Real here = 0;
  const int dim = model.mesh().dim();
  for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f)
    for (int k = 0; k < dim; ++k)
      here += model.mesh().fracture_faces[f].area * traction[dim * f + k] * (now[dim * f + k] - plastic[dim * f + k]);
  plastic = now;
  return base::sum_over_ranks(*model.mesh().comm, here);
}

/// Without loss of heat: the gain in each step is the work of the traction on the plastic jump, including dilation.
/// Without dilation it is mu N times the slip.
TEST(HeatOfFriction, IsWhatSlidingDissipates) {
  for (const int dim : {2, 3})
    for (const Real angle : {0.0, 10.0}) {
      model::Model model(sliding_block(dim, angle), Tpetra::getDefaultComm());
      const auto& mesh = model.mesh();
      ASSERT_TRUE(model.step_to(1).converged) << dim;
      auto plastic = model.output("plastic jump local").values;
      Real before = heat_of(model), all_work = 0;
      EXPECT_NEAR(before, 30, 1e-10);
      for (int step = 1; step <= 8; ++step) {
        ASSERT_TRUE(model.step_to(1 + 0.5 * step).converged) << dim << " " << step;
        const auto old = plastic, traction = model.output("traction local").values;
        const Real work = work_on(model, plastic), after = heat_of(model);
        Real by_hand = 0;
        for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
          Real slip = 0;
          for (int k = 1; k < dim; ++k) slip += std::pow(plastic[dim * f + k] - old[dim * f + k], 2);
          by_hand -= mesh.fracture_faces[f].area * 0.6 * traction[dim * f] * std::sqrt(slip);
        }
        EXPECT_NEAR(after - before, work, 1e-10) << dim << " " << angle << " " << step;
        if (angle == 0) {
          EXPECT_NEAR(work, base::sum_over_ranks(*mesh.comm, by_hand), 1e-10) << dim << " " << step;
        }
        EXPECT_GE(work, -1e-12);
        before = after;
        all_work += work;
      }
      EXPECT_GT(all_work, 0.05) << dim << " " << angle;
    }
}

/// The gain of heat equals the work also if the dilation angle decreases within the step, by slip or wear.
TEST(HeatOfFriction, FollowsWhatSlipDoesToTheJoint) {
  const std::string joint = "Materials.joint.";
  for (const std::vector<std::string>& law : std::vector<std::vector<std::string>>{
           {joint + "dilation=decaying angle", joint + "dilation decay distance=0.5"},
           {joint + "damage=isotropic", joint + "residual part of friction=0.7", joint + "damage length of friction=1",
            joint + "residual part of dilation=0.2", joint + "damage length of dilation=0.5"}})
    for (const int dim : {2, 3}) {
      model::Model model(sliding_block(dim, 10, law), Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged) << law[0];
      auto plastic = model.output("plastic jump local").values;
      Real before = heat_of(model), all_work = 0;
      for (int step = 1; step <= 6; ++step) {
        ASSERT_TRUE(model.step_to(1 + 0.5 * step).converged) << law[0] << dim << " " << step;
        const Real work = work_on(model, plastic), after = heat_of(model);
        EXPECT_NEAR(after - before, work, 1e-9) << law[0] << " " << dim << " " << step;
        before = after;
        all_work += work;
      }
      EXPECT_GT(all_work, 0.05) << law[0];
    }
}

/// Tests the rows with the frictional power; rows of the joint are not differentiable everywhere and tested elsewhere.
TEST(HeatOfFriction, JacobianIsItsDerivative) {
  for (const int dim : {2, 3}) {
    model::Model model(sliding_block(dim, 10), Tpetra::getDefaultComm());
    auto& system = model.system();
    system.set_time(1, 0.5);
    auto x = system.initial();
    test::randomize(x, 0.3, 1);
    system.commit(x);
    test::randomize(x, 0.3, 2);
    int checked = 0;
    for (const auto& e : assembly::check_jacobian(system, x, 1e-6)) {
      if (e.module.find("jump") == std::string::npos || e.row != "face temperature") continue;
      ++checked;
      EXPECT_LE(e.error, 1e-5) << dim << ": " << e.row << ", " << e.column;
    }
    EXPECT_GE(checked, 3);
  }
}

}  // namespace
}  // namespace sprekk::tests
