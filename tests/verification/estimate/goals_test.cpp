// Quantities of interest, their errors, and the cells to refine.
#include "estimate/goals.hpp"
#include "model/error_estimates.hpp"
#include "verification/scenes.hpp"

#include <Teuchos_DefaultMpiComm.hpp>

#include <numeric>

namespace sprekk::tests {
namespace {

struct Crack {
  std::string scene, quantity;
  int component;  // component of the jump; the quantity is its mean, up to the sign
};

const std::vector<Crack> cracks = {{"sneddon", "opening", 1}, {"sneddon_shear", "slip", 0}};
const Real exact = 1.5e-3 * M_PI / 4;  // mean of 2 (1 - nu) s/G sqrt(1 - x^2) over the crack

model::Scene scene_of(const Crack& crack, int order) {
  return read_scene("verification/" + crack.scene + ".xml",
                    {fmt::format("Mesh file.order={}", order), "Accuracy.quantities.goal.quantity=" + crack.quantity,
                     "Accuracy.quantities.goal.relative=0.01"});
}

Real sum(const Comm& comm, const std::vector<Real>& here) {
  const Real mine = std::accumulate(here.begin(), here.end(), Real{0});
  Real all = 0;
  Teuchos::reduceAll(comm, Teuchos::REDUCE_SUM, 1, &mine, &all);
  return all;
}

/// Compares the estimate with the exact error, and the bound from cells with the estimate.
TEST(Goals, ErrorsOfCracksAndTheirBounds) {
  for (const auto& crack : cracks)
    for (const int order : {1, 2}) {
      SCOPED_TRACE(fmt::format("{} of order {}", crack.scene, order));
      model::Model model(scene_of(crack, order), Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged);
      auto estimator = model::make_error_estimator(model, 0);
      const auto outputs = Outputs(model).all();
      const auto state = model::present_state(model, outputs);
      const auto estimate = estimator(state);
      estimate::Goals goals(estimator, model.scene().accuracy->functionals());
      goals.add(state, estimate, true);
      goals.weigh(state, estimate, true);
      const auto& goal = goals.estimates().at("goal");
      const Real ratio = goal.error / std::abs(goal.value - exact);
      EXPECT_GE(ratio, 0.5);
      EXPECT_LE(ratio, 2);
      const auto products = estimator.contributions(model.scene().accuracy->quantities.at("goal"), state,
                                                    *estimator.errors()[0], {estimate.norms[0]});
      ASSERT_EQ(products.size(), static_cast<std::size_t>(model.mesh().n_owned_cells));
      const Real bound = sum(*model.mesh().comm, products) / (2 * goal.error);  // the crack has the length 2
      EXPECT_GE(bound, 0.9);
      EXPECT_LE(bound, 4);
      if (model.mesh().comm->getRank() == 0)
        fmt::print("  {} of order {}: estimate {:.2f}, bound over estimate {:.2f}\n", crack.scene, order, ratio, bound);
      const auto shares = goals.indicators({{"goal", 3}});
      EXPECT_NEAR(sum(*model.mesh().comm, shares), 3, 1e-12);
      for (std::size_t c = 0; c < shares.size(); ++c)
        EXPECT_NEAR(shares[c], 3 * products[c] / (2 * goal.error * bound), 1e-6 * shares[c]);
    }
}

/// Mode III along the fronts of a crack in 3D, where cells touch the front with only an edge or a corner. Optionally,
/// the front of another fracture without jump is in the same cells.
TEST(Goals, ErrorsOfTearing) {
  for (const int order : {1, 2})
    for (const bool glued : {false, true}) {
      SCOPED_TRACE(fmt::format("order {}, {}", order, glued));
      std::vector<std::string> sets = {
          "Mesh.cells={8, 2, 8}", fmt::format("Mesh.order={}", order), "Accuracy.quantities.goal.quantity=slip",
          "Accuracy.quantities.goal.fractures={crack}", "Accuracy.quantities.goal.relative=0.01"};
      if (glued)
        for (const char* entry :
             {"Mesh.fractures.glued.lower corner={1.5, 0, 0}", "Mesh.fractures.glued.upper corner={2, 1, 0}",
              "Materials.glue.type=joint", "Materials.glue.friction coefficient=1e6", "Fractures.glued.material=glue"})
          sets.emplace_back(entry);
      model::Model model(read_scene("verification/tearing_3d.xml", sets), Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged);
      auto estimator = model::make_error_estimator(model, 0);
      const auto outputs = Outputs(model).all();
      const auto state = model::present_state(model, outputs);
      estimate::Goals goals(estimator, model.scene().accuracy->functionals());
      goals.add(state, estimator(state), true);
      const auto& goal = goals.estimates().at("goal");
      const Real ratio = goal.error / std::abs(goal.value - 2e-3 * M_PI / 4);
      EXPECT_GE(ratio, 0.5);
      EXPECT_LE(ratio, 1.3);
      if (model.mesh().comm->getRank() == 0)
        fmt::print("  order {}{}: {:.2f}\n", order, glued ? ", with another front" : "", ratio);
    }
}

/// Reaction of a block with free sides and a compliant fracture; reference:
/// perf/verification/references/free_sides.csv.
TEST(Goals, ErrorsOfReactions) {
  for (const int order : {1, 2}) {
    SCOPED_TRACE(fmt::format("order {}", order));
    model::Model model(
        read_scene("verification/free_sides_2d.xml",
                   {"Mesh.cell=triangle", fmt::format("Mesh.order={}", order), "Mesh.cells={16, 16}",
                    "Accuracy.quantities.goal.quantity=reaction", "Accuracy.quantities.goal.boundary=north",
                    "Accuracy.quantities.goal.component=x", "Accuracy.quantities.goal.relative=0.01"}),
        Tpetra::getDefaultComm());
    ASSERT_TRUE(model.step_to(model.scene().time.times().back()).converged);
    auto estimator = model::make_error_estimator(model, 0);
    const auto outputs = Outputs(model).all();
    const auto state = model::present_state(model, outputs);
    estimate::Goals goals(estimator, model.scene().accuracy->functionals());
    goals.add(state, estimator(state), true);
    const auto& goal = goals.estimates().at("goal");
    const Real ratio = goal.error / std::abs(goal.value - 0.4900271545);
    EXPECT_GE(ratio, 0.5);
    EXPECT_LE(ratio, 2);
    if (model.mesh().comm->getRank() == 0) fmt::print("  order {}: {:.2f}\n", order, ratio);
  }
}

}  // namespace
}  // namespace sprekk::tests
