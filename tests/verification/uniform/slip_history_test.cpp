// Slip-dependent laws on meshes: the block of cyclic_2d.xml and cyclic_3d.xml, N = 0.3 and K_s = 2/3. All faces behave
// like one point. In 3D the shear has a general direction of the joint frame.
#include "base/over_ranks.hpp"
#include "verification/uniform/states.hpp"

namespace sprekk::tests {
namespace {

/// Returns the block with the displacement `top` of its top, e.g. {d(t), -0.1}; d(k) is the k-th value of the path.
model::Scene block(int dim, std::vector<std::string> overrides, const std::vector<Real>& path, const std::string& top) {
  std::vector<Real> times = {0}, from_rest = {0};
  for (const Real d : path) {
    times.push_back(times.size());
    from_rest.push_back(d);
  }
  overrides.push_back(fmt::format("Tables.tangential.arguments={{{}}}", fmt::join(times, ", ")));
  overrides.push_back(values("tangential", from_rest));
  overrides.push_back(fmt::format("Time.end={}", path.size()));
  overrides.push_back(fmt::format("Time.steps={}", path.size()));
  overrides.push_back("Boundary conditions.moved.displacement=" + top);
  auto scene = read_scene(fmt::format("verification/cyclic_{}d.xml", dim), overrides);
  tie_sides(scene);
  return scene;
}

Vector3 direction(int dim) { return dim == 2 ? Vector3{1, 0, 0} : Vector3{0.6, -0.8, 0}; }

std::string along(int dim) {
  return dim == 2 ? "{tangential(t), -0.1}" : "{0.6*tangential(t), -0.8*tangential(t), -0.1}";
}

/// Shears a block along the path and compares each step with the plastic jump u[k]; other values follow from the
/// column.
void expect_slip(model::Model& model, const std::vector<Real>& path, const std::vector<Real>& u, Real digits) {
  for (std::size_t k = 0; k < path.size(); ++k) {
    SCOPED_TRACE(fmt::format("step {}", k + 1));
    const auto report = model.step_to(k + 1);
    ASSERT_TRUE(report.converged) << report.reason;
    auto e = UniformJoint{2.0 / 3 * (path[k] - u[k]), -0.3, u[k], 0, 0, 2}.along(direction(model.mesh().dim()),
                                                                                 model.mesh().dim());
    e.tolerance = e.traction_tolerance = digits;
    expect_joint(model, e);
  }
}
void expect_slip(int dim, const std::vector<std::string>& overrides, const std::vector<Real>& path,
                 const std::vector<Real>& u, Real digits) {
  model::Model model(block(dim, overrides, path, along(dim)), Tpetra::getDefaultComm());
  expect_slip(model, path, u, digits);
}

TEST(SlipHistory, WeakeningOnEveryMesh) {
  const std::vector<Real> path = {0.1, 0.2, 0.3, 0.4, 0.6}, u = {0, 0, 3.0 / 55, 0.22, 0.42};
  for (const int dim : {2, 3})
    for (const auto& d : discretisations(dim)) {
      SCOPED_TRACE(d.name());
      expect_slip(
          dim,
          d.with({"Materials.joint.friction=slip weakening", "Materials.joint.residual friction coefficient=0.4",
                  "Materials.joint.weakening distance=0.2"}),
          path, u, 1e-10);
    }
}

/// Returns the largest runaway slip of all faces. Collective.
Real runaway(model::Model& model) {
  Real maximum = 0;
  for (const auto& output : model.system().outputs(model.state()))
    for (const Real slip : output.values)
      if (output.name == "runaway slip") maximum = std::max(maximum, slip);
  return base::max_over_ranks(*model.mesh().comm, maximum);
}

/// The bound decreases faster than the column unloads (by 1.2 or 4.5 against 2/3), so slip jumps: friction that
/// weakens over 0.05; damage with L = 0.02, b = 0.18 + 0.09 exp(-u/L). The state after the jump obeys the law (by hand
/// or by a fixed-point iteration). The runaway slip is reported; it is zero for slow weakening.
TEST(SlipHistory, RunsAwayOnEveryMesh) {
  const std::vector<std::string> weakens = {"Materials.joint.friction=slip weakening",
                                            "Materials.joint.residual friction coefficient=0.4"};
  const auto with = [](std::vector<std::string> all, const std::string& more) {
    all.push_back("Materials.joint.weakening distance=" + more);
    return all;
  };
  Real worn = 0.15;
  for (int k = 0; k < 50; ++k) worn = 0.42 - (0.18 + 0.09 * std::exp(-worn / 0.02)) * 1.5;
  const struct {
    std::vector<std::string> joint;
    std::vector<Real> path, u;
    Real ran;
  } cases[] = {{with(weakens, "0.05"), {0.1, 0.2, 0.26, 0.28, 0.3, 0.4}, {0, 0, 0, 0.1, 0.12, 0.22}, 0.1},
               {with(weakens, "0.2"), {0.2, 0.3}, {0, 3.0 / 55}, 0},
               {{"Materials.joint.friction coefficient=0.9", "Materials.joint.damage=isotropic",
                 "Materials.joint.residual part of friction=0.66666666666666667",
                 "Materials.joint.damage length of friction=0.02"},
                {0.2, 0.4, 0.42},
                {0, 0, worn},
                worn}};
  for (const int dim : {2, 3})
    for (const auto& d : discretisations(dim))
      for (const auto& c : cases) {
        SCOPED_TRACE(d.name());
        model::Model model(block(dim, d.with(c.joint), c.path, along(dim)), Tpetra::getDefaultComm());
        expect_slip(model, c.path, c.u, 1e-9);
        EXPECT_NEAR(runaway(model), c.ran, 1e-8);
      }
}

/// Independent values with twelve digits, as in the tests at a point.
TEST(SlipHistory, DamageOnEveryMesh) {
  const std::vector<Real> path = {0.2, 0.4, 0.6, 0.3, 0, -0.3, -0.6, -0.3};
  const std::vector<Real> u = {
      0, 0, 0.299855684813, 0.299855684813, 0.299855684813, -0.024031101387, -0.328698882491, -0.328698882491};
  for (const int dim : {2, 3})
    for (const auto& d : discretisations(dim)) {
      SCOPED_TRACE(d.name());
      expect_slip(dim,
                  d.with({"Materials.joint.friction coefficient=0.9", "Materials.joint.damage=isotropic",
                          "Materials.joint.residual part of friction=0.66666666666666667",
                          "Materials.joint.damage length of friction=0.2"}),
                  path, u, 1e-9);
    }
}

/// Two sides with separate wear: slip to u wears the first side. Slip beyond 0 meets the intact second side, with the
/// same slip as on the first.
TEST(SlipHistory, AnisotropicDamage) {
  const std::vector<std::string> damage = {
      "Materials.joint.friction coefficient=0.9", "Materials.joint.damage=anisotropic",
      "Materials.joint.residual part of friction=0.66666666666666667", "Materials.joint.damage length of friction=0.2"};
  const Real u = 0.299855684813;  // as above, for first loading
  for (const int dim : {2, 3}) expect_slip(dim, damage, {0.6, 0, -0.6}, {u, u, -u}, 1e-9);
}

/// Tension: rock of stiffness 3 (plane strain, height 1) in series with a joint without elastic deformation, t = 3 (d
/// - o). With T = 0.06 and o_f = 2 G/T = 0.1, it is intact up to T, softens with t = T (1 - o/o_f), unloads with
/// t/t_max = o/o_max, and is open from o_f.
TEST(SlipHistory, BondOnEveryMesh) {
  const std::vector<Real> pulled = {0.01, 0.03, 0.06, 0.04, 0.02, 0.08, 0.12};
  const Real T = 0.06, o_f = 0.1;
  for (const int dim : {2, 3})
    for (const auto& d : discretisations(dim)) {
      SCOPED_TRACE(d.name());
      const auto bond = d.with({"Materials.joint.bond=linear softening", "Materials.joint.cohesion=0.05",
                                "Materials.joint.shear fracture energy=1", "Materials.joint.tensile strength=0.06",
                                "Materials.joint.fracture energy=0.003"});
      model::Model model(block(dim, bond, pulled, dim == 2 ? "{0, tangential(t)}" : "{0, 0, tangential(t)}"),
                         Tpetra::getDefaultComm());
      Real widest = 0;
      for (std::size_t k = 0; k < pulled.size(); ++k) {
        SCOPED_TRACE(k);
        const auto report = model.step_to(k + 1);
        ASSERT_TRUE(report.converged) << report.reason;
        Real o = std::max((pulled[k] - T / 3) / (1 - T / (3 * o_f)), Real(0));  // on the softening line
        if (o < widest) o = pulled[k] / (1 + T * (1 - widest / o_f) / (3 * widest));
        if (o > o_f) o = pulled[k];
        widest = std::max(widest, o);
        auto e = UniformJoint{0, 3 * (pulled[k] - o), 0, o, 0, 2}.along({1, 0, 0}, dim);
        e.tolerance = e.traction_tolerance = 1e-10;
        expect_joint(model, e);
      }
      EXPECT_GT(widest, o_f);
    }
}

}  // namespace
}  // namespace sprekk::tests
