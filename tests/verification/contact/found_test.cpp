// Scenes on which a random search has once found the solver to fail.
#include "verification/contact/states.hpp"

namespace sprekk::tests {
namespace {

std::string failure(const std::string& scene, const std::vector<std::string>& overrides = {}) {
  return run(read_scene(scene, overrides)).failure;
}

/// Steps towards zero of a search along a free motion grew too short for the arithmetic: it went on for ever.
TEST(Found, PiecesCutOut) { EXPECT_EQ(failure("contact/network_cut_2d.xml"), ""); }

/// Faces that slide back close what they had opened, and their friction falls: they slip at once, to a state that is
/// far away, and only tethers that leave the joint's own stretch alone lead there.
TEST(Found, SoftJointsThatDilate) {
  EXPECT_EQ(failure("contact/network_soft_2d.xml", {"Time.end=3", "Time.steps=3"}), "");
}

/// Layers that are soft in bending by the square of their thickness over their length: tethers that are weak for the
/// rock at a fracture hold them fast.
TEST(Found, ThinLayers) { EXPECT_EQ(failure("contact/thin_layers_2d.xml"), ""); }

/// The joints' own stretch is long: a face that parts has moved far, and dilates; it must slide, not spring back.
TEST(Found, BricksWithSoftJointsThatDilate) {
  const auto found = run(read_scene("contact/masonry_soft_2d.xml"));
  EXPECT_EQ(found.failure, "");
  for (const int newton : found.newton_iterations) EXPECT_LE(newton, 20);
}

/// A hundred thousandth as thick as they are long: their motions are long next to what deforms them, and no direct
/// solve leaves less than the rounding of these motions.
TEST(Found, VeryThinLayers) {
  constexpr Real h = 1e-5;
  std::vector<std::string> entries = {"Mesh.cells={20, 5}", fmt::format("Mesh.upper corner={{1, {:.17g}}}", 5 * h),
                                      fmt::format("Tables.shear.values={{0, 0, {0}, -{0}}}", 0.05 * h),
                                      fmt::format("Tables.press.values={{0, {0}, {0}}}", 5e-4 * h)};
  for (int k = 1; k < 5; ++k)
    for (const auto& [corner, x] : {std::pair{"lower", 0}, {"upper", 1}})
      entries.push_back(fmt::format("Mesh.fractures.joint {}.{} corner={{{}, {:.17g}}}", k, corner, x, k * h));
  EXPECT_EQ(failure("contact/layers_2d.xml", entries), "");
}

/// The displacement is so large that its rounding is seen in the jumps.
TEST(Found, StiffRockOnSoft) {
  EXPECT_EQ(failure("contact/soft_foundation_2d.xml", {"Time.end=1", "Time.steps=1"}), "");
}

}  // namespace
}  // namespace sprekk::tests
