#include "transport/hybrid_error.hpp"

#include "base/check.hpp"
#include "base/over_ranks.hpp"
#include "transport/places.hpp"

namespace sprekk::transport {

namespace {

template <Shape shape>
class Error final : public HybridError {
 public:
  using Flux = HybridFlux<shape>;
  static constexpr int dim = Flux::dim, n = Flux::n;
  using InCell = typename Flux::InCell;
  using InFace = typename Flux::InFace;

  Error(RCP<const mesh::Mesh> mesh, const fields::Layout& cells, const fields::Layout& facets,
        ConstView<char*> held_facets, HybridErrorParameters parameters)
      : mesh_(mesh),
        flow_(mesh, {&cells, &facets}, std::move(parameters.flow)),
        storage_(std::move(parameters.storage)) {
    find_cells();
    find_faces();
    find_sides();
    join_places();
    n_of_energy_ = cell_of_component_.size();
    for (LocalIndex f = 0; dim == 2 && f < mesh_->n_owned_fracture_faces; ++f)
      cell_of_component_.insert(cell_of_component_.end(), flow_.parameters().fed.count(f) ? 3 : 1,
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

  HybridError::Parts of_state(const fields::Vector& cells, const fields::Vector& facets, Real t,
                                      const assembly::Rates& rates) override {
    auto [result, s] = parts(Potentials(flow_.layouts(), rock().fluid, {&cells, &facets}), t, &sums_);
    if (varies()) base::collectively(*mesh_->comm, [&] { add_rates(s, t, rates, result); });
    return result;
  }
  HybridError::Parts of_answer(const fields::Vector& cells, const fields::Vector& facets,
                                       const fields::Vector& d_cells, const fields::Vector& d_facets) const override {
    auto [result, s] =
        parts(Potentials(flow_.layouts(), rock().fluid, {&cells, &facets}, {&d_cells, &d_facets}), 0, nullptr);
    for (LocalIndex c = 0; varies() && c < mesh_->n_owned_cells; ++c)
      for (const Real one : variation(c, s)) result.error.push_back(one);
    result.whole.resize(result.error.size(), 0);
    return result;
  }

  Forces forces(const std::vector<Real>& e) const override {
    TransposedForm of(*this);
    auto next = e.begin();
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c) of.add_entity(cells_[c], of.in_cells[c], next);
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) of.add_entity(faces_[f], of.in_faces[f], next);
    for (const auto& side : sides_)
      if (side.resistance > 0) of.add_side(side, next);
    for (LocalIndex f = 0; dim == 2 && f < mesh_->n_owned_fracture_faces; ++f) of.add_two_points(f, next);
    for (const auto& face : held_faces_)
      if (is_mean(face.of)) ++next;
    for (LocalIndex c = 0; varies() && c < mesh_->n_owned_cells; ++c) of.add_variation(c, next);
    return of.forces();
  }
  void set_transmissivity(std::vector<Real> of_local_faces) override {
    flow_.set_transmissivity(std::move(of_local_faces));
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) {
      faces_[f].flux = flow_.face(f).flux;
      faces_[f].weight = weight_of_face(f);
    }
    find_stiffness();
  }

 private:
  using Of = Potentials::Of;
  using Numbers = std::vector<std::array<Real, 1>>;
  static constexpr int n_sweeps = 5;
  static constexpr Real relaxation = 1.5;  // stable below 2

  /// Data of a cell or a fracture face.
  template <class In>
  struct Entity {
    In flux;
    std::array<int, In::n_places> place;
    Real weight;  // weight in means: mobility times size^(dim - 2)
  };
  /// Side of a fracture face in an owned cell.
  struct Side {
    LocalIndex face, cell;
    int local_face;
    std::array<int, dim> corner;                         // corners of the cell, in the order of the face corners
    std::array<int, InFace::n_places> of_cell, of_face;  // places, in the order of the face places
    Real resistance;                                     // R, Pa s/m; 0: none
    Real spring;                                         // area / R
  };
  /// Place with a prescribed potential.
  struct HeldPlace {
    int place;
    mesh::Vector x;
    LocalIndex facet;
    Real share;  // weight in the mean over its face
  };
  /// End with a prescribed potential. Its places are held_[begin] to held_[end - 1].
  struct HeldFace {
    typename Flux::Held of;
    std::size_t begin, end;
  };

  const HybridDiffusionParameters& rock() const { return flow_.parameters().rock; }

  /// Global numbers of places: rock nodes; midpoints of rock edges; fracture points; midpoints of fracture edges; in 2D
  /// also midpoints of fracture sides, because nodes do not distinguish the two sides.
  GlobalIndex rock_place(GlobalIndex a, GlobalIndex b) const {
    return a == b ? a : mesh_->n_global_nodes * (1 + std::min(a, b)) + std::max(a, b);
  }
  GlobalIndex first_of_fractures() const { return mesh_->n_global_nodes * (1 + mesh_->n_global_nodes); }
  GlobalIndex fracture_place(GlobalIndex a, GlobalIndex b) const { return first_of_fractures() + rock_place(a, b); }
  GlobalIndex side_place(GlobalIndex face, int side) const { return 2 * first_of_fractures() + 2 * face + side; }

  void find_cells() {
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c) {
      const auto& flux = flow_.cell(c).flux;
      const auto& mobility = rock().mobility.of_cell(*mesh_, c);
      Entity<InCell> cell{flux, {}, mobility.template trace<dim>() / dim * std::pow(flux.volume(), 1 - 2.0 / dim)};
      for (int a = 0; a < n; ++a)
        for (int b = a; b < n; ++b) cell.place[InCell::place(a, b)] = place_between(c, a, b);
      cells_.push_back(cell);
      cell_of_component_.insert(cell_of_component_.end(), InCell::n_components, c);
    }
  }
  /// Place between two corners of a cell.
  int place_between(LocalIndex c, int a, int b) {
    const auto id = [&](int k) { return mesh_->node_id[mesh_->free_node(flow_.node(c, k))]; };
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
      faces_.push_back({flow_.face(f).flux, places_of_face(f), weight_of_face(f)});
      cell_of_component_.insert(cell_of_component_.end(), InFace::n_components,
                                mesh_->fracture_faces[f].cell[mesh::minus]);
    }
  }
  Real weight_of_face(LocalIndex f) const {
    return flow_.parameters().transmissivity[f] * std::pow(mesh_->fracture_faces[f].area, 1 - 2.0 / (dim - 1));
  }

  void find_sides() {
    for (const auto& [f, s] : assembly::fracture_sides(*mesh_)) {
      const auto& face = mesh_->fracture_faces[f];
      const LocalIndex c = face.cell[s];
      if (c >= mesh_->n_owned_cells) continue;
      Side side{
          f, c, face.local_face[s], {}, {}, places_of_face(f), 1 / flow_.exchange(f), face.area * flow_.exchange(f)};
      for (int k = 0; k < dim; ++k)
        for (int a = 0; a < n; ++a)
          if (flow_.node(c, a) == face.nodes[s][k]) side.corner[k] = a;
      if (dim == 2)
        cells_[c].place[InCell::place(side.corner[0], side.corner[1])] = places_.add(side_place(face.id, s));
      sides_.push_back(side);
      if (side.resistance == 0) continue;
      cell_of_component_.insert(cell_of_component_.end(), n_face_points, c);
    }
  }

  /// Identifies the places of rock and fracture on sides without resistance. Cells of any rank may touch these places
  /// with a corner, so the pairs are gathered over all ranks. Collective.
  void join_places() {
    std::vector<GlobalIndex> joined;  // pairs: place of the rock, place of the fracture
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

  /// Computes the Jacobi scaling of each place: the sum of the absolute second derivatives of half of the energy. It
  /// bounds the curvature of the scaled energy from above. Collective.
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

  /// Calls visit(side, area of the point divided by R, shape functions) at the quadrature points of sides with
  /// resistance.
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
    for (const auto& held : flow_.held(held_facets)) {
      const auto begin = held_.size();
      for (const auto& point : flow_.points(held)) {
        const int place = held.in_rock ? cells_[held.entity].place[InCell::place(point.a, point.b)]
                                       : faces_[held.entity].place[InFace::place(point.a, point.b)];
        held_.push_back({place, point.x, held.facet, point.share});
      }
      held_faces_.push_back({held, begin, held_.size()});
      if (is_mean(held))
        cell_of_component_.push_back(held.in_rock ? held.entity : mesh_->fracture_faces[held.entity].cell[mesh::minus]);
    }
  }
  /// Returns whether the facet unknown is a mean over the end, i.e. whether the end is not a point.
  static bool is_mean(const typename Flux::Held& held) { return held.in_rock || dim == 3; }

  /// Transpose of the error components: the linear form -e . e_v in v. Coefficients of flows and of values at places
  /// are accumulated first. Values at places depend on v through means of the surrounding potentials, or through facets
  /// with a prescribed potential.
  struct TransposedForm {
    const Error& error;
    std::vector<typename InCell::Flows> in_cells;
    std::vector<typename InFace::Flows> in_faces;
    std::vector<std::array<Real, 2>> at_places;  // of the values; of the total inflow of a face, at its last place
    using Next = std::vector<Real>::const_iterator;

    explicit TransposedForm(const Error& of)
        : error(of), in_cells(of.cells_.size()), in_faces(of.faces_.size()), at_places(of.places_.size()) {}

    template <class Entity, class Flows>
    void add_entity(const Entity& entity, Flows& on_flows, Next& next) {
      using In = std::decay_t<decltype(entity.flux)>;
      typename In::Components e;
      std::copy_n(next, In::n_components, e.begin());
      next += In::n_components;
      for (int k = 0; k < In::n; ++k) {
        typename In::Flows one{};
        one[k] = 1;
        on_flows[k] += product(e, entity.flux.flux(one, {}));
      }
      const auto gradients = entity.flux.gradients();
      for (std::size_t k = 0; k < gradients.size(); ++k) at_places[entity.place[k]][0] += product(e, gradients[k]);
    }
    void add_side(const Side& side, Next& next) {
      for (int p = 0; p < n_face_points; ++p, ++next) {
        std::array<Real, dim> l{};
        const Real share = face_point(p, l), e = *next * std::sqrt(share * error.area(side) * side.resistance);
        const auto N = InFace::shapes(l);
        in_cells[side.cell][Flux::opposite(side.local_face)] += e / error.area(side);
        for (std::size_t k = 0; k < N.size(); ++k) {
          at_places[side.of_cell[k]][0] -= e / side.resistance * N[k];
          at_places[side.of_face[k]][0] += e / side.resistance * N[k];
        }
      }
    }
    /// Transposes Error::add_two_points().
    void add_two_points(LocalIndex f, Next& next) {
      const auto well = error.flow_.parameters().fed.find(f);
      const bool fed = well != error.flow_.parameters().fed.end();
      const Real e = *next++ * std::sqrt(error.two_point_resistance(f));
      if (fed) at_places[error.faces_[f].place.back()][1] += e;
      for (int k = 0; k < 2; ++k) {
        if (!fed) {
          in_faces[f][k] += e;
          continue;
        }
        const Real nearer = error.nearer(f, k, well->second);
        in_faces[f][Flux::opposite_ridge(k)] +=
            *next++ * (nearer < 0 ? -1 : 1) * std::sqrt(std::abs(nearer) / error.flow_.parameters().transmissivity[f]);
      }
    }
    void add_variation(LocalIndex c, Next& next) {
      const auto& cell = error.cells_[c];
      for (std::size_t j = 0; j < cell.place.size(); ++j) {
        typename InCell::AtPlaces one{};
        one[j] = 1;
        const auto of = cell.flux.variation([&](const auto&, const auto& l) { return InCell::quadratic(one, l); });
        for (int k = 0; k < n; ++k) at_places[cell.place[j]][0] += next[k] * of[k];
      }
      next += n;
    }

    /// Transposes one step of improve(): s - relaxation/stiffness * slope of the energy. Collective.
    void transpose_improvement() {
      std::vector<std::array<Real, 2>> more(at_places.size());
      std::vector<Real> y(at_places.size(), 0);
      for (std::size_t p = 0; p < y.size(); ++p)
        if (error.sums_[p][held] == 0 && error.stiffness_[p][0] > 0)
          y[p] = -relaxation * at_places[p][0] / error.stiffness_[p][0];
      const auto add = [&](const auto& entity, auto& on_flows) {
        using In = std::decay_t<decltype(entity.flux)>;
        const auto gradients = entity.flux.gradients();
        const auto g = entity.flux.error({}, gradients, at(y, entity.place));
        for (int k = 0; k < In::n; ++k) {
          typename In::Flows one{};
          one[k] = 1;
          on_flows[k] += product(g, entity.flux.flux(one, {}));
        }
        for (std::size_t k = 0; k < gradients.size(); ++k) more[entity.place[k]][0] += product(g, gradients[k]);
      };
      for (std::size_t c = 0; c < in_cells.size(); ++c) add(error.cells_[c], in_cells[c]);
      for (std::size_t f = 0; f < in_faces.size(); ++f) add(error.faces_[f], in_faces[f]);
      error.for_each_point_of_sides([&](const Side& side, Real spring, const auto& N) {
        const Real jump = product(at(y, side.of_cell), N) - product(at(y, side.of_face), N);
        in_cells[side.cell][Flux::opposite(side.local_face)] -= spring * side.resistance / error.area(side) * jump;
        for (std::size_t k = 0; k < N.size(); ++k) {
          more[side.of_cell[k]][0] += spring * jump * N[k];
          more[side.of_face[k]][0] -= spring * jump * N[k];
        }
      });
      error.places_.sum_over_ranks(more);
      for (std::size_t p = 0; p < more.size(); ++p) at_places[p][0] += more[p][0];
    }
    /// Transposes the means at places. Adds coefficients of the flows and returns the coefficient of the mean.
    template <class Entity, class Flows>
    Real add_means(const Entity& entity, Flows& on_flows) const {
      using In = std::decay_t<decltype(entity.flux)>;
      typename In::AtPlaces shares{};
      Real on_mean = 0;
      for (std::size_t j = 0; j < shares.size(); ++j) {
        const auto& sum = error.sums_[entity.place[j]];
        if (sum[held] == 0) shares[j] = entity.weight / sum[weight] * at_places[entity.place[j]][0];
        on_mean += shares[j];
      }
      for (int k = 0; k < In::n; ++k) {
        typename In::Flows one{};
        one[k] = 1;
        on_flows[k] += product(shares, entity.flux.potential(one, 0, {}));
      }
      return on_mean;
    }
    Forces forces() {
      const auto& mesh = *error.mesh_;
      error.places_.sum_over_ranks(at_places);
      for (int k = 0; k < n_sweeps; ++k) transpose_improvement();
      Forces all{{}, std::vector<Real>(mesh.facets->id.size(), 0), {}};
      for (const auto& side : error.sides_)
        in_cells[side.cell][Flux::opposite(side.local_face)] += at_places[side.of_face.back()][1];
      for (LocalIndex c = 0; c < mesh.n_owned_cells; ++c) {
        all.on_cells.push_back(-add_means(error.cells_[c], in_cells[c]));
        for (int k = 0; k < n; ++k) all.on_flows.in_cells.push_back(-in_cells[c][Flux::opposite(k)]);
      }
      for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
        const Real on_mean = add_means(error.faces_[f], in_faces[f]);
        if (dim == 3) all.on_facets[mesh.facets->fracture_face[f]] -= on_mean;
        for (int k = 0; k < 2 && dim == 2; ++k) {  // see mean_in_face()
          all.on_facets[error.flow_.facet_of_face(f, k)] -= on_mean / 2;
          in_faces[f][k] += on_mean * error.two_point_resistance(f) / 2;
        }
        for (int k = 0; k < dim; ++k) all.on_flows.in_faces.push_back(-in_faces[f][Flux::opposite_ridge(k)]);
      }
      for (const auto& one : error.held_)
        all.on_facets[one.facet] -= at_places[one.place][0] / error.sums_[one.place][held];
      return all;
    }
  };
  friend struct TransposedForm;

  /// Results of SimplexFlux::flux().
  struct Components {
    std::vector<typename InCell::Components> in_cells;
    std::vector<typename InFace::Components> in_faces;
  };
  /// Sums at a place.
  enum Sum { weight, weighted, held, held_values, springs, drops, sides, inflow, n_sums };
  using Sums = std::vector<std::array<Real, n_sums>>;

  /// Adds the weighted values of an entity at its places.
  template <class Entity, class AtPlaces>
  static void add(const Entity& entity, const AtPlaces& p, Sums& sums) {
    for (std::size_t k = 0; k < p.size(); ++k) {
      auto& sum = sums[entity.place[k]];
      sum[weight] += entity.weight;
      sum[weighted] += entity.weight * p[k];
    }
  }

  /// Prescribed values at the places of held_. Throws an Error if an expression has no value.
  std::vector<Real> values_of_held(const Potentials& u, Real t) const {
    std::vector<Real> given;
    for (const auto& face : held_faces_)
      for (std::size_t k = face.begin; k < face.end; ++k)
        given.push_back(u.is_answer() ? u(Of::facet, held_[k].facet)
                                      : u.of_pressure(flow_.prescribed(face.of, held_[k].x, t)));
    return given;
  }

  /// Returns the components and s at all places. `kept`: receives the sums; may be null. Collective.
  std::pair<HybridError::Parts, std::vector<Real>> parts(const Potentials& u, Real t, Sums* kept) const {
    Sums sums(places_.size());
    std::vector<typename InCell::Flows> in_cells;
    std::vector<typename InFace::Flows> in_faces;
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c) {
      in_cells.push_back(flow_.in_cell(c, u));
      add(cells_[c], cells_[c].flux.potential(in_cells.back(), u(Of::cell, c), weight_in_cell(c, u)), sums);
    }
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f) {
      in_faces.push_back(flow_.in_face(f, u));
      add(faces_[f],
          faces_[f].flux.potential(in_faces.back(), mean_in_face(f, in_faces.back(), u), weight_in_face(f, u)), sums);
    }
    for (const auto& side : sides_) {
      const Real q = in_cells[side.cell][Flux::opposite(side.local_face)], drop = side.resistance * q / area(side);
      for (std::size_t k = 0; side.resistance > 0 && k < side.of_cell.size(); ++k) {
        auto& sum = sums[side.of_cell[k]];
        ++sum[sides];
        sum[springs] += side.spring;
        sum[drops] += side.spring * drop;
      }
      sums[side.of_face.back()][inflow] += q;
    }
    std::vector<Real> given;
    base::collectively(*mesh_->comm, [&] { given = values_of_held(u, t); });
    for (std::size_t k = 0; k < held_.size(); ++k) {
      ++sums[held_[k].place][held];
      sums[held_[k].place][held_values] += given[k];
    }
    places_.sum_over_ranks(sums);
    if (kept) *kept = sums;
    auto s = common_potential(sums);
    Components fluxes;
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c)
      fluxes.in_cells.push_back(cells_[c].flux.flux(in_cells[c], weight_in_cell(c, u)));
    for (LocalIndex f = 0; f < mesh_->n_owned_fracture_faces; ++f)
      fluxes.in_faces.push_back(faces_[f].flux.flux(in_faces[f], weight_in_face(f, u)));
    for (int k = 0; k < n_sweeps; ++k) improve(fluxes, in_cells, sums, s);
    auto result = errors(u, fluxes, in_cells, in_faces, sums, s);
    for (const auto& face : held_faces_) {
      if (!is_mean(face.of)) continue;
      const Real q = face.of.in_rock ? in_cells[face.of.entity][Flux::opposite(face.of.end)]
                                     : in_faces[face.of.entity][Flux::opposite_ridge(face.of.end)];
      Real missed = -u(Of::facet, held_[face.begin].facet);
      for (std::size_t k = face.begin; k < face.end; ++k) missed += held_[k].share * given[k];
      result.error.push_back(u.is_answer() ? -q : missed);
      result.whole.push_back(0);
    }
    return {std::move(result), std::move(s)};
  }

  /// Returns whether the net source may vary within cells.
  bool varies() const { return !storage_.empty() || !rock().source.empty(); }
  typename InCell::Flows variation(LocalIndex c, const std::vector<Real>& s) const {
    const auto of_cell = at(s, cells_[c].place);
    return cells_[c].flux.variation([&](const auto&, const auto& l) { return InCell::quadratic(of_cell, l); });
  }
  /// Appends the variation of the storage rate minus the source.
  void add_rates(const std::vector<Real>& s, Real t, const assembly::Rates& rates, HybridError::Parts& parts) {
    const auto stored = std::move(before_);
    const auto& older = stored[1].empty() ? stored[0] : stored[1];
    before_[0].clear();
    before_[1] = stored[0];
    for (LocalIndex c = 0; c < mesh_->n_owned_cells; ++c) {
      typename InCell::Flows rate{};
      if (!rock().source.empty())
        rate = cells_[c].flux.variation([&](const auto& x, const auto&) { return -rock().source[0](x, t); });
      const auto now = variation(c, s);
      for (int k = 0; !stored[0].empty() && k < n; ++k)
        rate[k] +=
            storage_[c] * (rates.now * (now[k] - stored[0][c][k]) - rates.before * (stored[0][c][k] - older[c][k]));
      if (!stored[0].empty()) before_[0].push_back(now);
      parts.error.insert(parts.error.end(), rate.begin(), rate.end());
    }
    parts.whole.resize(parts.error.size(), 0);
  }
  /// Stores the variation of the initial potential. Collective.
  void find_before() {
    base::collectively(*mesh_->comm, [&] {
      for (LocalIndex c = 0; !storage_.empty() && c < mesh_->n_owned_cells; ++c)
        before_[0].push_back(cells_[c].flux.variation([&](const auto& x, const auto&) {
          return rock().initial ? potential_of(rock().fluid, (*rock().initial)(x, 0)) : 0;
        }));
    });
  }

  /// Computes s at all places, see HybridError. Collective.
  std::vector<Real> common_potential(const Sums& sums) const {
    constexpr Real fixed = 1e15;                            // relative weight of prescribed values
    std::vector<std::array<Real, 2>> of_rock(sums.size());  // rock's part of means: weight, weighted value
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
    std::vector<std::array<Real, 2>> beside_fractures(s.size());  // values in rock: sum over sides, number of sides
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
    places_.sum_over_ranks(beside_fractures);  // a cell may touch a fracture with one corner only
    for (std::size_t p = 0; p < s.size(); ++p)
      if (beside_fractures[p][1] > 0) s[p] = beside_fractures[p][0] / beside_fractures[p][1];
    return s;
  }

  /// Returns whether place k of a side has different values in fracture and rock.
  static bool is_apart(const Side& side, std::size_t k) {
    return side.resistance > 0 && side.of_cell[k] != side.of_face[k];
  }

  /// Performs one Jacobi step towards the s of least energy. Collective.
  void improve(const Components& fluxes, const std::vector<typename InCell::Flows>& in_cells, const Sums& sums,
               std::vector<Real>& s) const {
    Numbers slopes(s.size());
    const auto add = [&](const auto& entity, const auto& flux) {
      const auto of = entity.flux.gradients();
      const auto error = entity.flux.error(flux, of, at(s, entity.place));
      for (std::size_t k = 0; k < of.size(); ++k) slopes[entity.place[k]][0] += product(of[k], error);
    };
    for (std::size_t c = 0; c < cells_.size(); ++c) add(cells_[c], fluxes.in_cells[c]);
    for (std::size_t f = 0; f < faces_.size(); ++f) add(faces_[f], fluxes.in_faces[f]);
    for_each_point_of_sides([&](const Side& side, Real spring, const auto& N) {
      const Real q = in_cells[side.cell][Flux::opposite(side.local_face)] / area(side);
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

  HybridError::Parts errors(const Potentials& u, const Components& fluxes,
                                    const std::vector<typename InCell::Flows>& in_cells,
                                    const std::vector<typename InFace::Flows>& in_faces, const Sums& sums,
                                    const std::vector<Real>& s) const {
    HybridError::Parts result;
    const auto put = [](std::vector<Real>& all, const auto& some) { all.insert(all.end(), some.begin(), some.end()); };
    const auto add = [&](const auto& entity, const auto& flux, const auto& q) {
      put(result.error, entity.flux.error(flux, entity.flux.gradients(), at(s, entity.place)));
      put(result.whole, entity.flux.flux(q, {}));
    };
    for (std::size_t c = 0; c < cells_.size(); ++c) add(cells_[c], fluxes.in_cells[c], in_cells[c]);
    for (std::size_t f = 0; f < faces_.size(); ++f) add(faces_[f], fluxes.in_faces[f], in_faces[f]);
    for (const auto& side : sides_)
      if (side.resistance > 0)
        add_side(side, in_cells[side.cell][Flux::opposite(side.local_face)] / area(side), s, result);
    for (LocalIndex f = 0; dim == 2 && f < mesh_->n_owned_fracture_faces; ++f)
      add_two_points(f, in_faces[f], sums[faces_[f].place.back()][inflow], u.is_answer(), result.error);
    result.whole.resize(result.error.size(), 0);
    return result;
  }

  /// Adds the components of two-point fluxes (2D). The first is due to the inflow into the face. In a face with a well,
  /// the distance of the well from the centre changes the resistance to both ends; this gives two further components.
  void add_two_points(LocalIndex f, const typename InFace::Flows& q, Real inflow, bool is_answer,
                      std::vector<Real>& error) const {
    const auto well = flow_.parameters().fed.find(f);
    const bool fed = well != flow_.parameters().fed.end();
    error.push_back(std::sqrt(two_point_resistance(f)) * (fed ? inflow : q[0] + q[1]));
    if (!fed) return;
    for (int end = 0; end < 2; ++end) {  // the flow through end k is stored at the opposite corner, 1 - k
      const Real nearer = this->nearer(f, end, well->second);
      const Real factor = std::sqrt(std::abs(well->second) / flow_.parameters().transmissivity[f]);
      error.push_back((is_answer && nearer < 0 ? -1 : 1) * factor * q[Flux::opposite_ridge(end)]);
    }
  }

  /// Distance by which a well is nearer to an end of a face than the face centre is; negative: farther.
  Real nearer(LocalIndex f, int end, Real distance) const {
    Real towards = 0;
    for (int i = 0; i < dim; ++i) towards += flow_.face(f).plane.d[end][i] * mesh_->fracture_faces[f].frame[1][i];
    return towards > 0 ? distance : -distance;
  }

  void add_side(const Side& side, Real q, const std::vector<Real>& s, HybridError::Parts& parts) const {
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

  /// Barycentric coordinates and weights of a quadrature rule, of degree 5 on edges and degree 4 on triangles.
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
    for (int i = 0; i < dim; ++i) w[i] = rock().weight[i] * u.heaviness(Of::cell, c);
    return w;
  }
  typename InFace::Weight weight_in_face(LocalIndex f, const Potentials& u) const {
    typename InFace::Weight w{};
    const auto& face = mesh_->fracture_faces[f];
    for (int t = 0; t < dim - 1; ++t)
      for (int i = 0; i < dim; ++i)
        w[t] += rock().weight[i] * face.frame[1 + t][i] * u.heaviness(Of::facet, mesh_->facets->fracture_face[f]);
    return w;
  }
  /// Resistance of two-point fluxes in 2D, L/(6 T) with the length L.
  Real two_point_resistance(LocalIndex f) const {
    return mesh_->fracture_faces[f].area / (6 * flow_.parameters().transmissivity[f]);
  }
  /// Mean of the quadratic potential along a face. In 2D the potential is fitted to the potentials of both ends.
  Real mean_in_face(LocalIndex f, const typename InFace::Flows& q, const Potentials& u) const {
    if constexpr (dim == 3) return u(Of::facet, mesh_->facets->fracture_face[f]);
    const auto* ridge = &mesh_->facets->ridge[f * dim];
    return (u(Of::facet, ridge[0]) + u(Of::facet, ridge[1])) / 2 + two_point_resistance(f) / 2 * (q[0] + q[1]);
  }

  RCP<const mesh::Mesh> mesh_;
  Flux flow_;
  std::vector<Real> storage_;  // see HybridErrorParameters
  Places places_;
  std::vector<Entity<InCell>> cells_;
  std::vector<Entity<InFace>> faces_;
  std::vector<Side> sides_;
  Numbers stiffness_;  // [place]
  std::vector<HeldPlace> held_;
  std::vector<HeldFace> held_faces_;
  std::vector<LocalIndex> cell_of_component_;
  std::size_t n_of_energy_ = 0;
  /// [owned cell] variation of the potential in the last two states; before the first step only the initial one
  std::array<std::vector<typename InCell::Flows>, 2> before_;
  Sums sums_;  // of the last state
};

}  // namespace

std::unique_ptr<HybridError> make_hybrid_error(RCP<const mesh::Mesh> mesh, const fields::Layout& cells,
                                               const fields::Layout& facets, ConstView<char*> held_facets,
                                               HybridErrorParameters parameters) {
  SPREKK_CHECK(mesh::is_simplex(mesh->shape), "the estimate of the error of flow is of triangles and tetrahedra");
  return mesh::for_corners(mesh->shape, [&](auto shape) -> std::unique_ptr<HybridError> {
    if constexpr (mesh::is_simplex(shape()))
      return std::make_unique<Error<shape()>>(mesh, cells, facets, held_facets, std::move(parameters));
    else
      return nullptr;
  });
}

}  // namespace sprekk::transport
