// Initial stress, gravity, periodic sides, and meshes of gmsh, against exact states.
#include "scenes.hpp"

namespace sprekk::tests {
namespace {

const std::vector<std::string> cells_2d = {"triangle", "quadrilateral"}, cells_3d = {"tetrahedron", "hexahedron"};

/// Under its own weight and the lithostatic stress rock does not move, and the fracture carries the initial traction at
/// its centre: sigma_xx = ratio density g (z - surface).
void expect_rest(const std::string& name, const std::string& cell, int order) {
  SCOPED_TRACE(fmt::format("{} {} order {}", name, cell, order));
  auto scene = read_scene(name, {"Mesh.cell=" + cell, fmt::format("Mesh.order={}", order)});
  model::Model model(scene, Tpetra::getDefaultComm());
  const auto report = model.step_to(1);
  ASSERT_TRUE(report.converged) << report.reason;
  const Outputs out(model);
  const Real weight = 2700 * 9.81;
  const int up = model.mesh().dim() - 1;
  for (Real u : out["displacement"].values) EXPECT_NEAR(u, 0, 1e-13);  // strains would be about 1e-1
  for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
    const auto traction = out.vector("traction local", f);
    EXPECT_NEAR(traction[0], 0.5 * weight * (model.mesh().fracture_faces[f].centre[up] - 3), 1e-9 * weight);
    EXPECT_NEAR(norm({0, traction[1], traction[2]}), 0, 1e-9 * weight);
    EXPECT_EQ(out.scalar("state", f), 1);
  }
}

TEST(InitialStress, BalancesGravity) {
  for (int order : {1, 2}) {
    for (const auto& cell : cells_2d) expect_rest("verification/lithostatic_2d.xml", cell, order);
    for (const auto& cell : cells_3d) expect_rest("verification/lithostatic_3d.xml", cell, order);
  }
}

/// Without the initial stress the same weight does move the rock, so that the test above is one.
TEST(InitialStress, IsNeededForRest) {
  auto scene = read_scene("verification/lithostatic_2d.xml");
  scene.bulk.lithostatic_stress.reset();
  model::Model model(scene, Tpetra::getDefaultComm());
  ASSERT_TRUE(model.step_to(1).converged);
  Real largest = 0;
  for (Real u : Outputs(model)["displacement"].values) largest = std::max(largest, std::abs(u));
  EXPECT_TRUE(anywhere(*Tpetra::getDefaultComm(), largest > 1e-3));
}

/// The block in series with a joint, slip regime: N/k_n + V(N) + mu tan(theta) N/K_s = g0 + tan(theta)|d_t| - d_n with
/// k_n = 3, 1/K_s = 1 + 1/2 is a quadratic in N.
TEST(Periodic, BlockSlipsUniformly) {
  const Real N = 0.322985706114, l_t = 0.193791423668, u_p = 0.209312864497, opening = 0.007661902038;
  for (int order : {1, 2})
    for (const auto& cell : cells_2d)
      for (int seed : {-1, 5}) {
        SCOPED_TRACE(fmt::format("{} order {} seed {}", cell, order, seed));
        auto scene =
            read_scene("verification/periodic_2d.xml", {"Mesh.cell=" + cell, fmt::format("Mesh.order={}", order)});
        if (seed >= 0) scene.mesh.renumbering_seed = seed;
        model::Model model(scene, Tpetra::getDefaultComm());
        const auto report = model.step_to(1);
        ASSERT_TRUE(report.converged) << report.reason;
        const Outputs out(model);
        for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
          EXPECT_NEAR(out.vector("traction local", f)[0], -N, 1e-10);
          EXPECT_NEAR(out.vector("traction local", f)[1], l_t, 1e-10);
          EXPECT_NEAR(out.scalar("slip", f), u_p, 1e-10);
          EXPECT_NEAR(out.scalar("opening", f), opening, 1e-10);
        }
      }
}

TEST(Periodic, UnknownDirectionIsRefused) {
  auto scene = read_scene("verification/periodic_2d.xml");
  scene.mesh.periodic = {"z"};
  try {
    model::Model model(scene, Tpetra::getDefaultComm());
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("x or y"), std::string::npos) << error.what();
  }
}

/// A uniform stress whose fractures all stick and are rigid passes through any mesh: no jump, traction sigma n.
void expect_uniform_stress(const std::string& file, int n_fractures) {
  SCOPED_TRACE(file);
  const Real xx = -0.8, xy = 0.15, yy = -0.5;  // stress; G = lambda = 1
  const Real trace = (xx + yy) / 4, e_xx = (xx - trace) / 2, e_xy = xy / 2, e_yy = (yy - trace) / 2;
  model::Scene scene;
  scene.mesh_file.emplace();
  scene.mesh_file->path = std::string(SPREKK_SOURCE_DIR) + "/tests/data/meshes/" + file;
  auto& rock = scene.materials["rock"];
  rock.type = "elastic";
  rock.G = rock.lambda = base::Expression(1);
  auto& joint = scene.materials["joint"];
  joint.type = "joint";
  joint.friction_coefficient = base::Expression(5);
  scene.bulk.material = "rock";
  for (int f = 1; f <= n_fractures; ++f) {
    scene.mesh_file->fractures[fmt::format("f{}", f)];
    scene.fractures[fmt::format("f{}", f)].material = "joint";
  }
  for (const std::string side : {"west", "east", "south", "north"}) {
    auto& condition = scene.boundary_conditions[side];
    condition.boundary = side;
    condition.displacement = {base::Expression(fmt::format("{:.17g}*x+{:.17g}*y", e_xx, e_xy)),
                              base::Expression(fmt::format("{:.17g}*x+{:.17g}*y", e_xy, e_yy))};
    for (auto& value : condition.displacement) value.compile();
  }
  model::Model model(scene, Tpetra::getDefaultComm());
  const auto report = model.step_to(1);
  ASSERT_TRUE(report.converged) << report.reason;
  EXPECT_EQ(report.newton_iterations, 1);
  const Outputs out(model);
  for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
    const auto& n = model.mesh().fracture_faces[f].frame[0];
    const auto traction = out.vector("traction", f);
    EXPECT_NEAR(norm(out.vector("jump", f)), 0, 1e-12);
    EXPECT_NEAR(traction[0], xx * n[0] + xy * n[1], 1e-11);
    EXPECT_NEAR(traction[1], xy * n[0] + yy * n[1], 1e-11);
  }
}

TEST(Gmsh, UniformStressPassesThroughEveryMesh) {
  for (const std::string file :
       {"x_order1_v22", "x_order1_v41", "x_order1_v22_binary", "x_order2_v41_binary", "t", "t_order2", "l", "l_order2"})
    expect_uniform_stress(file + ".msh", 2);
  for (const std::string file : {"y", "y_order2", "star", "star_order2"}) expect_uniform_stress(file + ".msh", 3);
  for (const std::string file : {"immersed", "immersed_order2", "reach", "reach_order2"})
    expect_uniform_stress(file + ".msh", 1);
}

TEST(Gmsh, NamesThatTheMeshDoesNotHaveAreRefused) {
  model::Scene scene;
  scene.mesh_file.emplace();
  scene.mesh_file->path = std::string(SPREKK_SOURCE_DIR) + "/tests/data/meshes/immersed.msh";
  scene.mesh_file->fractures["f1"];
  scene.materials["rock"].type = "elastic";
  scene.bulk.material = "rock";
  scene.boundary_conditions["a"].boundary = "nort";
  scene.boundary_conditions["a"].displacement = {base::Expression(0), base::Expression(0)};
  try {
    model::Model model(scene, Tpetra::getDefaultComm());
    ADD_FAILURE();
  } catch (const Error& error) {
    const std::string message = error.what();
    EXPECT_NE(message.find("Did you mean \"north\"?"), std::string::npos) << message;
    EXPECT_NE(message.find("\"f1\" is in the mesh and has no section here"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace sprekk::tests
