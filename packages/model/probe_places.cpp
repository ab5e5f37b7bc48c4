#include "model/probe_places.hpp"

#include "assembly/geometry.hpp"
#include "base/check.hpp"
#include "base/over_ranks.hpp"
#include "mesh/extents.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

namespace sprekk::model {

using fields::Entity;
using mesh::cross;
using mesh::dot;
using mesh::Mesh;
using mesh::norm;
using mesh::Shape;
using mesh::Vector;
using mesh::operator-;
using mesh::operator*;

namespace {

/// Solves the dim x dim system J d = r by Cramer's rule.
template <int dim>
void solve(const Real (&J)[dim][dim], const Real (&r)[dim], Real (&d)[dim]) {
  if constexpr (dim == 2) {
    const Real det = J[0][0] * J[1][1] - J[0][1] * J[1][0];
    d[0] = (r[0] * J[1][1] - r[1] * J[0][1]) / det;
    d[1] = (J[0][0] * r[1] - J[1][0] * r[0]) / det;
  } else {
    Vector column[3], right{r[0], r[1], r[2]};
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) column[j][i] = J[i][j];
    const Real det = dot(column[0], cross(column[1], column[2]));
    d[0] = dot(right, cross(column[1], column[2])) / det;
    d[1] = dot(column[0], cross(right, column[2])) / det;
    d[2] = dot(column[0], cross(column[1], right)) / det;
  }
}

/// Shape functions at x of a cell that contains x; empty for other cells.
template <Shape shape>
std::vector<Real> shape_functions_at(const Mesh& mesh, LocalIndex cell, const Vector& x) {
  constexpr int dim = mesh::dimension(shape), n = mesh::n_nodes(shape);
  constexpr bool simplex = mesh::is_simplex(shape);
  Real X[n][dim], N[n], dN[n][dim], xi[dim], d[dim], origin[dim];
  assembly::gather_host<shape>(mesh, cell, X);
  Real farthest = 0, size = 0;  // coordinates may be large compared with the cell
  for (int i = 0; i < dim; ++i) {
    origin[i] = X[0][i];
    farthest = std::max(farthest, std::abs(origin[i]));
    for (int a = 0; a < n; ++a) size = std::max(size, std::abs(X[a][i] -= origin[i]));
  }
  const Real tolerance = std::max(Real(1e-9), 16 * std::numeric_limits<Real>::epsilon() * farthest / size);
  for (Real& one : xi) one = simplex ? Real(1) / (dim + 1) : 0;
  Real change = 1;
  for (int iterate = 0; iterate < 30 && change > 1e-14 && change < 1e3; ++iterate) {
    assembly::ReferenceCell<shape>::shape_functions(xi, N);
    assembly::ReferenceCell<shape>::gradients(xi, dN);
    Real J[dim][dim] = {}, r[dim];
    for (int i = 0; i < dim; ++i) {
      r[i] = x[i] - origin[i];
      for (int a = 0; a < n; ++a) {
        r[i] -= N[a] * X[a][i];
        for (int j = 0; j < dim; ++j) J[i][j] += X[a][i] * dN[a][j];
      }
    }
    solve(J, r, d);
    change = 0;
    for (int i = 0; i < dim; ++i) {
      xi[i] += d[i];
      change = std::max(change, std::abs(d[i]));
    }
  }
  if (!(change < 1e-10)) return {};
  Real minimum = simplex ? 1 : std::numeric_limits<Real>::max();  // distance to the sides in reference coordinates
  for (const Real one : xi) minimum = simplex ? std::min(minimum, one) : std::min(minimum, 1 - std::abs(one));
  if (simplex) {
    Real last = 1;
    for (const Real one : xi) last -= one;
    minimum = std::min(minimum, last);
  }
  if (minimum < -tolerance) return {};
  assembly::ReferenceCell<shape>::shape_functions(xi, N);
  return {N, N + n};
}

/// Points sorted by one coordinate, so the candidates for a box are adjacent.
class SortedPoints {
 public:
  explicit SortedPoints(const std::vector<Vector>& points) : points_(points) {
    Real widest = -1;
    for (int i = 0; i < 3; ++i) {
      const auto [low, high] =
          std::minmax_element(points.begin(), points.end(), [i](const auto& a, const auto& b) { return a[i] < b[i]; });
      if ((*high)[i] - (*low)[i] > widest) widest = (*high)[i] - (*low)[i], along_ = i;
    }
    for (std::size_t k = 0; k < points.size(); ++k) order_.push_back(k);
    std::sort(order_.begin(), order_.end(),
              [&](std::size_t a, std::size_t b) { return points_[a][along_] < points_[b][along_]; });
  }

  /// Calls use(point) for the points in a box.
  template <class Use>
  void for_each_in(const Vector& low, const Vector& high, const Use& use) const {
    auto next = std::lower_bound(order_.begin(), order_.end(), low[along_],
                                 [&](std::size_t k, Real value) { return points_[k][along_] < value; });
    for (; next != order_.end() && points_[*next][along_] <= high[along_]; ++next) {
      bool inside = true;
      for (int i = 0; i < 3; ++i) inside = inside && low[i] <= points_[*next][i] && points_[*next][i] <= high[i];
      if (inside) use(*next);
    }
  }

 private:
  const std::vector<Vector>& points_;
  std::vector<std::size_t> order_;
  int along_ = 0;
};

/// Best candidate for a point so far, on this rank.
struct Found {
  Real distance = std::numeric_limits<Real>::max();
  GlobalIndex number = std::numeric_limits<GlobalIndex>::max();
  Shares shares = {};

  void offer(Real other_distance, GlobalIndex other, Shares its) {
    if (std::tie(other_distance, other) >= std::tie(distance, number)) return;
    *this = {other_distance, other, std::move(its)};
  }
};

/// Assigns each point to the rank with the nearest candidate; among equal distances the lowest number is selected.
/// Collective.
std::vector<Shares> best(const Mesh& mesh, std::vector<Found> here, const std::vector<Vector>& points,
                         const char* where) {
  std::vector<Real> distance;
  for (const auto& found : here) distance.push_back(found.distance);
  const auto minimum = base::min_over_ranks(*mesh.comm, distance);
  std::vector<GlobalIndex> number;
  for (std::size_t k = 0; k < here.size(); ++k)
    number.push_back(here[k].distance == minimum[k] ? here[k].number : std::numeric_limits<GlobalIndex>::max());
  const auto lowest = base::min_over_ranks(*mesh.comm, number);
  std::vector<Shares> result;
  for (std::size_t k = 0; k < here.size(); ++k) {
    SPREKK_CHECK(lowest[k] < std::numeric_limits<GlobalIndex>::max(), "({:.10g}, {:.10g}, {:.10g}) is {}", points[k][0],
                 points[k][1], points[k][2], where);
    result.push_back(number[k] == lowest[k] && here[k].number == lowest[k] ? std::move(here[k].shares) : Shares());
  }
  return result;
}

std::vector<Shares> shares_in_cells(const Mesh& mesh, Entity entity, const std::vector<Vector>& points) {
  std::vector<Found> found(points.size());
  const SortedPoints sorted(points);
  const int n = mesh.nodes_per_cell(), dim = mesh.dim();
  mesh::for_shape(mesh.shape, [&](auto shape) {
    for (LocalIndex cell = 0; cell < mesh.n_owned_cells; ++cell) {
      Vector low{}, high{};
      for (int i = 0; i < dim; ++i) {
        low[i] = std::numeric_limits<Real>::max(), high[i] = -low[i];
        for (int a = 0; a < n; ++a) {
          const Real x = mesh.coordinates[mesh.cells[cell * n + a] * dim + i];
          low[i] = std::min(low[i], x), high[i] = std::max(high[i], x);
        }
        const Real room = 0.1 * (high[i] - low[i]);  // sides may be curved
        low[i] -= room, high[i] += room;
      }
      sorted.for_each_in(low, high, [&](std::size_t k) {
        const auto N = shape_functions_at<shape()>(mesh, cell, points[k]);
        if (N.empty()) return;
        Shares shares;
        for (int a = 0; a < n && entity == Entity::node; ++a) shares.push_back({mesh.cells[cell * n + a], N[a]});
        if (entity == Entity::cell) shares = {{cell, 1}};
        found[k].offer(0, mesh.cell_id[cell], std::move(shares));
      });
    }
  });
  return best(mesh, std::move(found), points, "outside of the mesh");
}

/// Distance from x to the segment from a to b, m.
Real distance_to(const Vector& a, const Vector& b, const Vector& x) {
  const Vector along = b - a;
  const Real s = std::clamp(dot(along, x - a) / dot(along, along), Real(0), Real(1));
  return norm(x - a - s * along);
}

/// Distance from x to a fracture face with straight edges, m.
Real distance_to(const Mesh& mesh, const Mesh::FractureFace& face, const Vector& x) {
  const auto corners = mesh::face_corners(mesh, face.cell[mesh::minus], face.local_face[mesh::minus]);
  if (corners.n == 2) return distance_to(corners.x[0], corners.x[1], x);
  const Vector n = face.frame[0];
  Real minimum = std::numeric_limits<Real>::max();
  int left = 0;
  for (int k = 0; k < corners.n; ++k) {
    const auto &a = corners.x[k], &b = corners.x[(k + 1) % corners.n];
    minimum = std::min(minimum, distance_to(a, b, x));
    left += dot(cross(b - a, x - a), n) > 0 ? 1 : -1;
  }
  return std::abs(left) == corners.n ? std::abs(dot(n, x - corners.x[0])) : minimum;
}

std::vector<Shares> shares_on_faces(const Mesh& mesh, const std::vector<Vector>& points) {
  const Real reach = 1e-6 * mesh::largest_extent(mesh);
  std::vector<Found> found(points.size());
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f)
    for (std::size_t k = 0; k < points.size(); ++k)
      if (distance_to(mesh, mesh.fracture_faces[f], points[k]) <= reach)
        found[k].offer(0, mesh.fracture_faces[f].id, {{f, 1}});
  return best(mesh, std::move(found), points, "on no fracture");
}

/// Merges shares of equal entities; their weights are summed.
Shares merged(Shares shares) {
  std::sort(shares.begin(), shares.end(), [](const auto& a, const auto& b) { return a.entity < b.entity; });
  Shares result;
  for (const auto& share : shares)
    if (!result.empty() && result.back().entity == share.entity)
      result.back().weight += share.weight;
    else
      result.push_back(share);
  return result;
}

}  // namespace

std::vector<Shares> shares_at(const Mesh& mesh, Entity entity, const std::vector<Vector>& points) {
  return entity == Entity::fracture_face ? shares_on_faces(mesh, points) : shares_in_cells(mesh, entity, points);
}

Shares shares_on_boundary(const Mesh& mesh, Entity entity, int boundary) {
  Shares shares;
  for (const auto& face : mesh.boundary_faces) {
    if (!face.owned || face.boundary != boundary) continue;
    Real area = 0;
    assembly::FaceValues at_nodes{};
    assembly::for_each_face_point(mesh, face.cell, face.local_face, [&](const auto& N, Real part, const auto&) {
      area += part;
      for (std::size_t k = 0; k < N.size(); ++k) at_nodes[k] += part * N[k];
    });
    if (entity == Entity::cell) shares.push_back({face.cell, area});
    for (int k = 0; k < mesh::n_face_nodes(mesh.shape) && entity == Entity::node; ++k) {
      const int local = mesh::face_nodes(mesh.shape)[face.local_face][k];
      shares.push_back({mesh.cells[face.cell * mesh.nodes_per_cell() + local], at_nodes[k]});
    }
  }
  return merged(std::move(shares));
}

Shares shares_in_region(const Mesh& mesh, Entity entity, int region) {
  Shares shares;
  mesh::for_shape(mesh.shape, [&](auto s) {
    constexpr Shape shape = s();
    constexpr int n = mesh::n_nodes(shape);
    for (LocalIndex cell = 0; cell < mesh.n_owned_cells; ++cell) {
      if (mesh.cell_region[cell] != region) continue;
      Real volume = 0, at_nodes[n] = {}, N[n];
      assembly::for_each_cell_point<shape>(mesh, cell, [&](const auto& xi, Real part, const auto&) {
        assembly::ReferenceCell<shape>::shape_functions(xi, N);
        volume += part;
        for (int a = 0; a < n; ++a) at_nodes[a] += part * N[a];
      });
      if (entity == Entity::cell) shares.push_back({cell, volume});
      for (int a = 0; a < n && entity == Entity::node; ++a) shares.push_back({mesh.cells[cell * n + a], at_nodes[a]});
    }
  });
  return merged(std::move(shares));
}

Shares shares_on_fractures(const Mesh& mesh, bool is_set, int number) {
  Shares shares;
  for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
    const auto& face = mesh.fracture_faces[f];
    if ((is_set ? face.fracture : face.single) == number) shares.push_back({f, face.area});
  }
  return shares;
}

}  // namespace sprekk::model
