#include "mesh/fronts.hpp"

#include "base/over_ranks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace sprekk::mesh {

namespace {

constexpr Real plateau = 0.4;  // fraction of the radius with weight 1
constexpr Real largest_turn = 50 * M_PI / 180;

Vector unit(const Vector& v) { return (1 / norm(v)) * v; }

/// Value of f(rho), 1 for rho below `plateau`, 0 from 1 on, and its derivative.
std::array<Real, 2> fall(Real rho) {
  if (rho <= plateau) return {1, 0};
  if (rho >= 1) return {0, 0};
  const Real t = (rho - plateau) / (1 - plateau);
  return {1 - t * t * (3 - 2 * t), -6 * t * (1 - t) / (1 - plateau)};
}

Real distance_to_segment(const Vector& x, const Vector& a, const Vector& b) {
  const Vector d = b - a;
  const Real t = std::clamp(dot(x - a, d) / dot(d, d), 0.0, 1.0);
  return norm(x - a - t * d);
}

/// Distance to the edges and the centre of a face.
Real distance_to(const Vector& x, const FaceCorners& face) {
  Real least = norm(x - face_centre(face));
  for (int k = 0; k < face.n; ++k) least = std::min(least, distance_to_segment(x, face.x[k], face.x[(k + 1) % face.n]));
  return least;
}

FaceCorners corners_of(const Mesh& mesh, LocalIndex f) {
  FaceCorners corners{{}, n_face_corners(mesh.shape)};
  for (int k = 0; k < corners.n; ++k) corners.x[k] = face_corner(mesh, f, k);
  return corners;
}

/// Edge of a front between two of its nodes.
struct Edge {
  int single;
  std::array<GlobalIndex, 2> node;
  std::array<Vector, 2> x;
};

class Fronts {
 public:
  Fronts(const Mesh& mesh, const std::vector<char>& requested, const RockConstants& rock) : mesh_(mesh), rock_(rock) {
    gather_points(requested);
    if (mesh.dim() == 3) gather_edges(requested);
    for (auto& point : points_) set_frame(point);
    find_radii();
    for (auto& point : points_) {
      for (const auto& edge : edges_)
        if (edge.single == point.single &&
            distance_to_segment(point.x, edge.x[0], edge.x[1]) <= 1.5 * point.radius + 1e-9 * point.size)
          point.edges.push_back(edge.x);
      if (mesh.dim() == 3 && point.radius > 0) point.length = length(point);
    }
  }
  std::vector<FrontPoint> take() { return std::move(points_); }

 private:
  bool is_tip(const Mesh::FractureFace& face, int k) const {
    return face.nodes[0][k] >= 0 && face.nodes[0][k] == face.nodes[1][k];
  }
  GlobalIndex id(const Mesh::FractureFace& face, int k) const { return mesh_.node_id[face.nodes[0][k]]; }

  /// Gathers the nodes, with sums of normals and of vectors to the centres of faces in `normal` and `ahead`.
  void gather_points(const std::vector<char>& requested) {
    std::vector<Real> here;
    for (LocalIndex f = 0; f < mesh_.n_owned_fracture_faces; ++f) {
      const auto& face = mesh_.fracture_faces[f];
      if (!requested[face.fracture]) continue;
      const auto corners = corners_of(mesh_, f);
      const auto rock = rock_(face.cell[minus]);
      for (int k = 0; k < corners.n; ++k) {
        if (!is_tip(face, k)) continue;
        const Vector& x = corners.x[k];
        Real size = 0;
        for (int l = 0; l < corners.n; ++l) size = std::max(size, norm(corners.x[l] - x));
        const Vector n = face.area * face.frame[0], behind = face_centre(corners) - x;
        here.insert(here.end(), {Real(id(face, k)), Real(face.single), x[0], x[1], x[2], n[0], n[1], n[2], behind[0],
                                 behind[1], behind[2], size, rock[0], rock[1], rock[2]});
      }
    }
    const auto all = base::gather_over_ranks(*mesh_.comm, here);
    std::map<GlobalIndex, FrontPoint> found;
    for (std::size_t i = 0; i < all.size(); i += 15) {
      const Real* v = &all[i];
      const auto node = static_cast<GlobalIndex>(v[0]);
      const auto [at, is_new] = found.try_emplace(node);
      auto& point = at->second;
      if (is_new) {
        point.node = node;
        point.single = static_cast<int>(v[1]);
        point.x = {v[2], v[3], v[4]};
        point.size = 0;
        point.rock = {v[12], v[13], v[14]};
        point.normal = point.ahead = {};
      }
      point.normal = point.normal + Vector{v[5], v[6], v[7]};
      point.ahead = point.ahead - Vector{v[8], v[9], v[10]};
      point.size = std::max(point.size, v[11]);
    }
    for (auto& [node, point] : found) points_.push_back(point);
  }

  /// Gathers the edges that belong to one face.
  void gather_edges(const std::vector<char>& requested) {
    std::vector<Real> here;
    for (LocalIndex f = 0; f < mesh_.n_owned_fracture_faces; ++f) {
      const auto& face = mesh_.fracture_faces[f];
      if (!requested[face.fracture]) continue;
      const auto corners = corners_of(mesh_, f);
      for (int k = 0; k < corners.n; ++k) {
        const int l = (k + 1) % corners.n;
        if (!is_tip(face, k) || !is_tip(face, l)) continue;
        here.insert(here.end(), {Real(face.single), Real(id(face, k)), Real(id(face, l))});
        for (const int c : {k, l}) here.insert(here.end(), corners.x[c].begin(), corners.x[c].end());
      }
    }
    const auto all = base::gather_over_ranks(*mesh_.comm, here);
    std::map<std::array<GlobalIndex, 2>, std::pair<int, Edge>> found;
    for (std::size_t i = 0; i < all.size(); i += 9) {
      const Real* v = &all[i];
      const Edge edge{static_cast<int>(v[0]),
                      {static_cast<GlobalIndex>(v[1]), static_cast<GlobalIndex>(v[2])},
                      {Vector{v[3], v[4], v[5]}, Vector{v[6], v[7], v[8]}}};
      const auto [a, b] = edge.node;
      auto& [count, first] = found[{std::min(a, b), std::max(a, b)}];
      if (count++ == 0) first = edge;
    }
    for (const auto& [nodes, counted] : found) {
      const auto& [count, edge] = counted;
      if (count != 1) continue;
      edges_.push_back(edge);
      for (const int k : {0, 1}) next_[edge.node[k]].push_back({edge.node[1 - k], edge.x[1 - k]});
    }
  }

  /// Sets frame and curvature; radius -1 at corners and nodes off fronts.
  void set_frame(FrontPoint& point) const {
    point.normal = unit(point.normal);
    const Vector outward = point.ahead;
    Vector along{}, to_centre{};
    if (mesh_.dim() == 3) {
      const auto ends = ends_at(point);
      if (ends.empty()) return void(point.radius = -1);
      along = ends.back() - (ends.size() > 1 && opposite(ends) ? ends.front() : Vector{});
      if (ends.size() > 1) to_centre = centre_of_circle(ends[0], ends[1]);
      if (const Real r = norm(to_centre); r > 0) {
        along = along - (dot(along, to_centre) / (r * r)) * to_centre;
        point.curvature = 1 / r;
      }
      along = unit(along - dot(along, point.normal) * point.normal);
      point.ahead = cross(along, point.normal);
    }
    point.ahead = point.ahead - dot(point.ahead, point.normal) * point.normal;
    if (dot(point.ahead, outward) < 0) point.ahead = Real(-1) * point.ahead;
    point.ahead = unit(point.ahead);
    point.along = cross(point.ahead, point.normal);
    if (dot(to_centre, point.ahead) > 0) point.curvature = -point.curvature;
  }

  /// Vectors to the two neighbours on the front, or from its end to the next two nodes. Empty at corners, one vector
  /// for a front of one edge.
  std::vector<Vector> ends_at(const FrontPoint& point) const {
    const auto found = next_.find(point.node);
    if (found == next_.end() || found->second.size() > 2) return {};
    std::vector<Vector> ends;
    for (const auto& [node, x] : found->second) ends.push_back(x - point.x);
    if (ends.size() == 1)
      for (const auto& [node, x] : next_.at(found->second[0].first))
        if (node != point.node) ends.push_back(x - point.x);
    if (ends.size() > 2) return {};
    const Vector& a = ends.front();
    const Vector b = ends.size() == 1 ? a : found->second.size() == 2 ? ends[1] : ends[1] - a;
    const Real cosine = dot(a, b) / (norm(a) * norm(b)) * (found->second.size() == 2 ? -1 : 1);
    if (cosine < std::cos(largest_turn)) return {};
    if (found->second.size() == 1 && ends.size() == 2) std::swap(ends[0], ends[1]);  // the tangent is that to the next
    return ends;
  }
  static bool opposite(const std::vector<Vector>& ends) { return dot(ends[0], ends[1]) < 0; }

  /// Vector from the origin to the centre of the circle through the origin, p and q; zero if they are collinear.
  static Vector centre_of_circle(const Vector& p, const Vector& q) {
    const Vector n = cross(p, q);
    const Real pp = dot(p, p), qq = dot(q, q), nn = dot(n, n);
    if (nn < 1e-12 * pp * qq) return {};
    return (1 / (2 * nn)) * cross(pp * q - qq * p, n);
  }

  /// Reduces the distances of obstacles of each valid point, then sets the radii.
  void find_radii() {
    using Distances = std::array<Real, 3>;  // of boundary, fracture, rock
    constexpr std::array<const char*, 3> names = {"a boundary", "a fracture", "another rock"};
    constexpr Real far = std::numeric_limits<Real>::max();
    std::vector<Distances> least(points_.size(), {far, far, far});
    for (std::size_t p = 0; p < points_.size(); ++p)
      if (points_[p].radius == 0) least[p] = {to_boundary(points_[p]), to_faces(points_[p]), to_cells(points_[p])};
    if (!least.empty()) least = base::min_over_ranks(*mesh_.comm, least);
    for (std::size_t p = 0; p < points_.size(); ++p) {
      auto& point = points_[p];
      if (point.radius < 0) {
        point.radius = 0;
        continue;
      }
      least[p][1] = std::min(least[p][1], to_fronts(point));
      const auto nearest = std::min_element(least[p].begin(), least[p].end());
      point.nearest = names[nearest - least[p].begin()];
      Real radius = 0.9 * *nearest;
      if (mesh_.dim() == 3) radius = std::min(radius, 10 * point.size);
      if (point.curvature != 0) radius = std::min(radius, 0.5 / std::abs(point.curvature));
      point.radius = radius < 1.2 * point.size ? 0 : radius;
    }
  }
  Real to_boundary(const FrontPoint& point) const {
    Real least = std::numeric_limits<Real>::max();
    for (const auto& face : mesh_.boundary_faces) {
      if (!face.owned) continue;
      const auto corners = face_corners(mesh_, face.cell, face.local_face);
      const bool is_end = mesh_.dim() == 3 && std::abs(dot(unit(area_vector(corners)), point.along)) > 0.98;
      if (!is_end) least = std::min(least, distance_to(point.x, corners));
    }
    return least;
  }
  Real to_faces(const FrontPoint& point) const {
    Real least = std::numeric_limits<Real>::max();
    for (LocalIndex f = 0; f < mesh_.n_owned_fracture_faces; ++f) {
      const auto corners = corners_of(mesh_, f);
      bool follows = mesh_.fracture_faces[f].single == point.single;
      for (int k = 0; k < corners.n && follows; ++k) {
        const Vector d = corners.x[k] - point.x;
        follows = std::abs(dot(d, point.normal)) <= 0.02 * norm(d);
      }
      if (follows) {
        const Vector d = face_centre(corners) - point.x;
        follows = point.at(face_centre(corners)).x1 < 0.05 * norm(d);
      }
      if (!follows) least = std::min(least, distance_to(point.x, corners));
    }
    return least;
  }
  Real to_cells(const FrontPoint& point) const {
    Real least = std::numeric_limits<Real>::max();
    const int n = mesh_.nodes_per_cell(), dim = mesh_.dim();
    for (LocalIndex c = 0; c < mesh_.n_owned_cells; ++c) {
      const auto rock = rock_(c);
      const auto differs = [](Real a, Real b) { return std::abs(a - b) > 1e-9 * (std::abs(a) + std::abs(b)); };
      if (std::equal(rock.begin(), rock.end(), point.rock.begin(), std::not_fn(differs))) continue;
      for (int a = 0; a < n; ++a) {
        Real square = 0;
        for (int i = 0; i < dim; ++i) {
          const Real d = mesh_.coordinates[mesh_.cells[c * n + a] * dim + i] - point.x[i];
          square += d * d;
        }
        least = std::min(least, std::sqrt(square));
      }
    }
    return least;
  }
  Real to_fronts(const FrontPoint& point) const {
    Real least = std::numeric_limits<Real>::max();
    for (const auto& other : points_) {
      const Real d = norm(other.x - point.x);
      if (d == 0 || d >= least) continue;
      const auto local = point.at(other.x);
      const bool same = mesh_.dim() == 3 && other.single == point.single && std::hypot(local.x1, local.x2) <= 0.1 * d;
      if (!same) least = d;
    }
    return least;
  }

  /// Integral of the weight along the front around a point, by Gauss points on its edges.
  Real length(const FrontPoint& point) const {
    constexpr Real place[] = {0.0694318442029737, 0.3300094782075719, 0.6699905217924281, 0.9305681557970263},
                   weight[] = {0.1739274225687269, 0.3260725774312731, 0.3260725774312731, 0.1739274225687269};
    Real sum = 0;
    Vector gradient;
    for (const auto& [a, b] : point.edges) {
      const Vector d = b - a;
      for (int g = 0; g < 4; ++g) sum += weight[g] * norm(d) * point.weight(a + place[g] * d, gradient);
    }
    return sum;
  }
  const Mesh& mesh_;
  const RockConstants& rock_;
  std::vector<FrontPoint> points_;
  std::vector<Edge> edges_;
  std::map<GlobalIndex, std::vector<std::pair<GlobalIndex, Vector>>> next_;  // neighbours on fronts
};

}  // namespace

FrontPoint::Local FrontPoint::at(const Vector& point) const {
  const Vector d = point - x;
  if (curvature == 0) return {dot(d, ahead), dot(d, normal), 0, ahead, along};
  const Real r = 1 / curvature, a = dot(d, ahead) + r, b = dot(d, along);
  const Real sign = curvature > 0 ? 1 : -1, rho = sign * std::hypot(a, b);  // rho has the sign of r
  const Vector out = (a / rho) * ahead + (b / rho) * along;
  return {rho - r, dot(d, normal), 1 / rho, out, cross(out, normal)};
}

Real FrontPoint::weight(const Vector& point, Vector& gradient) const {
  const Vector d = point - x;
  const Real r = norm(d);
  const auto [value, slope] = fall(r / radius);
  gradient = r > 0 ? (slope / (radius * r)) * d : Vector{};
  return value;
}

Real FrontPoint::distance(const Vector& point) const {
  if (edges.empty()) return -at(point).x1;
  Real least = std::numeric_limits<Real>::max();
  for (const auto& [a, b] : edges) least = std::min(least, distance_to_segment(point, a, b));
  return least;
}

std::vector<FrontPoint> find_fronts(const Mesh& mesh, const std::vector<char>& requested, const RockConstants& rock) {
  return Fronts(mesh, requested, rock).take();
}

}  // namespace sprekk::mesh
