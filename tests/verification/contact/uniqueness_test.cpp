// Non-unique states due to dilation, and the warnings about them.
#include "laws/shear/linear.hpp"
#include "laws/friction/coulomb.hpp"
#include "laws/dilation/constant_angle.hpp"
#include "laws/joint.hpp"
#include "physics/mechanics/uniqueness.hpp"
#include "verification/scenes.hpp"

#include <gmock/gmock.h>

namespace sprekk::tests {
namespace {

/// Block of height 1, lambda = G = 1, with a joint of K_t = 0.5 and mu = 0.6, so K_s = 1/3 and k_n = 3. Slip reversal
/// is unique only if mu tan(theta)/K_s < 1/k_n, i.e. tan(theta) < 5/27.
constexpr Real k_n = 3, k_s = 1, K_s = 1 / 3.0, mu = 0.6, limit = 5 / 27.0;

using Joint = laws::JointLaw<laws::LinearShear, laws::CoulombFriction, laws::NormalGap<laws::ConstantDilation>>;

Joint joint_with(Real tangent) {
  Joint law;
  law.elastic.inverse_stiffness = 2;
  law.friction.coefficient = mu;
  law.gap.dilation.tangent = tangent;
  return law;
}

/// Returns the contact states that satisfy the law (open, stick, slip in both directions), for a top displacement
/// (d_n, d_t) after a slip p_old >= 0.
std::vector<laws::ContactState> states(const Joint& law, Real d_n, Real d_t, Real p_old) {
  using laws::ContactState;
  const Real T = law.gap.dilation.tangent, old[] = {p_old};
  std::vector<ContactState> found;
  const auto keep = [&](ContactState state, Real N, Real shear) {
    const Real w[] = {d_n + N / k_n, d_t - shear / k_s}, lambda[] = {-N, shear};
    Real R[2];
    const auto is = laws::contact_residual<2>(law, laws::augmentation(law, 1), w, lambda, old, R);
    if (is == state && std::hypot(R[0], R[1]) < 1e-13) found.push_back(state);
  };
  keep(ContactState::open, 0, 0);
  keep(ContactState::stick, k_n * (T * p_old - d_n), K_s * (d_t - p_old));
  for (const int sense : {1, -1})
    for (const int side : {1, -1}) {
      const Real N = (T * side * d_t - d_n) / (1 / k_n + side * sense * mu * T / K_s);
      keep(ContactState::slip, N, sense * mu * N);
    }
  return found;
}

TEST(Uniqueness, EndsWhereDilationIsTooStrong) {
  const auto below = joint_with(0.999 * limit);
  for (int i = -30; i <= 30; ++i)
    for (int j = -30; j <= 30; ++j)
      for (const Real p_old : {0.0, 0.4, 1.0})
        EXPECT_EQ(states(below, 0.01 * i + 0.0021, 0.05 * j + 0.0007, p_old).size(), 1)
            << i << ' ' << j << ' ' << p_old;
  for (const Real factor : {1.001, 1.1, 2.0}) {
    const Real T = factor * limit, d_t = 0.5;
    const Real d_n = T * d_t + (factor - 1) * (1 - d_t) / 4 * K_s / (k_n * mu);
    EXPECT_THAT(
        states(joint_with(T), d_n, d_t, 1),
        testing::UnorderedElementsAre(laws::ContactState::open, laws::ContactState::stick, laws::ContactState::slip));
  }
}

TEST(Uniqueness, IsReportedOfAScene) {
  const auto doubt = [](int dim, Real tangent, const std::vector<std::string>& others = {}) {
    auto overrides = others;
    overrides.insert(overrides.begin(),
                     {"Materials.joint.tangential stiffness=0.5", "Materials.joint.maximum closure=0",
                      fmt::format("Materials.joint.dilation angle={:.17g}", std::atan(tangent) * 180 / M_PI)});
    const model::Model model(read_scene(fmt::format("contact/block_{}d.xml", dim), overrides),
                             Tpetra::getDefaultComm());
    return physics::dilation_doubt(model.scene(), model.mesh());
  };
  for (const int dim : {2, 3}) {
    EXPECT_EQ(doubt(dim, 0.999 * limit), "");
    EXPECT_THAT(doubt(dim, 1.001 * limit), testing::AllOf(testing::HasSubstr("on reversal of slip on \"joint\""),
                                                          testing::HasSubstr("above 10.49 the")));
    // The load on a movable block determines the normal traction, which dilation cannot change.
    const std::string top = dim == 2 ? "{0, free}" : "{0, 0, free}";
    EXPECT_EQ(doubt(dim, 2 * limit, {"Boundary conditions.moved.displacement=" + top}), "");
  }
  // Closure with a compliance of at most 1/5 increases the limit to tan(theta) = (1/3 + 1/5)/1.8.
  for (const std::string closure : {"0.1", "infinite"}) {
    const std::vector<std::string> closes = {"Materials.joint.maximum closure=" + closure};
    EXPECT_EQ(doubt(2, 0.999 * (1 / 3.0 + 0.2) / 1.8, closes), "");
    EXPECT_NE(doubt(2, 1.001 * (1 / 3.0 + 0.2) / 1.8, closes), "");
  }
}

/// Returns the failure message of the first failed step, with a limit of iterations and without bisection and proximal
/// continuation.
std::string reason(const std::string& scene, int iterations, std::vector<std::string> overrides) {
  for (const std::string other : {"Time.maximum halvings=0", "Time.proximal continuation=false"})
    overrides.push_back(other);
  overrides.push_back(fmt::format("Solver.maximum iterations={}", iterations));
  model::Model model(read_scene(scene, overrides), Tpetra::getDefaultComm());
  for (const Real t : model.scene().time.times())
    if (const auto report = model.step_to(t); !report.converged) return report.reason;
  ADD_FAILURE() << "no step failed";
  return "";
}

TEST(Uniqueness, IsInTheReasonOfAFailedStep) {
  const auto of_friction = testing::HasSubstr("the friction coefficient of \"joint\" is 2"),
             of_dilation = testing::HasSubstr("on reversal of slip on \"joint\" the solution may not be unique"),
             changes = testing::HasSubstr("faces that oscillate");
  EXPECT_THAT(reason("contact/block_2d.xml", 1, {"Materials.joint.friction coefficient=2"}), of_friction);
  const std::vector<std::string> dilation = {"Materials.joint.dilation angle=60"};
  EXPECT_THAT(reason("contact/network_x.xml", 3, dilation), testing::AllOf(changes, of_dilation));
  std::vector<std::string> cohesion = {"Materials.joint.bond=constant cohesion", "Materials.joint.cohesion=1e-9"};
  const auto of_cohesion = testing::HasSubstr("faces of \"joint\" lose their cohesion, 1e-09 Pa, at once");
  EXPECT_THAT(reason("contact/network_x.xml", 3, cohesion), testing::AllOf(changes, of_cohesion));
  cohesion.push_back("Materials.joint.opening without cohesion=1e-3");
  EXPECT_THAT(reason("contact/network_x.xml", 3, cohesion), testing::Not(of_cohesion));
  EXPECT_THAT(reason("contact/network_x.xml", 1, dilation), testing::Not(testing::AnyOf(changes, of_dilation)));
}

}  // namespace
}  // namespace sprekk::tests
