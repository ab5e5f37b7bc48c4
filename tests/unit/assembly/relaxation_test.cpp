// Fixed-point iterations that diverge or swing when they are not relaxed.
#include "assembly/relaxation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace sprekk::assembly::testing {
namespace {

using Map = std::function<std::vector<Real>(const std::vector<Real>&)>;

/// Iterations until the largest |g(y) - y| is below 1e-3; many if there is no end.
int iterations(const Map& g, std::vector<Real> y) {
  constexpr int many = 200;
  Relaxation relaxation;
  relaxation.start(std::move(y));
  for (int k = 0; k < many; ++k) {
    const auto next = g(relaxation.y());
    Real away = 0;
    for (std::size_t i = 0; i < next.size(); ++i) away = std::max(away, std::abs(next[i] - relaxation.y()[i]));
    if (away < 1e-3) return k;
    relaxation.follow(next);
  }
  return many;
}

TEST(Relaxation, FindsALineInThreeSteps) {
  // the first step goes all the way, the second knows the slope, which a line has everywhere
  EXPECT_LE(iterations([](const auto& y) { return std::vector<Real>{-3 * y[0]}; }, {1}), 3);
}

/// The valves of a pipe, ln of their apertures: the pressure before each, which opens it, is that of all resistances
/// exp(-3 y) behind it. Without relaxation they all swing between open and closed.
TEST(Relaxation, SettlesValvesInSeries) {
  for (const int n : {2, 5, 20}) {
    const Map valves = [](const auto& y) {
      std::vector<Real> g(y.size());
      Real pressure = 0;
      for (std::size_t i = y.size(); i-- > 0;) {
        pressure += std::exp(-3 * y[i]);
        g[i] = std::clamp(std::log(pressure / y.size()), Real(-7), Real(7));
      }
      return g;
    };
    EXPECT_LE(iterations(valves, std::vector<Real>(n, 3.0)), 60) << n;
  }
}

TEST(Relaxation, DoesNotFallByMoreThanTwo) {
  Relaxation relaxation;
  relaxation.start({0, 0});
  relaxation.follow({-10, 10});
  EXPECT_EQ(relaxation.y(), (std::vector<Real>{-2, 10}));
}

}  // namespace
}  // namespace sprekk::assembly::testing
