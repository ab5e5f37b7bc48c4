#include "assembly/tip_rule.hpp"

#include <algorithm>
#include <cmath>

namespace sprekk::assembly {
namespace {

using mesh::Shape;
using Point = std::array<Real, 3>;

struct Node1D {
  Real x, weight;
};

/// Returns Gauss points on [0, 1]: the roots of Legendre's polynomial, by Newton's method.
std::vector<Node1D> gauss(int n) {
  std::vector<Node1D> rule;
  for (int i = 0; i < n; ++i) {
    Real z = std::cos(M_PI * (i + 0.75) / (n + 0.5)), slope = 1;
    for (int iteration = 0; iteration < 6; ++iteration) {
      Real p = 1, before = 0;
      for (int k = 1; k <= n; ++k) {
        const Real next = ((2 * k - 1) * z * p - (k - 1) * before) / k;
        before = p;
        p = next;
      }
      slope = n * (z * p - before) / (z * z - 1);
      z -= p / slope;
    }
    rule.push_back({(1 + z) / 2, 1 / ((1 - z * z) * slope * slope)});
  }
  return rule;
}

struct Barycentric {
  std::array<Real, 3> l;
  Real weight;
};

/// Returns a rule on the simplex with n_corners corners, in barycentric coordinates. Weights sum to 1 / (n_corners -
/// 1)!.
std::vector<Barycentric> simplex_rule(std::size_t n_corners, const std::vector<Node1D>& gauss) {
  if (n_corners == 1) return {{{1, 0, 0}, 1}};
  std::vector<Barycentric> rule;
  for (const auto& a : gauss) {
    if (n_corners == 2) rule.push_back({{1 - a.x, a.x, 0}, a.weight});
    for (const auto& b : gauss)
      if (n_corners == 3) rule.push_back({{1 - a.x, a.x * (1 - b.x), a.x * b.x}, a.weight * b.weight * a.x});
  }
  return rule;
}

/// Appends the rule of one simplex with the given corners. volume: reference volume times the factorial of the
/// dimension.
void append(const std::vector<Point>& tips, const std::vector<Point>& others, Real volume, int n,
            std::vector<RulePoint>& rule) {
  const auto line = gauss(n);
  const auto at_tips = simplex_rule(tips.size(), line), at_others = simplex_rule(others.size(), line);
  const auto combine = [](const std::vector<Point>& corners, const Barycentric& at, Real factor, Point& x) {
    for (std::size_t k = 0; k < corners.size(); ++k)
      for (int i = 0; i < 3; ++i) x[i] += factor * at.l[k] * corners[k][i];
  };
  for (const auto& s : line) {
    const Real rho = s.x * s.x;
    const Real weight =
        volume * s.weight * 2 * s.x * std::pow(rho, others.size() - 1.0) * std::pow(1 - rho, tips.size() - 1.0);
    for (const auto& t : at_tips)
      for (const auto& o : at_others) {
        RulePoint point{{}, weight * t.weight * o.weight};
        combine(tips, t, 1 - rho, point.xi);
        combine(others, o, rho, point.xi);
        rule.push_back(point);
      }
  }
}

std::vector<Point> corners_of(Shape shape) {
  switch (shape) {
    case Shape::triangle:
      return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    case Shape::tetrahedron:
      return {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    case Shape::quadrilateral:
      return {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    default:
      return {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}};
  }
}

/// Returns the corner that differs from corner a of a square or cube along one axis.
int neighbour(const std::vector<Point>& corners, int a, int axis) {
  Point x = corners[a];
  x[axis] = -x[axis];
  return static_cast<int>(std::find(corners.begin(), corners.end(), x) - corners.begin());
}

/// Returns the tips with most neighbouring tips. Each is the common corner of all simplices of a cut.
std::vector<int> centres_of(const std::vector<Point>& corners, const std::vector<char>& tips, int dim) {
  std::vector<int> best;
  int maximum = -1;
  for (int a = 0; a < static_cast<int>(corners.size()); ++a) {
    if (!tips[a]) continue;
    int n = 0;
    for (int axis = 0; axis < dim; ++axis) n += tips[neighbour(corners, a, axis)];
    if (n > maximum) best.clear();
    if (n >= maximum) best.push_back(a);
    maximum = std::max(n, maximum);
  }
  return best;
}

/// Returns the simplices around a corner of a square or cube. There is one for each order of the axes of the edges to
/// the opposite corner.
std::vector<std::vector<int>> cut(const std::vector<Point>& corners, int centre, int dim) {
  std::vector<std::vector<int>> simplices;
  std::vector<int> axes(dim);
  for (int i = 0; i < dim; ++i) axes[i] = i;
  do {
    std::vector<int> simplex{centre};
    for (int axis : axes) simplex.push_back(neighbour(corners, simplex.back(), axis));
    simplices.push_back(simplex);
  } while (std::next_permutation(axes.begin(), axes.end()));
  return simplices;
}

void append(const std::vector<Point>& corners, const std::vector<char>& tips, const std::vector<int>& simplex,
            Real volume, int n, std::vector<RulePoint>& rule) {
  std::vector<Point> of_tips, of_others;
  for (int a : simplex) (tips[a] ? of_tips : of_others).push_back(corners[a]);
  if (of_tips.empty()) std::swap(of_tips, of_others);
  if (of_others.empty()) {
    of_others.push_back(of_tips.back());
    of_tips.pop_back();
  }
  if (of_tips.size() > 3) {
    of_others.push_back(of_tips.back());
    of_tips.pop_back();
  }
  append(of_tips, of_others, volume, n, rule);
}

}  // namespace

std::vector<RulePoint> tip_rule(Shape shape, const std::vector<char>& tips, int n) {
  const auto corners = corners_of(shape);
  const int dim = mesh::dimension(shape);
  std::vector<RulePoint> rule;
  if (mesh::is_simplex(shape)) {
    std::vector<int> all(corners.size());
    for (std::size_t a = 0; a < all.size(); ++a) all[a] = static_cast<int>(a);
    append(corners, tips, all, 1, n, rule);
  } else {
    const Real volume = dim == 2 ? 4 : 8;  // factorial of the dimension times the volume of one simplex
    auto centres = centres_of(corners, tips, dim);
    if (dim == 2 && tips[(centres.front() + 2) % 4])
      centres = {(centres.front() + 1) % 4};  // cut along the other diagonal
    for (int centre : centres)                // mean of all cuts: mirrored cells have mirrored rules
      for (const auto& simplex : cut(corners, centre, dim))
        append(corners, tips, simplex, volume / static_cast<Real>(centres.size()), n, rule);
  }
  return rule;
}

std::vector<RulePoint> tip_rule_of_edge(const std::vector<char>& tips, int n) {
  std::vector<RulePoint> rule;
  append({{0, 0, 0}, {1, 0, 0}}, tips, {0, 1}, 1, n, rule);
  return rule;
}

const TipRules::Rule& TipRules::of(Shape shape, const std::vector<char>& tips, int n) {
  const auto [at, is_new] = rules_.try_emplace({shape, tips, n});
  if (is_new) at->second = tip_rule(shape, tips, n);
  return at->second;
}

const TipRules::Rule& TipRules::of_edge(const std::vector<char>& tips, int n) {
  const auto [at, is_new] = edges_.try_emplace({tips, n});
  if (is_new) at->second = tip_rule_of_edge(tips, n);
  return at->second;
}

}  // namespace sprekk::assembly
