#include "physics/hybrid_error.hpp"

#include "assembly/geometry.hpp"
#include "base/check.hpp"
#include "base/over_ranks.hpp"
#include "mesh/facets.hpp"
#include "physics/flow/face_plane.hpp"
#include "physics/simplex_flux.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>
#include <utility>

namespace sprekk::physics {

namespace {

using HostVector = fields::Vector::dual_view_type::t_host::const_type;

/// Sums over all ranks at numbered places.
class Places {
 public:
  int add(GlobalIndex id) {
    const auto [found, is_new] = number_.emplace(id, static_cast<int>(ids_.size()));
    if (is_new) ids_.push_back(id);
    return found->second;
  }
  /// Once all are added. Collective.
  void close(const RCP<const Comm>& comm) {
    const auto unknown = Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid();
    map_ =
        rcp(new const fields::Map(unknown, Teuchos::ArrayView<const GlobalIndex>(ids_.data(), ids_.size()), 0, comm));
    import_ = rcp(new const fields::Import(Tpetra::createOneToOne(map_), map_));
  }
  std::size_t size() const { return ids_.size(); }
  GlobalIndex id(int place) const { return ids_[place]; }

  /// Collective.
  template <std::size_t m>
  void sum_over_ranks(std::vector<std::array<Real, m>>& values) const {
    fields::MultiVector here(map_, m), unique(import_->getSourceMap(), m);
    const auto copy = [&](const auto& one) {
      const auto view = here.getLocalViewHost(Tpetra::Access::ReadWrite);
      for (std::size_t p = 0; p < values.size(); ++p)
        for (std::size_t k = 0; k < m; ++k) one(values[p][k], view(p, k));
    };
    copy([](Real& value, Real& entry) { entry = value; });
    unique.doExport(here, *import_, Tpetra::ADD);
    here.doImport(unique, *import_, Tpetra::REPLACE);
    copy([](Real& value, Real& entry) { value = entry; });
  }

 private:
  std::unordered_map<GlobalIndex, int> number_;
  std::vector<GlobalIndex> ids_;
  RCP<const fields::Map> map_;
  RCP<const fields::Import> import_;
};

/// (e - 1)/c.
Real potential_of(const laws::Fluid& fluid, Real p) {
  const Real c = fluid.compressibility;
  return c == 0 ? p : std::expm1(c * (p - fluid.reference_pressure)) / c;
}

/// Potentials of a state, or what they change by in an answer to small forces. Those of a compressible fluid are
/// (e - 1)/c, of which the flux of mass is the gradient.
class Potentials {
 public:
  using Layouts = std::array<const fields::Layout*, 2>;
  enum Of { cell, facet };

  /// Collective.
  Potentials(const Layouts& layouts, const laws::Fluid& fluid, const std::array<const fields::Vector*, 2>& p,
             const std::array<const fields::Vector*, 2>& dp = {})
      : fluid_(fluid), is_answer_(dp[0]) {
    for (int k = 0; k < 2; ++k) {
      p_[k] = with_ghosts(*layouts[k], *p[k]);
      if (is_answer_) dp_[k] = with_ghosts(*layouts[k], *dp[k]);
    }
  }

  bool is_answer() const { return is_answer_; }
  Real operator()(Of of, LocalIndex i) const {
    return is_answer_ ? fluid_.density(p_[of][i]) * dp_[of][i] : of_pressure(p_[of][i]);
  }
  Real of_pressure(Real p) const { return potential_of(fluid_, p); }
  /// What drives a flow from an entity to one of its ends, see laws::Fluid.
  Real drop(Of of, LocalIndex entity, LocalIndex end, Real lift) const {
    const Real a = p_[of][entity], b = p_[facet][end];
    if (!is_answer_) return fluid_.drop(a, b, lift);
    return fluid_.ddrop_da(a, b, lift) * dp_[of][entity] + fluid_.ddrop_db(a, b, lift) * dp_[facet][end];
  }
  /// The fluid's weight in the gradient, over rho_0 g: e^2.
  Real heaviness(Of of, LocalIndex i) const {
    const Real e = fluid_.density(p_[of][i]);
    return e * e * (is_answer_ ? 2 * fluid_.compressibility * dp_[of][i] : 1);
  }

 private:
  static std::vector<Real> with_ghosts(const fields::Layout& layout, const fields::Vector& owned) {
    fields::Vector all(layout.ghosted());
    all.doImport(owned, *layout.import(), Tpetra::REPLACE);
    const auto view = all.getLocalViewHost(Tpetra::Access::ReadOnly);
    return {view.data(), view.data() + view.extent(0)};
  }

  laws::Fluid fluid_;
  bool is_answer_;
  std::array<std::vector<Real>, 2> p_, dp_;
};

template <Shape shape>
class Error final : public HybridError {
 public:
  static constexpr int dim = mesh::dimension(shape), n = dim + 1;
  using InCell = SimplexFlux<dim>;
  using InFace = SimplexFlux<dim - 1>;

  Error(RCP<const mesh::Mesh> mesh, const fields::Layout& cells, const fields::Layout& facets,
        ConstView<char*> held_facets, HybridErrorParameters parameters)
      : mesh_(mesh), layouts_{&cells, &facets}, parameters_(std::move(parameters)) {
    find_cells();
    find_faces();
    find_sides();
    join_places();
    n_of_energy_ = cell_of_component_.size();
    for (LocalIndex f = 0; dim == 2 && f < mesh_->n_owned_fracture_faces; ++f)
      cell_of_component_.insert(cell_of_component_.end(), parameters_.fed.count(f) ? 3 : 1,
                                mesh_->fracture_faces[f].cell[mesh::minus]);
    find_held(held_facets);
    places_.close(mesh_->comm);
    find_stiffness();
    find_before();
    for (LocalIndex c = 0; varies() && c < mesh_->n_owned_cells; ++c)
      cell_of_component_.insert(cell_of_component_.end(), n, c);
  }

  const std::vector<LocalIndex>& cells() const override { return cell_of_component_; }
  std::size_t n_of_energy() const override { return n_of_energy_; }

  MeshError::Parts of_state(const fields::Vector& cells, const fields::Vector& facets, Real t) override {
    auto [result, s] = parts(Potentials(layouts_, parameters_.rock.fluid, {&cells, &facets}), t);
    if (varies()) add_rates(s, t, result);
    return result;
  }
  MeshError::Parts of_answer(const fields::Vector& cells, const fields::Vector& facets, const fields::Vector& d_cells,
                             const fields::Vector& d_facets) const override {
    auto [result, s] = parts(Potentials(layouts_, parameters_.rock.fluid, {&cells, &facets}, {&d_cells, &d_facets}), 0);
    for (LocalIndex c = 0; varies() && c < mesh_->n_owned_cells; ++c)
      for (const Real one : variation(c, s)) result.error.push_back(one);
    result.whole.resize(result.error.size(), 0);
    return result;
  }

 private:
  using Of = Potentials::Of;
  using Numbers = std::vector<std::array<Real, 1>>;
  static constexpr int n_sweeps = 5;

  struct Cell {
    InCell flux;
    CellFaces<shape> faces;
    std::array<int, InCell::n_places> place;
    Real weight;  // in means: mobility times size^(dim - 2)
  };
  /// An owned fracture face.
  struct Face {
    InFace flux;
    FacePlane<shape> plane;
    std::array<int, InFace::n_places> place;
    Real weight;
  };
  /// A side of a fracture face in an owned cell.
  struct Side {
    LocalIndex face, cell;
    int local_face;
    std::array<int, dim> corner;                         // of the cell, by those of the face
    std::array<int, InFace::n_places> of_cell, of_face;  // places, by those of the face
    Real resistance;                                     // R, Pa s/m; 0: none
    Real spring;                                         // area / R
  };
  /// A place where a potential is prescribed.
  struct HeldPlace {
    int place, condition;
    mesh::Vector x;
    LocalIndex facet;
    Real share;  // in the mean over its face
  };
  /// A face of a cell, or the end of a fracture face, with places held_[begin] to held_[end - 1].
  struct HeldFace {
    bool in_rock;
    LocalIndex entity;  // cell or fracture face
    int opposite;
    std::size_t begin, end;
  };

  /// The corner opposite to a face of a cell, or to a ridge of a face.
  static constexpr int opposite(int face) { return dim == 2 ? (face + 2) % 3 : face; }
  static constexpr int opposite_ridge(int ridge) { return dim == 2 ? 1 - ridge : (ridge + 2) % 3; }

  Real exchange(LocalIndex f) const {
    return parameters_.rock.exchange.empty() ? INFINITY : parameters_.rock.exchange[f];
  }
  LocalIndex node(LocalIndex cell, int k) const { return mesh_->cells[cell * mesh_->nodes_per_cell() + k]; }

  /// Numbers of places: nodes of the rock; middles of its edges, by their nodes; points of fractures; middles of their
  /// edges; in 2D, where nodes do not tell the two sides of a fracture apart, middles of sides.
  GlobalIndex rock_place(GlobalIndex a, GlobalIndex b) const {
    return a == b ? a : mesh_->n_global_nodes * (1 + std::min(a, b)) + std::max(a, b);
  }
  GlobalIndex first_of_fractures() const { return mesh_->n_global_nodes * (1 + mesh_->n_global_nodes); }
  GlobalIndex fracture_place(GlobalIndex a, GlobalIndex b) const { return first_of_fractures() + rock_place(a, b); }
  GlobalIndex side_place(GlobalIndex face, int side) const { return 2 * first_of_fractures() + 2 * face + side; }

  void find_cells() {
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c) {
      Real X[mesh::n_nodes(shape)][dim], corners[n][dim];
      assembly::gather_host<shape>(*mesh_, c, X);
      for (int k = 0; k < n; ++k) std::copy_n(X[k], dim, corners[k]);
      const auto& mobility = parameters_.rock.mobility.of_cell(*mesh_, c);
      Cell cell{InCell(corners, mobility), CellFaces<shape>(X), {}, 0};
      cell.weight = mobility.template trace<dim>() / dim * std::pow(cell.flux.volume(), 1 - 2.0 / dim);
      for (int a = 0; a < n; ++a)
        for (int b = a; b < n; ++b) cell.place[InCell::place(a, b)] = place_between(c, a, b);
      cells_.push_back(cell);
      cell_of_component_.insert(cell_of_component_.end(), InCell::n_components, c);
    }
  }
  /// The place between two corners of a cell.
  int place_between(LocalIndex c, int a, int b) {
    const auto id = [&](int k) { return mesh_->node_id[mesh_->free_node(node(c, k))]; };
    return places_.add(rock_place(id(a), id(b)));
  }

  std::array<int, InFace::n_places> places_of_face(LocalIndex f) {
    const auto& corners = mesh_->fracture_faces[f].corners;
    std::array<int, InFace::n_places> place{};
    for (int a = 0; a < dim; ++a)
      for (int b = a; b < dim; ++b) place[InFace::place(a, b)] = places_.add(fracture_place(corners[a], corners[b]));
    return place;
  }

  void find_faces() {
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) {
      const auto& face = mesh_->fracture_faces[f];
      const Real T = parameters_.transmissivity[f];
      Real X[dim][dim - 1];
      for (int k = 0; k < dim; ++k)
        for (int t = 0; t < dim - 1; ++t) {
          X[k][t] = 0;
          for (int i = 0; i < dim; ++i)
            X[k][t] += face.frame[1 + t][i] * mesh_->coordinates[face.nodes[mesh::minus][k] * dim + i];
        }
      faces_.push_back({InFace(X, laws::Mobility::isotropic(T)),
                        FacePlane<shape>(*mesh_, f, T, parameters_.rock.scheme), places_of_face(f),
                        T * std::pow(face.area, 1 - 2.0 / (dim - 1))});
      cell_of_component_.insert(cell_of_component_.end(), InFace::n_components, face.cell[mesh::minus]);
    }
  }

  void find_sides() {
    for (const auto& [f, s] : assembly::fracture_sides(*mesh_)) {
      const auto& face = mesh_->fracture_faces[f];
      const LocalIndex c = face.cell[s];
      if (c >= mesh_->n_owned_cells) continue;
      Side side{f, c, face.local_face[s], {}, {}, places_of_face(f), 1 / exchange(f), face.area * exchange(f)};
      for (int k = 0; k < dim; ++k)
        for (int a = 0; a < n; ++a)
          if (node(c, a) == face.nodes[s][k]) side.corner[k] = a;
      if (dim == 2)
        cells_[c].place[InCell::place(side.corner[0], side.corner[1])] = places_.add(side_place(face.id, s));
      sides_.push_back(side);
      if (side.resistance == 0) continue;
      resistance_[c * n + side.local_face] = side.resistance / face.area;
      cell_of_component_.insert(cell_of_component_.end(), n_face_points, c);
    }
  }

  /// Where nothing resists, rock has the places of the fracture. Any cell may touch these with a corner, so all ranks
  /// are told.
  void join_places() {
    std::vector<GlobalIndex> joined;  // place of the rock, of the fracture
    const auto for_each_pair = [](const auto& visit) {
      for (int a = 0; a < dim; ++a)
        for (int b = a; b < dim; ++b) visit(a, b, InFace::place(a, b));
    };
    for (const auto& side : sides_)
      for_each_pair([&](int a, int b, int k) {
        if (side.resistance > 0) return;
        const int in_cell = cells_[side.cell].place[InCell::place(side.corner[a], side.corner[b])];
        joined.insert(joined.end(), {places_.id(in_cell), places_.id(side.of_face[k])});
      });
    joined = base::gather_over_ranks(*mesh_->comm, joined);
    std::unordered_map<GlobalIndex, GlobalIndex> of_fracture;
    for (std::size_t k = 0; k < joined.size(); k += 2) of_fracture[joined[k]] = joined[k + 1];
    for (auto& cell : cells_)
      for (int& place : cell.place)
        if (const auto found = of_fracture.find(places_.id(place)); found != of_fracture.end())
          place = places_.add(found->second);
    for (auto& side : sides_)
      for_each_pair([&](int a, int b, int k) {
        side.of_cell[k] = cells_[side.cell].place[InCell::place(side.corner[a], side.corner[b])];
      });
  }

  /// Sums of the sizes of second derivatives of half of the energy, by places: at least as large as any of its
  /// curvatures, over values at places that are scaled by them.
  void find_stiffness() {
    Numbers sums(places_.size());
    const auto add = [&](const auto& entity) {
      const auto of = entity.flux.gradients();
      for (std::size_t i = 0; i < of.size(); ++i)
        for (std::size_t j = 0; j < of.size(); ++j) sums[entity.place[i]][0] += std::abs(product(of[i], of[j]));
    };
    for (const auto& cell : cells_) add(cell);
    for (const auto& face : faces_) add(face);
    for_each_point_of_sides([&](const Side& side, Real spring, const auto& N) {
      Real all = 0;
      for (const Real value : N) all += 2 * std::abs(value);
      for (std::size_t k = 0; k < N.size(); ++k)
        for (const int place : {side.of_cell[k], side.of_face[k]}) sums[place][0] += spring * std::abs(N[k]) * all;
    });
    places_.sum_over_ranks(sums);
    stiffness_ = std::move(sums);
  }

  template <std::size_t m>
  static Real product(const std::array<Real, m>& a, const std::array<Real, m>& b) {
    Real sum = 0;
    for (std::size_t k = 0; k < m; ++k) sum += a[k] * b[k];
    return sum;
  }

  /// Calls visit(side, what an area of the point stands for over R, shape functions) on sides that resist.
  template <class Visit>
  void for_each_point_of_sides(const Visit& visit) const {
    for (const auto& side : sides_)
      for (int p = 0; side.resistance > 0 && p < n_face_points; ++p) {
        std::array<Real, dim> l{};
        const Real share = face_point(p, l);
        visit(side, share * side.spring, InFace::shapes(l));
      }
  }

  void find_held(ConstView<char*> held_facets) {
    std::vector<Real> held;
    {
      fields::Vector owned(layouts_[1]->owned()), all(layouts_[1]->ghosted());
      {
        const auto mask = Kokkos::create_mirror_view_and_copy(Kokkos::HostSpace(), held_facets);
        const auto to = owned.getLocalViewHost(Tpetra::Access::OverwriteAll);
        for (std::size_t k = 0; k < mask.extent(0); ++k) to(k, 0) = mask(k);
      }
      all.doImport(owned, *layouts_[1]->import(), Tpetra::REPLACE);
      const auto from = all.getLocalViewHost(Tpetra::Access::ReadOnly);
      held.assign(from.data(), from.data() + from.extent(0));
    }
    const auto x_of = [&](LocalIndex a, LocalIndex b) {
      mesh::Vector x{};
      for (int i = 0; i < dim; ++i) x[i] = (mesh_->coordinates[a * dim + i] + mesh_->coordinates[b * dim + i]) / 2;
      return x;
    };
    const auto& nodes_of = mesh::face_nodes(shape);
    for (const auto& face : mesh_->boundary_faces) {
      const LocalIndex facet = mesh_->facets->of_cell[face.cell * n + face.local_face];
      if (!face.owned || held[facet] == 0) continue;
      const int condition = condition_of(face.boundary, mesh_->cell_region[face.cell], -1);
      const auto begin = held_.size();
      for (int a = 0; a < dim; ++a)
        for (int b = a; b < dim; ++b) {
          const int k = nodes_of[face.local_face][a], l = nodes_of[face.local_face][b];
          held_.push_back({cells_[face.cell].place[InCell::place(k, l)], condition,
                           x_of(node(face.cell, k), node(face.cell, l)), facet, a == b ? at_corner : at_middle});
        }
      add_held_face({true, face.cell, opposite(face.local_face), begin, held_.size()});
    }
    std::map<std::pair<LocalIndex, int>, int> conditions;  // of ends, of which several boundaries may have one
    for (const auto& rim : mesh_->facets->rims) {
      const LocalIndex facet = mesh_->facets->ridge[rim.face * dim + rim.ridge];
      if (rim.face >= mesh_->n_owned_fracture_faces || held[facet] == 0) continue;
      const int condition = condition_of(rim.boundary, -1, mesh_->fracture_faces[rim.face].fracture);
      if (condition == static_cast<int>(parameters_.held.size())) continue;  // something else holds it
      const auto [known, is_new] = conditions.emplace(std::pair(rim.face, rim.ridge), condition);
      if (!is_new) known->second = std::min(known->second, condition);
    }
    for (const auto& [end, condition] : conditions) {
      const auto [f, ridge] = end;
      const auto& face = mesh_->fracture_faces[f];
      const LocalIndex facet = mesh_->facets->ridge[f * dim + ridge];
      const int last = dim == 2 ? ridge : (ridge + 1) % 3;
      const auto begin = held_.size();
      for (const auto& [a, b] : {std::pair(ridge, ridge), std::pair(ridge, last), std::pair(last, last)})
        held_.push_back({faces_[f].place[InFace::place(a, b)], condition,
                         x_of(face.nodes[mesh::minus][a], face.nodes[mesh::minus][b]), facet,
                         a == b ? 1.0 / 6 : 2.0 / 3});
      if (dim == 3) add_held_face({false, f, opposite_ridge(ridge), begin, held_.size()});
    }
  }
  void add_held_face(const HeldFace& face) {
    held_faces_.push_back(face);
    cell_of_component_.push_back(face.in_rock ? face.entity : mesh_->fracture_faces[face.entity].cell[mesh::minus]);
  }
  /// The first that holds a face of the rock (fracture < 0), or the end of a fracture.
  int condition_of(int boundary, int region, int fracture) const {
    const auto& all = parameters_.held;
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& one) {
      if (one.boundary != boundary) return false;
      return fracture < 0 ? one.fracture < 0 && (one.region < 0 || one.region == region)
                          : one.region < 0 && (one.fracture < 0 || one.fracture == fracture);
    });
    return static_cast<int>(found - all.begin());
  }

  typename InCell::Flows flows_of_cell(LocalIndex c, const Potentials& u) const {
    const auto& cell = cells_[c];
    FlowMatrix<shape> matrix(cell.faces, parameters_.rock.mobility.of_cell(*mesh_, c), parameters_.rock.scheme);
    for (int k = 0; k < n; ++k)
      if (const auto found = resistance_.find(c * n + k); found != resistance_.end())
        add_resistance(matrix.T, k, found->second);
    typename InCell::Flows q{};
    for (int k = 0; k < n; ++k) {
      Real lift = 0;
      for (int i = 0; i < dim; ++i) lift += parameters_.rock.weight[i] * cell.faces.centre[k][i];
      const Real drop = u.drop(Of::cell, c, mesh_->facets->of_cell[c * n + k], lift);
      for (int l = 0; l < n; ++l) q[opposite(l)] += matrix.T[l][k] * drop;
    }
    return q;
  }
  typename InFace::Flows flows_of_face(LocalIndex f, const Potentials& u) const {
    const auto& plane = faces_[f].plane;
    typename InFace::Flows q{};
    for (int k = 0; k < dim; ++k) {
      Real lift = 0;
      for (int i = 0; i < dim; ++i) lift += parameters_.rock.weight[i] * plane.d[k][i];
      const Real drop = u.drop(Of::facet, mesh_->facets->fracture_face[f], mesh_->facets->ridge[f * dim + k], lift);
      for (int l = 0; l < dim; ++l) q[opposite_ridge(l)] += plane.T[l][k] * drop;
    }
    return q;
  }

  /// Of SimplexFlux::flux().
  struct Components {
    std::vector<typename InCell::Components> in_cells;
    std::vector<typename InFace::Components> in_faces;
  };
  /// What adds up at a place.
  enum Sum { weight, weighted, held, held_values, springs, drops, sides, inflow, n_sums };
  using Sums = std::vector<std::array<Real, n_sums>>;

  /// Adds what an entity says of the potential at its places.
  template <class Entity, class AtPlaces>
  static void add(const Entity& entity, const AtPlaces& p, Sums& sums) {
    for (std::size_t k = 0; k < p.size(); ++k) {
      auto& sum = sums[entity.place[k]];
      sum[weight] += entity.weight;
      sum[weighted] += entity.weight * p[k];
    }
  }

  /// And s at all places.
  std::pair<MeshError::Parts, std::vector<Real>> parts(const Potentials& u, Real t) const {
    Sums sums(places_.size());
    std::vector<typename InCell::Flows> in_cells;
    std::vector<typename InFace::Flows> in_faces;
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c) {
      in_cells.push_back(flows_of_cell(c, u));
      add(cells_[c], cells_[c].flux.potential(in_cells.back(), u(Of::cell, c), weight_in_cell(c, u)), sums);
    }
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) {
      in_faces.push_back(flows_of_face(f, u));
      add(faces_[f],
          faces_[f].flux.potential(in_faces.back(), mean_in_face(f, in_faces.back(), u), weight_in_face(f, u)), sums);
    }
    for (const auto& side : sides_) {
      const Real q = in_cells[side.cell][opposite(side.local_face)], drop = side.resistance * q / area(side);
      for (std::size_t k = 0; side.resistance > 0 && k < side.of_cell.size(); ++k) {
        auto& sum = sums[side.of_cell[k]];
        ++sum[sides];
        sum[springs] += side.spring;
        sum[drops] += side.spring * drop;
      }
      sums[side.of_face.back()][inflow] += q;
    }
    std::vector<Real> given;
    for (const auto& one : held_) {
      given.push_back(u.is_answer() ? u(Of::facet, one.facet)
                                    : u.of_pressure((*parameters_.held[one.condition].values[0])(one.x, t)));
      ++sums[one.place][held];
      sums[one.place][held_values] += given.back();
    }
    places_.sum_over_ranks(sums);
    auto s = common_potential(sums);
    Components fluxes;
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c)
      fluxes.in_cells.push_back(cells_[c].flux.flux(in_cells[c], weight_in_cell(c, u)));
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f)
      fluxes.in_faces.push_back(faces_[f].flux.flux(in_faces[f], weight_in_face(f, u)));
    for (int k = 0; k < n_sweeps; ++k) improve(fluxes, in_cells, sums, s);
    auto result = errors(u, fluxes, in_cells, in_faces, sums, s);
    for (const auto& face : held_faces_) {
      const Real q = face.in_rock ? in_cells[face.entity][face.opposite] : in_faces[face.entity][face.opposite];
      Real missed = -u(Of::facet, held_[face.begin].facet);
      for (std::size_t k = face.begin; k < face.end; ++k) missed += held_[k].share * given[k];
      result.error.push_back(u.is_answer() ? -q : missed);
      result.whole.push_back(0);
    }
    return {std::move(result), std::move(s)};
  }

  /// Something adds to or takes from the flow in cells that need not be constant in them.
  bool varies() const { return !parameters_.storage.empty() || !parameters_.rock.source.empty(); }
  typename InCell::Flows variation(LocalIndex c, const std::vector<Real>& s) const {
    const auto of_cell = at(s, cells_[c].place);
    return cells_[c].flux.variation([&](const auto&, const auto& l) { return InCell::quadratic(of_cell, l); });
  }
  /// What is stored per time, less the source.
  void add_rates(const std::vector<Real>& s, Real t, MeshError::Parts& parts) {
    const Real dt = t - time_before_;
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c) {
      typename InCell::Flows rate{};
      if (!parameters_.rock.source.empty())
        rate = cells_[c].flux.variation([&](const auto& x, const auto&) { return -parameters_.rock.source[0](x, t); });
      const auto now = variation(c, s);
      for (int k = 0; !before_.empty() && dt > 0 && k < n; ++k)
        rate[k] += parameters_.storage[c] * (now[k] - before_[c][k]) / dt;
      if (!before_.empty()) before_[c] = now;
      parts.error.insert(parts.error.end(), rate.begin(), rate.end());
    }
    parts.whole.resize(parts.error.size(), 0);
    time_before_ = t;
  }
  /// At the start.
  void find_before() {
    for (LocalIndex c = 0; !parameters_.storage.empty() && c < mesh_->n_owned_cells; ++c)
      before_.push_back(cells_[c].flux.variation([&](const auto& x, const auto&) {
        return parameters_.rock.initial ? potential_of(parameters_.rock.fluid, (*parameters_.rock.initial)(x, 0)) : 0;
      }));
    time_before_ = parameters_.start;
  }

  /// s at all places, see HybridErrorParameters.
  std::vector<Real> common_potential(const Sums& sums) const {
    constexpr Real fixed = 1e15;                            // weight of what is prescribed, over that of others
    std::vector<std::array<Real, 2>> of_rock(sums.size());  // what rock adds to means in fractures: weight, weighted
    const auto own = [&](int place) {
      const auto& sum = sums[place];
      if (sum[held] == 0) return std::array{sum[weight], sum[weighted] / sum[weight]};
      return std::array{fixed * (sum[weight] + sum[springs]), sum[held_values] / sum[held]};
    };
    for (const auto& side : sides_)
      for (std::size_t k = 0; k < side.of_cell.size(); ++k) {
        if (!is_apart(side, k)) continue;
        const auto& sum = sums[side.of_cell[k]];
        const auto [w, value] = own(side.of_cell[k]);
        const Real share = w * sum[springs] / (w + sum[springs]) / sum[sides];
        auto& of = of_rock[side.of_face[k]];
        of[0] += share;
        of[1] += share * (value - sum[drops] / sum[springs]);
      }
    places_.sum_over_ranks(of_rock);
    std::vector<Real> s(sums.size());
    for (std::size_t p = 0; p < s.size(); ++p) {
      const auto [w, value] = own(static_cast<int>(p));
      s[p] = (w * value + of_rock[p][1]) / (w + of_rock[p][0]);
    }
    std::vector<std::array<Real, 2>> beside_fractures(s.size());  // of rock: sum over sides, and how many
    for (const auto& side : sides_)
      for (std::size_t k = 0; k < side.of_cell.size(); ++k) {
        if (!is_apart(side, k)) continue;
        const auto& sum = sums[side.of_cell[k]];
        const auto [w, value] = own(side.of_cell[k]);
        const Real c = sum[springs], beside = s[side.of_face[k]];
        auto& of = beside_fractures[side.of_cell[k]];
        of[0] += sum[held] > 0 ? value : (w * value + c * beside + sum[drops]) / (w + c);
        ++of[1];
      }
    places_.sum_over_ranks(beside_fractures);  // a cell may touch a fracture with a corner alone
    for (std::size_t p = 0; p < s.size(); ++p)
      if (beside_fractures[p][1] > 0) s[p] = beside_fractures[p][0] / beside_fractures[p][1];
    return s;
  }

  /// Whether place k of a side is one of the fracture and one of the rock.
  static bool is_apart(const Side& side, std::size_t k) {
    return side.resistance > 0 && side.of_cell[k] != side.of_face[k];
  }

  /// A step of Jacobi's method towards the s with the least energy.
  void improve(const Components& fluxes, const std::vector<typename InCell::Flows>& in_cells, const Sums& sums,
               std::vector<Real>& s) const {
    constexpr Real relaxation = 1.5;  // stable below 2
    Numbers slopes(s.size());
    const auto add = [&](const auto& entity, const auto& flux) {
      const auto of = entity.flux.gradients();
      const auto error = entity.flux.error(flux, of, at(s, entity.place));
      for (std::size_t k = 0; k < of.size(); ++k) slopes[entity.place[k]][0] += product(of[k], error);
    };
    for (std::size_t c = 0; c < cells_.size(); ++c) add(cells_[c], fluxes.in_cells[c]);
    for (std::size_t f = 0; f < faces_.size(); ++f) add(faces_[f], fluxes.in_faces[f]);
    for_each_point_of_sides([&](const Side& side, Real spring, const auto& N) {
      const Real q = in_cells[side.cell][opposite(side.local_face)] / area(side);
      const Real error = product(at(s, side.of_cell), N) - product(at(s, side.of_face), N) - side.resistance * q;
      for (std::size_t k = 0; k < N.size(); ++k) {
        slopes[side.of_cell[k]][0] += spring * error * N[k];
        slopes[side.of_face[k]][0] -= spring * error * N[k];
      }
    });
    places_.sum_over_ranks(slopes);
    for (std::size_t p = 0; p < s.size(); ++p)
      if (sums[p][held] == 0 && stiffness_[p][0] > 0) s[p] -= relaxation * slopes[p][0] / stiffness_[p][0];
  }

  MeshError::Parts errors(const Potentials& u, const Components& fluxes,
                          const std::vector<typename InCell::Flows>& in_cells,
                          const std::vector<typename InFace::Flows>& in_faces, const Sums& sums,
                          const std::vector<Real>& s) const {
    MeshError::Parts result;
    const auto put = [](std::vector<Real>& all, const auto& some) { all.insert(all.end(), some.begin(), some.end()); };
    const auto add = [&](const auto& entity, const auto& flux, const auto& q) {
      put(result.error, entity.flux.error(flux, entity.flux.gradients(), at(s, entity.place)));
      put(result.whole, entity.flux.flux(q, {}));
    };
    for (std::size_t c = 0; c < cells_.size(); ++c) add(cells_[c], fluxes.in_cells[c], in_cells[c]);
    for (std::size_t f = 0; f < faces_.size(); ++f) add(faces_[f], fluxes.in_faces[f], in_faces[f]);
    for (const auto& side : sides_)
      if (side.resistance > 0) add_side(side, in_cells[side.cell][opposite(side.local_face)] / area(side), s, result);
    for (LocalIndex f = 0; dim == 2 && f < mesh_->n_owned_fracture_faces; ++f)
      add_two_points(f, in_faces[f], sums[faces_[f].place.back()][inflow], u.is_answer(), result.error);
    result.whole.resize(result.error.size(), 0);
    return result;
  }

  /// 2D: what flow between two points misses where a face gains what flows in; and of a well what its distance from the
  /// middle of the face makes of the ways to both ends.
  void add_two_points(LocalIndex f, const typename InFace::Flows& q, Real inflow, bool is_answer,
                      std::vector<Real>& error) const {
    const auto well = parameters_.fed.find(f);
    const bool fed = well != parameters_.fed.end();
    error.push_back(std::sqrt(two_point_resistance(f)) * (fed ? inflow : q[0] + q[1]));
    if (!fed) return;
    const auto& plane = faces_[f].plane;
    for (int end = 0; end < 2; ++end) {  // the flow through end k is opposite to corner 1 - k
      Real towards = 0;
      for (int i = 0; i < dim; ++i) towards += plane.d[end][i] * mesh_->fracture_faces[f].frame[1][i];
      const Real nearer = towards > 0 ? well->second : -well->second;
      const Real factor = std::sqrt(std::abs(well->second) / parameters_.transmissivity[f]);
      error.push_back((is_answer && nearer < 0 ? -1 : 1) * factor * q[opposite_ridge(end)]);
    }
  }

  void add_side(const Side& side, Real q, const std::vector<Real>& s, MeshError::Parts& parts) const {
    const auto in_cell = at(s, side.of_cell), in_face = at(s, side.of_face);
    for (int p = 0; p < n_face_points; ++p) {
      std::array<Real, dim> l{};
      const Real share = face_point(p, l);
      const Real factor = std::sqrt(share * area(side) * side.resistance);
      const Real jump = InFace::quadratic(in_cell, l) - InFace::quadratic(in_face, l);
      parts.error.push_back(factor * (q - jump / side.resistance));
      parts.whole.push_back(factor * q);
    }
  }

  /// Shares of places in the mean of a quadratic function over a face.
  static constexpr Real at_corner = dim == 2 ? 1.0 / 6 : 0, at_middle = dim == 2 ? 2.0 / 3 : 1.0 / 3;
  /// Barycentric coordinates and share of the area, of a rule of degree 5 on edges, of degree 4 on triangles.
  static constexpr int n_face_points = dim == 2 ? 3 : 6;
  static Real face_point(int p, std::array<Real, dim>& l) {
    if constexpr (dim == 2) {
      l = {(1 - assembly::Gauss<3>::point(p)) / 2, (1 + assembly::Gauss<3>::point(p)) / 2};
      return assembly::Gauss<3>::weight(p) / 2;
    } else {
      const Real a = p < 3 ? 0.445948490915965 : 0.091576213509771;
      l = {a, a, a};
      l[p % 3] = 1 - 2 * a;
      return p < 3 ? 0.223381589678011 : 0.109951743655322;
    }
  }

  template <std::size_t m>
  static std::array<Real, m> at(const std::vector<Real>& s, const std::array<int, m>& place) {
    std::array<Real, m> values{};
    for (std::size_t k = 0; k < m; ++k) values[k] = s[place[k]];
    return values;
  }
  Real area(const Side& side) const { return mesh_->fracture_faces[side.face].area; }
  typename InCell::Weight weight_in_cell(LocalIndex c, const Potentials& u) const {
    typename InCell::Weight w{};
    for (int i = 0; i < dim; ++i) w[i] = parameters_.rock.weight[i] * u.heaviness(Of::cell, c);
    return w;
  }
  typename InFace::Weight weight_in_face(LocalIndex f, const Potentials& u) const {
    typename InFace::Weight w{};
    const auto& face = mesh_->fracture_faces[f];
    for (int t = 0; t < dim - 1; ++t)
      for (int i = 0; i < dim; ++i)
        w[t] +=
            parameters_.rock.weight[i] * face.frame[1 + t][i] * u.heaviness(Of::facet, mesh_->facets->fracture_face[f]);
    return w;
  }
  /// 2D: L/(6 T), with the length L.
  Real two_point_resistance(LocalIndex f) const {
    return mesh_->fracture_faces[f].area / (6 * parameters_.transmissivity[f]);
  }
  /// The mean of the quadratic potential along a face; 2D: that which has the potentials of both ends.
  Real mean_in_face(LocalIndex f, const typename InFace::Flows& q, const Potentials& u) const {
    if constexpr (dim == 3) return u(Of::facet, mesh_->facets->fracture_face[f]);
    const auto* ridge = &mesh_->facets->ridge[f * dim];
    return (u(Of::facet, ridge[0]) + u(Of::facet, ridge[1])) / 2 + two_point_resistance(f) / 2 * (q[0] + q[1]);
  }

  RCP<const mesh::Mesh> mesh_;
  Potentials::Layouts layouts_;
  HybridErrorParameters parameters_;
  Places places_;
  std::vector<Cell> cells_;
  std::vector<Face> faces_;
  std::vector<Side> sides_;
  Numbers stiffness_;  // [place]
  std::vector<HeldPlace> held_;
  std::vector<HeldFace> held_faces_;
  std::unordered_map<LocalIndex, Real> resistance_;  // [cell * n + face] Pa s/m^3
  std::vector<LocalIndex> cell_of_component_;
  std::size_t n_of_energy_ = 0;
  std::vector<typename InCell::Flows> before_;  // [owned cell] variation of the potential in the state before
  Real time_before_ = 0;
};

}  // namespace

std::unique_ptr<HybridError> make_hybrid_error(RCP<const mesh::Mesh> mesh, const fields::Layout& cells,
                                               const fields::Layout& facets, ConstView<char*> held_facets,
                                               HybridErrorParameters parameters) {
  SPREKK_CHECK(mesh::is_simplex(mesh->shape), "the estimate of the error of flow is of triangles and tetrahedra");
  return mesh::for_shape(mesh->shape, [&](auto shape) -> std::unique_ptr<HybridError> {
    if constexpr (mesh::is_simplex(shape()))
      return std::make_unique<Error<shape()>>(mesh, cells, facets, held_facets, std::move(parameters));
    else
      return nullptr;
  });
}

}  // namespace sprekk::physics
