// Every regime of the joint law on one block, with shear and compression or tension in one step. Rock and joint are
// springs in series, k_n = (lambda + 2G)/H and 1/K_s = H/G + 1/K_t. The compression N is the root of a quadratic
// equation:
//   stick  N/k_n + V(N) = g0 + tan(theta)|u^p_old| - d_n,                  lambda_t = K_s (d_t - u^p_old)
//   slip   N/k_n + V(N) + mu tan(theta) N/K_s = g0 + tan(theta)|d_t| - d_n,  |lambda_t| = mu N
// with the closure V(N) = Du N/(Du K_n + N). Numbers below are the roots in double precision.
#include "verification/uniform/states.hpp"

namespace sprekk::tests {
namespace {

/// Displacement of the top, and the state of the joint after one step, or after one step that follows "slip".
struct Regime {
  const char* name;
  Real d_t, d_n, l_t, l_n, u_p, opening;
  bool follows_slip;
};

/// H = G = lambda = 1, K_t = 2, mu = 0.6, theta = 10 degrees, g0 = 0.01, Du = 0.1, K_n = 5.
const Regime slip = {"slip", 0.5, -0.1, 0.193791423668432, -0.322985706114053, 0.209312864497352, 0.007661902038018,
                     false};
const std::vector<Regime> regimes = {
    {"open", 0.2, 0.2, 0, 0, 0.2, 0.2, false},
    {"stick", 0.05, -0.1, 0.1 / 3, -0.234281365494092, 0, -0.021906211501969, false},
    slip,
    {"strongly dilating", 1, -0.05, 0.234665843754141, -0.391109739590235, 0.648001234368789, 0.080369913196745, false},
    {"unloaded", 0.35, -0.1, 0.093791423668432, -0.322985706114053, 0.209312864497352, 0.007661902038018, true},
    {"reverse", -0.6, -0.1, -0.212578130500585, -0.354296884167642, -0.281132804249122, 0.018098961389214, true},
    {"nearly open", 0.3, 0.05, 0.011301447521894, -0.018835745869824, 0.283047828717158, 0.056278581956608, false}};

Expected expected(const Regime& r, const Vector3& m, int dim) {
  const Real closure = 0.1 * r.l_n / (0.5 - r.l_n);
  return UniformJoint{r.l_t, r.l_n, r.u_p, r.opening, closure, 2}.along(m, dim);
}

/// Tied sides allow shear in a general direction.
TEST(JointRegimes, ExactStates) {
  for (const int dim : {2, 3})
    for (const auto& d : discretisations(dim))
      for (const auto sides : {Sides::loaded, Sides::tied})
        for (const auto& r : regimes) {
          if (dim == 3 && d.order == 2 && sides == Sides::loaded) continue;
          SCOPED_TRACE(fmt::format("{}, sides {}: {}", d.name(), sides == Sides::tied ? "tied" : "loaded", r.name));
          const auto path = [&](Real Regime::*member, Real factor) {
            return std::vector<Real>{0, factor * (r.follows_slip ? slip : r).*member, factor * r.*member, 0};
          };
          auto overrides = d.with({"Solver.tolerance=1e-13", values("tangential", path(&Regime::d_t, 1)),
                                   values("normal", path(&Regime::d_n, 1)), values("shear", path(&Regime::l_t, 1)),
                                   values("lateral", path(&Regime::l_n, 1.0 / 3))});
          const bool oblique = dim == 3 && sides == Sides::tied;
          const Vector3 m = oblique ? Vector3{0.6, 0.8, 0} : Vector3{1, 0, 0};
          if (oblique)
            overrides.push_back(
                "Boundary conditions.moved.displacement={0.6*tangential(t), 0.8*tangential(t), normal(t)}");
          auto scene = read_scene(fmt::format("verification/regimes_{}d.xml", dim), overrides);
          if (sides == Sides::tied) tie_sides(scene);
          model::Model model(scene, Tpetra::getDefaultComm());
          for (int step = 1; step <= (r.follows_slip ? 2 : 1); ++step) {
            const auto report = model.step_to(step);
            ASSERT_TRUE(report.converged) << report.reason;
          }
          auto e = expected(r, m, dim);
          e.tolerance = e.traction_tolerance = 1e-12;
          expect_joint(model, e);
        }
}

/// A step after slip equals one step from the initial plastic jump that the slip causes: along t in 2D, t2 in 3D.
TEST(JointRegimes, FromAPlasticJump) {
  for (const int dim : {2, 3})
    for (const auto& r : regimes) {
      if (!r.follows_slip) continue;
      SCOPED_TRACE(fmt::format("{}D: {}", dim, r.name));
      auto scene = read_scene(
          fmt::format("verification/regimes_{}d.xml", dim),
          {"Solver.tolerance=1e-13", values("tangential", {0, r.d_t, 0, 0}), values("normal", {0, r.d_n, 0, 0}),
           values("shear", {0, r.l_t, 0, 0}), values("lateral", {0, r.l_n / 3, 0, 0})});
      for (auto& [name, fracture] : scene.fractures) {
        fracture.plastic_jump.assign(dim - 1, base::Expression(0));
        fracture.plastic_jump.back() = base::Expression(slip.u_p);
      }
      model::Model model(scene, Tpetra::getDefaultComm());
      ASSERT_TRUE(model.step_to(1).converged);
      auto e = expected(r, {1, 0, 0}, dim);
      e.tolerance = e.traction_tolerance = 1e-12;
      expect_joint(model, e);
    }
}

/// The steps of the scene: slip, unloading to stick, reverse slip.
TEST(JointRegimes, Scene) {
  for (const int dim : {2, 3}) {
    model::Model model(read_scene(fmt::format("verification/regimes_{}d.xml", dim)), Tpetra::getDefaultComm());
    int k = 0;
    for (const auto& r : {slip, regimes[4], regimes[5]}) {
      SCOPED_TRACE(r.name);
      ASSERT_TRUE(model.step_to(++k).converged);
      expect_joint(model, expected(r, {1, 0, 0}, dim));
    }
  }
}

/// Push and pull tests of Wollmann (2024) without lateral strain: G = 1 MPa, lambda = 1 kPa, K_t = 1e-5 Pa/m. Under
/// push the joint sticks with u^e = 1/(1 + K_t H/G) = 1 - 1e-11 and lambda_n = -(2G + lambda); under pull it opens.
TEST(JointRegimes, PushAndPull) {
  const Real stiffness = 2.001e6;
  for (const int dim : {2, 3})
    for (const auto& d : discretisations(dim))
      for (const int pull : {0, 1}) {
        SCOPED_TRACE(fmt::format("{} {}", d.name(), pull ? "pulled" : "pushed"));
        auto scene = read_scene(
            fmt::format("verification/regimes_{}d.xml", dim),
            d.with({"Materials.rock.shear modulus=1e6", "Materials.rock.Lame's first parameter=1e3",
                    "Materials.joint.tangential stiffness=1e-5", "Materials.joint.friction coefficient=1",
                    "Materials.joint.dilation angle=0", "Materials.joint.initial gap=0",
                    "Materials.joint.maximum closure=0", values("tangential", {0, 1, 1, 1}),
                    values("normal", pull ? std::vector<Real>{0, 1, 1, 1} : std::vector<Real>{0, -1, -1, -1})}));
        tie_sides(scene);
        model::Model model(scene, Tpetra::getDefaultComm());
        ASSERT_TRUE(model.step_to(1).converged);
        const Real l_t = 1e-5 * (1 - 1e-11);
        auto e = pull ? UniformJoint{0, 0, 1, 1, 0, 1e-5}.along({1, 0, 0}, dim)
                      : UniformJoint{l_t, -stiffness, 0, 0, 0, 1e-5}.along({1, 0, 0}, dim);
        e.traction_tolerance = tolerance * stiffness;
        expect_joint(model, e);
        if (!pull) {
          EXPECT_NEAR(mean(model, Outputs(model)["traction"], 0), l_t, tolerance * l_t);
        }
      }
}

}  // namespace
}  // namespace sprekk::tests
