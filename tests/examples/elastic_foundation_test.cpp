// Bar on springs: Jacobian of the module, and displacement compared with a manual solution.
#include "assembly/jacobian_check.hpp"
#include "mesh/box.hpp"
#include "mesh/distribute.hpp"
#include "physics/mechanics/bulk_momentum.hpp"
#include "physics/mechanics/elastic_foundation.hpp"
#include "solve/newton.hpp"

#include <Tpetra_Core.hpp>
#include <gtest/gtest.h>

#include <tuple>

namespace sprekk::examples {
namespace {

constexpr Real E = 2e9, length = 3, pull = 1e6, k = 5e8;  // Pa, m, Pa, Pa/m

/// Returns a bar along x on springs at its west end, with tension at its east end; rollers permit lateral contraction.
std::unique_ptr<assembly::System> bar(const std::tuple<std::string, int>& cell_and_order) {
  mesh::BoxMesh box;
  std::tie(box.cell, box.order) = cell_and_order;
  const int dim = box.cell == "triangle" || box.cell == "quadrilateral" ? 2 : 3;
  box.lower_corner.assign(dim, 0);
  box.upper_corner.assign(dim, 1);
  box.upper_corner[0] = length;
  box.cells.assign(dim, 2);
  box.cells[0] = 5;
  const RCP<const mesh::Mesh> mesh = mesh::make_distributed(mesh::make_box(box), Tpetra::getDefaultComm());

  const std::vector<base::Expression> zero(dim, 0.0);
  std::vector<base::Expression> traction = zero;
  traction[0] = pull;
  const int west = 0, east = 1, south = 2, bottom = 4;
  physics::BulkMomentumParameters rock;
  rock.elasticity.values = {laws::Elasticity{E / 2, 0}};  // Poisson's ratio 0
  rock.tractions = {{east, traction}};
  std::vector<std::unique_ptr<assembly::Module>> modules;
  modules.push_back(physics::make_bulk_momentum(mesh->shape, rock));
  modules.push_back(physics::make_elastic_foundation(*mesh, {west, {k, k, k}}));

  std::vector<assembly::DirichletCondition> rollers{{"south", "displacement", south, {std::nullopt, 0.0}}};
  if (dim == 3) {
    rollers[0].values.push_back(std::nullopt);
    rollers.push_back({"bottom", "displacement", bottom, {std::nullopt, std::nullopt, 0.0}});
  }
  return std::make_unique<assembly::System>(mesh, std::move(modules), rollers, rcp(new base::Timers));
}

class ElasticFoundationTest : public testing::TestWithParam<std::tuple<std::string, int>> {};

TEST_P(ElasticFoundationTest, JacobianIsTheDerivativeOfTheResidual) {
  const auto system = bar(GetParam());
  system->set_time(1, 1);
  auto x = system->initial();
  x[0]->randomize(-1e-3, 1e-3);
  bool seen = false;
  for (const auto& error : assembly::check_jacobian(*system, x)) {
    EXPECT_LT(error.error, 1e-8) << error.module << ": " << error.row << ", " << error.column;
    seen = seen || error.module == "elastic foundation";
  }
  EXPECT_TRUE(seen);
}

TEST_P(ElasticFoundationTest, BarStretchesAndItsSpringsToo) {
  const auto system = bar(GetParam());
  solve::Newton newton(*system, {});
  auto x = system->initial();
  system->set_time(1, 1);
  const auto report = newton.solve(x);
  ASSERT_TRUE(report.converged) << report.reason;
  EXPECT_EQ(report.iterations, 1);
  const auto& mesh = system->mesh();
  const auto u = x[0]->getLocalViewHost(Tpetra::Access::ReadOnly);
  for (LocalIndex node = 0; node < mesh.n_owned_nodes; ++node)
    for (int i = 0; i < mesh.dim(); ++i) {
      const Real by_hand = i == 0 ? pull / k + pull / E * mesh.coordinates[node * mesh.dim()] : 0;
      EXPECT_NEAR(u(node * mesh.dim() + i, 0), by_hand, 1e-10 * pull / k);
    }
}

INSTANTIATE_TEST_SUITE_P(Cells, ElasticFoundationTest,
                         testing::Combine(testing::Values("triangle", "quadrilateral", "tetrahedron", "hexahedron"),
                                          testing::Values(1, 2)),
                         [](const auto& info) {
                           return std::get<0>(info.param) + std::to_string(std::get<1>(info.param));
                         });

}  // namespace
}  // namespace sprekk::examples
