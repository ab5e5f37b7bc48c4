// Intersections of the cells of two meshes of triangles.
#include <algorithm>
#include <array>
#include <cmath>

#include "mesh/bisect.hpp"

namespace sprekk::mesh {

namespace {

using Point = std::array<Real, 2>;
using Triangle = std::array<Point, 3>;

Real doubled_area(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Cuts a convex polygon by the half plane on the left of the line from a to b.
void cut(std::vector<Point>& polygon, const Point& a, const Point& b) {
  std::vector<Point> kept;
  for (std::size_t k = 0; k < polygon.size(); ++k) {
    const Point &p = polygon[k], &q = polygon[(k + 1) % polygon.size()];
    const Real at_p = doubled_area(a, b, p), at_q = doubled_area(a, b, q);
    if (at_p >= 0) kept.push_back(p);
    if ((at_p > 0 && at_q < 0) || (at_p < 0 && at_q > 0)) {
      const Real share = at_p / (at_p - at_q);
      kept.push_back({p[0] + share * (q[0] - p[0]), p[1] + share * (q[1] - p[1])});
    }
  }
  polygon = std::move(kept);
}

/// Area and centroid of the intersection of two triangles, relative to the first corner of the first one.
std::pair<Real, Point> intersection(const Triangle& one, const Triangle& other) {
  const auto relative = [&](const Point& x) { return Point{x[0] - one[0][0], x[1] - one[0][1]}; };
  std::vector<Point> polygon;
  for (const auto& x : one) polygon.push_back(relative(x));
  for (int k = 0; k < 3; ++k) cut(polygon, relative(other[k]), relative(other[(k + 1) % 3]));
  Real area = 0;
  Point moment{};
  for (std::size_t k = 2; k < polygon.size(); ++k) {
    const Point &a = polygon[0], &b = polygon[k - 1], &c = polygon[k];
    const Real part = doubled_area(a, b, c) / 2;
    area += part;
    for (int i = 0; i < 2; ++i) moment[i] += part * (a[i] + b[i] + c[i]) / 3;
  }
  if (area <= 0) return {0, {}};
  return {area, {moment[0] / area + one[0][0], moment[1] / area + one[0][1]}};
}

std::array<Real, 4> box_of(const Triangle& x) {
  return {std::min({x[0][0], x[1][0], x[2][0]}), std::min({x[0][1], x[1][1], x[2][1]}),
          std::max({x[0][0], x[1][0], x[2][0]}), std::max({x[0][1], x[1][1], x[2][1]})};
}

}  // namespace

std::vector<Overlap> Bisection::overlaps(const Bisection& before, const std::vector<GlobalIndex>& parent) const {
  if (dim_ != 2) return {};
  const auto triangle = [](const Bisection& mesh, GlobalIndex c) {
    Triangle x;
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 2; ++i) x[k][i] = mesh.coordinates_[2 * mesh.cells_[c].node[k] + i];
    return x;
  };
  constexpr Real rounding = 1e-12, least = 1e-14;  // relative to the doubled area of a cell
  std::vector<char> is_changed(before.cells_.size(), 0);
  std::vector<int> n_children(before.cells_.size(), 0);
  std::vector<Real> left(before.cells_.size());  // area without children
  std::vector<Triangle> cells_before;
  for (GlobalIndex c = 0; c < before.n_cells(); ++c) {
    cells_before.push_back(triangle(before, c));
    const auto& x = cells_before.back();
    left[c] = doubled_area(x[0], x[1], x[2]);
  }
  const auto area = left;
  for (GlobalIndex c = 0; c < n_cells(); ++c) {
    const auto x = triangle(*this, c);
    const auto& whole = cells_before[parent[c]];
    ++n_children[parent[c]];
    left[parent[c]] -= doubled_area(x[0], x[1], x[2]);
    for (const auto& corner : x)
      for (int k = 0; k < 3; ++k)
        if (doubled_area(whole[k], whole[(k + 1) % 3], corner) < -rounding * area[parent[c]]) is_changed[parent[c]] = 1;
  }
  std::vector<GlobalIndex> changed;
  for (GlobalIndex c = 0; c < before.n_cells(); ++c) {
    if (n_children[c] != 1 || std::abs(left[c]) > rounding * area[c]) is_changed[c] = 1;
    if (is_changed[c]) changed.push_back(c);
  }
  std::vector<Overlap> all;
  for (GlobalIndex c = 0; c < n_cells(); ++c) {
    if (!is_changed[parent[c]]) continue;
    const auto x = triangle(*this, c);
    const auto box = box_of(x);
    for (const auto other : changed) {
      const auto& y = cells_before[other];
      const auto b = box_of(y);
      if (b[0] > box[2] || b[1] > box[3] || b[2] < box[0] || b[3] < box[1]) continue;
      if (const auto [shared, centre] = intersection(x, y); shared > least * doubled_area(x[0], x[1], x[2]))
        all.push_back({c, other, shared, centre});
    }
  }
  return all;
}

}  // namespace sprekk::mesh
