// One problem in four systems of units: equal results and numbers of iterations.
#include "verification/uniform/states.hpp"

namespace sprekk::tests {
namespace {

struct Units {
  const char* name;
  Real length, stress;  ///< in m and Pa
};

/// Returns a slipping block: H = 10 m, G = 12 GPa, lambda = 8 GPa, K_t = 5 GPa/m, mu = 0.6, theta = 5 degrees, g0 =
/// 0.1 mm, Du = 0.2 mm, K_n = 30 GPa/m, d = (20, -1) mm.
model::Scene block(int dim, const Discretisation& d, const Units& u) {
  const std::vector<std::pair<std::string, Real>> entries = {
      {"Materials.rock.shear modulus", 12e9 / u.stress},
      {"Materials.rock.Lame's first parameter", 8e9 / u.stress},
      {"Materials.joint.tangential stiffness", 5e9 / (u.stress / u.length)},
      {"Materials.joint.friction coefficient", 0.6},
      {"Materials.joint.dilation angle", 5},
      {"Materials.joint.initial gap", 1e-4 / u.length},
      {"Materials.joint.maximum closure", 2e-4 / u.length},
      {"Materials.joint.normal stiffness", 30e9 / (u.stress / u.length)}};
  auto overrides = d.with({values("tangential", std::vector<Real>(4, 0.02 / u.length)),
                           values("normal", std::vector<Real>(4, -0.001 / u.length))});
  for (const auto& [entry, value] : entries) overrides.push_back(fmt::format("{}={:.17g}", entry, value));
  auto scene = read_scene(fmt::format("verification/regimes_{}d.xml", dim), overrides);
  for (auto* corner : {&scene.mesh.upper_corner, &scene.mesh.fractures.at("fracture").lower_corner,
                       &scene.mesh.fractures.at("fracture").upper_corner})
    for (Real& x : *corner) x *= 10 / u.length;
  tie_sides(scene);
  return scene;
}

/// Roots of the series block in 60 digits, see regimes_test.cpp.
TEST(Units, DoNotMatter) {
  const Real l_t = 4.480859218092e6, l_n = -7.468098696819e6, u_p = 1.536977880797e-2, opening = 1.333780842756e-3;
  for (const int dim : {2, 3})
    for (const auto& d : discretisations(dim)) {
      std::vector<int> iterations;
      for (const Units& u :
           {Units{"m, Pa", 1, 1}, {"km, GPa", 1e3, 1e9}, {"mm, MPa", 1e-3, 1e6}, {"um, Pa", 1e-6, 1}}) {
        SCOPED_TRACE(fmt::format("{}, {}", d.name(), u.name));
        model::Model model(block(dim, d, u), Tpetra::getDefaultComm());
        const auto report = model.step_to(1);
        ASSERT_TRUE(report.converged) << report.reason;
        iterations.push_back(report.newton_iterations);
        EXPECT_EQ(iterations.back(), iterations.front());
        const Outputs out(model);
        for (LocalIndex f = 0; f < model.mesh().n_owned_fracture_faces; ++f) {
          const auto traction = out.vector("traction", f);
          EXPECT_NEAR(traction[0] * u.stress, l_t, 1e-10 * l_t);
          EXPECT_NEAR(traction[dim - 1] * u.stress, l_n, -1e-10 * l_n);
          EXPECT_NEAR(out.scalar("slip", f) * u.length, u_p, 1e-10 * u_p);
          EXPECT_NEAR(out.scalar("opening", f) * u.length, opening, 1e-10 * opening);
        }
      }
    }
}

}  // namespace
}  // namespace sprekk::tests
