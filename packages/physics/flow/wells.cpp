#include "physics/flow/wells.hpp"

#include "mesh/extents.hpp"
#include "physics/flow/equivalent_radius.hpp"
#include "physics/flow/exchange.hpp"
#include "physics/flow/face_plane.hpp"

#include <Teuchos_CommHelpers.hpp>

#include <algorithm>
#include <limits>
#include <set>

namespace sprekk::physics {

using mesh::Vector;
using mesh::operator+;
using mesh::operator-;
using mesh::operator*;

namespace {

/// A straight part of a well; in 2D a point, with the direction across the plane and the length 1.
struct Segment {
  int well;
  Vector from, step, along;
  Real length;
};

/// Where fluid flows between a well and the rock or a fracture.
struct Connection {
  int well, fracture;  ///< -1: rock
  LocalIndex row;      ///< cell, or facet
  Real index;          ///< W, m^3/(Pa s); of a face over its transmissivity, -
  Vector x;            ///< the centre of the cell or the face, where its pressure is
  LocalIndex face;     ///< -1: rock
};

template <Shape shape>
class Wells final : public assembly::Module {
 public:
  static constexpr int dim = mesh::dimension(shape), n_faces = mesh::n_faces(shape);

  explicit Wells(WellsParameters parameters) : parameters_(std::move(parameters)) {}

  std::string name() const override { return "wells"; }
  void set_fields(const std::set<std::string>& fields) override { widens_ = fields.count("widening") > 0; }

  assembly::Declaration declare(const mesh::Mesh&) const override {
    assembly::Declaration d;
    d.couplings = {{assembly::Loop::cells, "pressure", {"pressure"}},
                   {assembly::Loop::cells, "face pressure", {"face pressure"}}};
    if (widens_) {
      d.couplings.push_back({assembly::Loop::fracture_cells, "face pressure", {"widening"}});
      d.history = {{"widening", fields::Entity::fracture_face, 1}};
    }
    d.linear = is_linear();
    return d;
  }

  void bind(const assembly::Context& context) override {
    mesh_ = context.mesh();
    size_ = mesh::largest_extent(*mesh_);
    const std::vector<int> blocks = {context.field("pressure"), context.field("face pressure")};
    find_segments();
    find_cells_of_nodes();
    std::string failure = find_connections();
    cells_of_node_.clear();
    if (widens_) widening_ = context.field("widening");
    sums_ = sums([](LocalIndex) { return 0; });
    for (const auto& c : connections_) {
      const bool widens = widens_ && c.face >= 0;
      if (well(c).pressure) exchange_[c.face >= 0].add(c.row, widens ? c.index : index(c), c.face);
    }
    for (int k = 0; k < 2; ++k) {
      const bool widens = widens_ && k == 1;
      exchange_[k].bind(context, blocks[k], parameters_.fluid,
                        widens ? parameters_.faces : std::vector<laws::Conduit>());
      load_[k] = View<Real*>("load", context.layout(blocks[k]).n_owned());
      blocks_[k] = blocks[k];
    }
    SPREKK_CHECK(failure.empty(), "{}", failure);
  }

  void residual(const assembly::State& state, const assembly::Rows& r) const override {
    for (int k = 0; k < 2; ++k) {
      exchange_[k].add_residual(state, r);
      const auto rows = r[blocks_[k]];
      const auto load = load_[k];
      Kokkos::parallel_for(
          "load", Kokkos::RangePolicy<Execution>(0, rows.extent(0)), KOKKOS_LAMBDA(int i) { rows(i) += load(i); });
    }
  }

  void jacobian(const assembly::State& state, fields::BlockMatrix& J) const override {
    for (const auto& exchange : exchange_) exchange.add_jacobian(state, J);
  }

  bool constant_load() const override {
    return !widens_ && std::all_of(parameters_.wells.begin(), parameters_.wells.end(),
                                   [](const Well& well) { return control(well).constant_in_time(); });
  }

  void start_step(const assembly::State& state) override {
    if (widens_) {
      const auto before = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), state.history[0]);
      start_ = {before.data(), before.data() + before.extent(0)};
      sums_ = sums([&](LocalIndex face) { return start_[face]; });
      for (std::size_t w = 0; w < sums_.size(); ++w)
        SPREKK_CHECK(
            sums_[w] > 0,
            "Sprekk > Flow > Wells > {}: the fractures that it is in are closed at t = {}, so that nothing flows "
            "into them; give a \"residual aperture\"",
            parameters_.wells[w].name, state.t);
    }
    std::array<std::vector<Real>, 2> outside;
    for (int k = 0; k < 2; ++k) {
      const auto host = Kokkos::create_mirror_view(load_[k]);
      Kokkos::deep_copy(host, 0.0);
      for (const auto& c : connections_) {
        if ((c.fracture >= 0) != (k == 1)) continue;
        if (well(c).pressure)
          outside[k].push_back(pressure(c, state.t));
        else
          host(c.row) -= rate(c, state.t);
      }
      Kokkos::deep_copy(load_[k], host);
      exchange_[k].set_outside(outside[k]);
    }
  }

  void commit(assembly::State& state) const override {
    if (!widens_) return;
    const auto widening = state.x[widening_];
    const auto kept = state.history[0];
    Kokkos::parallel_for(
        "widening", Kokkos::RangePolicy<Execution>(0, kept.extent(0)),
        KOKKOS_LAMBDA(int f) { kept(f, 0) = widening(f); });
  }

  /// The pressure in wells, or what draws a rate.
  assembly::Scales loads(Real t) const override {
    Real largest = 0;
    for (std::size_t w = 0; w < parameters_.wells.size(); ++w) {
      const auto& one = parameters_.wells[w];
      const Real value = std::abs(control(one)(one.points[0], t));
      largest = std::max(largest, one.pressure ? value : value / sums_[w]);
    }
    return {{"pressure", largest}};
  }

  void totals(const assembly::State& state, std::vector<assembly::Total>& totals) const override {
    const auto first = totals.size();
    const auto width = 3 + mesh_->fracture_names.size();
    for (const auto& one : parameters_.wells) {
      for (const char* what : {"rate", "pressure", "in rock"}) totals.push_back({{"wells", one.name, what}, 0});
      for (const auto& fracture : mesh_->fracture_names) totals.push_back({{"wells", one.name, "in " + fracture}, 0});
    }
    std::array<Kokkos::View<Real*>::HostMirror, 2> p;
    for (int k = 0; k < 2; ++k) {
      p[k] = Kokkos::View<Real*>::HostMirror("p", state.x[blocks_[k]].extent(0));
      Kokkos::deep_copy(p[k], state.x[blocks_[k]]);
    }
    const auto widening = widens_ ? Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), state.x[widening_]) : p[1];
    for (const auto& c : connections_) {
      const Real at = p[c.fracture >= 0](c.row), share = this->share(c);
      const Real W = index(c, widens_ && c.face >= 0 ? widening(c.face) : 0);
      const bool held = well(c).pressure.has_value();
      const Real flow = held ? W * parameters_.fluid.drop(pressure(c, state.t), at, 0) : rate(c, state.t);
      const Real drop = flow == 0 ? 0 : flow / W;
      const auto of_well = first + c.well * width;
      totals[of_well].value += flow;
      totals[of_well + 1].value +=
          share * (held ? control(well(c))(well(c).points[0], state.t) : at + drop - head(c, at + drop));
      totals[of_well + 3 + c.fracture].value += flow;
    }
  }

 private:
  bool is_linear() const { return parameters_.fluid.compressibility == 0 && !widens_; }
  const Well& well(const Connection& c) const { return parameters_.wells[c.well]; }
  static const base::Expression& control(const Well& well) { return well.pressure ? *well.pressure : *well.rate; }

  /// W.
  Real index(const Connection& c, Real widening = 0) const {
    return c.face < 0 ? c.index : c.index * parameters_.faces[c.face].transmissivity(widening);
  }
  /// Of all connections of each well on all ranks, with widening(face). Collective.
  template <class Widening>
  std::vector<Real> sums(const Widening& widening) const {
    std::vector<Real> here(parameters_.wells.size(), 0), all(here);
    for (const auto& c : connections_) here[c.well] += index(c, c.face < 0 ? 0 : widening(c.face));
    Teuchos::reduceAll(*mesh_->comm, Teuchos::REDUCE_SUM, static_cast<int>(here.size()), here.data(), all.data());
    return all;
  }
  Real share(const Connection& c) const {
    return index(c, c.face < 0 || start_.empty() ? 0 : start_[c.face]) / sums_[c.well];
  }
  Real rate(const Connection& c, Real t) const { return control(well(c))(well(c).points[0], t) * share(c); }

  Real lift(const Connection& c) const {
    Real sum = 0;
    for (int i = 0; i < dim; ++i) sum += parameters_.weight[i] * (c.x[i] - well(c).points[0][i]);
    return sum;
  }
  /// The pressure in the well where it is connected.
  Real pressure(const Connection& c, Real t) const {
    const Real first = control(well(c))(well(c).points[0], t);
    return first + parameters_.fluid.head(first, lift(c));
  }
  /// What of a pressure at a connection is due to the fluid between there and the first point.
  Real head(const Connection& c, Real p) const { return -parameters_.fluid.head(p, -lift(c)); }

  /// Moved, so that no part lies in a face.
  void find_segments() {
    const Vector shift = 1e-9 * size_ * Vector{0.443, 0.571, dim == 2 ? 0 : 0.691};
    for (std::size_t w = 0; w < parameters_.wells.size(); ++w) {
      const auto& points = parameters_.wells[w].points;
      const int number = static_cast<int>(w);
      if (dim == 2) segments_.push_back({number, points[0] + shift, {}, {0, 0, 1}, 1});
      for (std::size_t k = 0; dim == 3 && k + 1 < points.size(); ++k) {
        const Vector step = points[k + 1] - points[k];
        const Real length = mesh::norm(step);
        segments_.push_back({number, points[k] + shift, step, 1 / length * step, length});
      }
    }
  }

  void find_cells_of_nodes() {
    cells_of_node_.resize(mesh_->n_nodes());
    const int n = mesh_->nodes_per_cell();
    for (LocalIndex k = 0; k < mesh_->n_cells() * n; ++k) cells_of_node_[mesh_->cells[k]].push_back(k / n);
  }

  /// The part of from + s step in a cell with plane faces, where it lies in [low, high], and through which faces it
  /// enters and leaves (-1: through none); empty where low > high.
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

  /// Returns what is wrong with a well, the same on every rank but for radii.
  std::string find_connections() {
    const std::size_t n = parameters_.wells.size();
    std::vector<Real> here(2 * n, 0), all(2 * n);  // length in cells, crossed fractures
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
        connect(cell, segment, part.low, part.high);
      }
    Teuchos::reduceAll(*mesh_->comm, Teuchos::REDUCE_SUM, static_cast<int>(2 * n), here.data(), all.data());
    for (std::size_t w = 0; w < n; ++w) {
      Real length = 0;
      for (const auto& segment : segments_)
        if (segment.well == static_cast<int>(w)) length += segment.length;
      if (std::abs(all[w] - length) > 1e-6 * length)
        return fmt::format("Sprekk > Flow > Wells > {} > \"points\": {}", parameters_.wells[w].name,
                           dim == 2 ? "lies outside of the domain"
                                    : fmt::format("only {:.6g} of {:.6g} m are inside of the domain", all[w], length));
    }
    if (dim == 2)  // what lies on a fracture feeds that alone
      connections_.erase(std::remove_if(connections_.begin() + static_cast<std::ptrdiff_t>(in_fractures),
                                        connections_.end(), [&](const auto& c) { return all[n + c.well] > 0; }),
                         connections_.end());
    for (const auto& c : connections_)
      if (!(c.index > 0 && std::isfinite(c.index)))
        failure = fmt::format(
            "Sprekk > Flow > Wells > {} > \"radius\": is {}, too large for the cell at ({:.6g}, {:.6g}, {:.6g}): the "
            "distance at which the pressure is that of the cell, times exp(skin), must be larger; it is so of coarser "
            "cells, and of ones that are less long along the well",
            well(c).name, well(c).radius, c.x[0], c.x[1], c.x[2]);
    return failure;
  }

  /// 2 pi K over ln(r_0/r_w) + skin.
  Real radial_index(int number, Real conductance, Real log_ratio) const {
    return 2 * M_PI * conductance / (log_ratio + parameters_.wells[number].skin);
  }

  void connect(LocalIndex cell, const Segment& segment, Real low, Real high) {
    const auto& of_cell = parameters_.mobility_of_cell;
    const auto& mobility = parameters_.mobility[of_cell.empty() ? mesh_->cell_region[cell] : of_cell[cell]];
    const Vector x = segment.from + (low + high) / 2 * segment.step;
    const LineFlow line(dim, mobility, x, segment.along);
    const Real radius = parameters_.scheme == FluxScheme::tpfa ? log_two_point_radius(cell, line)
                                                               : log_patch_radius(cell, segment, mobility, line);
    const Real ratio = radius - std::log(line.stretch * parameters_.wells[segment.well].radius);
    const Real length = (high - low) * segment.length;
    const Real W = radial_index(segment.well, line.conductance * length, ratio);
    connections_.push_back({segment.well, -1, cell, W, centre(cell), -1});
  }

  Vector centre(LocalIndex cell) const {
    Real X[mesh::n_nodes(shape)][dim];
    assembly::gather_host<shape>(*mesh_, cell, X);
    const CellFaces<shape> faces(X);
    Vector x{};
    for (int i = 0; i < dim; ++i) x[i] = X[0][i] - faces.corners[0][i];
    return x;
  }

  /// Peaceman (1983), of a parallelepiped: exp(-gamma)/4 sqrt(a^2 + b^2) with the edges a, b across the well.
  Real log_two_point_radius(LocalIndex cell, const LineFlow& line) const {
    Real X[mesh::n_nodes(shape)][dim], square = 0;
    assembly::gather_host<shape>(*mesh_, cell, X);
    const CellFaces<shape> faces(X);
    for (int f = 0; f < n_faces; ++f)
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) square += 2 * faces.centre[f][i] * line.N[i][j] * faces.centre[f][j];
    return std::log(two_point_radius * std::sqrt(square));
  }

  /// The cells that share a corner with this one.
  Real log_patch_radius(LocalIndex cell, const Segment& segment, const laws::Mobility& mobility,
                        const LineFlow& line) const {
    std::vector<LocalIndex> around = {cell};
    for (int k = 0; k < mesh::n_corners(shape); ++k)
      for (const LocalIndex other : cells_of_node_[mesh_->cells[cell * mesh_->nodes_per_cell() + k]])
        if (std::find(around.begin(), around.end(), other) == around.end()) around.push_back(other);
    std::vector<PatchEntity> patch;
    std::map<LocalIndex, std::array<LocalIndex, 2>> where;  // of ends: cell, face
    std::set<LocalIndex> crossed;                           // ends
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
      Real sum = 0, total = 0;
      if (crossed.count(end)) return std::numeric_limits<Real>::quiet_NaN();  // no flow along the well
      assembly::for_each_face_point<shape>(*mesh_, where[end][0], where[end][1],
                                           [&](const auto&, Real area, const auto& at) {
                                             sum += area * line.log_distance(at);
                                             total += area;
                                           });
      return sum / total;
    });
  }

  /// Whether a well crosses (2D: lies on) a fracture face, which is then connected.
  bool cross(LocalIndex f, const Segment& segment, std::string& failure) {
    const auto& face = mesh_->fracture_faces[f];
    const Vector normal = face.frame[0];
    const Vector away = segment.from - face.centre;
    const auto& well = parameters_.wells[segment.well];
    if constexpr (dim == 2) {
      if (std::abs(mesh::dot(away, normal)) > 1e-8 * size_ || std::abs(mesh::dot(away, face.frame[1])) > face.area / 2)
        return false;
      const Real index = 2 / ((1 + well.skin) * well.radius);
      connections_.push_back({segment.well, face.fracture, mesh_->facets->fracture_face[f], index, face.centre, f});
      return true;
    } else {
      const Real towards = mesh::dot(segment.along, normal), height = mesh::dot(away, normal);
      const Real ahead = -mesh::dot(away, segment.along), wide = std::sqrt(face.area);
      if (std::abs(towards) < 1e-6) {
        if (std::abs(height) < 1e-8 * size_ && ahead > -wide && ahead < segment.length + wide &&
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
      connect_face(f, segment, x, 1 / std::abs(towards));
      return true;
    }
  }

  Vector corner(const mesh::Mesh::FractureFace& face, int k) const {
    const int side = face.cell[mesh::minus] >= 0 ? mesh::minus : mesh::plus;
    Vector x{};
    for (int i = 0; i < dim; ++i) x[i] = mesh_->coordinates[face.nodes[side][k] * dim + i];
    return x;
  }

  /// Of a point in the plane of a fracture face.
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

  /// `slant`: how much longer than wide the cut of the well is.
  void connect_face(LocalIndex f, const Segment& segment, const Vector& x, Real slant) {
    constexpr int n = mesh::n_face_corners(shape);
    const auto& face = mesh_->fracture_faces[f];
    const LineFlow line(dim, laws::Mobility::isotropic(1), x, face.frame[0]);
    std::vector<PatchEntity> patch;
    std::map<LocalIndex, std::array<LocalIndex, 2>> where;  // of ends: face, ridge
    const auto add = [&](LocalIndex one) {
      const FacePlane<shape> plane(*mesh_, one, 1, parameters_.scheme);
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
      if (other != f && its.fracture == face.fracture && shared) add(other);
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
    connections_.push_back({segment.well, face.fracture, mesh_->facets->fracture_face[f],
                            radial_index(segment.well, 1, ratio), face.centre, f});
  }

  WellsParameters parameters_;
  bool widens_ = false;  // fractures do
  RCP<const mesh::Mesh> mesh_;
  Real size_ = 0;  // largest extent of the domain, m
  std::vector<Segment> segments_;
  std::vector<std::vector<LocalIndex>> cells_of_node_;
  std::vector<Connection> connections_;  // of this rank
  std::vector<Real> start_;              // [owned fracture face] widening at the start of the step; empty: none
  std::vector<Real> sums_;               // [well] sum of W over all ranks then
  std::array<int, 2> blocks_{};          // pressure, face pressure
  int widening_ = -1;
  std::array<Exchange, 2> exchange_;  // of wells with a pressure
  std::array<View<Real*>, 2> load_;   // [owned row] of wells with a rate, m^3/s
};

}  // namespace

std::unique_ptr<assembly::Module> make_wells(Shape shape, WellsParameters parameters) {
  return mesh::for_shape(shape, [&](auto s) -> std::unique_ptr<assembly::Module> {
    return std::make_unique<Wells<s()>>(std::move(parameters));
  });
}

}  // namespace sprekk::physics
