// Steps, fields and saved states of a model, as a host program uses them.
#include "block.hpp"

#include "base/over_ranks.hpp"

namespace sprekk::model::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// Displacement of the east side of the block, m; t at the time t. Collective.
Real displacement_of(Model& model) {
  const auto view = model.field("displacement").values;
  const auto values = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), view);
  Real maximum = 0;
  for (std::size_t k = 0; k < values.extent(0); ++k) maximum = std::max(maximum, values(k, 0));
  return base::max_over_ranks(*model.mesh().comm, maximum);
}

TEST(Model, StepsFollowTheLoad) {
  Model model(block({"Time.start=-1.0"}), world());
  EXPECT_EQ(model.time(), -1);
  EXPECT_TRUE(model.step_to(0.5).converged);
  EXPECT_EQ(model.time(), 0.5);
  EXPECT_NEAR(displacement_of(model), 0.5, 1e-12);
  EXPECT_THAT(message_of([&] { model.step_to(0.5); }),
              HasSubstr("a step to t = 0.5 is no step forward: the model is at t = 0.5"));
}

TEST(Model, TheLastStepCanBeTakenBackOnce) {
  Model model(block(), world());
  EXPECT_THAT(message_of([&] { model.take_back(); }), HasSubstr("there is no step to take back, at t = 0"));
  model.step_to(1);
  model.step_to(3);
  model.take_back();
  EXPECT_EQ(model.time(), 1);
  EXPECT_NEAR(displacement_of(model), 1, 1e-12);
  EXPECT_THAT(message_of([&] { model.take_back(); }), HasSubstr("at t = 1"));
  model.step_to(2);
  EXPECT_NEAR(displacement_of(model), 2, 1e-12);
}

TEST(Model, FindsEquilibriumAfterAChange) {
  Model model(block(), world());
  model.step_to(1);
  model.change(block({"Boundary conditions.pull.traction={2.5, 0}"}));
  EXPECT_NEAR(displacement_of(model), 1, 1e-12);  // not solved
  EXPECT_TRUE(model.find_equilibrium().converged);
  EXPECT_EQ(model.time(), 1);
  EXPECT_NEAR(displacement_of(model), 0.5, 1e-12);
}

TEST(Model, MessagesNameFieldsAndOutputs) {
  Model model(block(), world());
  EXPECT_EQ(model.field("displacement").field.n_components, 2);
  EXPECT_EQ(model.output("stress").unit, "Pa");
  EXPECT_THAT(message_of([&] { model.field("displacment"); }),
              AllOf(HasSubstr("there is no field \"displacment\", but \"displacement\""),
                    HasSubstr("Did you mean \"displacement\"?")));
  EXPECT_THAT(message_of([&] { model.output("pressure"); }), HasSubstr("there is no output \"pressure\", but"));
}

TEST(Model, SavedStatesAreRestoredInModelsOfTheSameScene) {
  Model model(block(), world()), same(block({"Time.steps=5"}), world()),
      stiff(block({"Materials.rock.Young's modulus=20.0"}), world()), fine(block({"Mesh.cells={8, 2}"}), world());
  model.step_to(0.75);
  const auto state = model.save();
  same.restore(state);
  EXPECT_EQ(same.time(), 0.75);
  EXPECT_NEAR(displacement_of(same), 0.75, 1e-12);
  EXPECT_THAT(message_of([&] { stiff.restore(state); }), HasSubstr("Materials"));
  EXPECT_THAT(message_of([&] { fine.restore(state); }), HasSubstr("they differ in: mesh, unknowns"));
  EXPECT_EQ(stiff.time(), 0);
}

}  // namespace
}  // namespace sprekk::model::test
