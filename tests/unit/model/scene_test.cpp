// Reading of scenes: defaults, overrides, expressions and messages.
#include "model/change.hpp"
#include "block.hpp"

namespace sprekk::model::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Scene, MissingEntriesHaveTheirDefaults) {
  const auto scene = block();
  EXPECT_EQ(scene.origin, "block.xml");
  EXPECT_EQ(scene.time.start, 0);
  EXPECT_EQ(scene.time.end, 1);
  EXPECT_FALSE(scene.time.steps);
  EXPECT_FALSE(scene.time.chooses_steps());
  EXPECT_EQ(scene.time.scheme, "implicit Euler");
  EXPECT_TRUE(scene.output.vtu);
  EXPECT_EQ(scene.output.every, 1);
  EXPECT_EQ(scene.output.time_unit, "s");
  EXPECT_FALSE(scene.output.error_estimate);
  EXPECT_FALSE(scene.output.checkpoints);
  EXPECT_FALSE(scene.mesh_file);
  EXPECT_FALSE(scene.accuracy);
  EXPECT_TRUE(scene.stages.empty());
  EXPECT_EQ(scene.order(), 1);
  EXPECT_EQ(scene.refinements(), 0);
  EXPECT_EQ(scene.tips(), "enriched");
}

TEST(Scene, GivenEntriesReplaceDefaults) {
  const auto scene = block({"Mesh.cell=triangle", "Mesh.order=2", "Mesh.tips=plain", "Time.end=2 min", "Output.every=3",
                            "Output.time unit=h"});
  EXPECT_EQ(scene.mesh.cell, "triangle");
  EXPECT_EQ(scene.order(), 2);
  EXPECT_EQ(scene.tips(), "plain");
  EXPECT_EQ(scene.time.end, 120);
  EXPECT_EQ(scene.output.every, 3);
  EXPECT_EQ(scene.output.time_unit, "h");
}

TEST(Scene, TheLastOverrideApplies) {
  const auto scene =
      scene_of(*world(), block_entries({"Time.steps=2"}), "block.xml", "",
               {"Time.steps=3", "Time.end=4", "Time.steps=5", "Materials.rock.density=2.5", "Bulk.gravity={0, -10}"});
  EXPECT_EQ(scene.time.steps, 5);
  EXPECT_EQ(scene.time.end, 4);
  EXPECT_THAT(scene.bulk.gravity, ElementsAre(0, -10));
}

TEST(Scene, InvalidOverridesAreAllReported) {
  const auto message = message_of([] {
    scene_of(*world(), block_entries(), "block.xml", "", {"Time", "Bulk=rock", "Bulk.material.name=rock"});
  });
  EXPECT_EQ(n_lines(message), 3) << message;
  EXPECT_THAT(message, AllOf(HasSubstr("block.xml: override \"Time\": has no \"=\""),
                             HasSubstr("override \"Bulk=rock\": \"Bulk\" is a section"),
                             HasSubstr("override \"Bulk.material.name=rock\": \"material\" is not a section")));
}

TEST(Scene, NamedExpressionsCallEachOtherAndTables) {
  const auto scene =
      block({"Tables.ramp.arguments={0, 1}", "Tables.ramp.values={0, 8}", "Expressions.depth=1 - y",
             "Expressions.weight=-3*depth*ramp(t)", "Boundary conditions.pull.traction={weight + x, 0}"});
  const auto& traction = scene.boundary_conditions.at("pull").traction;
  EXPECT_NEAR(traction[0]({2, 0.25, 0}, 0.5), -3 * 0.75 * 4 + 2, 1e-14);
  EXPECT_FALSE(traction[0].constant_in_time());
  EXPECT_TRUE(traction[1].is_constant());
}

TEST(Scene, MaterialsOfTheLibraryNeedNoSection) {
  const auto scene = block({"Bulk.material=basalt"});
  EXPECT_EQ(scene.materials.at("basalt").E->text(), "78000000000");
  EXPECT_EQ(&scene.material_of("bulk"), &scene.materials.at("basalt"));
}

TEST(Scene, MaterialsOfRegionsReplaceThatOfTheBulk) {
  const auto scene = block({"Mesh.regions.core.lower corner={0, 0}", "Mesh.regions.core.upper corner={1, 1}",
                            "Materials.soft.type=elastic", "Materials.soft.Young's modulus=1.0",
                            "Materials.soft.Poisson's ratio=0.0", "Regions.core.material=soft"});
  EXPECT_EQ(&scene.material_of("core"), &scene.materials.at("soft"));
  EXPECT_EQ(&scene.material_of("bulk"), &scene.materials.at("rock"));
}

TEST(Scene, TheDefaultJointAppliesToFracturesWithoutMaterial) {
  auto entries = block_entries(
      with_fault({"Materials.weak.type=joint", "Materials.weak.tangential stiffness=1.0",
                  "Materials.weak.friction coefficient=0.1", "Fractures.material=weak",
                  "Mesh.fractures.other.lower corner={0.5, 0}", "Mesh.fractures.other.upper corner={0.5, 1}"}));
  const auto scene = scene_of(*world(), entries, "block.xml", "");
  EXPECT_EQ(scene.fractures.at("fault").material, "joint");
  EXPECT_EQ(scene.fractures.at("other").material, "weak");
}

TEST(Scene, MessagesNameThePlaceTheValueAndAllowedValues) {
  const std::vector<std::pair<Entries, std::vector<std::string>>> cases = {
      {{"Mesh.cell=hexagon"},
       {"block.xml: Sprekk > Mesh > \"cell\": is \"hexagon\", must be one of", "\"quadrilateral\"", "\"triangle\""}},
      {{"Time.steps=0"}, {"Sprekk > Time > \"steps\": is 0, must be", "between 1 and 10000000"}},
      {{"Time.stpes=2"}, {"Sprekk > Time > \"stpes\": unknown. Did you mean \"steps\"?"}},
      {{"Time.scheme=BDF3"}, {"Sprekk > Time > \"scheme\": is \"BDF3\", must be one of \"implicit Euler\", \"BDF2\""}},
      {{"Time.end=2 m"}, {"Sprekk > Time > \"end\"", "2 m", "allowed are"}},
      {{"Output.time unit=weeks"}, {"Sprekk > Output > \"time unit\": is \"weeks\"", "\"s\", \"min\", \"h\", \"d\""}},
      {{"Bulk.material=rok"}, {"Sprekk > Bulk > \"material\": is \"rok\"", "Did you mean \"rock\"?"}},
      {{"Boundary conditions.pull.boundary=est"},
       {"Sprekk > Boundary conditions > pull > \"boundary\": is \"est\"", "\"west\", \"east\", \"south\", \"north\""}},
      {{"Boundary conditions.pull.traction={5*s, 0}"},
       {"Sprekk > Boundary conditions > pull > \"traction\"[0]", "\"5*s\"", "\"t\", \"x\", \"y\", \"z\""}},
      {{"Expressions.a=2*b", "Expressions.b=a"}, {"Sprekk > Expressions", "\"a\"", "\"b\""}},
      {{"Output.checkpoints.steps=0"}, {"Sprekk > Output > checkpoints > \"steps\": is 0, must be at least 1"}},
      {{"Time.scheme=BDF2"}, {"Sprekk > Time > \"scheme\": is \"BDF2\": needs the section \"Flow\" or \"Heat\""}},
      {{"Probes.p.point={0, 0}"}, {"Sprekk > Probes > p > \"outputs\": missing"}},
      {{"Probes.p.outputs={stress}"}, {"Sprekk > Probes > p: give one of \"point\", \"line\", \"boundary\""}}};
  for (const auto& [changes, parts] : cases) {
    const auto message = refusal(changes);
    EXPECT_EQ(n_lines(message), 1) << message;
    for (const auto& part : parts) EXPECT_THAT(message, HasSubstr(part));
  }
}

TEST(Scene, AllMistakesAreReportedTogether) {
  const auto message = refusal({"Time.steps=0", "Output.every=0", "Bulk.material=rok", "Mesh.order=3"});
  EXPECT_EQ(n_lines(message), 4) << message;
  for (const char* part : {"\"steps\"", "\"every\"", "\"material\"", "\"order\""})
    EXPECT_THAT(message, HasSubstr(part));
}

TEST(Scene, RockWithoutSupportIsAMistake) {
  auto entries = block_entries();
  entries.sublist("Boundary conditions").remove("held");
  const auto scene = scene_of(*world(), entries, "block.xml", "");
  EXPECT_THAT(message_of([&] { Model(scene, world()); }),
              HasSubstr("block.xml: boundary conditions: nothing constrains the rock of \"bulk\""));
}

/// Springs along the normals of a flat side do not hold the rock in the directions of this side.
TEST(Scene, SpringsAlongTheNormalHoldNoTangentialMotion) {
  auto entries = block_entries();
  const auto side = entries.sublist("Boundary conditions").sublist("held").get<std::string>("boundary");
  entries.sublist("Boundary conditions").remove("held");
  auto& springs = entries.sublist("Boundary conditions").sublist("springs");
  springs.set("boundary", side);
  springs.set("foundation stiffness", Teuchos::Array<double>(1, 1e9));
  const auto scene = scene_of(*world(), entries, "block.xml", "");
  EXPECT_THAT(message_of([&] { Model(scene, world()); }),
              HasSubstr("block.xml: boundary conditions: nothing constrains"));
}

TEST(Scene, AccuracyExcludesOtherMeshesAndSteps) {
  const Entries goal = {"Mesh.cell=triangle", "Accuracy.quantities.q.quantity=stress",
                        "Accuracy.quantities.q.relative=0.1"};
  EXPECT_TRUE(block(goal).accuracy);
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"Mesh.refinements=1", "Mesh > \"refinements\": is 1, must be 0 with \"Accuracy\""},
      {"Time.tolerance=0.1", "Time > \"tolerance\": must be absent with \"Accuracy\""},
      {"Time.target Newton iterations=4", "Time > \"target Newton iterations\": must be absent"},
      {"Output.checkpoints.steps=1", "Output > \"checkpoints\": must be absent"},
      {"Stages.later.time=0.5", "Stages: must be absent"}};
  for (const auto& [change, part] : cases) {
    auto changes = goal;
    changes.push_back(change);
    EXPECT_THAT(refusal(changes), HasSubstr("block.xml: Sprekk > " + part));
  }
}

TEST(Scene, CheckpointsSelectReproducibleSolvesByDefault) {
  EXPECT_FALSE(block().solver.linear_solver.reproducible);
  EXPECT_EQ(block({"Output.checkpoints.minutes=5"}).solver.linear_solver.reproducible, true);
  EXPECT_EQ(block({"Output.checkpoints.steps=1", "Solver.Linear solver.reproducible=false"})
                .solver.linear_solver.reproducible,
            false);
}

TEST(Scene, PointScenesAreRefused) {
  Teuchos::ParameterList entries("Sprekk");
  entries.sublist("Point");
  EXPECT_THAT(message_of([&] { scene_of(*world(), entries, "point.xml", ""); }),
              HasSubstr("point.xml: is a scene for `sprekk point`"));
}

TEST(Scene, MeshFilesAreRelativeToTheScene) {
  auto entries = block_entries({"Mesh file.path=fault.msh"});
  entries.remove("Mesh");
  const auto scene = scene_of(*world(), entries, "block.xml", "/scenes");
  ASSERT_TRUE(scene.mesh_file);
  EXPECT_EQ(scene.mesh_file->path, "/scenes/fault.msh");
  EXPECT_EQ(scene.order(), 1);  // not specified
}

TEST(Scene, RefinementsDivideEachCellIntoFour) {
  EXPECT_EQ(block().make_mesh().n_cells(), 8);
  EXPECT_EQ(block({"Mesh.cell=triangle"}).make_mesh().n_cells(), 16);
  EXPECT_EQ(Model(block({"Mesh.refinements=1"}), world()).mesh().n_global_cells, 32);
  EXPECT_EQ(Model(block({"Mesh.refinements=2"}), world()).mesh().n_global_cells, 128);
}

TEST(Scene, PreparationReturnsEqualEntries) {
  auto scene = block(with_fault({"Time.schedule={0.5, 2}", "Stages.later.time=0.5"}));
  const auto draft = prepared(scene);
  EXPECT_THAT(draft.report.errors, ElementsAre());
  EXPECT_TRUE(same_entries(scene, draft.value));
  EXPECT_EQ(draft.value.origin, "block.xml");
  EXPECT_THAT(draft.value.time.times(), ElementsAre(0.5, 2));
  EXPECT_EQ(draft.value.stages.count("later"), 1);
  scene.solver.tolerance = -1;
  EXPECT_THAT(prepared(scene).report.errors,
              ElementsAre(AllOf(HasSubstr("block.xml: Sprekk > Solver > \"tolerance\""), HasSubstr("-1"))));
}

TEST(Network, BodiesHaveExactlyOneDescription) {
  const auto network_refusal = [](const Entries& changes) {
    Entries all = {"Mesh file.network.fractures.set.lines.a.points={0, 0, 1, 1}"};
    all.insert(all.end(), changes.begin(), changes.end());
    auto entries = block_entries(all);
    entries.remove("Mesh");
    return message_of([&] { scene_of(*world(), entries, "block.xml", "/scenes"); });
  };
  EXPECT_THAT(
      network_refusal({"Mesh file.network.domain.corners={0, 0, 1, 0, 1, 1}",
                       "Mesh file.network.domain.lower corner={0, 0}", "Mesh file.network.domain.upper corner={1, 1}"}),
      HasSubstr("network > domain: give either \"lower corner\" and \"upper corner\""));
  EXPECT_THAT(
      network_refusal({"Mesh file.network.domain.corners={0, 0, 1, 0, 1, 1}", "Mesh file.network.domain.sides={a, b}"}),
      HasSubstr("network > domain > \"sides\": has 2 names for 3 corners"));
  EXPECT_THAT(network_refusal(
                  {"Mesh file.network.domain.lower corner={0, 0}", "Mesh file.network.domain.upper corner={1, 1, 1}"}),
              HasSubstr("\"upper corner\": has 3 coordinates, \"lower corner\" 2"));
  EXPECT_THAT(network_refusal({"Mesh file.network.fractures.empty.format=points"}),
              HasSubstr("network > fractures > empty: is empty; give \"file\""));
}

}  // namespace
}  // namespace sprekk::model::test
