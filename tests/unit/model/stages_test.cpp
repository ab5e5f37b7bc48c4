// Stages: order, changes of the scene at their times, refused combinations.
#include "model/change.hpp"
#include "model/stages.hpp"
#include "model/steps.hpp"
#include "block.hpp"

#include "base/over_ranks.hpp"

namespace sprekk::model::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// Region "core", the left half of the block.
const Entries core = {"Mesh.regions.core.lower corner={0, 0}", "Mesh.regions.core.upper corner={1, 1}"};

Entries also(Entries a, const Entries& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::string traction_of(const Scene& scene) { return scene.boundary_conditions.at("pull").traction[0].text(); }

/// Largest displacement in the direction x, m. Collective.
Real elongation(Model& model) {
  const auto displacement = model.output("displacement").values;
  Real maximum = 0;
  for (std::size_t i = 0; i < displacement.size(); i += 2) maximum = std::max(maximum, displacement[i]);
  return base::max_over_ranks(*model.mesh().comm, maximum);
}

TEST(Stages, AreOrderedByTimeAndInheritChanges) {
  const auto stages = staged_scenes(
      block({"Stages.a.time=3.0", "Stages.b.time=1.0", "Stages.b.Boundary conditions.pull.traction={7, 0}",
             "Stages.a.Materials.rock.Young's modulus=20.0"}));
  ASSERT_EQ(stages.size(), 2);
  EXPECT_EQ(stages[0].name, "b");
  EXPECT_EQ(stages[0].time, 1);
  EXPECT_EQ(traction_of(stages[0].draft.value), "7");
  EXPECT_EQ(stages[0].draft.value.materials.at("rock").E->text(), "10");
  EXPECT_EQ(stages[1].name, "a");
  EXPECT_EQ(stages[1].time, 3);
  EXPECT_EQ(traction_of(stages[1].draft.value), "7");
  EXPECT_EQ(stages[1].draft.value.materials.at("rock").E->text(), "20");
  EXPECT_EQ(stages[1].draft.value.origin, "block.xml: stage \"a\"");
}

TEST(Stages, RemoveSectionsAndEntries) {
  const auto stages =
      staged_scenes(block({"Stages.free.time=0.5", "Stages.free.without={Boundary conditions > pull, Bulk > gravity}",
                           "Bulk.gravity={0, 1}", "Materials.rock.density=1.0"}));
  const auto& scene = stages.at(0).draft.value;
  EXPECT_EQ(scene.boundary_conditions.count("pull"), 0);
  EXPECT_EQ(scene.boundary_conditions.count("held"), 1);
  EXPECT_TRUE(scene.bulk.gravity.empty());
}

TEST(Stages, ExcavateReleaseAndBackfill) {
  const auto stages = staged_scenes(
      block(also(core, {"Stages.dig.time=0.25", "Stages.dig.excavate={core}", "Stages.dig.release=0.5",
                        "Stages.fill.time=0.875", "Stages.fill.backfill={core}", "Regions.core.material=rock"})));
  ASSERT_EQ(stages.size(), 2);
  EXPECT_THAT(stages[0].draft.value.excavated(), ElementsAre("core"));
  EXPECT_THAT(stages[0].draft.value.bulk.release, ElementsAre(0.25, 0.75));
  EXPECT_THAT(stages[1].draft.value.excavated(), ElementsAre());
}

TEST(Stages, ABackfilledRegionWithoutEntriesHasTheMaterialOfBulk) {
  const auto stages = staged_scenes(block(also(core, {"Stages.dig.time=0.25", "Stages.dig.excavate={core}",
                                                      "Stages.fill.time=0.5", "Stages.fill.backfill={core}"})));
  ASSERT_EQ(stages.size(), 2);
  EXPECT_THAT(stages[1].draft.report.errors, ElementsAre());
  EXPECT_EQ(stages[1].draft.value.regions.count("core"), 0);
}

TEST(Stages, RefuseTimesAtTheStartAndEqualTimes) {
  EXPECT_THAT(refusal({"Time.start=0.5", "Stages.a.time=0.5"}),
              HasSubstr("Stages > a > \"time\": is 0.5 s: must be after the \"start\" of \"Time\", 0.5 s"));
  EXPECT_THAT(refusal({"Stages.a.time=0.5", "Stages.b.time=0.5"}),
              HasSubstr("Stages > b > \"time\": is 0.5 s: the stage \"a\" begins then"));
  EXPECT_THAT(refusal({"Stages.a.without={}"}), HasSubstr("Stages > a > \"time\" (s): missing"));
}

TEST(Stages, RefuseChangesOfConstantSections) {
  for (const std::string entry : {"Mesh.order=2", "Mesh file.path=a.msh", "Time.end=2", "Output.every=2",
                                  "Probes.p.points=3", "Stages.b.time=1", "Accuracy.cells=5"}) {
    const auto section = entry.substr(0, entry.find('.'));
    EXPECT_THAT(refusal({"Stages.a.time=0.5", "Stages.a." + entry}),
                HasSubstr("block.xml: Sprekk > Stages > a > " + section + ": a stage cannot change it"));
  }
  EXPECT_THAT(refusal({"Stages.a.time=0.5", "Stages.a.Fractures.material=weak"}),
              HasSubstr("Stages > a > Fractures > \"material\": a stage changes the materials of fractures by their"));
}

TEST(Stages, RefuseNamesThatDoNotExist) {
  EXPECT_THAT(refusal({"Stages.a.time=0.5", "Stages.a.without={Boundary conditions > pul}"}),
              AllOf(StartsWith("block.xml: stage \"a\": \"without\": names \"Boundary conditions > pul\""),
                    HasSubstr("Did you mean \"pull\"?")));
  EXPECT_THAT(refusal(also(core, {"Stages.a.time=0.5", "Stages.a.backfill={core}"})),
              HasSubstr("stage \"a\": \"backfill\": names \"core\", which is not excavated at this time"));
  EXPECT_THAT(refusal(also(core, {"Stages.a.time=0.5", "Stages.a.excavate={core}", "Stages.a.backfill={core}"})),
              HasSubstr("\"backfill\": names \"core\", and so does \"excavate\": take two stages"));
  EXPECT_THAT(refusal({"Stages.a.time=0.5", "Stages.a.excavate={core}"}),
              HasSubstr("stage \"a\": Sprekk > Regions > \"core\": is \"core\", must be one of \"bulk\""));
  EXPECT_THAT(refusal({"Stages.a.time=0.5", "Stages.a.Matter.rock.density=1.0"}),
              HasSubstr("stage \"a\": Sprekk > \"Matter\": unknown; allowed are"));
  EXPECT_THAT(refusal({"Stages.a.time=0.5", "Stages.a.Boundary conditions.pull.boundary=up"}),
              HasSubstr("block.xml: stage \"a\": Sprekk > Boundary conditions > pull > \"boundary\": is \"up\""));
}

TEST(Stages, RefuseReleaseWithoutDuration) {
  EXPECT_THAT(refusal({"Stages.a.time=0.5", "Stages.a.release=0.0"}),
              HasSubstr("Stages > a > \"release\": is 0, must be positive"));
}

/// The traction is 5 t Pa, then 4 Pa, then 10 Pa; the block has the length 2 m and the modulus 10 Pa.
TEST(Stages, ChangeLoadsAtTheirTimes) {
  Model model(block({"Time.schedule={1, 3}", "Stages.high.time=2.0", "Stages.low.time=1.0",
                     "Stages.low.Boundary conditions.pull.traction={4, 0}",
                     "Stages.high.Boundary conditions.pull.traction={10, 0}"}),
              world());
  Steps steps(model);
  EXPECT_EQ(steps.n_left(), 3);
  auto step = steps.take();
  EXPECT_EQ(step.end, 1);
  EXPECT_EQ(step.stage, "");
  EXPECT_NEAR(elongation(model), 1, 1e-12);
  EXPECT_FALSE(steps.is_at_begin_of_stage());  // not begun
  step = steps.take();
  EXPECT_EQ(step.end, 2);  // begin of the next stage
  EXPECT_EQ(step.stage, "low");
  EXPECT_TRUE(step.begins_stage);
  EXPECT_NEAR(elongation(model), 0.8, 1e-12);
  step = steps.take();
  EXPECT_EQ(step.end, 3);
  EXPECT_EQ(step.stage, "high");
  EXPECT_NEAR(elongation(model), 2, 1e-12);
  EXPECT_FALSE(steps.any());
}

TEST(Stages, LastUntilTheNextOne) {
  Model model(block({"Time.steps=4", "Stages.low.time=0.5", "Stages.low.Boundary conditions.pull.traction={4, 0}"}),
              world());
  Steps steps(model);
  std::vector<std::string> names;
  std::vector<int> begins;
  while (steps.any()) {
    const auto step = steps.take();
    names.push_back(step.stage);
    begins.push_back(step.begins_stage);
  }
  EXPECT_THAT(names, ElementsAre("", "", "low", "low"));
  EXPECT_THAT(begins, ElementsAre(0, 0, 1, 0));
}

TEST(Stages, AreFoundForARestoredModel) {
  const auto scene =
      block({"Time.schedule={1, 2}", "Stages.low.time=1.0", "Stages.low.Boundary conditions.pull.traction={4, 0}"});
  for (const bool begun : {false, true}) {
    Model model(scene, world());
    Steps steps(model);
    steps.go_to_stage_at(1, begun);
    EXPECT_EQ(steps.stage(), begun ? "low" : "");
    EXPECT_EQ(traction_of(model.scene()), begun ? "4" : "5*t");
    model.step_to(1);
    steps.resume(nullptr);
    EXPECT_EQ(steps.is_at_begin_of_stage(), begun);
    const auto step = steps.take();
    EXPECT_TRUE(step.begins_stage);
    EXPECT_EQ(step.end, 2);
    EXPECT_NEAR(elongation(model), 0.8, 1e-12);
  }
}

TEST(Stages, AfterTheEndCauseAWarning) {
  const auto warnings_of = [](const Entries& changes) { return Model(block(changes), world()).warnings(); };
  EXPECT_THAT(warnings_of({"Stages.a.time=1.0"}),
              ElementsAre(AllOf(HasSubstr("block.xml: Sprekk > Stages > a > \"time\""), HasSubstr("never begins"))));
  EXPECT_THAT(warnings_of({"Stages.a.time=0.5", "Stages.a.release=1.0"}),
              ElementsAre(HasSubstr("Stages > a > \"release\": lasts to 1.5 s, and the last step ends at 1 s")));
  EXPECT_THAT(warnings_of({"Stages.a.time=0.5", "Stages.a.release=0.5"}), ElementsAre());
}

TEST(Change, IgnoresOutputProbesAndStages) {
  const auto before = block();
  EXPECT_TRUE(same_entries(before, block({"Output.every=2", "Stages.a.time=0.5", "Probes.p.point={0, 0}",
                                          "Probes.p.outputs={displacement}"})));
  EXPECT_FALSE(same_entries(before, block({"Time.steps=2"})));
  EXPECT_FALSE(same_entries(before, block({"Materials.rock.Young's modulus=11.0"})));
}

TEST(Change, RefusesOtherMeshesAndInitialStates) {
  const auto before = block();
  EXPECT_THAT(refused_changes(before, block({"Materials.rock.Young's modulus=20.0", "Time.steps=3"})), ElementsAre());
  EXPECT_THAT(refused_changes(before, block({"Mesh.cells={2, 2}"})),
              ElementsAre("Mesh: the mesh is another one; only regions of it may be taken away"));
  EXPECT_THAT(
      refused_changes(block({"Bulk.initial stress={-1, -1, -1, 0}"}), block({"Bulk.initial stress={-2, -1, -1, 0}"})),
      ElementsAre("Bulk > \"initial stress\": is {-2, -1, -1, 0}, was {-1, -1, -1, 0}"));
  EXPECT_THAT(refused_changes(before, block({"Materials.rock.Biot coefficient=0.5"})),
              ElementsAre("the rock of \"bulk\": \"Biot coefficient\": is 0.5, was 1"));
}

TEST(Change, RefusedByAModelLeavesItUnchanged) {
  Model model(block(), world());
  model.step_to(0.5);
  EXPECT_THAT(message_of([&] { model.change(block({"Mesh.cells={2, 2}"})); }),
              HasSubstr("block.xml: Mesh: the mesh is another one"));
  EXPECT_NEAR(elongation(model), 0.5, 1e-12);
  model.step_to(1);
  EXPECT_NEAR(elongation(model), 1, 1e-12);
}

/// The stress remains if the modulus is doubled; the added traction acts on the new rock.
TEST(Change, ANewModulusActsOnAddedLoadOnly) {
  Model model(block(), world());
  model.step_to(1);
  model.change(block({"Materials.rock.Young's modulus=20.0"}));
  EXPECT_NEAR(elongation(model), 1, 1e-12);
  model.step_to(3);  // 10 Pa added
  EXPECT_NEAR(elongation(model), 1 + 2 * 10.0 / 20, 1e-12);
}

TEST(Change, StorageMayLoseFieldsOfTipsOnly) {
  using fields::Entity;
  const Storage::Place node = {Entity::node, 2}, tip = {Entity::enriched_node, 8}, face = {Entity::fracture_face, 2};
  const Storage before = {{{"displacement", node}, {"tips", tip}}, {{"joint: slip", face}}};
  Storage after = before;
  EXPECT_THAT(misfits(before, after), ElementsAre());
  after.fields.erase("tips");
  after.histories["joint: damage"] = face;
  EXPECT_THAT(misfits(before, after), ElementsAre());
  after.fields["pressure"] = {Entity::cell, 1};
  EXPECT_THAT(misfits(before, after), ElementsAre("there would be the unknown \"pressure\", which was not"));
  EXPECT_THAT(misfits(after, before), ElementsAre("there would be the unknown \"tips\", which was not",
                                                  "the unknown \"pressure\" would be no more"));
  after = before;
  after.histories["joint: slip"].n_components = 1;
  EXPECT_THAT(misfits(before, after), ElementsAre(AllOf(StartsWith("the history \"joint: slip\": number of values per"),
                                                        HasSubstr(": 1; before: 2 per"))));
}

}  // namespace
}  // namespace sprekk::model::test
