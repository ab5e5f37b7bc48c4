#include "laws/kink.hpp"

#include <gtest/gtest.h>

namespace sprekk::laws {
namespace {

/// Angles and intensities for atan(K_II/K_I) = phase and |K| = 1. In pure sliding, cos(angle) = 1/3 exactly.
TEST(Kink, HasTheLargestHoopStress) {
  const Real phase[] = {0, 15, 30, 45, 60, 75, 90},
             angle[] = {0, -26.7396, -43.2213, -53.1301, -60, -65.5052, -70.5288},
             intensity[] = {1, 1.059443, 1.173448, 1.264911, 1.299038, 1.262826, 1.154701};
  for (int k = 0; k < 7; ++k) {
    const Real K_I = std::cos(phase[k] * M_PI / 180), K_II = std::sin(phase[k] * M_PI / 180);
    for (const int sign : {-1, 1}) {
      const auto kink = largest_hoop(K_I, sign * K_II);
      EXPECT_NEAR(kink.angle * 180 / M_PI, sign * angle[k], 1e-4);
      EXPECT_NEAR(kink.intensity, intensity[k], 1e-6);
    }
  }
  EXPECT_NEAR(std::cos(largest_hoop(0, 2).angle), 1.0 / 3, 1e-12);
}

TEST(Kink, OfClosedFacesHasNoOpening) {
  EXPECT_EQ(largest_hoop(-3, 0).intensity, 0);
  EXPECT_EQ(largest_hoop(-3, 0).angle, 0);
  EXPECT_EQ(largest_hoop(-3, 2).intensity, largest_hoop(0, 2).intensity);
}

}  // namespace
}  // namespace sprekk::laws
