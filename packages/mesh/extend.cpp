// Extension of fractures of a bisected mesh of triangles.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/check.hpp"
#include "mesh/bisect.hpp"

namespace sprekk::mesh {

namespace {

using Point = std::array<Real, 2>;

constexpr Real flattest = 0.15, good = 0.4;  // shapes of cells: permitted, and sufficient for a moved node

Point operator+(const Point& a, const Point& b) { return {a[0] + b[0], a[1] + b[1]}; }
Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1]}; }
Point operator*(Real s, const Point& a) { return {s * a[0], s * a[1]}; }
Real dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1]; }
Real cross(const Point& a, const Point& b) { return a[0] * b[1] - a[1] * b[0]; }
Real norm(const Point& a) { return std::hypot(a[0], a[1]); }

Point rotated(const Point& a, Real angle) {
  const Real c = std::cos(angle), s = std::sin(angle);
  return {c * a[0] - s * a[1], s * a[0] + c * a[1]};
}

Real distance_to_segment(const Point& x, const Point& a, const Point& b) {
  const Point d = b - a;
  return dot(d, d) == 0 ? norm(x - a) : norm(x - a - std::clamp<Real>(dot(x - a, d) / dot(d, d), 0, 1) * d);
}

}  // namespace

/// Triangles of a bisection with their incidence at nodes.
class Bisection::Patch {
 public:
  static constexpr int none = -1, on_boundary = -2;
  explicit Patch(Bisection& of) : of_(of) {
    const auto n = of.coordinates_.size() / 2;
    around_.resize(n);
    n_faces_.resize(n, 0);
    is_fixed_.resize(n, 0);
    single_.resize(n, none);
    for (std::size_t c = 0; c < of.cells_.size(); ++c)
      for (int k = 0; k < 3; ++k) {
        const auto& cell = of.cells_[c];
        auto& around = around_[cell.node[k]];
        if (!around.empty() && of.cells_[around[0]].region != cell.region) is_fixed_[cell.node[k]] = 1;
        around.push_back(c);
        if (cell.label[k] < 0) continue;
        const auto& label = of.labels_[cell.label[k]];
        for (const int end : {(k + 1) % 3, (k + 2) % 3}) {
          is_fixed_[cell.node[end]] = 1;
          if (label.boundary >= 0) single_[cell.node[end]] = on_boundary;
          if (label.fracture < 0 || label.side != minus) continue;
          ++n_faces_[cell.node[end]];
          auto& single = single_[cell.node[end]];
          if (single != on_boundary) single = label.single;
        }
      }
  }

  Point x(GlobalIndex node) const { return {of_.coordinates_[2 * node], of_.coordinates_[2 * node + 1]}; }
  GlobalIndex n_nodes() const { return static_cast<GlobalIndex>(around_.size()); }
  bool is_fixed(GlobalIndex node) const { return is_fixed_[node] != 0; }
  bool is_obstacle(GlobalIndex node) const { return single_[node] != none; }
  /// Returns whether a node belongs to a fracture inside the domain, but not to one single fracture.
  bool is_on_other(GlobalIndex node, int single) const { return single_[node] >= 0 && single_[node] != single; }
  void fix(GlobalIndex node) { is_fixed_[node] = 1; }

  /// Returns the single fracture of a node inside the domain, `none` or `on_boundary`.
  int single(GlobalIndex node) const { return single_[node]; }
  /// Returns the node on a fracture or boundary at a position; -1: none.
  GlobalIndex node_at(const Point& position, Real tolerance) const {
    for (GlobalIndex node = 0; node < n_nodes(); ++node)
      if (is_obstacle(node) && norm(x(node) - position) <= tolerance) return node;
    return -1;
  }
  /// Returns the tip at a position; -1: none.
  GlobalIndex tip_at(const Point& position, Real tolerance) const {
    for (GlobalIndex node = 0; node < n_nodes(); ++node)
      if (n_faces_[node] == 1 && single_[node] >= 0 && norm(x(node) - position) <= tolerance) return node;
    return -1;
  }

  /// Returns whether the ray from a point along a direction meets a single fracture.
  bool is_ahead(const Point& from, const Point& direction, int single) const {
    for (const auto& cell : of_.cells_)
      for (int k = 0; k < 3; ++k) {
        if (cell.label[k] < 0 || of_.labels_[cell.label[k]].single != single) continue;
        const Point a = x(cell.node[(k + 1) % 3]) - from, b = x(cell.node[(k + 2) % 3]) - from;
        const Real at_a = cross(direction, a), at_b = cross(direction, b);
        if (at_a == at_b || at_a * at_b > 0) continue;
        if (dot(direction, (at_b / (at_b - at_a)) * a - (at_a / (at_b - at_a)) * b) > 0) return true;
      }
    return false;
  }

  /// End of a fracture: label of the side, and whether side minus is on the left when looking ahead.
  struct End {
    Label label;
    bool minus_on_left;
  };
  /// Returns the end of a single fracture at a node, which is a tip or a junction.
  End end_at(GlobalIndex tip, int single) const {
    for (const auto c : around_[tip])
      for (int k = 0; k < 3; ++k) {
        const auto& cell = of_.cells_[c];
        if (cell.node[k] == tip || cell.label[k] < 0) continue;
        const auto& label = of_.labels_[cell.label[k]];
        if (label.fracture < 0 || label.single != single) continue;
        const GlobalIndex behind = cell.node[cell.node[(k + 1) % 3] == tip ? (k + 2) % 3 : (k + 1) % 3];
        const bool on_left = cross(x(tip) - x(behind), x(cell.node[k]) - x(behind)) > 0;
        return {label, on_left == (label.side == minus)};
      }
    throw Error("extension: there is no fracture at the tip");
  }

  /// 4 sqrt(3) area/sum of squared edges of a cell: 1 for an equilateral triangle, negative if inverted.
  Real shape(std::size_t c) const {
    const auto& node = of_.cells_[c].node;
    const Point a = x(node[1]) - x(node[0]), b = x(node[2]) - x(node[0]), e = b - a;
    return 2 * std::sqrt(Real(3)) * cross(a, b) / (dot(a, a) + dot(b, b) + dot(e, e));
  }
  Real worst(GlobalIndex node) const {
    Real least = 1;
    for (const auto c : around_[node]) least = std::min(least, shape(c));
    return least;
  }
  /// Moves a node and returns the worst shape around it.
  Real move(GlobalIndex node, const Point& to) {
    of_.coordinates_[2 * node] = to[0];
    of_.coordinates_[2 * node + 1] = to[1];
    return worst(node);
  }

  /// Corners a, b of the edge opposite to a node, in the cell that a ray from the node enters; a is on its right.
  std::optional<std::array<GlobalIndex, 2>> entered(GlobalIndex node, const Point& direction) const {
    for (const auto c : around_[node]) {
      const auto& all = of_.cells_[c].node;
      const int k = static_cast<int>(std::find(all.begin(), all.begin() + 3, node) - all.begin());
      const GlobalIndex a = all[(k + 1) % 3], b = all[(k + 2) % 3];
      const Point to_a = x(a) - x(node), to_b = x(b) - x(node);
      if (cross(direction, to_a) <= 0 && cross(direction, to_b) > 0 && dot(direction, to_a + to_b) > 0) return {{a, b}};
    }
    return {};
  }

  /// Splits an edge at a position, with its cells. Returns the new node.
  GlobalIndex split(GlobalIndex a, GlobalIndex b, const Point& position, std::vector<GlobalIndex>& parent) {
    const GlobalIndex middle = n_nodes();
    of_.coordinates_.insert(of_.coordinates_.end(), position.begin(), position.end());
    around_.emplace_back();
    n_faces_.push_back(0);
    is_fixed_.push_back(0);
    single_.push_back(none);
    const auto at_a = around_[a];
    for (const auto c : at_a) {
      const auto corner = [&](const Cell& cell, GlobalIndex node) {
        return static_cast<int>(std::find(cell.node.begin(), cell.node.begin() + 3, node) - cell.node.begin());
      };
      const int k = corner(of_.cells_[c], a), l = corner(of_.cells_[c], b);
      if (l == 3) continue;
      Cell other = of_.cells_[c];
      auto& one = of_.cells_[c];
      one.node[l] = middle;
      one.label[k] = -1;
      other.node[k] = middle;
      other.label[l] = -1;
      const auto added = of_.cells_.size();
      around_[middle].insert(around_[middle].end(), {c, added});
      around_[other.node[3 - k - l]].push_back(added);
      std::replace(around_[b].begin(), around_[b].end(), c, added);
      of_.cells_.push_back(other);
      parent.push_back(parent[c]);
    }
    return middle;
  }

  /// Adds the edge between two nodes to a fracture.
  void add_face(GlobalIndex from, GlobalIndex to, const End& end) {
    for (const auto c : around_[from]) {
      auto& cell = of_.cells_[c];
      int opposite = -1, found = 0;
      for (int k = 0; k < 3; ++k) cell.node[k] == from || cell.node[k] == to ? ++found : opposite = k;
      if (found < 2) continue;
      const bool on_left = cross(x(to) - x(from), x(cell.node[opposite]) - x(from)) > 0;
      cell.label[opposite] = label_of(end.label, on_left == end.minus_on_left ? minus : plus);
    }
  }

  /// Moves free nodes near a point towards the mean of their neighbours if the worst shape around them improves.
  void smooth(const Point& centre, Real radius) {
    for (int pass = 0; pass < 4; ++pass)
      for (GlobalIndex node = 0; node < n_nodes(); ++node) {
        if (is_fixed(node) || norm(x(node) - centre) > radius) continue;
        Point sum{};
        for (const auto c : around_[node])
          for (int k = 0; k < 3; ++k)
            if (of_.cells_[c].node[k] != node) sum = sum + x(of_.cells_[c].node[k]);
        const Point before = x(node);
        const Real shape = worst(node);
        if (move(node, (Real(0.5) / static_cast<Real>(around_[node].size())) * sum) <= shape) move(node, before);
      }
  }

  /// Selects the longest edges of the cells near a point as refinement edges, after nodes have moved.
  void mark(const Point& centre, Real radius) {
    for (auto& cell : of_.cells_) {
      if (norm(x(cell.node[0]) - centre) > radius) continue;
      Real longest = 0;
      for (signed char k = 0; k < 3; ++k) {
        const auto l = static_cast<signed char>((k + 1) % 3);
        const Real length = norm(x(cell.node[k]) - x(cell.node[l]));
        if (length > (1 + 1e-9) * longest) longest = length, cell.edge = {std::min(k, l), std::max(k, l)};
      }
    }
  }

 private:
  int label_of(Label label, int side) {
    label.side = side;
    for (std::size_t k = 0; k < of_.labels_.size(); ++k) {
      const auto& one = of_.labels_[k];
      if (one.boundary == label.boundary && one.fracture == label.fracture && one.single == label.single &&
          one.side == side)
        return static_cast<int>(k);
    }
    of_.labels_.push_back(label);
    return static_cast<int>(of_.labels_.size()) - 1;
  }

  Bisection& of_;
  std::vector<std::vector<std::size_t>> around_;  // [node] cells
  std::vector<int> n_faces_;                      // [node] of fractures
  std::vector<int> single_;                       // [node] single fracture, none or on_boundary
  std::vector<char> is_fixed_;                    // [node]
};

/// Bisects cells near an extension to a size.
void Bisection::refine_near(const Extension& e, Real size, std::vector<GlobalIndex>& parent) {
  const Point end = e.tip + e.length * e.direction;
  const auto node = [&](const Cell& cell, int k) {
    return Point{coordinates_[2 * cell.node[k]], coordinates_[2 * cell.node[k] + 1]};
  };
  for (std::vector<GlobalIndex> coarse(1); !coarse.empty();) {
    coarse.clear();
    for (GlobalIndex c = 0; c < n_cells(); ++c) {
      Real longest = 0, near = std::numeric_limits<Real>::max();
      for (int k = 0; k < 3; ++k) {
        const Point a = node(cells_[c], k), b = node(cells_[c], (k + 1) % 3);
        longest = std::max(longest, norm(b - a));
        near = std::min(near, distance_to_segment(Real(0.5) * (a + b), e.tip, end));
      }
      if (longest > size && near < e.length + longest / 2) coarse.push_back(c);
    }
    auto of_pass = refine(coarse);
    for (auto& cell : of_pass) cell = parent[cell];
    parent = std::move(of_pass);
  }
}

Extended Bisection::extend(const Extension& wanted, std::vector<GlobalIndex>& parent) {
  SPREKK_CHECK(dim_ == 2, "extension: needs a mesh of triangles");
  auto e = wanted;
  refine_near(e, e.size, parent);
  if (norm(e.direction) == 0) return {Extended::tip};
  int single, met = -1, passing = -1;
  bool is_ahead = false;
  {
    const Patch patch(*this);
    const GlobalIndex tip = patch.tip_at(e.tip, 1e-6 * e.length);
    if (tip < 0 && patch.node_at(e.tip, 1e-6 * e.length) >= 0) return {Extended::junction};  // joined by another
    SPREKK_CHECK(tip >= 0, "extension: there is no tip at ({}, {})", e.tip[0], e.tip[1]);
    single = patch.single(tip);
    const Point end = e.tip + e.length * e.direction;
    Real nearest = 0.75 * e.size;  // to the line
    for (GlobalIndex n = 0; n < patch.n_nodes(); ++n) {
      const Point r = patch.x(n) - wanted.tip;
      if (!patch.is_obstacle(n) || dot(r, wanted.direction) < 0.05 * wanted.length ||
          distance_to_segment(patch.x(n), wanted.tip, end) > 0.5 * wanted.length)
        continue;
      const int other = patch.single(n);
      if (!patch.is_on_other(n, single))
        return {.obstacle = other == single ? Extended::own_fracture : Extended::boundary};
      passing = other;
      const Real off = std::abs(cross(wanted.direction, r));
      if (off >= nearest) continue;
      nearest = off;
      met = other;
      e.length = norm(r);
      e.direction = (1 / e.length) * r;
    }
    if (passing >= 0 && met < 0) return {.met = passing, .obstacle = Extended::other_fracture};
    is_ahead = met >= 0 && patch.is_ahead(wanted.tip, wanted.direction, met);
  }
  if (!add_fitting_path(e, single, met < 0, parent)) return {};
  const Point end = e.tip + e.length * e.direction;
  if (met < 0) return {Extended::tip, e.tip, end};
  const Extension next{end, wanted.direction, wanted.beyond, wanted.size};
  if (next.length > 0 && is_ahead) {
    refine_near(next, next.size, parent);
    if (has_room(next, met) && add_fitting_path(next, single, true, parent))
      return {Extended::crossing, end, end + next.length * next.direction, met, true};
  }
  return {Extended::junction, e.tip, end, met, is_ahead};
}

/// Returns whether no fracture or boundary is near an extension from a junction, apart from both that meet there.
bool Bisection::has_room(const Extension& e, int met) {
  const Patch patch(*this);
  for (GlobalIndex n = 0; n < patch.n_nodes(); ++n) {
    const Point r = patch.x(n) - e.tip;
    const Real along = dot(r, e.direction);
    if (patch.is_obstacle(n) && along > 0.05 * e.length && (patch.single(n) != met || along > 0.9 * norm(r)) &&
        distance_to_segment(patch.x(n), e.tip, e.tip + e.length * e.direction) < 0.5 * e.length)
      return false;
  }
  return true;
}

/// Adds the path of an extension, through finer cells if it does not fit. Returns false, without a path, if cells
/// become too flat.
bool Bisection::add_fitting_path(const Extension& e, int single, bool refines, std::vector<GlobalIndex>& parent) {
  for (const Real share : {1.0, 0.75, 0.5}) {
    if (refines) refine_near(e, share * e.size, parent);
    const auto cells = cells_;
    const auto coordinates = coordinates_;
    const auto parent_before = parent;
    if (add_path(e, single, share * e.size, parent)) return true;
    cells_ = cells;
    coordinates_ = coordinates;
    parent = parent_before;
  }
  return false;
}

/// Adds the path of an extension through cells of a size. Returns false, with a damaged mesh, if cells become too flat.
bool Bisection::add_path(const Extension& e, int single, Real size, std::vector<GlobalIndex>& parent) {
  Patch patch(*this);
  const GlobalIndex tip = patch.node_at(e.tip, 1e-6 * e.length);
  const auto along = [&](GlobalIndex n) { return dot(patch.x(n) - e.tip, e.direction); };
  const auto fracture = patch.end_at(tip, single);
  const bool ends = patch.node_at(e.tip + e.length * e.direction, 1e-9 * size) >= 0;
  std::vector<GlobalIndex> path{tip};
  for (bool ended = false; !ended;) {
    const GlobalIndex from = path.back();
    const Real begin = along(from);
    const auto edge = patch.entered(from, e.direction);
    if (!edge) return false;
    const auto [a, b] = *edge;
    const auto place = [&](GlobalIndex n) {  // along the line
      const Real left = e.length - along(n);
      if (ends) return left < 1e-9 * size ? e.length : along(n);
      return left < std::max<Real>(0.5 * (along(n) - begin), 0.4 * size) ? e.length : along(n);
    };
    GlobalIndex best = -1;
    Real shape = flattest;
    for (const GlobalIndex n : {a, b}) {
      const Point before = patch.x(n), to = e.tip + place(n) * e.direction;
      if (patch.is_fixed(n) ? norm(to - before) > 1e-9 * size : ends && place(n) == e.length) continue;
      if ((place(n) < begin + 0.2 * size && !patch.is_fixed(n)) || place(n) - begin > 1.5 * size) continue;
      const Real here = patch.move(n, to);
      patch.move(n, before);
      if (here > shape) best = n, shape = here;
    }
    const Real at_a = std::abs(cross(e.direction, patch.x(a) - e.tip)),
               at_b = std::abs(cross(e.direction, patch.x(b) - e.tip)), share = at_a / (at_a + at_b);
    const Point crossing = (1 - share) * patch.x(a) + share * patch.x(b);
    const bool splits =
        shape < good && std::abs(share - 0.5) < 0.2 && dot(crossing - e.tip, e.direction) < e.length - 0.4 * size;
    if (best >= 0 && !splits) {
      ended = place(best) == e.length;
      patch.move(best, e.tip + place(best) * e.direction);
    } else {
      best = patch.split(a, b, crossing, parent);
      if (patch.worst(best) < flattest || along(best) > e.length - 0.2 * size) return false;
    }
    path.push_back(best);
    patch.fix(best);
  }
  for (std::size_t k = 1; k < path.size(); ++k) patch.add_face(path[k - 1], path[k], fracture);
  const Point middle = e.tip + Real(0.5) * e.length * e.direction;
  patch.smooth(middle, 1.5 * e.length);
  patch.mark(middle, 2 * e.length);
  return true;
}

bool Bisection::turn(const Turn& t) {
  SPREKK_CHECK(dim_ == 2, "turn: needs a mesh of triangles");
  const Point d = t.tip - t.begin;
  const Real length = norm(d);
  const auto coordinates = coordinates_;
  Patch patch(*this);
  const auto angle = [&](const Point& r) { return std::atan2(cross(d, r), dot(d, r)); };
  const auto on_path = [&](const Point& r) {
    return std::abs(cross(d, r)) < 1e-6 * length * length && dot(d, r) > 0 && norm(r) < (1 + 1e-6) * length;
  };
  constexpr Real inner = 0.15, largest = 1.75;  // rad
  Real reach = 2.5 * length, window = largest;
  for (GlobalIndex n = 0; n < patch.n_nodes(); ++n) {
    const Point r = patch.x(n) - t.begin;
    if (!patch.is_fixed(n) || norm(r) >= reach || norm(r) <= 1e-9 * length || on_path(r)) continue;
    const Real limit = 0.95 * std::abs(angle(r));
    if (limit < inner + 2 * std::abs(t.angle))
      reach = 0.95 * norm(r);  // ahead
    else
      window = std::min(window, limit);
  }
  if (reach < 1.3 * length) return false;
  for (GlobalIndex n = 0; n < patch.n_nodes(); ++n) {
    const Point r = patch.x(n) - t.begin;
    if (norm(r) >= reach || norm(r) == 0) continue;
    const Real radial = std::min<Real>(1, (reach - norm(r)) / (reach - 1.25 * length)),
               angular = std::clamp<Real>((window - std::abs(angle(r))) / (window - inner), 0, 1);
    if (radial * angular > 0) patch.move(n, t.begin + rotated(r, radial * angular * t.angle));
  }
  patch.smooth(t.begin, reach);
  for (std::size_t c = 0; c < cells_.size(); ++c)
    if (patch.shape(c) < flattest && norm(patch.x(cells_[c].node[0]) - t.begin) < 1.5 * reach) {
      coordinates_ = coordinates;
      return false;
    }
  patch.mark(t.begin, reach);
  return true;
}

}  // namespace sprekk::mesh
