// Results on several ranks equal those on one rank; several models in one process.
#include "verification/scenes.hpp"

#include <Teuchos_DefaultMpiComm.hpp>

#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>
#include <thread>

namespace sprekk::tests {
namespace {

/// Waits for all ranks in sleep. A barrier of MPI would use processor time of the rank that still computes.
/// Collective.
void wait_for_all(const Comm& comm) {
  MPI_Request request;
  MPI_Ibarrier(*dynamic_cast<const Teuchos::MpiComm<int>&>(comm).getRawMpiComm(), &request);
  for (int done = 0; !done; MPI_Test(&request, &done, MPI_STATUS_IGNORE))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

RCP<const Comm> alone() { return rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF)); }

/// Values of one output of the whole mesh, [global entity * n_components + component].
struct GlobalField {
  std::string name, unit;
  std::vector<Real> values;
};

/// Returns all outputs of the whole mesh, equal on every rank. Collective.
std::vector<GlobalField> gathered(model::Model& model) {
  const auto& mesh = model.mesh();
  std::vector<GlobalField> all;
  for (const auto& field : model.system().outputs(model.state())) {
    const bool nodes = field.entity == fields::Entity::node, cells = field.entity == fields::Entity::cell;
    const GlobalIndex n = nodes ? mesh.n_global_nodes : cells ? mesh.n_global_cells : mesh.n_global_fracture_faces;
    const LocalIndex n_owned = nodes ? mesh.n_owned_nodes : cells ? mesh.n_owned_cells : mesh.n_owned_fracture_faces;
    std::vector<Real> here(n * field.n_components, 0), sum(here.size());
    for (LocalIndex e = 0; e < n_owned; ++e) {
      const GlobalIndex id = nodes ? mesh.node_id[e] : cells ? mesh.cell_id[e] : mesh.fracture_faces[e].id;
      std::copy_n(field.values.begin() + e * field.n_components, field.n_components,
                  here.begin() + id * field.n_components);
    }
    Teuchos::reduceAll(*mesh.comm, Teuchos::REDUCE_SUM, static_cast<int>(here.size()), here.data(), sum.data());
    all.push_back({field.name, field.unit, sum});
  }
  return all;
}

/// Compares outputs: lengths within 1e-10 of the prescribed displacement u, stresses within 1e-10 of E u/L in a body
/// of size L, work per area within 1e-10 of their product, moments within 1e-10 of the largest, contact states exactly.
/// The mobilised strength is omitted: it is the traction over a bound that may be small.
void expect_same(const assembly::Scales& scales, const std::vector<GlobalField>& a, const std::vector<GlobalField>& b) {
  ASSERT_EQ(a.size(), b.size());
  const std::map<std::string, Real> scale_of_unit = {
      {"m", scales.at("displacement")},
      {"Pa", scales.at("stress")},
      {"J/m^2", scales.at("displacement") * scales.at("stress")},
      {"-", 0},
  };
  for (std::size_t k = 0; k < a.size(); ++k) {
    ASSERT_EQ(a[k].name, b[k].name);
    ASSERT_EQ(a[k].values.size(), b[k].values.size());
    const std::string& name = a[k].name;
    if (name == "mobilised strength") continue;
    Real largest = 0;
    for (const Real value : a[k].values) largest = std::max(largest, std::abs(value));
    const Real scale = name == "moment density" ? largest : scale_of_unit.at(a[k].unit);
    for (std::size_t i = 0; i < a[k].values.size(); ++i)
      EXPECT_NEAR(a[k].values[i], b[k].values[i], 1e-10 * scale) << name << " " << i;
  }
}

struct Counts {
  int open = 0, stick = 0, slip = 0;
};

/// Runs all steps of a scene on all ranks and on rank 0 alone, and compares after each step. Solutions are accurate to
/// round-off, because Newton's tolerance would cause differences. Returns the numbers of faces in each state over all
/// steps.
Counts expect_same_solution(model::Scene scene) {
  scene.solver.tolerance = 1e-13;
  const auto comm = Tpetra::getDefaultComm();
  model::Model together(scene, comm);
  std::optional<model::Model> single;
  if (comm->getRank() == 0) single.emplace(scene, alone());
  Counts counts;
  for (Real t : scene.time.times()) {
    SCOPED_TRACE(t);
    const auto report = together.step_to(t);
    EXPECT_TRUE(report.converged) << report.reason;
    const auto a = gathered(together);
    for (const auto& field : a)
      if (field.name == "state")
        for (Real s : field.values) ++(s == 0 ? counts.open : s == 1 ? counts.stick : counts.slip);
    if (single) {
      const auto reference = single->step_to(t);
      EXPECT_TRUE(reference.converged) << reference.reason;
      EXPECT_EQ(report.cuts, reference.cuts);
      expect_same(single->system().scales(), a, gathered(*single));
    }
    wait_for_all(*comm);
  }
  return counts;
}

TEST(SameSolution, CrossingFractures2D) {
  for (const auto& cell : cells_of(2)) {
    SCOPED_TRACE(cell);
    const auto counts =
        expect_same_solution(read_scene("verification/crossing_2d.xml", {"Mesh.cell=" + cell, "Mesh.rotation=30"}));
    EXPECT_GT(counts.open, 0);
    EXPECT_GT(counts.stick, 0);
    EXPECT_GT(counts.slip, 0);
  }
}

TEST(SameSolution, CrossingFractures3D) {
  for (const auto& cell : cells_of(3)) {
    SCOPED_TRACE(cell);
    const auto counts = expect_same_solution(read_scene("verification/crossing_3d.xml", {"Mesh.cell=" + cell}));
    EXPECT_GT(counts.open, 0);
    EXPECT_GT(counts.stick, 0);
    EXPECT_GT(counts.slip, 0);
  }
}

TEST(SameSolution, RenumberedAndSwapped) {
  auto scene = read_scene("verification/crossing_3d.xml", {"Mesh.renumbering seed=11"});
  scene.mesh.fractures.at("steep").swap_sides = true;
  expect_same_solution(scene);
}

/// Initial stress, gravity, ties, and non-uniform joint and rock properties.
TEST(SameSolution, LoadsAndVaryingMaterials) {
  expect_same_solution(read_scene("verification/lithostatic_3d.xml"));
  expect_same_solution(read_scene("verification/periodic_2d.xml", {"Mesh.cells={6, 8}"}));
  expect_same_solution(read_scene("gmsh/crossing.xml"));
  expect_same_solution(read_scene("seed/immersed_2d.xml", {"Materials.joint.friction coefficient=0.1 + 0.05*x",
                                                           "Materials.rock.shear modulus=1e6*(1 + y)"}));
}

TEST(SameSolution, Refined) {
  expect_same_solution(read_scene("verification/crossing_2d.xml", {"Mesh.refinements=2"}));
  expect_same_solution(read_scene("gmsh/crossing.xml", {"Mesh file.refinements=1"}));
  expect_same_solution(read_scene("verification/crossing_2d.xml", {"Mesh.refinements=1", "Mesh.order=2"}));
}

TEST(SameSolution, ScenesOfTheThesis) {
  for (const char* name : {"push_2d", "push_3d", "pull_2d", "pull_3d", "immersed_2d"}) {
    SCOPED_TRACE(name);
    expect_same_solution(read_scene(std::string("seed/") + name + ".xml"));
  }
}

TEST(SameSolution, IterativeSolver) {
  expect_same_solution(
      read_scene("verification/crossing_3d.xml", {"Solver.Linear solver.type=iterative", "Time.schedule={1}"}));
}

/// Fracture in one corner: one rank owns all its faces.
TEST(SameSolution, RanksWithoutFractureFaces) {
  const auto comm = Tpetra::getDefaultComm();
  if (comm->getSize() == 1) GTEST_SKIP() << "needs more than one rank";
  const auto scene =
      read_scene("verification/crossing_2d.xml",
                 {"Mesh.fractures.flat.lower corner={0.875, 0.875}", "Mesh.fractures.flat.upper corner={1, 0.875}",
                  "Mesh.fractures.steep.lower corner={0.875, 0.75}", "Mesh.fractures.steep.upper corner={0.875, 1}"});
  const model::Model model(scene, comm);
  ASSERT_TRUE(anywhere(*comm, model.mesh().n_owned_fracture_faces == 0));
  expect_same_solution(scene);
}

TEST(SameSolution, RanksWithoutCells) {
  const auto comm = Tpetra::getDefaultComm();
  if (comm->getSize() < 3) GTEST_SKIP() << "needs three ranks";
  const auto scene = read_scene("seed/push_2d.xml", {"Mesh.cell=quadrilateral", "Mesh.cells={1, 2}"});
  const model::Model model(scene, comm);
  ASSERT_TRUE(anywhere(*comm, model.mesh().n_owned_cells == 0));
  for (const char* d : {"{1, -1}", "{1, 1}"})
    expect_same_solution(read_scene("seed/push_2d.xml",
                                    {"Mesh.cells={1, 2}", std::string("Boundary conditions.moved.displacement=") + d}));
}

TEST(SameSolution, RanksWithoutCellsAndNoFracture) {
  expect_same_solution(read_scene("verification/uniaxial_2d.xml", {"Mesh.cell=quadrilateral", "Mesh.cells={1, 1}"}));
  expect_same_solution(read_scene("verification/uniaxial_3d.xml", {"Mesh.cell=hexahedron", "Mesh.cells={1, 1, 1}"}));
}

/// Two models advance alternately on the same communicator.
TEST(TwoModels, TakeTurns) {
  const auto comm = Tpetra::getDefaultComm();
  const auto scene_2d = read_scene("verification/crossing_2d.xml"), scene_3d = read_scene("verification/cyclic_3d.xml");
  model::Model a(scene_2d, comm), b(scene_3d, comm), only_a(scene_2d, comm), only_b(scene_3d, comm);
  for (int k = 1; k <= 4; ++k) {
    ASSERT_TRUE(a.step_to(k).converged);
    ASSERT_TRUE(b.step_to(k).converged);
  }
  for (int k = 1; k <= 4; ++k) ASSERT_TRUE(only_a.step_to(k).converged);
  for (int k = 1; k <= 4; ++k) ASSERT_TRUE(only_b.step_to(k).converged);
  expect_same(a.system().scales(), gathered(a), gathered(only_a));
  expect_same(b.system().scales(), gathered(b), gathered(only_b));
}

/// Two groups of ranks compute two scenes with different numbers of solves.
TEST(TwoModels, OnTwoCommunicators) {
  const auto world = Tpetra::getDefaultComm();
  if (world->getSize() == 1) GTEST_SKIP() << "needs more than one rank";
  const bool first = world->getRank() == 0;
  const RCP<const Comm> part = world->split(first ? 0 : 1, world->getRank());
  const std::string tight = "Solver.tolerance=1e-13";
  const auto scene_2d = read_scene("verification/crossing_2d.xml", {tight}),
             scene_3d = read_scene("verification/crossing_3d.xml", {tight});
  const auto& scene = first ? scene_2d : scene_3d;
  model::Model model(scene, part), single(scene, alone());
  for (Real t : scene.time.times()) {
    const auto report = model.step_to(t);
    ASSERT_TRUE(report.converged) << report.reason;
    ASSERT_TRUE(single.step_to(t).converged);
    expect_same(single.system().scales(), gathered(model), gathered(single));
  }
}

}  // namespace
}  // namespace sprekk::tests
