// Gmsh meshes, from the file to the solution.
#include "verification/loads/block.hpp"

#include <Teuchos_DefaultMpiComm.hpp>

#include <map>

namespace sprekk::tests {
namespace {

/// Checks a uniform stress with rigid, sticking fractures: no jump, traction sigma n.
void expect_uniform_stress(const std::string& file, int n_fractures) {
  SCOPED_TRACE(file);
  const Real xx = -0.8, xy = 0.15, yy = -0.5;  // stress; G = lambda = 1
  const Real trace = (xx + yy) / 4, e_xx = (xx - trace) / 2, e_xy = xy / 2, e_yy = (yy - trace) / 2;
  model::Scene scene;
  scene.mesh_file.emplace();
  scene.mesh_file->path = source_dir() + "/tests/data/meshes/" + file;
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

model::Scene gmsh_scene(const std::string& file, int n_fractures) {
  model::Scene scene;
  scene.mesh_file.emplace();
  scene.mesh_file->path = source_dir() + "/tests/data/meshes/" + file + ".msh";
  scene.materials["rock"].type = "elastic";
  scene.materials["joint"].type = "joint";
  scene.bulk.material = "rock";
  for (int f = 1; f <= n_fractures; ++f) {
    scene.mesh_file->fractures[fmt::format("f{}", f)];
    scene.fractures[fmt::format("f{}", f)].material = "joint";
  }
  return scene;
}

/// The initial plastic jump of a fracture in a file is its mean over each face.
TEST(Gmsh, FractureStartsWithAPlasticJump) {
  auto scene = gmsh_scene("planes", 2);
  scene.materials["rock"].G = scene.materials["rock"].lambda = base::Expression(1);
  scene.materials["joint"].friction_coefficient = base::Expression(0.6);
  prescribe(scene, "bottom", {"0", "0", "0"});
  scene.fractures["f1"].plastic_jump = {base::Expression("0.1 + x - 2*y"), base::Expression(0.3)};
  model::Model model(scene, Tpetra::getDefaultComm());
  const auto jump = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(),
                                                        model.field("elastic-plastic jump: plastic jump").values);
  for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
    const auto& face = model.mesh().fracture_faces[f];
    const bool given = model.mesh().fracture_names[face.fracture] == "f1";
    EXPECT_NEAR(jump(f, 0), given ? 0.1 + face.centre[0] - 2 * face.centre[1] : 0, 1e-14);
    EXPECT_NEAR(jump(f, 1), given ? 0.3 : 0, 1e-14);
  }
}

/// Poisson's ratio 0, vertical compression: fractures along the load are without traction, fractures across transmit
/// it.
TEST(Gmsh, TetrahedraUnderPressure) {
  const Real E = 2e6, pressure = 1e3;
  const std::pair<const char*, int> files[] = {{"patch", 1},         {"patch_order2", 1}, {"planes", 2},
                                               {"planes_order2", 2}, {"triple", 3},       {"triple_order2", 3}};
  for (const auto& [file, n_fractures] : files) {
    SCOPED_TRACE(file);
    auto scene = gmsh_scene(file, n_fractures);
    scene.materials["rock"].E = base::Expression(E);
    scene.materials["rock"].nu = base::Expression(0);
    scene.materials["joint"].friction_coefficient = base::Expression(0.6);
    prescribe(scene, "bottom", {"0", "0", "0"});
    load(scene, "top", {"0", "0", fmt::format("-{:.17g}", pressure)});
    model::Model model(scene, Tpetra::getDefaultComm());
    expect_displacement(model, 1e-10 * pressure / E, [&](const Vector3& x, const std::string&) {
      return Vector3{0, 0, -pressure / E * x[2]};
    });
    const Outputs out(model);
    for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
      const auto traction = out.vector("traction", f);
      const Real n_z = model.mesh().fracture_faces[f].frame[0][2];
      EXPECT_NEAR(norm({traction[0], traction[1], traction[2] + pressure * n_z}), 0, 1e-9 * pressure);
    }
  }
}

/// Data of a face, by fracture and centre.
using Faces = std::map<std::array<long, 4>, std::array<Real, 7>>;

/// Returns the data of all faces, equal on every rank. Collective.
Faces faces_by_place(model::Model& model) {
  const Outputs out(model);
  const auto gathered = gathered_faces(model, identity(), {1, 1, 1});  // normals are along axes
  std::vector<Real> here(2 * gathered.centre.size(), 0), all(here.size());
  for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
    const auto& face = model.mesh().fracture_faces[f];
    here[2 * face.id] = face.fracture;
    here[2 * face.id + 1] = out.scalar("state", f);
  }
  Teuchos::reduceAll(*model.mesh().comm, Teuchos::REDUCE_SUM, static_cast<int>(here.size()), here.data(), all.data());
  Faces faces;
  for (std::size_t k = 0; k < gathered.centre.size(); ++k) {
    const auto &x = gathered.centre[k], &jump = gathered.jump[k], &traction = gathered.traction[k];
    faces[{std::lround(all[2 * k]), std::lround(8 * x[0]), std::lround(8 * x[1]), std::lround(8 * x[2])}] = {
        all[2 * k + 1], jump[0], jump[1], jump[2], traction[0], traction[1], traction[2]};
  }
  return faces;
}

/// Compares a Gmsh mesh on all ranks with the box with the same cells on each rank alone, with slipping and open
/// faces.
void expect_as_box(const std::string& file, int n, Real height, const std::array<Real, 2>& range) {
  SCOPED_TRACE(file);
  const int order = file.find("order2") == file.npos ? 1 : 2;
  auto scene = gmsh_scene(file, 2);
  scene.materials["rock"].G = scene.materials["rock"].lambda = base::Expression(1e6);
  scene.materials["joint"].tangential_stiffness = base::Expression(1e7);
  scene.materials["joint"].friction_coefficient = base::Expression(0.2);
  scene.materials["joint"].dilation_angle = base::Expression(5);
  scene.bulk.body_force = expressions({fmt::format("1e4*({} - x) + 1e4*y", n / 2), "5e3*z - 1e4*x", "-1e4 - 1e3*x"});
  prescribe(scene, "bottom", {"0", "0", "0"});
  scene.solver.tolerance = 1e-13;
  model::Model model(scene, Tpetra::getDefaultComm());

  scene.mesh_file.reset();
  const Real size = n;
  scene.mesh.cell = "hexahedron";
  scene.mesh.order = order;
  scene.mesh.lower_corner = {0, 0, 0};
  scene.mesh.upper_corner = {size, size, height};
  scene.mesh.cells = {n, n, static_cast<int>(height)};
  const Real middle = size / 2;
  scene.mesh.fractures["f1"] = {{range[0], middle, 0}, {range[1], middle, height}, {}, false};
  scene.mesh.fractures["f2"] = {{middle, range[0], 0}, {middle, range[1], height}, {}, false};
  model::Model box(scene, rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF)));

  const auto report = model.step_to(1), reference = box.step_to(1);
  ASSERT_TRUE(report.converged) << report.reason;
  ASSERT_TRUE(reference.converged) << reference.reason;
  const auto a = faces_by_place(model), b = faces_by_place(box);
  ASSERT_EQ(a.size(), b.size());
  ASSERT_EQ(static_cast<GlobalIndex>(a.size()), box.mesh().n_global_fracture_faces);
  std::array<int, 3> n_state{};
  for (const auto& [place, values] : b) {
    ASSERT_TRUE(a.count(place)) << place[1] << " " << place[2] << " " << place[3];
    EXPECT_EQ(a.at(place)[0], values[0]);
    ++n_state.at(static_cast<int>(values[0]));
    for (int k = 1; k < 7; ++k)
      EXPECT_NEAR(a.at(place)[k], values[k],
                  1e-10 * (k < 4 ? box.system().scales().at("displacement") : box.system().scales().at("stress")));
  }
  EXPECT_GT(n_state[0], 0);
  EXPECT_GT(n_state[1] + n_state[2], 0);
}

TEST(Gmsh, HexahedraEqualABox) {
  for (const std::string order : {"", "_order2"}) {
    expect_as_box("hexahedra" + order, 4, 2, {1, 3});
    expect_as_box("cubes" + order, 2, 2, {0, 2});
  }
}

TEST(Gmsh, NamesThatTheMeshDoesNotHaveAreRefused) {
  auto scene = gmsh_scene("immersed", 1);
  scene.fractures.clear();
  scene.materials["rock"].G = scene.materials["rock"].lambda = base::Expression(1);
  scene.materials["joint"].friction_coefficient = base::Expression(0.5);
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
