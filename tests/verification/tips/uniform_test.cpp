// Fractures that end inside rock under uniform stress: without opening and slip, tips have no effect.
#include "unit/mesh/meshes.hpp"
#include "verification/patch/patch.hpp"

namespace sprekk::tests {
namespace {

const Matrix3 stress{{{-0.8, 0.15, 0.05}, {0.15, -0.5, -0.1}, {0.05, -0.1, -0.6}}};

/// Returns fractures that end inside, at each other, and on the boundary: rigid in contact, with sufficient friction.
model::Scene rigid_network(const std::string& cell, int order) {
  model::Scene scene;
  scene.mesh = mesh::testing::crossed(cell);
  scene.mesh.order = order;
  if (mesh::testing::dim_of(cell) ==
      3) {  // a corner of a fracture inside of the rock, and fronts that reach boundaries
    scene.mesh.fractures["a"].upper_corner = {5, 2, 1};
    scene.mesh.fractures["d"] = mesh::testing::fracture({1, 1, 1}, {2, 2, 1});
  }
  auto& rock = scene.materials["rock"];
  rock.type = "elastic";
  rock.E = 2.5;  // G = lambda = 1
  rock.nu = 0.25;
  auto& joint = scene.materials["joint"];
  joint.type = "joint";
  joint.friction_coefficient = 100;
  joint.tangential_stiffness = std::numeric_limits<Real>::infinity();
  scene.bulk.material = "rock";
  for (const auto& [name, fracture] : scene.mesh.fractures) scene.fractures[name].material = "joint";
  return scene;
}

void constrain(model::Scene& scene, const std::function<base::Expression(int)>& displacement) {
  const int dim = static_cast<int>(scene.mesh.lower_corner.size());
  for (const std::string side : {"west", "east", "south", "north", "bottom", "top"}) {
    if (dim == 2 && (side == "bottom" || side == "top")) continue;
    auto& condition = scene.boundary_conditions[side];
    condition.boundary = side;
    for (int i = 0; i < dim; ++i) condition.displacement.push_back(displacement(i));
  }
}

/// Compares displacement, stress, traction and jump with exact values. Collective.
void expect_uniform(const model::Scene& scene, const std::function<Real(const Vector3&, int)>& u) {
  model::Model model(scene, Tpetra::getDefaultComm());
  const auto report = model.step_to(1);
  ASSERT_TRUE(report.converged) << report.reason;
  const Outputs out(model);
  const auto& mesh = model.mesh();
  const int dim = mesh.dim();
  const auto forces = model.system().reactions(model.state());
  EXPECT_EQ(forces.size(), 2u * dim);  // one per condition
  Vector3 total{}, moment{};
  for (const auto& reaction : forces)
    for (int i = 0; i < 3; ++i) {
      if (i < dim) total[i] += reaction.force[i];
      moment[i] += reaction.moment[i];
    }
  EXPECT_NEAR(norm(total), 0, 1e-10);
  EXPECT_NEAR(norm(moment), 0, 1e-10);
  if (mesh::order(mesh.shape) == 1) EXPECT_GT(mesh.n_global_enriched, 0);
  Vector3 x{};
  for (LocalIndex node = 0; node < mesh.n_nodes(); ++node) {
    std::copy_n(&mesh.coordinates[node * dim], dim, x.begin());
    for (int i = 0; i < dim; ++i) EXPECT_NEAR(out["displacement"].values[node * dim + i], u(x, i), 1e-11);
  }
  constexpr int of_stress[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  for (LocalIndex cell = 0; cell < mesh.n_owned_cells; ++cell)
    for (int k : {0, 1, 3}) {
      const auto [i, j] = of_stress[k];
      EXPECT_NEAR(out["stress"].values[6 * cell + k], stress[i][j], 1e-10);
    }
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
    const auto normal = mesh.fracture_faces[f].frame[0];
    const auto traction = out.vector("traction", f), jump = out.vector("jump", f);
    for (int i = 0; i < dim; ++i) {
      Real exact = 0;
      for (int j = 0; j < dim; ++j) exact += stress[i][j] * normal[j];
      EXPECT_NEAR(traction[i], exact, 1e-9);
      EXPECT_NEAR(jump[i], 0, 1e-11);
    }
  }
}

class Uniform : public ::testing::TestWithParam<std::tuple<std::string, int>> {};

TEST_P(Uniform, Strain) {
  const auto [cell, order] = GetParam();
  auto scene = rigid_network(cell, order);
  const auto patch = uniform_patch(mesh::testing::dim_of(cell), stress);
  constrain(scene, [&](int i) {
    base::Expression u(fmt::format("{:.17g}*x + {:.17g}*y + {:.17g}*z", patch.strain[i][0], patch.strain[i][1],
                                   patch.dim == 3 ? patch.strain[i][2] : 0));
    u.compile();
    return u;
  });
  expect_uniform(scene, [&](const Vector3& x, int i) { return times(patch.strain, x)[i]; });
}

TEST_P(Uniform, InitialStress) {
  const auto [cell, order] = GetParam();
  auto scene = rigid_network(cell, order);
  const bool flat = mesh::testing::dim_of(cell) == 2;
  constexpr int of_stress[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {0, 2}};
  for (int k = 0; k < (flat ? 4 : 6); ++k)
    scene.bulk.initial_stress.emplace_back(stress[of_stress[k][0]][of_stress[k][1]]);
  constrain(scene, [](int) { return base::Expression(0); });
  expect_uniform(scene, [](const Vector3&, int) { return 0; });
}

INSTANTIATE_TEST_SUITE_P(Cells, Uniform,
                         ::testing::Combine(::testing::ValuesIn(mesh::testing::all_cells), ::testing::Values(1, 2)),
                         [](const auto& info) {
                           return std::get<0>(info.param) + std::to_string(std::get<1>(info.param));
                         });

}  // namespace
}  // namespace sprekk::tests
