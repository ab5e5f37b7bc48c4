// Slip driven by fluid on a fault of constant friction, against the similarity solution of Viesca (2021).
#include "../scenes.hpp"

namespace sprekk::tests {
namespace {

constexpr Real length = 120, end = 220;                                    // of the fault, m; s
constexpr Real front_coefficient = 1.3474239755, potency = 2.96711137e-3;  // for T = 0.3: a/sqrt(4 alpha t); m^2/s

struct Measured {
  Real front, potency;  ///< half-length of the slipping part, m; integral of slip over the half, m^2
};

/// Returns the half-box of xml/earthquakes/fluid_driven_2d.xml as `n` x 2 `n` squares with the stress parameter T =
/// 0.3, after ten steps.
Measured measured(int n) {
  auto scene = read_scene("earthquakes/fluid_driven_2d.xml",
                          {fmt::format("Expressions.potency={:.17g}*t", potency),
                           "Bulk.initial stress={-50e6, -50e6, -50e6, 26.4e6}", fmt::format("Time.end={}", end)});
  scene.mesh_file.reset();
  scene.mesh.cell = "quadrilateral";
  scene.mesh.lower_corner = {0, -length};
  scene.mesh.upper_corner = {length, length};
  scene.mesh.cells = {n, 2 * n};
  auto& fault = scene.mesh.fractures["fault"];
  fault.lower_corner = {0, 0};
  fault.upper_corner = {length, 0};
  auto& conditions = scene.boundary_conditions;
  for (const std::string name : {"middle", "initial stress in the middle"}) conditions.at(name).boundary = "west";
  for (const std::string side : {"east", "south", "north"}) {
    conditions[side] = conditions.at("far field");
    conditions[side].boundary = side;
  }
  conditions.erase("far field");
  model::Model model(scene, Tpetra::getDefaultComm());
  for (int k = 1; k <= 10; ++k) EXPECT_TRUE(model.step_to(k * end / 10).converged);
  const Outputs out(model);
  return {length * mean(model, out["has slipped"], 0), length * mean(model, out["slip"], 0)};
}

/// The front lies within half a face of a = lambda sqrt(4 alpha t). The integral of slip converges to that of the exact
/// solution; the time error of ten steps of BDF2 is small compared with the error of the meshes.
TEST(FluidDrivenSlip, FollowsTheSimilaritySolution) {
  const Real front = front_coefficient * std::sqrt(4 * end), exact = potency * end / 2;
  const auto coarse = measured(16), fine = measured(32);
  EXPECT_NEAR(fine.front, front, 0.5 * length / 32);
  EXPECT_NEAR(coarse.front, front, 0.5 * length / 16);
  EXPECT_NEAR(fine.potency / exact, 1, 1e-2);
  EXPECT_LT(std::abs(fine.potency - exact), 0.5 * std::abs(coarse.potency - exact));
}

}  // namespace
}  // namespace sprekk::tests
