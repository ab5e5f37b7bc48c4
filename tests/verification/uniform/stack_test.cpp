// Fractures in series have the same traction. While all stick, lambda_t = d_t/(H/G + sum 1/K_t), and the compression
// is the root of N/k_n + sum V(N) = -d_n. Only the fracture with the smallest friction slips, at lambda_t = mu N. H =
// G = lambda = 1, Du = 0.05, K_n = 5, d_n = -0.1.
#include "verification/uniform/states.hpp"

namespace sprekk::tests {
namespace {

struct Joint {
  std::string fracture;
  Real K_t, mu;
};

/// Joints and their compression N, the root in double precision.
struct Stack {
  std::vector<Joint> joints;
  Real N;
};

const std::vector<Stack> stacks = {{{{"lower", 2, 0.6}, {"middle", 2, 0.5}}, 0.176039864469807},
                                   {{{"lower", 1, 0.6}, {"middle", 2, 0.5}, {"upper", 4, 0.55}}, 0.139116499156263}};

void expect_stack(model::Model& model, const Stack& stack, Real d_t) {
  SCOPED_TRACE(d_t);
  Real compliance = 1;
  for (const auto& joint : stack.joints) compliance += 1 / joint.K_t;
  const Real l_t = std::min(d_t / compliance, 0.5 * stack.N), slip = d_t - compliance * l_t,
             closure = -0.05 * stack.N / (0.25 + stack.N);
  for (const auto& joint : stack.joints) {
    const Real u_p = joint.fracture == "middle" ? slip : 0;
    auto e = UniformJoint{l_t, -stack.N, u_p, closure, closure, joint.K_t}.along({1, 0, 0}, model.mesh().dim());
    e.fracture = joint.fracture;
    expect_joint(model, e);
  }
}

TEST(Stack, OnlyTheWeakestSlides) {
  for (const int dim : {2, 3})
    for (const auto& d : discretisations(dim))
      for (const auto& stack : stacks) {
        SCOPED_TRACE(fmt::format("{}, {} fractures", d.name(), stack.joints.size()));
        auto scene = read_scene(fmt::format("verification/stack_{}d.xml", dim), d.with());
        scene.mesh.cells = dim == 2 ? std::vector<int>{1, 4} : std::vector<int>{1, 1, 4};
        if (stack.joints.size() == 2) {
          scene.fractures.erase("upper");
          scene.mesh.fractures.erase("upper");
        }
        for (const auto& joint : stack.joints)
          scene.materials.at(joint.fracture).tangential_stiffness = base::Expression(joint.K_t);
        const auto step = [&](model::Model& model, Real t, Real d_t) {
          const auto report = model.step_to(t);
          ASSERT_TRUE(report.converged) << report.reason;
          EXPECT_EQ(report.cuts, 0);
          EXPECT_LE(report.newton_iterations, 6);
          expect_stack(model, stack, d_t);
        };
        model::Model in_steps(scene, Tpetra::getDefaultComm());
        step(in_steps, 1, 0.05);
        step(in_steps, 2, 0.5);
        if (dim == 3) continue;
        model::Model at_once(scene, Tpetra::getDefaultComm());
        step(at_once, 2, 0.5);
      }
}

}  // namespace
}  // namespace sprekk::tests
