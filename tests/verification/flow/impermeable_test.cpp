// Flow in fractures of impermeable rock, compared with exact solutions.
#include "boxes.hpp"

#include "base/over_ranks.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::tests {
namespace {

model::Scene impermeable_box(const std::string& cell) {
  auto scene = closed_box(cell);
  scene.materials.at("rock").permeability = {0};
  return scene;
}

/// Number of pressures on all ranks.
GlobalIndex unknowns_of(const model::Model& model, const std::string& name) {
  GlobalIndex n = 0;
  for (const auto& layout : model.system().layouts())
    if (layout.field().name == name) n += layout.n_owned();
  return base::sum_over_ranks(*model.mesh().comm, n);
}

/// Linear pressure in a network whose fractures end on the boundary, under gravity. The only unknowns are the pressures
/// of the faces and ridges of fractures.
TEST(ImpermeableRock, LinearPressureInANetworkIsExact) {
  const std::map<std::string, GlobalIndex> facets = {
      {"triangle", 8 + 9}, {"quadrilateral", 8 + 9}, {"tetrahedron", 64 + 2 * 56 - 4}, {"hexahedron", 32 + 2 * 40 - 4}};
  for (const std::string cell : all_cells) {
    SCOPED_TRACE(cell);
    auto scene = impermeable_box(cell);
    const bool flat = is_flat(cell);
    scene.flow->density = 3;
    scene.bulk.gravity = flat ? std::vector<Real>{0, -10} : std::vector<Real>{0, 0, -10};
    for (const std::string side : {"west", "east", "south", "north", "bottom", "top"})
      if (!flat || (side != "bottom" && side != "top")) constrain(scene, side, flat ? "1+2*x-3*y" : "1+2*x-3*y+4*z");
    model::Model model(scene, Tpetra::getDefaultComm());
    EXPECT_EQ(unknowns_of(model, "face pressure"), facets.at(cell));
    EXPECT_EQ(model.system().layouts().size(), 1);
    ASSERT_TRUE(model.step_to(1).converged);
    const auto p = [&](const auto& x, const auto&) { return Vector3{1 + 2 * x[0] - 3 * x[1] + (flat ? 0 : 4 * x[2])}; };
    EXPECT_LT(error(model, "fracture pressure", p), 1e-11);
  }
}

/// Fluid of the compressibility c enters closed fractures of the aperture a from a source s: the relative density grows
/// by s t/a from exp(c p_0), and the pressure is ln(exp(c p_0) + s t/a)/c.
TEST(ImpermeableRock, FracturesStoreTheFluidOfASource) {
  constexpr Real c = 0.1, s = 2e-3, initial = 2;
  for (const std::string cell : all_cells) {
    SCOPED_TRACE(cell);
    auto scene = impermeable_box(cell);
    scene.flow->compressibility = c;
    scene.flow->initial_pressure = initial;
    for (auto& [name, fracture] : scene.fractures) fracture.source = s;
    model::Model model(scene, Tpetra::getDefaultComm());
    EXPECT_LT(error(model, "fracture pressure", [](const auto&, const auto&) { return Vector3{initial}; }), 1e-14);
    for (const Real t : {0.5, 2.0, 3.0}) {
      ASSERT_TRUE(model.step_to(t).converged);
      const auto p = [&](const auto&, const auto&) {
        return Vector3{std::log(std::exp(c * initial) + s * t / aperture) / c};
      };
      EXPECT_LT(error(model, "fracture pressure", p), 1e-9);
    }
  }
}

/// The fluid of a source s partly leaks off: the relative density grows by (s t - 4 C_L sqrt(t))/a, in steps of any
/// length and in both time schemes.
TEST(ImpermeableRock, FracturesLoseFluidAfterCarter) {
  constexpr Real c = 0.1, s = 2e-3, C = 4e-4;
  for (const std::string cell : all_cells)
    for (const auto& [scheme, initial] : {std::pair<std::string, Real>("implicit Euler", 2), {"BDF2", -2}}) {
      SCOPED_TRACE(cell + scheme);
      auto scene = impermeable_box(cell);
      scene.time.scheme = scheme;
      scene.flow->compressibility = c;
      scene.flow->initial_pressure = initial;
      for (auto& [name, fracture] : scene.fractures) {
        fracture.source = s;
        fracture.leak_off = C;
      }
      model::Model model(scene, Tpetra::getDefaultComm());
      Real before = 0, then = 0;
      for (const Real t : {0.01, 0.5, 1.0, 3.0}) {
        ASSERT_TRUE(model.step_to(t).converged);
        const Real lost = 4 * C * std::sqrt(t);
        const auto constant = [](Real value) { return [=](const auto&, const auto&) { return Vector3{value}; }; };
        EXPECT_LT(error(model, "fracture pressure",
                        constant(std::log(std::exp(c * initial) + (s * t - lost) / aperture) / c)),
                  1e-9);
        EXPECT_LT(error(model, "leaked fluid", constant(lost)), 1e-15);
        EXPECT_LT(error(model, "exposure time", constant(t)), 1e-12);
        const auto totals = model.system().totals(model.state());
        const auto total =
            std::find_if(totals.begin(), totals.end(), [](const auto& one) { return one.names.back() == "leak-off"; });
        ASSERT_NE(total, totals.end());
        EXPECT_NEAR(total->value, -2 * (lost - before) / (t - then), 1e-12);  // two fractures of area 1
        before = lost;
        then = t;
      }
    }
}

/// Fracture "a" conducts between two sides at y = 1/2, with an outflow on the east side.
TEST(ImpermeableRock, AFractureCarriesAnOutflow) {
  for (const std::string cell : all_cells) {
    SCOPED_TRACE(cell);
    auto scene = impermeable_box(cell);
    constrain(scene, "west", "1");
    auto& east = scene.boundary_conditions["east"];
    east.boundary = "east";
    east.fracture = "a";
    east.flux = base::Expression(1e-7);
    model::Model model(scene, Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(1).converged);
    EXPECT_NEAR(inflow(model, "west") / (aperture * 1e-7), 1, 1e-9);
  }
}

}  // namespace
}  // namespace sprekk::tests
