// Directional table of the slip history, compared with the sum over all steps.
#include "laws/damage/exponential.hpp"

#include <Sacado.hpp>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <vector>

namespace sprekk::laws::testing {
namespace {

constexpr Real pi = 3.14159265358979323846;
using Vector = std::array<Real, 2>;
struct Path {
  std::vector<Vector> u;  // end points; the path starts at (0, 0)
  std::vector<Real> k;    // weight of the segment that ends there
};

/// Returns the sum over all segments.
Real exact(const Path& path, Real t) {
  const Real m[] = {std::cos(t), std::sin(t)};
  Real sum = 0, before = 0;
  for (std::size_t i = 0; i < path.u.size(); ++i) {
    const Real now = std::max(m[0] * path.u[i][0] + m[1] * path.u[i][1], Real(0));
    sum += path.k[i] * std::abs(now - before);
    before = now;
  }
  return sum;
}

using FanNumbers = std::vector<Real>;

void go(FanNumbers& history, const Path& path, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    const Real a[] = {i ? path.u[i - 1][0] : 0, i ? path.u[i - 1][1] : 0}, b[] = {path.u[i][0], path.u[i][1]};
    DirectionFan fan({history.data(), 1});
    fan.add(a, b, path.k[i]);
    fan.write({history.data(), 1});
  }
}
FanNumbers along(const Path& path) {
  FanNumbers history(DirectionFan::n_numbers, 0);
  go(history, path, 0, path.u.size());
  return history;
}

Real stored_value(const FanNumbers& history, Real t) {
  const Real m[] = {std::cos(t), std::sin(t)};
  const auto form = DirectionFan::form({history.data(), 1}, m[0], m[1]);
  return form.constant + form.gradient[0] * m[0] + form.gradient[1] * m[1];
}

/// Returns the interval of (exact value - stored value) of the sector that contains t.
std::array<Real, 2> interval(const FanNumbers& history, Real t) {
  int j = 0;
  while (j + 1 < history[0] && history[1 + 5 * (j + 1)] <= t) ++j;
  return {history[1 + 5 * j + 3], history[1 + 5 * j + 4]};
}

/// Checks in many directions that the interval contains the error. Returns the largest error divided by the largest
/// value.
Real expect_enclosed(const Path& path, const FanNumbers& history) {
  const DirectionFan fan({history.data(), 1});
  Real worst = 0, largest = 0;
  constexpr int n = 1440;
  for (int i = 0; i < n; ++i) {
    const Real t = 2 * pi * i / n + 1e-4, sum = exact(path, t), error = sum - stored_value(history, t);
    const auto [low, high] = interval(history, t);
    const Real rounding = 1e-11 * fan.largest();
    EXPECT_GE(error, low - rounding) << t;
    EXPECT_LE(error, high + rounding) << t;
    EXPECT_LE(std::abs(error), fan.error() + rounding) << t;
    worst = std::max(worst, std::abs(error));
    largest = std::max(largest, sum);
  }
  return worst / largest;
}

Path circle(int n, Vector centre, bool varying) {
  Path path;
  for (int i = 0; i < n; ++i) {
    const Real t = 2 * pi * (i + 1) / n;
    path.u.push_back({centre[0] - std::cos(t), centre[1] + std::sin(t)});
    path.k.push_back(varying ? 1 + 0.5 * std::sin(0.05 * i) : 1);
  }
  return path;
}
Path random_walk(int n, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<Real> normal;
  Path path;
  Vector u{};
  for (int i = 0; i < n; ++i) {
    for (Real& x : u) x += 0.05 * normal(random);
    path.u.push_back(u);
    path.k.push_back(1 + 0.5 * std::sin(0.05 * i));
  }
  return path;
}
Path cycles(int n, std::vector<Real> directions) {
  Path path;
  for (int i = 0; i < n; ++i) {
    const Real t = directions[i * directions.size() / n], size = std::sin(0.3 * i) + 0.2 * std::sin(1.7 * i);
    path.u.push_back({size * std::cos(t), size * std::sin(t)});
    path.k.push_back(1 + 0.5 * std::sin(0.05 * i));
  }
  return path;
}

/// Known values, independent of this program: Lambda in direction u after each step of short paths.
TEST(DirectionFan, KnownValues) {
  const auto expect = [](const Path& path, const std::vector<Real>& values) {
    FanNumbers history(DirectionFan::n_numbers, 0);
    for (std::size_t i = 0; i < path.u.size(); ++i) {
      go(history, path, i, i + 1);
      EXPECT_NEAR(stored_value(history, std::atan2(path.u[i][1], path.u[i][0])), values[i], 1e-12 * values[i]) << i;
    }
  };
  const std::vector<Vector> path = {{3e-3, 0},      {3e-3, 2e-3},  {-1e-3, 2e-3},
                                    {-1e-3, -2e-3}, {2e-3, -1e-3}, {.5e-3, 1.5e-3}};
  expect({path, {1, 1, 1, 1, 1, 1}},
         {3e-3, 3.605551275464e-3, 2.236067977500e-3, 2.236067977500e-3, 7.602631123499e-3, 7.273238618387e-3});
  expect({path, {10, 20, 15, 30, 5, 20}},
         {.03, .04714951667914, .03577708764, .067082039325, .08273451516749, .1454647723677});
  expect({{{-2e-4, 1e-4}, {-2e-4, 1e-4}, {2e-4, -1e-4}, {1e-4, 1e-4}}, {1, 1, 1, 1}},
         {2.2360679775e-4, 2.2360679775e-4, 2.2360679775e-4, 1.414213562373e-4});
}

/// With few directions of motion the table is exact, for any number of steps.
TEST(DirectionFan, ExactForFewDirections) {
  for (const auto& directions : {std::vector<Real>{0.3}, {0, 0.4, 1.1, 2, 2.9}}) {
    const auto path = cycles(10000, directions);
    const auto history = along(path);
    EXPECT_LT(history[0], DirectionFan::capacity / 2);
    EXPECT_LT(expect_enclosed(path, history), 1e-12);
    EXPECT_EQ(DirectionFan({history.data(), 1}).error(), 0);
  }
}

/// Paths with more directions than the table can store: the errors are below known bounds of the method.
TEST(DirectionFan, EnclosesTheExactHistory) {
  const std::pair<Path, Real> paths[] = {{circle(1000, {1, 0}, false), 1e-5}, {circle(300, {1, 0}, true), 5e-4},
                                         {circle(1000, {0, 0}, true), 1e-3},  {random_walk(1000, 1), 1e-2},
                                         {random_walk(1000, 2), 1e-2},        {random_walk(10000, 3), 2e-2}};
  for (const auto& [path, bound] : paths) {
    const auto history = along(path);
    EXPECT_EQ(history[0], DirectionFan::capacity);
    EXPECT_LT(expect_enclosed(path, history), bound);
    EXPECT_GT(DirectionFan({history.data(), 1}).error(), 0);
  }
}

/// In the direction of the present slip, the value is the previous value plus the term of the step; compression of the
/// table does not change it. The stored history is then consistent with the converged state.
TEST(DirectionFan, KeepsTheValueInThePresentDirection) {
  const auto path = random_walk(300, 11);
  FanNumbers history(DirectionFan::n_numbers, 0);
  for (std::size_t i = 0; i < path.u.size(); ++i) {
    const auto& u = path.u[i];
    const Real t = std::atan2(u[1], u[0]), size = std::hypot(u[0], u[1]);
    const Real along = i ? (u[0] * path.u[i - 1][0] + u[1] * path.u[i - 1][1]) / size : 0;
    const Real before = stored_value(history, t);
    go(history, path, i, i + 1);
    EXPECT_NEAR(stored_value(history, t), before + path.k[i] * std::abs(size - std::max(along, Real(0))), 1e-12) << i;
  }
  EXPECT_GT(DirectionFan({history.data(), 1}).error(), 0);
}

/// The stored numbers suffice to continue a path: the second half, started from them, gives bitwise equal values.
TEST(DirectionFan, GoesOnFromWhatItHasKept) {
  const auto path = random_walk(400, 7);
  FanNumbers first(DirectionFan::n_numbers, 0);
  go(first, path, 0, 200);
  FanNumbers later = first;
  go(later, path, 200, 400);
  EXPECT_EQ(later, along(path));
}

/// Derivatives of the remaining friction and dilation with respect to the plastic jump: near 0, near sector
/// boundaries, against, along and across the last slip.
TEST(AnisotropicDamage, HasItsDerivativesInSpace) {
  using Fad = Sacado::Fad::SFad<Real, 2>;
  const AnisotropicDamage law{{0.3, 0.1, 0.02, 0.05}};
  auto path = random_walk(300, 4);
  for (auto& u : path.u)
    for (Real& x : u) x *= 0.01;
  FanNumbers history(1 + DirectionFan::n_numbers, 0);
  for (std::size_t i = 0; i < path.u.size(); ++i) {
    Contact<Real> at{.dim = 3, .history = {history.data(), 1}};
    at.slip_of_step = std::hypot(path.u[i][0] - (i ? path.u[i - 1][0] : 0), path.u[i][1] - (i ? path.u[i - 1][1] : 0));
    at.wear = path.k[i];
    for (int k = 0; k < 2; ++k) {
      at.plastic_jump[k] = path.u[i][k];
      at.last_plastic_jump[k] = i ? path.u[i - 1][k] : 0;
    }
    law.commit(at, {history.data(), 1});
  }
  const auto left = [&](const auto& u, const auto& v, bool friction) {
    using T = std::decay_t<decltype(u)>;
    using std::sqrt;
    Contact<T> at;
    at.dim = 3;
    at.history = {history.data(), 1};
    at.wear = T(1.3);
    for (int k = 0; k < 2; ++k) at.last_plastic_jump[k] = path.u.back()[k];
    at.plastic_jump[0] = u;
    at.plastic_jump[1] = v;
    at.plastic_slip = sqrt(u * u + v * v);
    const T a = u - at.last_plastic_jump[0], b = v - at.last_plastic_jump[1];
    at.slip_of_step = sqrt(a * a + b * b);
    at.slip_direction[0] = a / at.slip_of_step;
    at.slip_direction[1] = b / at.slip_of_step;
    return friction ? law.left(at).friction : law.left(at).dilation;
  };
  std::mt19937 random(9);
  std::uniform_real_distribution<Real> uniform(0, 1);
  Real steepest = 0;
  for (const Real size : {3e-6, 1e-5, 1.5e-5, 1e-4, 3e-3, 1e-2})
    for (int i = 0; i < 50; ++i) {
      const Real t = 2 * pi * uniform(random), u = size * std::cos(t), v = size * std::sin(t), h = 1e-6 * size;
      for (const bool friction : {false, true}) {
        const Fad value = left(Fad(2, 0, u), Fad(2, 1, v), friction);
        EXPECT_EQ(value.val(), left(u, v, friction));
        EXPECT_NEAR(value.dx(0), (left(u + h, v, friction) - left(u - h, v, friction)) / (2 * h), 1e-5 / size);
        EXPECT_NEAR(value.dx(1), (left(u, v + h, friction) - left(u, v - h, friction)) / (2 * h), 1e-5 / size);
        steepest = std::max(steepest, size * std::abs(value.dx(0)));
      }
    }
  EXPECT_GT(steepest, 0.1);  // the tolerance is significant
}

/// The mean over all directions is the length of the path divided by pi.
TEST(DirectionFan, MeanOfAllDirections) {
  const auto path = random_walk(50, 5);
  Real length = 0, mean = 0;
  for (std::size_t i = 0; i < path.u.size(); ++i)
    length +=
        path.k[i] * std::hypot(path.u[i][0] - (i ? path.u[i - 1][0] : 0), path.u[i][1] - (i ? path.u[i - 1][1] : 0));
  constexpr int n = 200000;
  for (int i = 0; i < n; ++i) mean += exact(path, 2 * pi * i / n) / n;
  EXPECT_NEAR(mean, length / pi, 1e-8 * length);
}

}  // namespace
}  // namespace sprekk::laws::testing
