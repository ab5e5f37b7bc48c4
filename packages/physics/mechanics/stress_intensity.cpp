#include "physics/mechanics/stress_intensity.hpp"

#include "assembly/loop.hpp"
#include "assembly/system.hpp"
#include "assembly/tip_cell.hpp"
#include "base/check.hpp"
#include "base/entry_of_place.hpp"
#include "base/over_ranks.hpp"
#include "physics/mechanics/crossing.hpp"
#include "physics/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <unordered_map>

namespace sprekk::physics {

using front::Advance;
using front::Loads;
using front::Matrix;
using front::product;
using front::times;
using front::trace;
using front::values_of;
using front::virtual_fields;
using mesh::FrontPoint;
using mesh::Shape;
using mesh::Vector;
using mesh::operator+, mesh::operator-, mesh::operator*;

namespace {

template <Shape shape>
class StressIntensity final : public estimate::TableOfStates {
 public:
  static constexpr int dim = mesh::dimension(shape), n = mesh::n_nodes(shape), order = mesh::order(shape);
  using Cell = assembly::ReferenceCell<shape>;
  using Tip = assembly::TipCell<mesh::linear(shape)>;
  using Modes = std::array<Real, 3>;
  StressIntensity(const Setting& setting, assembly::System& system, std::vector<FrontPoint> fronts)
      : setting_(setting),
        mesh_(setting.mesh),
        system_(system),
        fronts_(std::move(fronts)),
        initial_(initial_stress(setting.scene, setting.mesh)),
        force_(body_force(setting.scene, setting.mesh)),
        loads_(setting, initial_) {
    const auto& blocks = system.blocks();
    for (std::size_t k = 0; k < names.size(); ++k)
      for (std::size_t b = 0; b < blocks.size(); ++b)
        if (blocks[b].name == names[k]) blocks_[k] = static_cast<int>(b);
    for (const auto& face : mesh_.fracture_faces)
      for (int k = 0; k < mesh::n_face_corners(shape); ++k)
        if (face.nodes[0][k] >= 0 && face.nodes[0][k] == face.nodes[1][k]) tips_.insert(face.nodes[0][k]);
    find_domains();
  }
  estimate::StateTable operator()(const estimate::State& state) const override {
    const Fields u(*this, state.x);
    const auto loads = loads_(state.outputs);
    const auto shift = means_of(loads);
    std::vector<Modes> sums(fronts_.size()), jumps(fronts_.size());
    std::vector<Real> roots(fronts_.size());
    const auto& local = *values_of(state.outputs, "jump");
    for (std::size_t p = 0; p < fronts_.size(); ++p) {
      for (const LocalIndex c : domains_[p].cells) add_cell(p, c, u, loads, shift[p], state.t, sums[p]);
      for (const LocalIndex f : domains_[p].faces) add_face(p, f, loads, shift[p], sums[p]);
      for (const std::size_t b : domains_[p].sides) add_side(p, mesh_.boundary_faces[b], u, loads, shift[p], sums[p]);
      for (const LocalIndex f : domains_[p].at_tip) add_jump(p, f, &local[f * dim], jumps[p], roots[p]);
    }
    if (!fronts_.empty()) {
      sums = base::sum_over_ranks(*mesh_.comm, sums);
      jumps = base::sum_over_ranks(*mesh_.comm, jumps);
      roots = base::sum_over_ranks(*mesh_.comm, roots);
    }
    return table(sums, jumps, roots, [&](std::size_t p, const Modes& K, const Vector& ahead) {
      return front::margin_of_crossing(setting_, fronts_[p], K, ahead, *values_of(state.outputs, "traction"),
                                       [&](LocalIndex c) { return in_cell(p, c, u, loads); });
    });
  }

 private:
  static constexpr std::array<const char*, 2> names = {"displacement", "tip displacement"};
  using Host = typename fields::Vector::dual_view_type::t_host::const_type;
  struct Domain {
    std::vector<LocalIndex> cells, faces, at_tip;  // owned; at_tip: fracture faces with the node as a corner
    std::vector<std::size_t> sides;                // owned boundary faces
  };

  /// Fields of the displacement with ghosts, without face bubbles.
  struct Fields {
    std::vector<fields::Vector> vectors;
    std::array<Host, names.size()> values;
    Fields(const StressIntensity& of, const fields::BlockVector& x) {
      vectors.reserve(names.size());
      for (std::size_t k = 0; k < names.size(); ++k) {
        const auto& layout = of.system_.layouts()[std::max(of.blocks_[k], 0)];
        vectors.emplace_back(layout.ghosted());
        if (of.blocks_[k] >= 0) vectors[k].doImport(*x[of.blocks_[k]], *layout.import(), Tpetra::REPLACE);
        values[k] = vectors[k].getLocalViewHost(Tpetra::Access::ReadOnly);
      }
    }
  };
  struct Point {
    Vector x{};
    Real volume;  // |det(dx/dxi)|
    Matrix H{};   // displacement gradient
  };
  void find_domains() {
    domains_.resize(fronts_.size());
    std::vector<std::pair<Vector, Real>> balls;  // around owned cells
    for (LocalIndex c = 0; c < mesh_.n_owned_cells; ++c) {
      const Vector centre = mesh::cell_centre(mesh_, c);
      Real size = 0;
      for (int a = 0; a < mesh::n_corners(shape); ++a) size = std::max(size, mesh::norm(node(c, a) - centre));
      balls.push_back({centre, size});
    }
    for (std::size_t p = 0; p < fronts_.size(); ++p) {
      const auto& front = fronts_[p];
      auto& domain = domains_[p];
      for (LocalIndex f = 0; f < mesh_.n_owned_fracture_faces; ++f) {
        const auto& face = mesh_.fracture_faces[f];
        if (face.single != front.single) continue;
        for (int k = 0; k < mesh::n_face_corners(shape); ++k)
          if (face.nodes[0][k] == face.nodes[1][k] && mesh_.node_id[face.nodes[0][k]] == front.node)
            domain.at_tip.push_back(f);
        if (is_near(front, mesh::face_corners(mesh_, face.cell[0], face.local_face[0]))) domain.faces.push_back(f);
      }
      if (front.radius == 0) continue;
      for (LocalIndex c = 0; c < mesh_.n_owned_cells; ++c)
        if (mesh::norm(balls[c].first - front.x) < front.radius + balls[c].second) domain.cells.push_back(c);
      for (std::size_t b = 0; b < mesh_.boundary_faces.size() && dim == 3; ++b)
        if (const auto& face = mesh_.boundary_faces[b];
            face.owned && is_near(front, mesh::face_corners(mesh_, face.cell, face.local_face)))
          domain.sides.push_back(b);
    }
    if constexpr (order == 1)
      for (const auto& domain : domains_)
        for (const LocalIndex c : domain.cells)
          if (assembly::has_tip(mesh_, c)) tip_cells_.try_emplace(c, mesh_, c);
  }
  static bool is_near(const FrontPoint& front, const mesh::FaceCorners& corners) {
    const Vector centre = mesh::face_centre(corners);
    Real size = 0;
    for (int k = 0; k < corners.n; ++k) size = std::max(size, mesh::norm(corners.x[k] - centre));
    return mesh::norm(centre - front.x) < front.radius + size;
  }

  Vector node(LocalIndex c, int a) const {
    Vector x{};
    std::copy_n(&mesh_.coordinates[mesh_.cells[c * n + a] * dim], dim, x.begin());
    return x;
  }

  /// Displacement gradient at a reference point.
  Point at(LocalIndex c, const Real (&xi)[dim], const Fields& u) const {
    Real X[n][dim], N[n], dN[n][dim], g[dim];
    assembly::gather_host<shape>(mesh_, c, X);
    Cell::shape_functions(xi, N);
    Cell::gradients(xi, dN);
    const assembly::CellPoint<shape> map(X, dN);
    Point point;
    point.volume = map.volume;
    const auto add = [&](const Host& values, LocalIndex first) {
      for (int i = 0; i < dim; ++i)
        for (int j = 0; j < dim; ++j) point.H[i][j] += values(first + i, 0) * g[j];
    };
    for (int a = 0; a < n; ++a) {
      map.gradient(dN[a], g);
      add(u.values[0], mesh_.free_node(mesh_.cells[c * n + a]) * dim);
      for (int i = 0; i < dim; ++i) point.x[i] += N[a] * X[a][i];
    }
    if constexpr (order == 1)
      if (const auto found = tip_cells_.find(c); found != tip_cells_.end()) {
        typename Tip::Values v;
        found->second.at(xi, v);
        for (int a = 0; a < n; ++a)
          if (const LocalIndex q = mesh_.enriched[mesh_.cells[c * n + a]]; q >= 0) {
            std::copy_n(v.grad_psi[a], dim, g);
            add(u.values[1], q * dim);
          }
      }
    return point;
  }

  /// Calls visit(xi, weight) at reference points of a rule for the crack fields of a front point.
  template <class Visit>
  void for_each_point(const FrontPoint& front, LocalIndex c, const Visit& visit) const {
    Real xi[dim];
    const auto visit_all = [&](const auto& rule) {
      for (int q = 0; q < rule.n; ++q) {
        const Real weight = rule.at(q, xi);
        visit(xi, weight);
      }
    };
    if constexpr (order == 2) {
      Real X[n][dim];
      assembly::gather_host<shape>(mesh_, c, X);
      assembly::with_rule<shape, assembly::Quadrature<shape, 4>>(X, visit_all);
    } else {
      std::vector<char> tips(n);
      Real nearest = std::numeric_limits<Real>::max(), size = 0;
      for (int a = 0; a < n; ++a) {
        tips[a] = tips_.count(mesh_.cells[c * n + a]) > 0;
        nearest = std::min(nearest, mesh::norm(node(c, a) - front.x));
        size = std::max(size, mesh::norm(node(c, a) - node(c, 0)));
      }
      const auto n_tips = std::count(tips.begin(), tips.end(), 1);
      if (n_tips > 0 && n_tips < n) {
        for (const auto& point : rules_.of(shape, tips, dim == 2 ? 6 : 5)) {
          std::copy_n(point.xi.begin(), dim, xi);
          visit(xi, point.weight);
        }
      } else if (nearest < 2 * size) {
        visit_all(assembly::Quadrature<shape, 4>());
      } else {
        visit_all(assembly::Quadrature<shape, 2>());
      }
    }
  }

  /// F + div sigma_0 at a point, N/m^3. The divergence is that of central differences.
  Vector body(LocalIndex c, const Vector& x, Real t) const {
    Vector f{};
    for (int i = 0; i < dim && !force_.empty(); ++i) f[i] = force_(i, c, x, t);
    if (initial_.empty()) return f;
    const auto& components = initial_.of_cell(mesh_, c);
    if (std::all_of(components.begin(), components.end(), [](const auto& one) { return one.is_constant(); })) return f;
    const Real step = 1e-3 * mesh::norm(node(c, 1) - node(c, 0));
    for (int j = 0; j < dim; ++j)
      for (const int sign : {-1, 1}) {
        Vector there = x;
        there[j] += sign * step;
        Real sigma[dim][dim];
        initial_.at(mesh_, c, there, sigma);
        for (int i = 0; i < dim; ++i) f[i] += sign * sigma[i][j] / (2 * step);
      }
    return f;
  }

  void add_cell(std::size_t p, LocalIndex c, const Fields& u, const Loads& loads, Real shift, Real t,
                Modes& sum) const {
    const auto& front = fronts_[p];
    const Real e = loads.isotropic.empty() ? 0 : loads.isotropic[c] - shift;
    for_each_point(front, c, [&](const Real(&xi)[dim], Real reference) {
      const Point point = at(c, xi, u);
      const Advance advance(front, point.x);
      if (advance.weight == 0) return;
      const Real volume = reference * point.volume, growth = trace(advance.dq);
      const Matrix s = front::stress(front::rock_at(front), point.H);
      const Vector along = times(point.H, advance.q), f = body(c, point.x, t);
      const auto modes = virtual_fields(front, advance.local);
      for (int m = 0; m < dim; ++m) {
        const auto& v = modes[m];
        Real value = mesh::dot(v.force, along) - product(s, v.H) * growth - mesh::dot(f, times(v.H, advance.q)) +
                     e * advance.weight * v.slope;
        for (int k = 0; k < 3; ++k)
          for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i)
              value += ((s[i][j] + (i == j ? e : 0)) * v.H[i][k] + v.stress[i][j] * point.H[i][k]) * advance.dq[k][j];
        sum[m] += volume * value;
      }
    });
  }

  /// Calls visit(area, x) at points of a fracture face, for functions with an inverse square root at its tips.
  template <class Visit>
  void for_each_face_point(const mesh::Mesh::FractureFace& face, const Visit& visit) const {
    const LocalIndex c = face.cell[mesh::minus];
    const int local_face = face.local_face[mesh::minus];
    const auto corners = mesh::face_corners(mesh_, c, local_face);
    std::vector<char> tips;
    for (int k = 0; k < corners.n; ++k)
      tips.push_back(tips_.count(mesh_.cells[c * n + mesh::face_nodes(shape)[local_face][k]]) > 0);
    const auto n_tips = std::count(tips.begin(), tips.end(), 1);
    if (order == 2 || n_tips == 0 || n_tips == corners.n)
      return assembly::for_each_face_point(mesh_, c, local_face,
                                           [&](const auto&, Real area, const auto& x) { visit(area, x); });
    const auto& rule = dim == 2 ? rules_.of_edge(tips, 6) : rules_.of(mesh::face_shape(shape), tips, 6);
    Real whole = 0;
    for (const auto& point : rule) whole += point.weight;
    for (const auto& point : rule) visit(point.weight / whole * face.area, mesh::place(corners, point.xi));
  }

  void add_face(std::size_t p, LocalIndex f, const Loads& loads, Real shift, Modes& sum) const {
    const auto& front = fronts_[p];
    const auto& face = mesh_.fracture_faces[f];
    const Real sign = mesh::dot(face.frame[0], front.normal) > 0 ? 1 : -1;
    const Vector t = sign * (loads.traction[f] - shift * face.frame[0]);
    for_each_face_point(face, [&](Real area, const Vector& x) {
      const Advance advance(front, x);
      const Real r = front.distance(x);
      if (advance.weight == 0 || !(r > 0)) return;
      const Vector axes[] = {front.normal, advance.local.ahead, advance.local.along};
      for (int m = 0; m < dim; ++m)
        sum[m] += area * advance.weight * mesh::dot(t, axes[m]) * laws::jump_of_slope(front::rock_at(front), m, r);
    });
  }

  /// Adds the flux through a side of the domain that the front meets.
  void add_side(std::size_t p, const mesh::Mesh::BoundaryFace& face, const Fields& u, const Loads& loads, Real shift,
                Modes& sum) const {
    const auto& front = fronts_[p];
    const auto corners = mesh::face_corners(mesh_, face.cell, face.local_face);
    Vector outward = mesh::area_vector(corners);
    outward = (1 / mesh::norm(outward)) * outward;
    const Real e = loads.isotropic.empty() ? 0 : loads.isotropic[face.cell] - shift;
    assembly::for_each_face_point(mesh_, face.cell, face.local_face, [&](const auto& N, Real area, const Vector& x) {
      const Advance advance(front, x);
      if (advance.weight == 0) return;
      Real xi[dim] = {};
      for (int k = 0; k < mesh::n_face_nodes(shape); ++k)
        for (int i = 0; i < dim; ++i) xi[i] += N[k] * reference_of(mesh::face_nodes(shape)[face.local_face][k], i);
      const Point point = at(face.cell, xi, u);
      const Matrix s = front::stress(front::rock_at(front), point.H);
      const Vector along = times(point.H, advance.q);
      const auto modes = virtual_fields(front, advance.local);
      for (int m = 0; m < dim; ++m) {
        const auto& v = modes[m];
        sum[m] -= area * (mesh::dot(times(s, outward) + e * outward, times(v.H, advance.q)) +
                          mesh::dot(times(v.stress, outward), along) - product(s, v.H) * mesh::dot(advance.q, outward));
      }
    });
  }
  /// Component i of the reference position of a node. Nodes of order 2 lie between their corners.
  static Real reference_of(int a, int i) {
    if (a < mesh::n_corners(shape)) return Cell::corner(a, i);
    Real x = 0;
    for (int c = 0; c < mesh::n_corners(shape); ++c) x += Cell::corner_share(a, c) * Cell::corner(c, i);
    return x;
  }

  /// Adds integrals of the jump and of the square root of the distance from the front over a face at the front.
  void add_jump(std::size_t p, LocalIndex f, const Real* jump, Modes& sum, Real& root) const {
    const auto& front = fronts_[p];
    const auto& face = mesh_.fracture_faces[f];
    const Real sign = mesh::dot(face.frame[0], front.normal) > 0 ? 1 : -1;
    Vector w{};
    for (int i = 0; i < dim; ++i) w[i] = sign * jump[i];
    const Vector axes[] = {front.normal, front.ahead, front.along};
    for (int m = 0; m < dim; ++m) sum[m] += face.area * mesh::dot(w, axes[m]);
    for_each_face_point(
        face, [&](Real area, const Vector& x) { root += area * std::sqrt(std::max(front.distance(x), 0.0)); });
  }

  /// Means of the isotropic stress over the cells at each front point.
  std::vector<Real> means_of(const Loads& loads) const {
    std::vector<Real> means(fronts_.size(), 0);
    if (!base::on_any_rank(*mesh_.comm, !loads.isotropic.empty()) || fronts_.empty()) return means;
    std::vector<std::array<Real, 2>> sums(fronts_.size());
    for (std::size_t p = 0; p < fronts_.size(); ++p)
      for (const LocalIndex c : domains_[p].cells)
        for (int a = 0; a < mesh::n_corners(shape); ++a)
          if (mesh_.node_id[mesh_.cells[c * n + a]] == fronts_[p].node)
            sums[p] = {sums[p][0] + loads.isotropic[c], sums[p][1] + 1};
    sums = base::sum_over_ranks(*mesh_.comm, sums);
    for (std::size_t p = 0; p < fronts_.size(); ++p) means[p] = sums[p][1] > 0 ? sums[p][0] / sums[p][1] : 0;
    return means;
  }

  /// Quantities in an owned cell beyond a fracture that a tip meets.
  front::InCell in_cell(std::size_t p, LocalIndex c, const Fields& u, const Loads& loads) const {
    Real xi[dim], sigma[dim][dim] = {};
    std::fill_n(xi, dim, Real(1) / 3);
    const Point point = at(c, xi, u);
    const auto& rock = setting_.scene.material_of(mesh_.region_names[mesh_.cell_region[c]]);
    Matrix s = front::stress(rock.elasticity(point.x), point.H);
    if (!initial_.empty()) initial_.at(mesh_, c, point.x, sigma);
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        s[i][j] += sigma[i][j] + (i == j && !loads.isotropic.empty() ? loads.isotropic[c] : 0);
    return {point.x, s, value_of(p, "strength", &Mechanics::Fracture::strength, point.x)};
  }
  /// Value of an entry of the fracture of a front point; NaN if it is not given.
  Real value_of(std::size_t p, const char* name, std::optional<base::Expression> Mechanics::Fracture::*entry,
                const Vector& x) const {
    const auto& fracture = mesh_.fracture_names[mesh_.single_fractures[fronts_[p].single].set];
    const auto& one = setting_.scene.fractures.at(fracture).*entry;
    const auto place = fmt::format("{}: Sprekk > Fractures > {}", setting_.scene.origin, fracture);
    return one ? base::value_at(place, name, *one, base::positive(), x) : std::nan("");
  }

  /// Returns K of all modes, Pa m^0.5.
  estimate::StateTable table(const std::vector<Modes>& sums, const std::vector<Modes>& jumps,
                             const std::vector<Real>& roots, const auto& crossing) const {
    estimate::StateTable table;
    const auto column = [&](const std::string& name, const char* unit, const auto& of) {
      auto& values = table.columns.emplace_back(estimate::StateTable::Column{name, unit}).values;
      for (std::size_t p = 0; p < fronts_.size(); ++p) values.push_back(of(p));
    };
    std::vector<Modes> K(fronts_.size()), near(fronts_.size());
    std::vector<Real> stiffness;
    for (std::size_t p = 0; p < fronts_.size(); ++p) {
      const auto& front = fronts_[p];
      const auto [G, lambda] = front::rock_at(front);
      stiffness.push_back(4 * G * (lambda + G) / (lambda + 2 * G));
      for (int m = 0; m < 3; ++m) {
        const Real whole = m < 2 ? stiffness[p] / 2 : G,
                   at_jump = std::sqrt(2 * M_PI) * (m < 2 ? stiffness[p] / 8 : G / 4);
        K[p][m] = front.radius > 0 ? sums[p][m] * whole / front.length : std::nan("");
        near[p][m] = roots[p] > 0 ? at_jump * jumps[p][m] / roots[p] : std::nan("");
      }
      table.fractures.push_back(front.single);
    }
    constexpr const char *unit = "Pa*m^0.5", *modes[] = {"K_I", "K_II", "K_III"};
    column("tip", "-", [&](auto p) { return Real(fronts_[p].node); });
    for (int i = 0; i < dim; ++i) column(std::string(1, "xyz"[i]), "m", [&](auto p) { return fronts_[p].x[i]; });
    for (int m = 0; m < dim; ++m) {
      column(modes[m], unit, [&](auto p) { return K[p][m]; });
      column(std::string(modes[m]) + "_of_jump", unit, [&](auto p) { return near[p][m]; });
    }
    column("G", "N/m", [&](auto p) {
      const auto& k = K[p];
      return (k[0] * k[0] + k[1] * k[1]) / stiffness[p] +
             (dim == 3 ? k[2] * k[2] / (2 * front::rock_at(fronts_[p]).G) : 0);
    });
    column("error", unit, [&](auto p) {
      Real square = 0;
      for (int m = 0; m < dim; ++m) square += (K[p][m] - near[p][m]) * (K[p][m] - near[p][m]);
      return std::sqrt(square);
    });
    column("radius", "m", [&](auto p) { return fronts_[p].radius; });
    const auto any = [&](auto entry) {
      const auto& all = setting_.scene.fractures;
      return std::any_of(all.begin(), all.end(), [&](auto& one) { return (one.second.*entry).has_value(); });
    };
    if (dim == 3 || !any(&Mechanics::Fracture::toughness)) return table;
    const auto kink = [&](auto p) { return laws::largest_hoop(K[p][0], K[p][1]); };
    const auto ahead = [&](auto p) {
      return std::cos(kink(p).angle) * fronts_[p].ahead + std::sin(kink(p).angle) * fronts_[p].normal;
    };
    column("K_hoop", unit, [&](auto p) { return kink(p).intensity; });
    column("toughness", unit,
           [&](auto p) { return value_of(p, "toughness", &Mechanics::Fracture::toughness, fronts_[p].x); });
    for (int i = 0; i < 2; ++i) column(i == 0 ? "kink_x" : "kink_y", "-", [&](auto p) { return ahead(p)[i]; });
    if (any(&Mechanics::Fracture::strength))
      column("crossing", "-", [&](auto p) {
        const bool has_it =
            fronts_[p].radius > 0 && !std::isnan(value_of(p, "strength", &Mechanics::Fracture::strength, fronts_[p].x));
        return has_it ? crossing(p, K[p], ahead(p)) : std::nan("");
      });
    return table;
  }

  Setting setting_;
  const mesh::Mesh& mesh_;
  assembly::System& system_;
  std::vector<FrontPoint> fronts_;
  InitialStress initial_;
  BodyForce force_;
  front::LoadsOfStates loads_;
  std::array<int, 2> blocks_{-1, -1};
  std::set<LocalIndex> tips_;  // local nodes where a fracture ends
  std::unordered_map<LocalIndex, Tip> tip_cells_;
  std::vector<Domain> domains_;  // [front point]
  mutable assembly::TipRules rules_;
};

}  // namespace

std::unique_ptr<estimate::TableOfStates> make_stress_intensity(const Setting& setting, assembly::System& system) {
  const auto& [scene, mesh, start] = setting;
  std::vector<char> requested;
  for (const auto& name : mesh.fracture_names)
    requested.push_back(scene.fractures.at(name).stress_intensity || scene.fractures.at(name).toughness);
  if (std::count(requested.begin(), requested.end(), 1) == 0) return nullptr;
  const auto fail_if = [&, &scene = scene](bool fails, const char* why) {
    SPREKK_CHECK(!fails, "{}: Sprekk > Fractures: \"stress intensity\" {}", scene.origin, why);
  };
  fail_if(base::any_rank(*mesh.comm, [&, &mesh = mesh] { return !mesh.tied_to.empty(); }),
          "is not available with periodic boundaries");
  fail_if(scene.keeps_stress, "is not available after changes of elastic constants or a backfill");
  const bool regions_differ = std::any_of(scene.regions.begin(), scene.regions.end(),
                                          [](const auto& region) { return !region.second.initial_stress.empty(); });
  const auto rock = elasticity(scene, mesh);
  auto fronts = mesh::find_fronts(mesh, requested, [&, &mesh = mesh](LocalIndex c) {
    return front::constants(rock.of_cell(mesh, c), regions_differ ? mesh.cell_region[c] : 0);
  });
  return mesh::for_shape(mesh.shape, [&](auto shape) -> std::unique_ptr<estimate::TableOfStates> {
    return std::make_unique<StressIntensity<shape()>>(setting, system, std::move(fronts));
  });
}

std::string Mechanics::Tables::name() { return "stress intensity"; }

std::unique_ptr<estimate::TableOfStates> Mechanics::Tables::table(const Setting& setting, assembly::System& system) {
  return is_in(setting.scene) ? make_stress_intensity(setting, system) : nullptr;
}

}  // namespace sprekk::physics
