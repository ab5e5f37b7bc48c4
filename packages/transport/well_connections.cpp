#include "transport/well_connections.hpp"

#include "base/over_ranks.hpp"
#include "mesh/extents.hpp"
#include "transport/equivalent_radius.hpp"
#include "transport/face_plane.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace sprekk::transport {

using mesh::Vector;
using mesh::operator+;
using mesh::operator-;
using mesh::operator*;

namespace {

/// Distance of a point on a fracture from the plane of its face, relative to the domain size.
constexpr Real on_fracture = 1e-8;

/// Straight part of a well. In 2D a point with the length 1, perpendicular to the plane.
struct Segment {
  int well;
  Vector from, step, along;
  Real length;
};

template <Shape shape>
class Finder {
 public:
  static constexpr int dim = mesh::dimension(shape), n_faces = mesh::n_faces(shape);

  Finder(const mesh::Mesh& mesh, const WellsParameters& parameters)
      : mesh_(&mesh), parameters_(parameters), size_(mesh::largest_extent(mesh)) {}

  WellConnections find() {
    find_segments();
    find_cells_of_nodes();
    auto failure = find_connections();
    return {std::move(connections_), std::move(failure)};
  }

 private:
  const Well& well(const WellConnection& c) const { return parameters_.wells[c.well]; }

  /// Collects the segments, shifted so that no segment lies in a face.
  void find_segments() {
    const Vector shift = 1e-9 * size_ * Vector{0.443, 0.571, dim == 2 ? 0 : 0.691};
    for (std::size_t w = 0; w < parameters_.wells.size(); ++w) {
      const auto& points = parameters_.wells[w].points;
      const int number = static_cast<int>(w);
      if (dim == 2)
        segments_.push_back({.well = number, .from = points[0] + shift, .step = {}, .along = {0, 0, 1}, .length = 1});
      for (std::size_t k = 0; dim == 3 && k + 1 < points.size(); ++k) {
        const Vector step = points[k + 1] - points[k];
        const Real length = mesh::norm(step);
        segments_.push_back(
            {.well = number, .from = points[k] + shift, .step = step, .along = 1 / length * step, .length = length});
      }
    }
  }

  void find_cells_of_nodes() {
    cells_of_node_.resize(mesh_->n_nodes());
    const int n = mesh_->nodes_per_cell();
    for (LocalIndex k = 0; k < mesh_->n_cells() * n; ++k) cells_of_node_[mesh_->cells[k]].push_back(k / n);
  }

  /// Part low <= s <= high of a segment from + s step in a cell with plane faces, with the faces through which it
  /// enters and leaves (-1: none). Empty if low > high.
  struct Part {
    Real low, high;
    int enters = -1, leaves = -1;
  };
  Part clip(LocalIndex cell, const Segment& segment, Real low, Real high) const {
    Real X[mesh::n_nodes(shape)][dim];
    assembly::gather_host<shape>(*mesh_, cell, X);
    const CellFaces<shape> faces(X);
    Part part{low, high};
    for (int f = 0; f < n_faces; ++f) {
      Real inside = 0, towards = 0;  // (centre of the face - x) . A = inside - s towards
      for (int i = 0; i < dim; ++i) {
        const Real centre = X[0][i] - faces.corners[0][i] + faces.centre[f][i];
        inside += (centre - segment.from[i]) * faces.area[f][i];
        towards += segment.step[i] * faces.area[f][i];
      }
      if (towards > 0 && inside / towards < part.high) part = {part.low, inside / towards, part.enters, f};
      if (towards < 0 && inside / towards > part.low) part = {inside / towards, part.high, f, part.leaves};
      if (towards == 0 && inside < 0) return {1, 0};
    }
    return part;
  }

  bool is_far(LocalIndex cell, const Segment& segment) const {
    for (int i = 0; i < dim; ++i) {
      Real low = std::numeric_limits<Real>::max(), high = -low;
      for (int k = 0; k < mesh::n_corners(shape); ++k) {
        const Real x = mesh_->coordinates[mesh_->cells[cell * mesh_->nodes_per_cell() + k] * dim + i];
        low = std::min(low, x);
        high = std::max(high, x);
      }
      const Real a = segment.from[i], b = a + segment.step[i];
      if (std::max(a, b) < low || std::min(a, b) > high) return true;
    }
    return false;
  }

  std::string find_connections() {
    const std::size_t n = parameters_.wells.size();
    std::vector<Real> here(2 * n, 0);  // [well] length in cells; number of crossed fracture faces
    std::string failure;
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f)
      for (const auto& segment : segments_)
        if (cross(f, segment, failure)) ++here[n + segment.well];
    const auto in_fractures = connections_.size();
    for (LocalIndex cell = 0; cell < mesh_->n_owned_cells; ++cell)
      for (const auto& segment : segments_) {
        if (is_far(cell, segment)) continue;
        const auto part = clip(cell, segment, 0, 1);
        if (part.low >= part.high) continue;
        here[segment.well] += (part.high - part.low) * segment.length;
        if (!parameters_.mobility.values.empty()) connect(cell, segment, part.low, part.high);
      }
    const auto all = base::sum_over_ranks(*mesh_->comm, here);
    for (std::size_t w = 0; w < n; ++w) {
      Real length = 0;
      for (const auto& segment : segments_)
        if (segment.well == static_cast<int>(w)) length += segment.length;
      if (std::abs(all[w] - length) > 1e-6 * length)
        return fmt::format("Sprekk > Flow > Wells > {} > \"points\": {}", parameters_.wells[w].name,
                           dim == 2 ? "lies outside of the domain"
                                    : fmt::format("only {:.6g} of {:.6g} m are inside of the domain", all[w], length));
    }
    for (std::size_t w = 0; w < n && parameters_.mobility.values.empty(); ++w)
      if (all[n + w] == 0)
        return fmt::format("Sprekk > Flow > Wells > {} > \"points\": {} no fracture, and the rock is impermeable",
                           parameters_.wells[w].name, dim == 2 ? "lies on" : "cross");
    if (dim == 2)  // a well on a fracture is not connected to the rock
      connections_.erase(std::remove_if(connections_.begin() + static_cast<std::ptrdiff_t>(in_fractures),
                                        connections_.end(), [&](const auto& c) { return all[n + c.well] > 0; }),
                         connections_.end());
    for (const auto& c : connections_)
      if (!(c.index > 0 && std::isfinite(c.index)))
        failure = fmt::format(
            "Sprekk > Flow > Wells > {} > \"radius\": is {}, too large for the cell at ({:.6g}, {:.6g}, {:.6g}): the "
            "equivalent radius of the cell times exp(skin) must be larger; use coarser cells, or cells that are "
            "shorter along the well",
            well(c).name, well(c).radius, c.x[0], c.x[1], c.x[2]);
    return failure;
  }

  /// Returns 2 pi K/(ln(r_0/r_w) + skin).
  Real radial_index(int number, Real conductance, Real log_ratio) const {
    return 2 * M_PI * conductance / (log_ratio + parameters_.wells[number].skin);
  }

  void connect(LocalIndex cell, const Segment& segment, Real low, Real high) {
    const auto& mobility = parameters_.mobility.of_cell(*mesh_, cell);
    const Vector x = segment.from + (low + high) / 2 * segment.step;
    const LineFlow line(dim, mobility, x, segment.along);
    const Real radius = parameters_.scheme == FluxScheme::tpfa ? log_two_point_radius(cell, line)
                                                               : log_patch_radius(cell, segment, mobility, line);
    const Real ratio = radius - std::log(line.stretch * parameters_.wells[segment.well].radius);
    const Real length = (high - low) * segment.length;
    const Real W = radial_index(segment.well, line.conductance * length, ratio);
    connections_.push_back(
        {.well = segment.well, .fracture = -1, .row = cell, .index = W, .x = centre(cell), .face = -1});
  }

  Vector centre(LocalIndex cell) const {
    Real X[mesh::n_nodes(shape)][dim];
    assembly::gather_host<shape>(*mesh_, cell, X);
    const CellFaces<shape> faces(X);
    Vector x{};
    for (int i = 0; i < dim; ++i) x[i] = X[0][i] - faces.corners[0][i];
    return x;
  }

  /// Logarithm of the radius of Peaceman (1983) for a parallelepiped: exp(-gamma)/4 sqrt(a^2 + b^2) with the edges a, b
  /// across the well.
  Real log_two_point_radius(LocalIndex cell, const LineFlow& line) const {
    Real X[mesh::n_nodes(shape)][dim], square = 0;
    assembly::gather_host<shape>(*mesh_, cell, X);
    const CellFaces<shape> faces(X);
    for (int f = 0; f < n_faces; ++f)
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) square += 2 * faces.centre[f][i] * line.N[i][j] * faces.centre[f][j];
    return std::log(two_point_radius * std::sqrt(square));
  }

  /// Logarithm of the equivalent radius, from the patch of cells that share a corner with the cell.
  Real log_patch_radius(LocalIndex cell, const Segment& segment, const laws::Mobility& mobility,
                        const LineFlow& line) const {
    std::vector<LocalIndex> around = {cell};
    for (int k = 0; k < mesh::n_corners(shape); ++k)
      for (const LocalIndex other : cells_of_node_[mesh_->cells[cell * mesh_->nodes_per_cell() + k]])
        if (std::find(around.begin(), around.end(), other) == around.end()) around.push_back(other);
    std::vector<WellPatchEntity> patch;
    std::map<LocalIndex, std::array<LocalIndex, 2>> where;  // [end] cell and face
    std::set<LocalIndex> crossed;                           // ends crossed by the well
    const Real far = std::numeric_limits<Real>::infinity();
    for (const LocalIndex one : around) {
      Real X[mesh::n_nodes(shape)][dim];
      assembly::gather_host<shape>(*mesh_, one, X);
      const FlowMatrix<shape> matrix(CellFaces<shape>(X), mobility, parameters_.scheme);
      const auto part = clip(one, segment, dim == 2 ? 0 : -far, dim == 2 ? 1 : far);
      const Real length = part.low < part.high ? (part.high - part.low) * segment.length : 0;
      patch.push_back({{}, 2 * M_PI * line.conductance * length, {}});
      if (length > 0)
        for (const int f : {part.enters, part.leaves})
          if (f >= 0) crossed.insert(mesh_->facets->of_cell[one * n_faces + f]);
      for (int f = 0; f < n_faces; ++f) {
        for (int g = 0; g < n_faces; ++g) patch.back().T.push_back(matrix.T[f][g]);
        patch.back().ends.push_back(mesh_->facets->of_cell[one * n_faces + f]);
        where[patch.back().ends.back()] = {one, f};
      }
    }
    return log_equivalent_radius(patch, [&](LocalIndex end) {
      if (crossed.count(end)) return std::numeric_limits<Real>::quiet_NaN();  // impermeable: no flow along the well
      return assembly::face_mean(*mesh_, where[end][0], where[end][1],
                                 [&](const auto&, const auto& at) { return line.log_distance(at); });
    });
  }

  /// Connects a fracture face if a well crosses it (2D: lies on it). Returns whether it does. Sets `failure` if the
  /// well lies in the plane of the face (3D).
  bool cross(LocalIndex f, const Segment& segment, std::string& failure) {
    const auto& face = mesh_->fracture_faces[f];
    const Vector normal = face.frame[0];
    const Vector away = segment.from - face.centre;
    const auto& well = parameters_.wells[segment.well];
    if constexpr (dim == 2) {
      if (std::abs(mesh::dot(away, normal)) > on_fracture * size_ ||
          std::abs(mesh::dot(away, face.frame[1])) > face.area / 2)
        return false;
      const Real off_mean = parameters_.in_fractures == FluxScheme::tpfa ? 0 : face.area / 6;
      connect_face(f, segment, 1 / ((1 + well.skin) * well.radius / 2 + off_mean));
      return true;
    } else {
      const Real towards = mesh::dot(segment.along, normal), height = mesh::dot(away, normal);
      const Real ahead = -mesh::dot(away, segment.along), wide = std::sqrt(face.area);
      if (std::abs(towards) < 1e-6) {
        if (std::abs(height) < on_fracture * size_ && ahead > -wide && ahead < segment.length + wide &&
            mesh::norm(away + ahead * segment.along) < wide)
          failure = fmt::format(
              "Sprekk > Flow > Wells > {} > \"points\": a part lies in the fracture \"{}\"; a well may "
              "cross fractures only",
              well.name, mesh_->fracture_names[face.fracture]);
        return false;
      }
      const Real at = -height / towards;
      const Vector x = segment.from + at * segment.along;
      if (at < 0 || at >= segment.length || mesh::norm(x - face.centre) > 3 * wide || !is_inside(f, x)) return false;
      cross_face(f, segment, x, 1 / std::abs(towards));
      return true;
    }
  }

  Vector corner(const mesh::Mesh::FractureFace& face, int k) const {
    const int side = face.cell[mesh::minus] >= 0 ? mesh::minus : mesh::plus;
    Vector x{};
    for (int i = 0; i < dim; ++i) x[i] = mesh_->coordinates[face.nodes[side][k] * dim + i];
    return x;
  }

  /// Returns whether a point in the plane of a fracture face lies inside of the face.
  bool is_inside(LocalIndex f, const Vector& x) const {
    const auto& face = mesh_->fracture_faces[f];
    constexpr int n = mesh::n_face_corners(shape);
    int left = 0;
    for (int k = 0; k < n; ++k) {
      const Vector a = corner(face, k), b = corner(face, (k + 1) % n);
      left += mesh::dot(mesh::cross(b - a, x - a), face.frame[0]) > 0;
    }
    return left == 0 || left == n;
  }

  /// Connects a crossed face. `slant`: ratio of length to width of the elliptic section of the well.
  void cross_face(LocalIndex f, const Segment& segment, const Vector& x, Real slant) {
    constexpr int n = mesh::n_face_corners(shape);
    const auto& face = mesh_->fracture_faces[f];
    const LineFlow line(dim, laws::Mobility::isotropic(1), x, face.frame[0]);
    std::vector<WellPatchEntity> patch;
    std::map<LocalIndex, std::array<LocalIndex, 2>> where;  // [end] face and ridge
    const auto add = [&](LocalIndex one) {
      const FacePlane<shape> plane(*mesh_, one, 1, parameters_.in_fractures);
      patch.push_back({{}, one == f ? 2 * M_PI : 0, {}});
      for (int k = 0; k < n; ++k) {
        for (int j = 0; j < n; ++j) patch.back().T.push_back(plane.T[k][j]);
        patch.back().ends.push_back(mesh_->facets->ridge[one * n + k]);
        where[patch.back().ends.back()] = {one, k};
      }
    };
    add(f);
    for (LocalIndex other = 0; other < mesh_->n_fracture_faces(); ++other) {
      const auto& its = mesh_->fracture_faces[other];
      const auto shared = std::any_of(face.corners.begin(), face.corners.begin() + n, [&](GlobalIndex point) {
        return std::find(its.corners.begin(), its.corners.begin() + n, point) != its.corners.begin() + n;
      });
      if (other != f && its.single == face.single && shared) add(other);
    }
    const Real radius = log_equivalent_radius(patch, [&](LocalIndex end) {
      const auto& its = mesh_->fracture_faces[where[end][0]];
      const Vector a = corner(its, where[end][1]), b = corner(its, (where[end][1] + 1) % n);
      Real sum = 0;
      for (int q = 0; q < 3; ++q)
        sum += assembly::Gauss<3>::weight(q) / 2 *
               line.log_distance(0.5 * (a + b) + assembly::Gauss<3>::point(q) / 2 * (b - a));
      return sum;
    });
    const Real ratio = radius - std::log(line.stretch * parameters_.wells[segment.well].radius * (1 + slant) / 2);
    connect_face(f, segment, radial_index(segment.well, 1, ratio));
  }

  void connect_face(LocalIndex f, const Segment& segment, Real index) {
    const auto& face = mesh_->fracture_faces[f];
    connections_.push_back({.well = segment.well,
                            .fracture = face.fracture,
                            .row = mesh_->facets->fracture_face[f],
                            .index = index,
                            .x = face.centre,
                            .face = f});
  }

  const mesh::Mesh* mesh_;
  const WellsParameters& parameters_;
  Real size_;  // largest extent of the domain, m
  std::vector<Segment> segments_;
  std::vector<std::vector<LocalIndex>> cells_of_node_;
  std::vector<WellConnection> connections_;
};

}  // namespace

WellConnections find_well_connections(const mesh::Mesh& mesh, const WellsParameters& parameters) {
  return mesh::for_corners(mesh.shape, [&](auto shape) { return Finder<shape()>(mesh, parameters).find(); });
}

std::vector<WellNearFracture> wells_near_fractures(const mesh::Mesh& mesh, const std::vector<Well>& wells) {
  std::vector<WellNearFracture> near;
  if (mesh.dim() == 3 || mesh.single_fractures.empty()) return near;
  const Real size = mesh::largest_extent(mesh);
  for (std::size_t w = 0; w < wells.size(); ++w) {
    std::vector<Real> distances(mesh.single_fractures.size(), size);  // [single fracture] if less than half a face
    for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
      const auto& face = mesh.fracture_faces[f];
      const Vector away = wells[w].points[0] - face.centre;
      const Real beyond = std::max(std::abs(mesh::dot(away, face.frame[1])) - face.area / 2, Real(0));
      const Real distance = std::hypot(mesh::dot(away, face.frame[0]), beyond);
      if (distance < face.area / 2) distances[face.single] = std::min(distances[face.single], distance);
    }
    distances = base::min_over_ranks(*mesh.comm, distances);
    const auto nearest = std::min_element(distances.begin(), distances.end());
    if (*nearest > on_fracture * size && *nearest < size)
      near.push_back({static_cast<int>(w), static_cast<int>(nearest - distances.begin()), *nearest});
  }
  return near;
}

}  // namespace sprekk::transport
