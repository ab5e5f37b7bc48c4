// The augmentation constant affects iterates only; results must not depend on it.
#include "verification/contact/states.hpp"

#include <iostream>

namespace sprekk::tests {
namespace {

/// For constants within a factor of three, Newton needs similar numbers of steps. This holds also for other constants,
/// because calibration corrects the constant after the first movements of faces.
void expect_no_influence(const std::string& name) {
  auto scene = read_scene(name);
  const Real c = scene.augmentation;
  const auto reference = run(scene);
  ASSERT_EQ(reference.failure, "");
  const bool serial = Tpetra::getDefaultComm()->getSize() == 1;
  for (const Real factor : serial ? std::vector<Real>{1e-2, 0.3, 1, 3, 1e2} : std::vector<Real>{0.3, 3}) {
    SCOPED_TRACE(fmt::format("{}, factor {}", name, factor));
    scene.augmentation = factor * c;
    const auto other = run(scene);
    ASSERT_EQ(other.failure, "");
    EXPECT_EQ(other.cuts, std::vector<int>(reference.cuts.size(), 0));
    Real largest = 0;
    for (std::size_t step = 0; step < reference.states.size(); ++step) {
      largest = std::max(largest, distance(other, reference, step));
      EXPECT_LE(other.newton_iterations[step], 1.3 * reference.newton_iterations[step] + 1) << "step " << step;
    }
    EXPECT_LE(largest, 1e-8);
    EXPECT_TRUE(factor == 1 || largest > 0) << "the constant is not the one in use";
    if (Tpetra::getDefaultComm()->getRank() == 0)
      std::cout << fmt::format("{}, constant x {:g}: Newton steps {}, largest difference {:.1e}\n", name, factor,
                               fmt::join(other.newton_iterations, " "), largest);
  }
}

TEST(AugmentationConstant, HasNoInfluenceOnResults) {
  for (const std::string name : {"contact/network_x.xml", "contact/floating_3d.xml", "verification/crossing_2d.xml",
                                 "verification/crossing_3d.xml"})
    expect_no_influence(name);
}

}  // namespace
}  // namespace sprekk::tests
