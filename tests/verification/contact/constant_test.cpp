// The constant of the augmentation steers iterates; results must not depend on it.
#include "verification/contact/states.hpp"

#include <iostream>

namespace sprekk::tests {
namespace {

/// The steps whose states are determined: where friction acts, one in substeps takes another path, and the equations
/// do not say where a loose piece is, nor where it touches when it is pressed again.
std::size_t n_determined(const Run& run) {
  std::size_t n = 0;
  while (n < run.states.size() && run.cuts[n] == 0 && !run.loose[n]) ++n;
  return n;
}

/// Within a factor of three Newton takes a like number of steps; far from there it may need substeps, or fail.
void expect_no_influence(const std::string& name) {
  auto scene = read_scene(name);
  const Real c = scene.augmentation;
  const auto reference = run(scene);
  ASSERT_EQ(reference.failure, "");
  const bool serial = Tpetra::getDefaultComm()->getSize() == 1;  // far away it takes long
  for (const Real factor : serial ? std::vector<Real>{1e-2, 0.3, 1, 3, 1e2} : std::vector<Real>{0.3, 3}) {
    SCOPED_TRACE(fmt::format("{}, factor {}", name, factor));
    scene.augmentation = factor * c;
    const auto other = run(scene);
    const bool near = factor >= 0.3 && factor <= 3;
    if (near) {
      EXPECT_EQ(other.failure, "");
      EXPECT_EQ(other.cuts, std::vector<int>(reference.cuts.size(), 0));
    }
    const auto n_steps = std::min(n_determined(reference), n_determined(other));
    EXPECT_GE(n_steps, near ? 3 : 2);
    Real largest = 0;
    for (std::size_t step = 0; step < n_steps; ++step) {
      largest = std::max(largest, distance(other, reference, step));
      EXPECT_TRUE(!near || other.newton_iterations[step] <= 1.3 * reference.newton_iterations[step] + 1)
          << other.newton_iterations[step] << " instead of " << reference.newton_iterations[step];
    }
    EXPECT_LE(largest, 1e-8);
    EXPECT_TRUE(factor == 1 || largest > 0) << "the constant is not the one in use";
    if (Tpetra::getDefaultComm()->getRank() == 0)
      std::cout << fmt::format(
          "{}, constant x {:g}: Newton steps {}, cuts {}, largest difference {:.1e} in {} steps {}\n", name, factor,
          fmt::join(other.newton_iterations, " "), fmt::join(other.cuts, " "), largest, n_steps, other.failure);
  }
}

TEST(AugmentationConstant, HasNoInfluenceOnResults) {
  for (const std::string name : {"contact/network_x.xml", "contact/floating_3d.xml", "verification/crossing_2d.xml",
                                 "verification/crossing_3d.xml"})
    expect_no_influence(name);
}

}  // namespace
}  // namespace sprekk::tests
