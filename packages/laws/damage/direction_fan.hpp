// Directional table of the slip history in all directions of the plane, in constant memory, with an error bound.
#pragma once

#include "base/view.hpp"
#include "laws/contact.hpp"

#include <cmath>

namespace sprekk::laws {

/// Damage history of a path in the plane, as a function of the unit vector m = (cos t, sin t):
///   Lambda(m) = sum of k `|<m.b> - <m.a>|` over the segments a -> b,  `<x>` = max(x, 0)
/// The term of a segment is m.V with constant V between neighbours of these directions: perpendicular to a, to b, and
/// to b - a where m.a = m.b > 0. The sum is therefore piecewise m.V on a set of angles. It is exact as long as the path
/// has few directions. Beyond `capacity` angles, those whose removal causes the smallest error are removed. Between two
/// angles t_0 and t_1, with w = t_1 - t_0 <= pi/2 and the centre c:
///   Lambda = (v_0 sin(t_1 - t) + v_1 sin(t - t_0))/sin w + q (1 - cos(t - c)/cos(w/2)),   Lambda'' + Lambda = q
/// The curvature q results from angles removed there. Each sector stores an interval [low, high] that contains the
/// exact value minus this one, up to round-off. The angles of the axes are never removed. In each step the angle of b
/// is not removed either, so the value there at the end of the step is unchanged.
class DirectionFan {
 public:
  static constexpr int capacity = 64;
  static constexpr int n_numbers = 1 + 5 * capacity;  ///< count, five numbers per angle; all 0: no path

  /// Lambda(m) = constant + gradient.m for directions m near a given one.
  struct Form {
    Real constant = 0, gradient[2] = {};
  };

  /// Reads numbers written by write().
  KOKKOS_INLINE_FUNCTION explicit DirectionFan(const History& history) : size_(size_of(history)) {
    for (int j = 0; j < size_; ++j) nodes_[j] = node(history, j);
  }
  /// Writes at most n_numbers numbers.
  KOKKOS_INLINE_FUNCTION void write(const Numbers<Real>& history) const {
    history[0] = size_;
    for (int j = 0; j < size_; ++j) {
      const Node& n = nodes_[j];
      const Real numbers[] = {n.angle, n.value, n.curvature, n.low, n.high};
      for (int i = 0; i < 5; ++i) history[1 + 5 * j + i] = numbers[i];
    }
  }

  /// Returns the stored Lambda near the direction of (u, v).
  KOKKOS_INLINE_FUNCTION static Form form(const History& history, Real u, Real v) {
    using std::atan2, std::cos, std::sin;
    const int size = size_of(history);
    if (size == 0) return {};
    const Real t = wrapped(atan2(v, u));
    int j = 0;  // last node with an angle <= t
    for (int end = size; end - j > 1;) {
      const int middle = (j + end) / 2;
      (node(history, middle).angle <= t ? j : end) = middle;
    }
    const Node first = node(history, j), second = node(history, j + 1 < size ? j + 1 : 0);
    const Real half = (second.angle - first.angle + (j + 1 < size ? 0 : turn)) / 2, c = first.angle + half;
    const Real along = ((first.value + second.value) / 2 - first.curvature) / cos(half),
               across = (second.value - first.value) / (2 * sin(half));
    return {first.curvature, {along * cos(c) - across * sin(c), along * sin(c) + across * cos(c)}};
  }

  /// Adds the segment from a to b with the weight k per length.
  KOKKOS_INLINE_FUNCTION void add(const Real (&a)[2], const Real (&b)[2], Real k) {
    using std::abs, std::atan2, std::cos, std::sin;
    const Real d[] = {b[0] - a[0], b[1] - a[1]};
    if (k == 0 || (d[0] == 0 && d[1] == 0)) return;
    for (; size_ < 4; ++size_) nodes_[size_] = {size_ * quarter, 0, 0, 0, 0};
    for (const Real* end : {&a[0], &b[0]})
      for (const Real side : {-quarter, quarter})
        if (end[0] != 0 || end[1] != 0) insert(atan2(end[1], end[0]) + side);
    const Real between = atan2(d[1], d[0]) + quarter, at = a[0] * cos(between) + a[1] * sin(between);
    if (at != 0) insert(at > 0 ? between : between + 2 * quarter);
    const Real present = wrapped(atan2(b[1], b[0]));
    insert(present);
    const auto positive = [](Real x) { return x > 0 ? x : 0; };
    for (int j = 0; j < size_; ++j) {
      const Real m[] = {cos(nodes_[j].angle), sin(nodes_[j].angle)};
      nodes_[j].value += k * abs(positive(m[0] * b[0] + m[1] * b[1]) - positive(m[0] * a[0] + m[1] * a[1]));
    }
    compress(present);
  }

  /// Error bound over all directions; largest value at an angle of the table.
  KOKKOS_INLINE_FUNCTION Real error() const {
    Real maximum = 0;
    for (int j = 0; j < size_; ++j) maximum = larger(maximum, larger(nodes_[j].high, -nodes_[j].low));
    return maximum;
  }
  KOKKOS_INLINE_FUNCTION Real largest() const {
    Real maximum = 0;
    for (int j = 0; j < size_; ++j) maximum = larger(maximum, nodes_[j].value);
    return maximum;
  }

 private:
  static constexpr Real quarter = 1.57079632679489661923, turn = 4 * quarter;
  static constexpr Real same = 1e-13;  ///< tolerance of equal angles
  static constexpr int more = 6;       ///< largest number of angles added by a segment
  static constexpr Real endless = 1e300;

  /// Angle, value there, and properties of the sector that begins there.
  struct Node {
    Real angle, value, curvature, low, high;
  };
  /// Sector that results from the removal of the node between two sectors. `cost` is the error bound of its interval.
  struct Merged {
    Real curvature, low, high, cost;
  };
  struct Range {
    Real low, high;
  };
  /// Width w of a sector: w, tan(w/2), sin(w), cos(w).
  struct Width {
    Real angle, half, sine, cosine;

    Width() = default;
    KOKKOS_INLINE_FUNCTION explicit Width(Real w) : angle(w) {
      using std::tan;
      half = tan(w / 2);
      const Real secant = 1 / (1 + half * half);
      sine = 2 * half * secant;
      cosine = (1 - half * half) * secant;
    }
    KOKKOS_INLINE_FUNCTION Width operator+(const Width& other) const { return Width(angle + other.angle); }
  };

  KOKKOS_INLINE_FUNCTION int next(int j) const { return j + 1 < size_ ? j + 1 : 0; }
  KOKKOS_INLINE_FUNCTION static Real larger(Real a, Real b) { return a > b ? a : b; }
  KOKKOS_INLINE_FUNCTION static Real smaller(Real a, Real b) { return a < b ? a : b; }
  KOKKOS_INLINE_FUNCTION static int size_of(const History& history) {
    return history[0] < 4 ? 0 : static_cast<int>(history[0]);
  }
  KOKKOS_INLINE_FUNCTION static Node node(const History& history, int j) {
    const auto own = history.from(1 + 5 * j);
    return {own[0], own[1], own[2], own[3], own[4]};
  }
  KOKKOS_INLINE_FUNCTION static Real wrapped(Real t) {  // from (-2 pi, 4 pi) to [0, 2 pi)
    if (t < 0) t += turn;
    return t >= turn ? t - turn : t;
  }
  KOKKOS_INLINE_FUNCTION static bool is_axis(Real t) {
    return t == 0 || t == quarter || t == 2 * quarter || t == 3 * quarter;
  }

  /// Splits the sector that contains the angle t. The function is unchanged.
  KOKKOS_INLINE_FUNCTION void insert(Real t) {
    using std::cos, std::sin;
    t = wrapped(t);
    int j = 0;
    while (j < size_ && nodes_[j].angle < t) ++j;
    const Node before = nodes_[j > 0 ? j - 1 : size_ - 1], after = nodes_[j < size_ ? j : 0];
    const Real left = t - before.angle + (j > 0 ? 0 : turn), right = after.angle - t + (j < size_ ? 0 : turn);
    if (left < same || right < same) return;
    Node added = before;
    added.angle = t;
    added.value =
        (before.value * sin(right) + after.value * sin(left)) / sin(left + right) + before.curvature * bow(left, right);
    for (int i = size_++; i > j; --i) nodes_[i] = nodes_[i - 1];
    nodes_[j] = added;
  }

  /// Returns 1 - cos(t - c)/cos(w/2) at the distances l and r from the ends of a sector.
  KOKKOS_INLINE_FUNCTION static Real bow(Real l, Real r) {
    using std::cos, std::sin;
    return -2 * sin(l / 2) * sin(r / 2) / cos((l + r) / 2);
  }

  /// Removes nodes until `capacity` remain, but not the axes and the angle `present`.
  KOKKOS_INLINE_FUNCTION void compress(Real present) {
    using std::abs;
    if (size_ <= capacity) return;
    Merged without[capacity + more];
    Width widths[capacity + more];  // of the sectors
    for (int j = 0; j < size_; ++j)
      widths[j] = Width(nodes_[next(j)].angle - nodes_[j].angle + (j + 1 < size_ ? 0 : turn));
    const Real rounding = 1e-13 * largest();
    const auto consider = [&](int j) {
      const bool stays = is_axis(nodes_[j].angle) || abs(nodes_[j].angle - present) <= same;
      without[j] = stays ? Merged{0, 0, 0, endless} : merged(j, widths, rounding);
    };
    for (int j = 0; j < size_; ++j) consider(j);
    while (size_ > capacity) {
      int best = 0;  // an axis, never removed
      for (int j = 1; j < size_; ++j)
        if (without[j].cost < without[best].cost) best = j;
      Node& sector = nodes_[best - 1];
      sector.curvature = without[best].curvature;
      sector.low = without[best].low;
      sector.high = without[best].high;
      widths[best - 1] = widths[best - 1] + widths[best];
      --size_;
      for (int j = best; j < size_; ++j) {
        nodes_[j] = nodes_[j + 1];
        without[j] = without[j + 1];
        widths[j] = widths[j + 1];
      }
      consider(best - 1);
      if (best < size_) consider(best);
    }
  }

  /// Returns the sector without node j. Its curvature either spreads the slope jump at the node over both sectors or
  /// preserves the value at the node, whichever gives the smaller error. A node with changes below `rounding` costs
  /// nothing.
  KOKKOS_INLINE_FUNCTION Merged merged(int j, const Width* widths, Real rounding) const {
    using std::abs;
    const int previous = j > 0 ? j - 1 : size_ - 1;
    const Node &at = nodes_[j], &l = nodes_[previous], &r = nodes_[next(j)];
    const Width &to_l = widths[previous], &to_r = widths[j];
    // Slopes of m.V on both sides, and slope jump of the function.
    const Real before = (at.value - l.value) / to_l.sine - at.value * to_l.half,
               after = (r.value - at.value) / to_r.sine + at.value * to_r.half;
    const Real jump = after - before - at.curvature * to_r.half - l.curvature * to_l.half;
    const Real sines = to_l.sine * to_r.sine, halves = to_l.half * to_r.half;
    const Real rises = (before - after) * sines / (to_l.sine * to_r.cosine + to_l.cosine * to_r.sine);  // above new m.V
    const Real bow = -2 * halves / (1 - halves);
    const Real spread = (l.curvature * to_l.angle + at.curvature * to_r.angle + jump) / (to_l.angle + to_r.angle);
    Merged best{};
    for (const Real q : {spread, rises / bow}) {
      const Real d = rises - q * bow;
      const Range left = range(l.curvature - q, d, to_l), right = range(at.curvature - q, d, to_r);
      Merged one{q, smaller(l.low, at.low) + smaller(left.low, right.low),
                 larger(l.high, at.high) + larger(left.high, right.high), 0};
      one.cost = larger(one.high, -one.low);
      if (q == spread || one.cost < best.cost) best = one;
    }
    if (abs(jump) < rounding && abs(at.curvature - l.curvature) < rounding) best.cost = 0;
    return best;
  }

  /// Returns the smallest and largest value in [0, w] of D with D'' + D = a, D(0) = 0, D(w) = d. The slope is `first`
  /// at 0; it changes sign at most once, because w <= pi/2.
  KOKKOS_INLINE_FUNCTION static Range range(Real a, Real d, const Width& w) {
    using std::sqrt;
    const Real first = d / w.sine - a * w.half, last = a * w.sine + first * w.cosine;
    Range range{smaller(0, d), larger(0, d)};
    if (first > 0 && last < 0) range.high = larger(range.high, a + sqrt(a * a + first * first));
    if (first < 0 && last > 0) range.low = smaller(range.low, a - sqrt(a * a + first * first));
    return range;
  }

  int size_ = 0;
  Node nodes_[capacity + more];
};

}  // namespace sprekk::laws
