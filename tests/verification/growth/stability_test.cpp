// Stability of growth: a Griffith crack under given tension.
#include "bonded_fracture.hpp"

namespace sprekk::tests {
namespace griffith {

constexpr Real modulus = 32e9, energy = 125, notch = 1, half = 4, end = 3;  // E/(1 - nu^2), Pa; J/m^2; m

/// Half of a plate of width 2 `half` between rollers, under tension, with a crack of half-length `notch` in its
/// middle that is bonded up to x = `end`. The tension is t times that at which a sharp crack grows,
/// K_c/sqrt(2 W tan(pi a/2W)).
model::Scene plate(const std::string& cell) {
  const Real critical = std::sqrt(energy * modulus / (2 * half * std::tan(M_PI * notch / (2 * half))));
  auto scene = read_scene("growth/injection_2d.xml", {"Materials.bonded joint.tensile strength=2 MPa"});
  const bool flat = cell == "quadrilateral" || cell == "triangle";
  const Real width = 0.25;
  scene.flow.reset();
  scene.mesh_file.reset();
  scene.bulk.initial_stress.clear();
  scene.materials.at("granite").permeability.clear();
  scene.materials.at("bonded joint").residual_aperture = 0;
  scene.mesh.cell = cell;
  scene.mesh.lower_corner = {0, -4};
  scene.mesh.upper_corner = {half, 4};
  scene.mesh.cells = {16, 32};
  auto& plane = scene.mesh.fractures["growing"];
  plane.lower_corner = {0, 0};
  plane.upper_corner = {end, 0};
  scene.boundary_conditions.clear();
  const auto expression = [](const std::string& text) {
    base::Expression made(text);
    if (text != "free") made.compile();
    return made;
  };
  const auto hold = [&](const std::string& side, int axis) {
    auto& condition = scene.boundary_conditions[side];
    condition.boundary = side;
    for (int i = 0; i < (flat ? 2 : 3); ++i) condition.displacement.push_back(expression(i == axis ? "0" : "free"));
  };
  for (const std::string side : {"west", "east"}) hold(side, 0);
  hold("south", 1);
  auto& north = scene.boundary_conditions["north"];
  north.boundary = "north";
  north.traction = {expression("0"), expression(fmt::format("{}*t", critical))};
  if (flat) return scene;
  north.traction.push_back(expression("0"));
  for (const std::string side : {"bottom", "top"}) hold(side, 2);
  scene.mesh.cells.push_back(1);
  for (auto* lower : {&scene.mesh.lower_corner, &plane.lower_corner}) lower->push_back(0);
  for (auto* upper : {&scene.mesh.upper_corner, &plane.upper_corner}) upper->push_back(width);
  return scene;
}

/// Under given tension K grows with the length: the crack stands below the critical tension, except for a part of the
/// process zone of 0.8 m, and runs through the bonded part above. An injected volume is stable, see injection_test.cpp.
TEST(GriffithCrack, IsUnstableUnderGivenTension) {
  for (const std::string cell : {"quadrilateral", "hexahedron"}) {
    const auto scene = plate(cell);
    const Real width = cell == "quadrilateral" ? 1 : 0.25;
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(0.75).converged) << cell;
    EXPECT_LT(opened(model, false).broken / width, 0.25) << cell;
    const auto report = model.step_to(1.15);
    ASSERT_TRUE(report.converged) << cell << report.reason;
    EXPECT_NEAR(opened(model, false).broken / width, end - notch, 0.1) << cell;
  }
}

}  // namespace griffith
}  // namespace sprekk::tests
