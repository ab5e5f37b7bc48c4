// Scenes in which the solver once failed, found by random search.
#include "verification/contact/states.hpp"

namespace sprekk::tests {
namespace {

std::string failure(const std::string& scene, const std::vector<std::string>& overrides = {}) {
  return run(read_scene(scene, overrides)).failure;
}

/// The search along a free motion had step lengths below the floating-point resolution and did not terminate.
TEST(Found, PiecesCutOut) { EXPECT_EQ(failure("contact/network_cut_2d.xml"), ""); }

/// On slip reversal, faces lose their dilation and thus their friction. They slip at once to a distant state. Only
/// proximal terms that do not resist the elastic jump lead there.
TEST(Found, SoftJointsThatDilate) {
  EXPECT_EQ(failure("contact/network_soft_2d.xml", {"Time.end=3", "Time.steps=3"}), "");
}

/// The bending stiffness of the layers is small by (thickness/length)^2. Proximal terms that are weak relative to the
/// rock at a fracture still constrain the layers.
TEST(Found, ThinLayers) { EXPECT_EQ(failure("contact/thin_layers_2d.xml"), ""); }

/// The elastic jumps are long. A face that opens has moved far and dilates; it must slide and not return elastically.
TEST(Found, BricksWithSoftJointsThatDilate) {
  const auto found = run(read_scene("contact/masonry_soft_2d.xml"));
  EXPECT_EQ(found.failure, "");
  for (const int newton : found.newton_iterations) EXPECT_LE(newton, 20);
}

/// Thickness over length is 1e-5: displacements are large relative to the deformation. The residual of a direct solve
/// is limited by round-off of the displacements.
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

/// The displacement is so large that its round-off is visible in the jumps.
TEST(Found, StiffRockOnSoft) {
  EXPECT_EQ(failure("contact/soft_foundation_2d.xml", {"Time.end=1", "Time.steps=1"}), "");
}

}  // namespace
}  // namespace sprekk::tests
