// Limits of the refinement to tolerances.
#include "model/adaptation.hpp"
#include "model/steps.hpp"
#include "block.hpp"

namespace sprekk::model::test {
namespace {

constexpr int most = 60;  // meshes of a step

/// A block whose stress no mesh resolves to the tolerance.
Scene unreachable() {
  return block(
      with_fault({"Mesh.cell=triangle", "Materials.rock.Poisson's ratio=0.3", "Accuracy.refinement=during the run",
                  "Accuracy.quantities.q.quantity=stress", "Accuracy.quantities.q.relative=1e-6"}));
}

/// Attempts of a step that mark cells, at most `n`.
int n_attempts(Adaptation& adaptation, Model& model, Real begin, int n) {
  RunEstimates estimates(model, begin);
  int k = 0;
  while (k < n && !adaptation.cells_for_step(model, begin, estimates).empty()) ++k;
  return k;
}

TEST(Adaptation, EachStepHasAtMostSixtyMeshes) {
  Model model(unreachable(), world());
  Steps steps(model);
  ASSERT_TRUE(steps.take().report.converged);
  Adaptation adaptation;
  EXPECT_EQ(n_attempts(adaptation, model, 0, 3), 3);
  EXPECT_EQ(n_attempts(adaptation, model, 0.5, 2 * most), most - 1);
  EXPECT_EQ(adaptation.why(), "60 meshes were not enough");
  EXPECT_FALSE(adaptation.goes_on());
  EXPECT_EQ(n_attempts(adaptation, model, 0.75, 1), 0);  // the mesh remains in later steps
}

}  // namespace
}  // namespace sprekk::model::test
