// Pressures prescribed at points and lines of fractures, compared with exact solutions.
#include "boxes.hpp"

#include <gmock/gmock.h>

namespace sprekk::tests {
namespace {

/// Prescribes a pressure on fracture "a" at x = place, over the whole depth in 3D.
void hold(model::Scene& scene, Real place, const std::string& pressure, bool along_depth = true) {
  auto& held = scene.fractures.at("a").held_pressures["point"];
  held.pressure = base::Expression(pressure);
  held.lower_corner = held.upper_corner = {place, 0.5};
  if (scene.mesh.lower_corner.size() == 3) {
    held.lower_corner.push_back(0);
    held.upper_corner.push_back(along_depth ? 1 : 0);
  }
}

/// Fracture in impermeable rock with p = 1 and p = 0 at its ends, and 3 t in its middle: the pressure is linear on both
/// sides, with the flow a^3/(12 mu) times the gradient.
TEST(HeldPressure, IsBetweenLinearProfiles) {
  for (const std::string cell : all_cells)
    for (const std::string solver : {"direct", "iterative"}) {
      SCOPED_TRACE(cell + " " + solver);
      auto scene = closed_box(cell, false);
      scene.materials.at("rock").permeability = {0};
      scene.solver.linear_solver.type = solver;
      constrain(scene, "west", "1");
      constrain(scene, "east", "0");
      hold(scene, 0.5, "3*t");
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged);
      EXPECT_LT(error(model, "fracture pressure",
                      [](const Vector3& x, const auto&) {
                        return Vector3{x[0] < 0.5 ? 1 + 4 * x[0] : 3 - 6 * (x[0] - 0.5)};
                      }),
                1e-11);
      const Real transmissivity = std::pow(aperture, 3) / (12 * viscosity);
      EXPECT_NEAR(inflow(model, "Fractures > a > Held pressures > point") / transmissivity, 10, 1e-8);
      EXPECT_NEAR(inflow(model, "west") / transmissivity, -4, 1e-8);
    }
}

/// In permeable rock with a linear pressure on all sides, the pressure of the same field does not disturb the flow.
TEST(HeldPressure, OfALinearFieldTakesNoFluid) {
  for (const std::string cell : all_cells) {
    SCOPED_TRACE(cell);
    auto scene = closed_box(cell);
    for (const std::string side : {"west", "east", "south", "north", "bottom", "top"})
      if (!is_flat(cell) || (side != "bottom" && side != "top")) constrain(scene, side, "1+2*x-3*y");
    hold(scene, 0.25, "0");
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1).converged);
    const auto linear = [](const Vector3& x, const auto&) { return Vector3{1 + 2 * x[0] - 3 * x[1]}; };
    EXPECT_LT(error(model, "fracture pressure", linear), 1e-11);
    EXPECT_LT(error(model, "pressure", linear), 1e-11);
  }
}

/// Returns the message of a model that is not accepted.
std::string refusal(const model::Scene& scene) {
  try {
    model::Model model(scene, Tpetra::getDefaultComm());
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(HeldPressure, RefusesABoxWithoutAnEdge) {
  for (const std::string cell : all_cells) {
    auto scene = closed_box(cell);
    hold(scene, 0.3, "1");
    EXPECT_THAT(refusal(scene), testing::HasSubstr(fmt::format(
                                    "Fractures > a > Held pressures > point: the box contains no {} of the fracture; "
                                    "the nearest corner is (0.25, 0.5, ",
                                    is_flat(cell) ? "node" : "edge")));
  }
  auto scene = closed_box("tetrahedron");
  hold(scene, 0.25, "1", false);  // a point in 3D
  EXPECT_THAT(refusal(scene), testing::HasSubstr("contains no edge"));
}

}  // namespace
}  // namespace sprekk::tests
