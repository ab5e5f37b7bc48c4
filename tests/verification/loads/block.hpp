// Scenes built in code for the tests of loads, in 2D and 3D.
#pragma once

#include "verification/scenes.hpp"

namespace sprekk::tests {

/// Returns compiled expressions, "free" included.
inline std::vector<base::Expression> expressions(const std::vector<std::string>& texts) {
  std::vector<base::Expression> result;
  for (const auto& text : texts) {
    result.emplace_back(text);
    if (text != "free") result.back().compile();
  }
  return result;
}

inline base::Expression expression(const std::string& text) { return expressions({text}).front(); }

/// Returns the first `dim` values.
template <class T>
std::vector<T> first(int dim, std::vector<T> values) {
  values.resize(dim);
  return values;
}

/// Returns a box of rock "rock" (elastic, E given, Poisson's ratio 0), without fractures and conditions.
inline model::Scene box_of_rock(const Discretisation& cells, const std::vector<Real>& size, const std::vector<int>& n,
                                const std::string& youngs_modulus) {
  model::Scene scene;
  scene.mesh.cell = cells.cell;
  scene.mesh.order = cells.order;
  scene.mesh.lower_corner.assign(size.size(), 0);
  scene.mesh.upper_corner = size;
  scene.mesh.cells = n;
  auto& rock = scene.materials["rock"];
  rock.type = "elastic";
  rock.E = expression(youngs_modulus);
  rock.nu = base::Expression(0);
  scene.bulk.material = "rock";
  return scene;
}

inline void prescribe(model::Scene& scene, const std::string& boundary, const std::vector<std::string>& displacement,
                      const std::string& region = "") {
  auto& condition = scene.boundary_conditions[boundary + " " + region + " held"];
  condition.boundary = boundary;
  condition.displacement = expressions(displacement);
  if (!region.empty()) condition.region = region;
}

inline void load(model::Scene& scene, const std::string& boundary, const std::vector<std::string>& traction,
                 const std::string& region = "") {
  auto& condition = scene.boundary_conditions[boundary + " " + region + " loaded"];
  condition.boundary = boundary;
  condition.traction = expressions(traction);
  if (!region.empty()) condition.region = region;
}

/// Solves one step and compares the displacement of every node with u(x, region of an adjacent cell).
template <class Exact>
void expect_displacement(model::Model& model, Real tolerance, const Exact& u) {
  const auto report = model.step_to(1);
  ASSERT_TRUE(report.converged) << report.reason;
  const auto& mesh = model.mesh();
  const Outputs out(model);
  const auto& values = out["displacement"].values;
  const int dim = mesh.dim(), n = mesh.nodes_per_cell();
  for (LocalIndex k = 0; k < static_cast<LocalIndex>(mesh.cells.size()); ++k) {
    const LocalIndex node = mesh.cells[k];
    Vector3 x{};
    std::copy_n(mesh.coordinates.begin() + node * dim, dim, x.begin());
    const Vector3 expected = u(x, mesh.region_names[mesh.cell_region[k / n]]);
    for (int i = 0; i < dim; ++i)
      EXPECT_NEAR(values[node * dim + i], expected[i], tolerance)
          << "component " << i << " at (" << x[0] << ", " << x[1] << ", " << x[2] << ")";
  }
}

}  // namespace sprekk::tests
