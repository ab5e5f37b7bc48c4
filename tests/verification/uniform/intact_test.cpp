// Rock without fractures under uniform stress.
#include "verification/scenes.hpp"

namespace sprekk::tests {
namespace {

/// E = 10 GPa, nu = 0.25, 5 MPa on top; plane strain in 2D.
TEST(IntactRock, UniaxialCompression) {
  constexpr Real E = 10e9, nu = 0.25, p = 5e6;
  for (const int dim : {2, 3})
    for (const auto& d : discretisations(dim)) {
      SCOPED_TRACE(d.name());
      model::Model model(read_scene(fmt::format("verification/uniaxial_{}d.xml", dim), d.with()),
                         Tpetra::getDefaultComm());
      const auto report = model.step_to(1);
      ASSERT_TRUE(report.converged);
      EXPECT_EQ(report.newton_iterations, 1);
      const Real along = dim == 2 ? -p * (1 - nu * nu) / E : -p / E,
                 across = dim == 2 ? p * nu * (1 + nu) / E : p * nu / E;
      const Outputs out(model);
      const auto& mesh = model.mesh();
      for (LocalIndex node = 0; node < mesh.n_nodes(); ++node)
        for (int i = 0; i < dim; ++i) {
          const Real strain = i == dim - 1 ? along : across;
          EXPECT_NEAR(out["displacement"].values[node * dim + i], strain * mesh.coordinates[node * dim + i],
                      1e-12 * 4 * p / E * 10);
        }
      const Vector3 exact = dim == 2 ? Vector3{0, -p, -nu * p} : Vector3{0, 0, -p};
      for (LocalIndex c = 0; c < mesh.n_owned_cells; ++c)
        for (int i = 0; i < 6; ++i) EXPECT_NEAR(out["stress"].values[c * 6 + i], i < 3 ? exact[i] : 0, 1e-10 * p);
    }
}

}  // namespace
}  // namespace sprekk::tests
