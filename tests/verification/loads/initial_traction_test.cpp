// Initial tractions of fractures that differ from those of the rock.
#include "verification/loads/block.hpp"

#include <gmock/gmock.h>

namespace sprekk::tests {
namespace {

constexpr Real E = 2, height = 2, stiffness = 3;

/// Returns a block of rock of the modulus E with a joint at half of its height. Its bottom and top are fixed. `stress`:
/// vertical stress and shear stress in the plane of x and the vertical.
model::Scene split_block(const Discretisation& cells, int dim, Real vertical, Real shear) {
  auto scene = dim == 2 ? box_of_rock(cells, {1, height}, {2, 2}, fmt::format("{}", E))
                        : box_of_rock(cells, {1, 1, height}, {1, 1, 2}, fmt::format("{}", E));
  scene.mesh.fractures["joint"] = {first<Real>(dim, dim == 2 ? std::vector<Real>{0, 1} : std::vector<Real>{0, 0, 1}),
                                   first<Real>(dim, dim == 2 ? std::vector<Real>{1, 1} : std::vector<Real>{1, 1, 1})};
  auto& joint = scene.materials["joint"];
  joint.type = "joint";
  joint.friction = "no slip";
  joint.tangential_stiffness = joint.normal_stiffness = base::Expression(stiffness);
  joint.initial_aperture = base::Expression(10);
  scene.fractures["joint"].material = "joint";
  auto& stress = scene.bulk.initial_stress;
  stress.assign(dim == 2 ? 4 : 6, base::Expression(0));
  stress[dim == 2 ? 1 : 2] = base::Expression(vertical);
  stress[dim == 2 ? 3 : 5] = base::Expression(shear);
  const bool is_sheared = shear != 0;  // simple shear: no vertical displacement anywhere
  for (const std::string side : {"west", "east", "south", "north", "bottom", "top"}) {
    const bool horizontal = dim == 2 ? side == "south" || side == "north" : side == "bottom" || side == "top";
    if (dim == 2 && (side == "bottom" || side == "top")) continue;
    if (horizontal)
      prescribe(scene, side, first<std::string>(dim, {"0", "0", "0"}));
    else if (is_sheared)
      prescribe(scene, side,
                dim == 2 ? std::vector<std::string>{"free", "0"} : std::vector<std::string>{"free", "0", "0"});
  }
  return scene;
}

void give(model::Scene& scene, const std::vector<Real>& traction) {
  for (const Real component : traction) scene.fractures.at("joint").initial_traction.emplace_back(component);
}

/// Checks the tractions of all faces after a step: (n, t) in 2D, (n, |t|) in 3D.
void expect_traction(const model::Scene& scene, Real normal, Real shear) {
  model::Model model(scene, Tpetra::getDefaultComm());
  const auto report = model.step_to(1);
  ASSERT_TRUE(report.converged) << report.reason;
  const Outputs out(model);
  for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
    const auto traction = out.vector("traction local", f);
    EXPECT_NEAR(traction[0], normal, 1e-9);
    EXPECT_NEAR(model.mesh().dim() == 2 ? traction[1] : std::hypot(traction[1], traction[2]), shear, 1e-9);
  }
}

/// A traction t_1 of the joint next to rock with the stress s_0 changes to the t with
///   (t - s_0) H/M + (t - t_1)/K = 0
/// and the modulus M of the rock of height H: the displacements of bottom and top are zero.
Real balanced(Real of_rock, Real of_joint, Real modulus) {
  const Real rock = height / modulus, joint = 1 / stiffness;
  return (rock * of_rock + joint * of_joint) / (rock + joint);
}

TEST(InitialTraction, OfShearRelaxes) {
  constexpr Real G = E / 2, s = 0.3;
  for (const int dim : {2, 3})
    for (const auto& cells : discretisations(dim))
      for (const Real t : {0.0, -0.2}) {
        if (dim == 3 && t != 0) continue;  // the direction of t1 depends on the face
        SCOPED_TRACE(cells.name());
        auto scene = split_block(cells, dim, -1, s);
        give(scene, first<Real>(dim, {-1, t, 0}));
        expect_traction(scene, -1, balanced(s, t, G));
      }
}

TEST(InitialTraction, OfCompressionRelaxes) {
  for (const int dim : {2, 3})
    for (const auto& cells : discretisations(dim)) {
      SCOPED_TRACE(cells.name());
      auto scene = split_block(cells, dim, -1, 0);
      give(scene, first<Real>(dim, {-0.4, 0, 0}));
      expect_traction(scene, balanced(-1, -0.4, E), 0);
    }
}

TEST(InitialTraction, RequiresAnInitialStress) {
  auto scene = split_block({"triangle", 1}, 2, -1, 0);
  give(scene, {-1, 0});
  scene.bulk.initial_stress.clear();
  try {
    model::Model model(scene, Tpetra::getDefaultComm());
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("Fractures > joint > \"initial traction\": requires an \"initial "
                                                 "stress\""));
  }
}

}  // namespace
}  // namespace sprekk::tests
