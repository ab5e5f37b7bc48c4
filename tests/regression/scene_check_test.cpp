// Scenes of hosts are checked like files; all errors are reported together.
#include "base/check.hpp"
#include "verification/scenes.hpp"

#include <algorithm>

namespace sprekk::tests {
namespace {

std::string error_of(const model::Scene& scene, const model::ModuleFactory& modules = {}) {
  try {
    model::Model(scene, Tpetra::getDefaultComm(), modules);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

long n_lines(const std::string& text) { return std::count(text.begin(), text.end(), '\n') + !text.empty(); }

bool has(const std::string& text, const std::string& part) { return text.find(part) != text.npos; }

TEST(SceneCheck, AHostIsReportedEverythingAtOnce) {
  auto scene = read_scene("seed/push_2d.xml");
  EXPECT_EQ(error_of(scene), "");
  scene.origin = "host";
  scene.solver.tolerance = -1;
  scene.bulk.material = "rok";
  scene.fractures.clear();
  auto third = scene.boundary_conditions.at("fixed");
  third.displacement = {0.5, 0};
  scene.boundary_conditions["third"] = third;
  const auto error = error_of(scene);
  EXPECT_EQ(n_lines(error), 4) << error;
  EXPECT_TRUE(has(error, "host: Sprekk > Solver > \"tolerance\"")) << error;
  EXPECT_TRUE(has(error, "host: Sprekk > Bulk > \"material\": is \"rok\"")) << error;
  EXPECT_TRUE(has(error, "host: Sprekk > Fractures: \"fracture\" is in the mesh")) << error;
  EXPECT_TRUE(has(error, "host: boundary conditions \"fixed\" and \"third\" prescribe 0 and 0.5")) << error;
}

TEST(SceneCheck, ModulesOfAHostMayHoldTheRock) {
  auto scene = read_scene("seed/push_2d.xml");
  scene.boundary_conditions.clear();
  const auto alone = error_of(scene),
             with_modules =
                 error_of(scene, [](const mesh::Mesh&) { return std::vector<std::unique_ptr<assembly::Module>>(); });
  EXPECT_TRUE(has(alone, "nothing constrains the rock")) << alone;
  EXPECT_EQ(alone, with_modules);
  scene.bulk.material = "rok";
  EXPECT_EQ(n_lines(error_of(scene)), 2);
  EXPECT_EQ(n_lines(error_of(scene,
                             [](const mesh::Mesh&) {  // not called, so supports are unknown
                               return std::vector<std::unique_ptr<assembly::Module>>();
                             })),
            1);
}

TEST(SceneCheck, ConditionsThatHaveNoValueYetAreNoErrorOfTheModel) {
  auto scene = read_scene("seed/push_2d.xml");
  scene.boundary_conditions.at("moved").displacement = {base::Expression("0*sqrt(0.5-t)"), 0};
  EXPECT_EQ(error_of(scene), "");  // a host chooses its own times
}

TEST(SceneCheck, EntriesOfTheOtherTypeOfMaterialAreRefused) {
  auto scene = read_scene("seed/push_2d.xml");
  scene.materials.at("rock").friction_coefficient = 0.5;
  scene.materials.at("rock").initial_gap = 1e-3;
  scene.materials.at("joint").density = 2700;
  scene.materials.at("rock").source = scene.materials.at("joint").source = "of both types";
  const auto error = error_of(scene);
  EXPECT_EQ(n_lines(error), 3) << error;
  EXPECT_TRUE(has(error, "Materials > rock > \"friction coefficient\": unknown")) << error;
  EXPECT_TRUE(has(error, "Materials > rock > \"initial gap\": unknown")) << error;
  EXPECT_TRUE(has(error, "Materials > joint > \"density\": unknown")) << error;
}

TEST(SceneCheck, EntriesOfAnotherLawOfAJointAreRefused) {
  auto scene = read_scene("seed/push_2d.xml");
  auto& joint = scene.materials.at("joint");
  joint.friction = "Barton-Choubey";
  joint.entry("joint roughness coefficient") = 10;
  joint.entry("joint wall strength") = 1e8;
  joint.entry("residual friction angle") = 30;
  const auto error = error_of(scene);
  EXPECT_EQ(n_lines(error), 1) << error;
  EXPECT_TRUE(has(error, "Materials > joint > \"friction coefficient\": unknown. It belongs to friction")) << error;
  joint.friction_coefficient.reset();
  EXPECT_EQ(error_of(scene), "");
  joint.friction = "no slip";  // the roughness is still an entry of the hydraulic aperture
  joint.hydraulic_aperture = "Barton";
  for (const char* entry : {"joint wall strength", "residual friction angle"}) joint.entry(entry).reset();
  EXPECT_EQ(error_of(scene), "");
}

}  // namespace
}  // namespace sprekk::tests
