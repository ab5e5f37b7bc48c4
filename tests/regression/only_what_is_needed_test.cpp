// Nothing unnecessary for the scene is allocated, assembled, exchanged or solved.
#include "model/results.hpp"
#include "verification/scenes.hpp"

namespace sprekk::tests {
namespace {

using nlohmann::json;

long long count(model::Model& model, const std::string& phase) {
  for (const auto& p : model.timers().phases())
    if (p.name == phase) return p.count;
  return 0;
}

std::vector<std::string> names(const json& list) {
  std::vector<std::string> result;
  for (const auto& entry : list) result.push_back(entry.is_string() ? entry : entry["name"]);
  return result;
}

using Names = std::vector<std::string>;

/// Returns the number of ghost nodes on all ranks. Collective.
long long all_ghost_nodes(const mesh::Mesh& mesh) {
  const long long here = mesh.n_free_nodes - mesh.n_owned_nodes;
  long long all = 0;
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_SUM, 1, &here, &all);
  return all;
}

TEST(IntactRock, IsOneFieldAssembledAndFactorisedOnce) {
  for (const int dim : {2, 3}) {
    const std::string load = dim == 2 ? "{0, -5e6*t}" : "{0, 0, -5e6*t}";
    model::Model model(read_scene(fmt::format("verification/uniaxial_{}d.xml", dim),
                                  {"Boundary conditions.load.traction=" + load, "Time.end=4", "Time.steps=4"}),
                       Tpetra::getDefaultComm());
    const auto blocks = model::block_summary(model.system());
    EXPECT_EQ(names(blocks["fields"]), Names{"displacement"});
    // received once per residual: ghosts of all ranks, 8 bytes per component
    EXPECT_EQ(blocks["fields"][0]["halo_bytes"], 8 * dim * all_ghost_nodes(model.mesh()));
    EXPECT_EQ(blocks["matrices"].size(), 1u);
    EXPECT_EQ(names(blocks["modules"]), Names{"bulk momentum"});
    EXPECT_TRUE(!blocks.contains("local_groups") || blocks["local_groups"].empty());
    for (int k = 1; k <= 4; ++k) {
      const auto report = model.step_to(k);
      ASSERT_TRUE(report.converged);
      EXPECT_EQ(report.newton_iterations, 1);
      EXPECT_EQ(solve::iterations(report.linear_solves), 1);
      EXPECT_EQ(report.substeps, 1);
    }
    EXPECT_EQ(model.newton().linear().n_setups(), 1);
    EXPECT_EQ(count(model, "assembly of the linear part"), 1);
    EXPECT_EQ(count(model, "set-up of linear solver"), 1);
    EXPECT_EQ(count(model, "linear solve"), 4);
    EXPECT_EQ(count(model, "loads"), 4);
  }
}

TEST(IntactRock, ConstantLoadNeedsNoSecondSolve) {
  model::Model model(read_scene("verification/uniaxial_2d.xml", {"Time.end=3", "Time.steps=3"}),
                     Tpetra::getDefaultComm());
  for (int k = 1; k <= 3; ++k) {
    const auto report = model.step_to(k);
    ASSERT_TRUE(report.converged);
    EXPECT_EQ(report.newton_iterations, k == 1 ? 1 : 0);
  }
  EXPECT_EQ(count(model, "linear solve"), 1);
}

/// Two by two squares and two faces, with 2 components per node. Each half of the body has two squares of 4 nodes, with
/// 6 nodes and 2 (4 + 6 + 4) pairs of coupled nodes.
/// Each side of a face couples 4 nodes, 2 of them on the face. The condensed displacement matrix also couples the 4
/// nodes of both sides of a face: 2 (16 + 16 - 4) additional pairs. The pairs of the 2 nodes between the squares belong
/// to both faces and are stored once. Tractions are along the axes and act on the nodes of the face and on the bubble;
/// zero entries between them are not stored.
TEST(Fractures, BlocksCountedByHand) {
  model::Model model(read_scene("seed/push_2d.xml"), Tpetra::getDefaultComm());
  const auto blocks = model::block_summary(model.system());
  EXPECT_EQ(names(blocks["fields"]), (Names{"displacement", "side bubble", "traction"}));
  EXPECT_EQ(names(blocks["modules"]), (Names{"bulk momentum", "interface traction balance", "elastic-plastic jump"}));
  ASSERT_EQ(blocks["local_groups"].size(), 1u);
  EXPECT_EQ(names(blocks["local_groups"][0]["blocks"]), (Names{"side bubble", "traction"}));
  const std::vector<long long> unknowns = {12 * 2, 2 * 2 * 2, 2 * 2};
  for (int b = 0; b < 3; ++b) {
    EXPECT_EQ(blocks["fields"][b]["unknowns"], unknowns[b]);
    if (model.mesh().comm->getSize() == 1) {
      EXPECT_EQ(blocks["fields"][b]["halo_bytes"], 0);
    }
  }
  const long long sides = 4, faces = 2, dim = 2;
  const std::map<std::pair<std::string, std::string>, long long> entries = {
      {{"displacement", "displacement"}, 2 * (2 * (4 + 6 + 4) + 16 + 16 - 4) * dim * dim},
      {{"displacement", "side bubble"}, sides * 4 * dim * dim},
      {{"displacement", "traction"}, sides * 2 * dim},
      {{"side bubble", "displacement"}, sides * 4 * dim * dim},
      {{"side bubble", "side bubble"}, sides * dim * dim},
      {{"side bubble", "traction"}, sides * dim},
      {{"traction", "displacement"}, faces * 4 * dim * dim},
      {{"traction", "side bubble"}, faces * 2 * dim * dim},
      {{"traction", "traction"}, faces * dim * dim}};
  ASSERT_EQ(blocks["matrices"].size(), entries.size());
  for (const auto& matrix : blocks["matrices"]) {
    const std::string row = matrix["row"], column = matrix["column"];
    const long long n = entries.at({row, column}), rows = row == "displacement" ? 24 : row == "side bubble" ? 8 : 4;
    EXPECT_EQ(matrix["entries"], n) << row << ", " << column;
    const long long together = row == column && row == "displacement" ? dim : 1;  // rows and columns per block
    EXPECT_EQ(matrix["bytes"], n * 8 + n / (together * together) * 4 + rows / together * 8) << row << ", " << column;
  }
}

/// Ranks exchange only the ghosts that neighbours need, once per field; one rank exchanges nothing.
TEST(Fractures, GhostsAreExchangedOnce) {
  model::Model model(read_scene("verification/crossing_2d.xml"), Tpetra::getDefaultComm());
  const auto& mesh = model.mesh();
  const auto blocks = model::block_summary(model.system());
  const long long ghost_faces = mesh.n_fracture_faces() - mesh.n_owned_fracture_faces;
  long long all = 0;
  Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_SUM, 1, &ghost_faces, &all);
  EXPECT_EQ(blocks["fields"][0]["halo_bytes"], 8 * 2 * all_ghost_nodes(mesh));
  EXPECT_EQ(blocks["fields"][1]["halo_bytes"], 8 * 4 * all);
  EXPECT_EQ(blocks["fields"][2]["halo_bytes"], 8 * 2 * all);
  if (mesh.comm->getSize() == 1) {
    EXPECT_EQ(blocks["fields"][0]["halo_bytes"], 0);
  }
}

/// Residual, Jacobian, measures, contact states and commit at a state read from one exchange, also in line searches,
/// cut steps, proximal continuation and motions of floating blocks, and with lagged coefficients of fluxes. Known
/// exception: searches of several floating blocks repeat motions, for example in contact/network_soft_2d.xml.
TEST(Iterates, ExchangeGhostsOnce) {
  const std::vector<std::pair<std::string, std::vector<std::string>>> scenes = {
      {"seed/immersed_3d.xml", {}},
      {"verification/regimes_2d.xml", {"Solver.maximum iterations=3", "Time.proximal continuation=false"}},
      {"contact/snap_back_2d.xml", {}},
      {"contact/floating_2d.xml", {}},
      {"poro/injection_2d.xml", {}},
      {"flow/network_2d.xml", {}},
      {"heat/cooling_2d.xml", {}}};
  int cuts = 0, searched = 0;
  for (const auto& [name, changes] : scenes) {
    model::Model model(read_scene(name, changes), Tpetra::getDefaultComm());
    const auto times = model.scene().time.times();
    for (std::size_t k = 0; k < times.size() && k < 3; ++k) {
      const auto report = model.step_to(times[k]);
      EXPECT_EQ(report.exchanges.ghosts, report.exchanges.iterates) << name << ", t = " << times[k];
      EXPECT_GT(report.exchanges.iterates, 0) << name;
      cuts += report.cuts;
      searched += report.exchanges.iterates > 1 + report.newton_iterations;
    }
  }
  EXPECT_GT(cuts, 0);
  EXPECT_GT(searched, 0);
}

TEST(Fractures, StickingSceneIsFactorisedOnce) {
  for (const char* name : {"seed/immersed_2d.xml", "seed/immersed_3d.xml"}) {
    auto scene = read_scene(name);
    if (scene.mesh.cells.size() == 3) scene.mesh.cells = {6, 6, 6};
    model::Model model(scene, Tpetra::getDefaultComm());
    for (int k = 1; k <= 10; ++k) {
      const auto report = model.step_to(k);
      ASSERT_TRUE(report.converged);
      EXPECT_EQ(report.newton_iterations, 1);
      EXPECT_EQ(solve::iterations(report.linear_solves), 1);
    }
    EXPECT_EQ(model.newton().linear().n_setups(), 1) << name;
    EXPECT_EQ(count(model, "assembly of the linear part"), 1);
  }
}

/// Stick, slip, constant load, stick: the matrix of a sticking step equals that before slip.
TEST(Fractures, SlidingSceneIsFactorisedWhenItsMatrixChanges) {
  model::Model model(read_scene("verification/cyclic_2d.xml"), Tpetra::getDefaultComm());
  ASSERT_TRUE(model.step_to(1).converged);
  EXPECT_EQ(model.newton().linear().n_setups(), 1);
  const auto slides = model.step_to(2);
  ASSERT_TRUE(slides.converged);
  const int n_setups = model.newton().linear().n_setups();
  EXPECT_GT(n_setups, 1);
  EXPECT_LE(n_setups, 1 + slides.newton_iterations);
  ASSERT_TRUE(model.step_to(3).converged);  // constant load: no solve
  EXPECT_EQ(model.newton().linear().n_setups(), n_setups);
  EXPECT_EQ(count(model, "assembly of the linear part"), 1);
}

}  // namespace
}  // namespace sprekk::tests
