// Flow in networks of fractures whose meshes contain flat cells: two nearly parallel pairs of traces and three discs
// that intersect near each other.
#include "boxes.hpp"

namespace sprekk::tests {
namespace {

/// Returns the scene of steady flow from west to east, with fractures of 0.3 mm in tight rock.
model::Scene network(const std::string& file, const std::string& solver) {
  auto scene = closed_box(file == "traces" ? "triangle" : "tetrahedron", false);
  scene.mesh.fractures.clear();
  scene.fractures.clear();
  scene.mesh_file.emplace();
  scene.mesh_file->path = source_dir() + "/tests/data/meshes/" + file + ".msh";
  scene.mesh_file->fractures["dfn"];
  scene.fractures["dfn"].material = "joint";
  scene.materials.at("rock").permeability = {base::Expression(1e-16)};
  scene.materials.at("joint").initial_aperture = 3e-4;
  scene.flow->viscosity = 1e-3;
  constrain(scene, "west", "1e6");
  constrain(scene, "east", "0");
  scene.solver.linear_solver.type = solver;
  return scene;
}

/// The number of iterations is bounded, and the solution is that of the direct solver.
TEST(FlatCells, MultigridSolvesPressuresInNetworks) {
  for (const auto& [file, maximum] : {std::pair("traces", 26), std::pair("discs", 30)}) {
    SCOPED_TRACE(file);
    std::vector<std::vector<Real>> pressures;
    for (const std::string solver : {"direct", "iterative"}) {
      model::Model model(network(file, solver), Tpetra::getDefaultComm());
      const auto report = model.step_to(1);
      ASSERT_TRUE(report.converged) << report.reason;
      for (const auto& solve : report.linear_solves) EXPECT_LE(solve.iterations, maximum) << solver;
      pressures.push_back(model.output("pressure").values);
      const auto in_fractures = model.output("fracture pressure").values;
      pressures.back().insert(pressures.back().end(), in_fractures.begin(), in_fractures.end());
    }
    ASSERT_EQ(pressures[0].size(), pressures[1].size());
    for (std::size_t k = 0; k < pressures[0].size(); ++k) EXPECT_NEAR(pressures[1][k], pressures[0][k], 1e-2);
  }
}

}  // namespace
}  // namespace sprekk::tests
