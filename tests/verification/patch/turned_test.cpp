// Inclined fracture through a box that is rotated, translated, renumbered, or has exchanged sides: the state is the
// same in every frame. Further tests: onset of slip under uniaxial compression.
#include "verification/patch/inclined.hpp"

#include <random>

namespace sprekk::tests {
namespace {

/// Placement of the box of inclined_box_2d.xml or 3d.xml: its centre before the rotation about the origin, and its
/// half width.
struct Placing {
  std::string cell;
  int order = 1;
  Real degrees = 0;
  Vector3 axis = {0, 0, 1}, middle = {};
  Real half_width = 1;
  bool swap = false;
  int seed = 0;  ///< seed of a renumbering; 0: none
};

int dim_of(const std::string& cell) { return cell == "quadrilateral" || cell == "triangle" ? 2 : 3; }

/// Returns the scene with its box placed by p.
model::Scene placed_scene(const Placing& p) {
  const int dim = dim_of(p.cell);
  auto scene = read_scene(fmt::format("verification/inclined_box_{}d.xml", dim), {"Mesh.cell=" + p.cell});
  auto& box = scene.mesh;
  box.order = p.order;
  box.rotation = p.degrees;
  box.rotation_axis = {p.axis[0], p.axis[1], p.axis[2]};
  if (p.seed > 0) box.renumbering_seed = p.seed;
  box.fractures.at("f1").swap_sides = p.swap;
  const auto place = [&](std::vector<Real>& corner) {
    for (int i = 0; i < dim; ++i) corner[i] = p.middle[i] + p.half_width * corner[i];
  };
  place(box.lower_corner);
  place(box.upper_corner);
  for (auto* map : {&box.regions})
    for (auto& [name, part] : *map) place(part.lower_corner), place(part.upper_corner);
  for (auto& [name, part] : box.fractures) place(part.lower_corner), place(part.upper_corner);
  return scene;
}

Vector3 up(int dim) { return dim == 2 ? Vector3{0, 1, 0} : Vector3{0, 0, 1}; }

void expect_placed(const Placing& p, bool slips, Real tolerance) {
  SCOPED_TRACE(fmt::format("{}, order {}, {} degrees about ({}), {}", p.cell, p.order, p.degrees,
                           fmt::join(p.axis, ", "), slips ? "slip" : "stick"));
  const int dim = dim_of(p.cell);
  const auto Q = rotation(p.degrees, p.axis);
  auto scene = placed_scene(p);
  const auto patch = inclined_patch(dim, times(Q, up(dim)), slips, times(Q, p.middle));
  prescribe(scene, patch);
  expect_solves(scene, patch, tolerance);
}

/// The unchanged scenes.
TEST(TurnedPatch, Scenes) {
  for (const int dim : {2, 3})
    for (const auto& cell : cells_of(dim)) {
      const Vector3 n = dim == 2 ? Vector3{-0.5, std::sqrt(0.75), 0} : Vector3{0, -0.5, std::sqrt(0.75)};
      expect_solves(read_scene(fmt::format("verification/inclined_box_{}d.xml", dim), {"Mesh.cell=" + cell}),
                    inclined_patch(dim, n, false), 1e-11);
    }
}

TEST(TurnedPatch, AnyAngle2D) {
  for (const auto& cell : cells_of(2))
    for (int k = 0; k < 12; ++k)
      expect_placed({cell, 1 + k % 2, -180 + 30.0 * k + 0.7 * (k % 5), {0, 0, 1}, {0.3, -0.2}, 1, k % 3 == 1, k},
                    k % 4 < 2, 1e-11);
}

TEST(TurnedPatch, AnyAxis3D) {
  std::mt19937 random(5);
  std::normal_distribution<Real> normal;
  for (int k = 0; k < 8; ++k) {
    const Vector3 axis = {normal(random), normal(random), normal(random)};
    const Real degrees = 180 * std::uniform_real_distribution<Real>(-1, 1)(random);
    for (const auto& cell : cells_of(3))
      expect_placed({cell, 1 + k % 2, degrees, axis, {0.3, -0.2, 0.1}, 1, k % 3 == 1, k}, k % 4 < 2, 1e-11);
  }
}

/// At 1e6 m, coordinates of a rotated box are rounded to 6e-11 m (half a unit in the last place). Over faces of 0.5 m
/// the normal of the fracture varies by about 1e-10, and with it the components of the jump.
TEST(TurnedPatch, FarAway) {
  for (const int dim : {2, 3})
    for (const auto& cell : cells_of(dim))
      for (const int order : {1, 2})
        for (const bool slips : {false, true})
          expect_placed(
              {cell, order, 33, dim == 2 ? Vector3{0, 0, 1} : Vector3{1, 2, -1}, {1e6, -1e6, 5e5}, 1, slips, 7}, slips,
              1e-9);
}

/// Returns the state of a joint at an angle beta to the horizontal under vertical compression: the shear is tan(beta)
/// times the normal force.
Patch uniaxial_patch(Real degrees) {
  auto patch = uniform_patch(2, {{{0, 0, 0}, {0, -1, 0}, {0, 0, 0}}});
  const auto n = times(rotation(degrees, {0, 0, 1}), up(2));
  patch.joints["f1"] = at_stress({2, std::tan(10 * M_PI / 180), 0.01, 0.1, 5}, n, patch.stress, {});
  add_blocks(patch);
  return patch;
}

/// Returns the scene with a fixed lower block and tractions on all sides of the upper block.
model::Scene uniaxial_scene(Real degrees, const std::string& cell) {
  auto scene = placed_scene({cell, 1, degrees});
  const auto patch = uniaxial_patch(degrees);
  const std::map<std::string, Vector3> outward = {{"west", {-1, 0, 0}}, {"east", {1, 0, 0}}, {"north", {0, 1, 0}}};
  prescribe(scene, patch);
  for (auto& [name, condition] : scene.boundary_conditions) {
    if (condition.region != "+") continue;
    const auto load = times(patch.stress, times(rotation(degrees, {0, 0, 1}), outward.at(condition.boundary)));
    condition.displacement.clear();
    condition.traction = {load[0], load[1]};
  }
  return scene;
}

/// Slip begins if tan(beta) > mu = 0.6, i.e. above 30.96 degrees. Under prescribed tractions, the upper block then has
/// no equilibrium.
TEST(UniaxialCompression, BlockStaysUpToTheFrictionAngle) {
  for (const auto& cell : cells_of(2))
    for (const Real degrees : {20.0, 30.0, 30.96, 30.97, 32.0, 45.0, -30.96, -30.97}) {
      SCOPED_TRACE(fmt::format("{} {} degrees", cell, degrees));
      const auto scene = uniaxial_scene(degrees, cell);
      if (std::abs(std::tan(degrees * M_PI / 180)) < friction_coefficient) {
        expect_solves(scene, uniaxial_patch(degrees), 1e-11);
      } else {
        model::Model model(scene, Tpetra::getDefaultComm());
        EXPECT_FALSE(model.step_to(1).converged);
      }
    }
}

/// Displacements of the sticking state are prescribed on the whole boundary: above the friction angle every face
/// slips.
TEST(UniaxialCompression, FacesSlipBeyondTheFrictionAngle) {
  for (const auto& cell : cells_of(2))
    for (const Real degrees : {30.97, 32.0, 45.0, -30.97}) {
      SCOPED_TRACE(fmt::format("{} {} degrees", cell, degrees));
      auto scene = placed_scene({cell, 1, degrees});
      prescribe(scene, uniaxial_patch(degrees));
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged);
      const Outputs out(model);
      for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
        EXPECT_EQ(out.scalar("state", f), 2);
        const auto traction = out.vector("traction local", f);
        EXPECT_NEAR(std::abs(traction[1]), -friction_coefficient * traction[0], 1e-11);
      }
    }
}

}  // namespace
}  // namespace sprekk::tests
