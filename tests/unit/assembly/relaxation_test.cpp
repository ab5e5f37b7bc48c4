// Fixed-point iterations that diverge or oscillate without relaxation.
#include "assembly/relaxation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace sprekk::assembly::testing {
namespace {

using Map = std::function<std::vector<Real>(const std::vector<Real>&)>;

/// Returns the number of steps until the largest |g(y) - y| is below 1e-3; `many` without convergence.
int steps(const Map& g, std::vector<Real> y) {
  constexpr int many = 200;
  Relaxation relaxation;
  relaxation.start(std::move(y));
  for (int k = 0; k < many; ++k) {
    const auto next = g(relaxation.y());
    Real farthest = 0;
    for (std::size_t i = 0; i < next.size(); ++i) farthest = std::max(farthest, std::abs(next[i] - relaxation.y()[i]));
    if (farthest < 1e-3) return k;
    relaxation.follow(next);
  }
  return many;
}

/// Fixed-point map of the logarithms y of valve apertures in a pipe. The flow 1 has the pressure drop exp(-3 y) in
/// each valve. The aperture is 10 (pressure before the valve - stress on the valve), at least 7e-3.
Map valves(const std::vector<Real>& stress) {
  return [stress](const auto& y) {
    std::vector<Real> g(y.size());
    Real pressure = 0;
    for (std::size_t i = y.size(); i-- > 0;) {
      pressure += std::exp(-3 * y[i]);
      g[i] = std::log(std::max(10 * (pressure - stress[i]), 7e-3));
    }
    return g;
  };
}

TEST(Relaxation, FindsALineAtOnce) {
  // The second step uses the measured slope, which is exact for a line.
  EXPECT_EQ(steps([](const auto& y) { return std::vector<Real>{-3 * y[0]}; }, {0.5}), 2);
}

TEST(Relaxation, OpensValvesWithoutStress) {
  for (const int n : {2, 5, 20}) EXPECT_LE(steps(valves(std::vector<Real>(n, 0)), std::vector<Real>(n, 3)), 20) << n;
}

/// Without limits on the steps these iterations oscillate: the valves alternately open and close each other.
TEST(Relaxation, SettlesValvesThatStressCloses) {
  for (const auto& stress : std::vector<std::vector<Real>>{{2, 2}, {2, 0}, {3, 1}, {4, 2}, {3, 0}})
    EXPECT_LE(steps(valves(stress), {2, 2}), 35) << stress[0] << ' ' << stress[1];
}

TEST(Relaxation, DoesNotFallByMoreThanTwo) {
  Relaxation relaxation;
  relaxation.start({0, 0});
  relaxation.follow({-10, 10});
  EXPECT_EQ(relaxation.y(), (std::vector<Real>{-2, 10}));
}

}  // namespace
}  // namespace sprekk::assembly::testing
