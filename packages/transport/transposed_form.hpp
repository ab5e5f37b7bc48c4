// Transpose of the error components of the hybrid form.
#pragma once

#include "transport/hybrid_error.hpp"
#include "transport/hybrid_places.hpp"

namespace sprekk::transport {

/// Transpose of the error components: the linear form -e . e_v in v. Coefficients of flows and of values at places
/// are accumulated first. Values at places depend on v through means of the surrounding potentials, or through facets
/// with a prescribed potential.
template <Shape shape>
struct TransposedForm : PlaceSums {
  using Grid = HybridPlaces<shape>;
  using Flux = typename Grid::Flux;
  using InCell = typename Grid::InCell;
  using InFace = typename Grid::InFace;
  using Side = typename Grid::Side;
  static constexpr int dim = Grid::dim, n = Grid::n, n_face_points = Grid::n_face_points;

  const HybridPlaces<shape>& grid;
  const Sums& sums;  // of the state
  std::vector<typename InCell::Flows> in_cells;
  std::vector<typename InFace::Flows> in_faces;
  typename Grid::Numbers at_places;
  using Next = std::vector<Real>::const_iterator;

  TransposedForm(const HybridPlaces<shape>& of, const Sums& of_state)
      : grid(of), sums(of_state), in_cells(of.cells.size()), in_faces(of.faces.size()), at_places(of.places.size()) {}

  template <class Entity, class Flows>
  void add_entity(const Entity& entity, Flows& on_flows, Next& next) {
    using In = std::decay_t<decltype(entity.flux)>;
    typename In::Components e;
    std::copy_n(next, In::n_components, e.begin());
    next += In::n_components;
    for (int k = 0; k < In::n; ++k) {
      typename In::Flows one{};
      one[k] = 1;
      on_flows[k] += Grid::product(e, entity.flux.flux(one, {}));
    }
    const auto gradients = entity.flux.gradients();
    for (std::size_t k = 0; k < gradients.size(); ++k) at_places[entity.place[k]][0] += Grid::product(e, gradients[k]);
  }
  void add_side(const Side& side, Next& next) {
    for (int p = 0; p < n_face_points; ++p, ++next) {
      std::array<Real, dim> l{};
      const Real share = Grid::face_point(p, l), e = *next * std::sqrt(share * grid.area(side) * side.resistance);
      const auto N = InFace::shapes(l);
      in_cells[side.cell][Flux::opposite(side.local_face)] += e / grid.area(side);
      for (std::size_t k = 0; k < N.size(); ++k) {
        at_places[side.of_cell[k]][0] -= e / side.resistance * N[k];
        at_places[side.of_face[k]][0] += e / side.resistance * N[k];
      }
    }
  }
  /// Transposes the components of a fracture face with a well at a distance from its centre.
  void add_well(LocalIndex f, Real distance, Next& next) {
    const Real factor = std::sqrt(std::abs(distance) / grid.flow.parameters().transmissivity[f]);
    for (int end = 0; end < 2; ++end)
      in_faces[f][Flux::opposite_ridge(end)] += *next++ * (grid.nearer(f, end, distance) < 0 ? -1 : 1) * factor;
  }
  void add_variation(LocalIndex c, Next& next) {
    const auto& cell = grid.cells[c];
    for (std::size_t j = 0; j < cell.place.size(); ++j) {
      typename InCell::AtPlaces one{};
      one[j] = 1;
      const auto of = cell.flux.variation([&](const auto&, const auto& l) { return InCell::quadratic(one, l); });
      for (int k = 0; k < n; ++k) at_places[cell.place[j]][0] += next[k] * of[k];
    }
    next += n;
  }

  /// Transposes one Jacobi step: s - relaxation/stiffness * slope of the energy. Collective.
  void transpose_improvement() {
    typename Grid::Numbers more(at_places.size());
    std::vector<Real> y(at_places.size(), 0);
    for (std::size_t p = 0; p < y.size(); ++p)
      if (sums[p][constrained] == 0 && grid.stiffness[p][0] > 0)
        y[p] = -Grid::relaxation * at_places[p][0] / grid.stiffness[p][0];
    const auto add = [&](const auto& entity, auto& on_flows) {
      using In = std::decay_t<decltype(entity.flux)>;
      const auto gradients = entity.flux.gradients();
      const auto g = entity.flux.error({}, gradients, Grid::at(y, entity.place));
      for (int k = 0; k < In::n; ++k) {
        typename In::Flows one{};
        one[k] = 1;
        on_flows[k] += Grid::product(g, entity.flux.flux(one, {}));
      }
      for (std::size_t k = 0; k < gradients.size(); ++k) more[entity.place[k]][0] += Grid::product(g, gradients[k]);
    };
    for (std::size_t c = 0; c < in_cells.size(); ++c) add(grid.cells[c], in_cells[c]);
    for (std::size_t f = 0; f < in_faces.size(); ++f) add(grid.faces[f], in_faces[f]);
    grid.for_each_point_of_sides([&](const Side& side, Real spring, const auto& N) {
      const Real jump = Grid::product(Grid::at(y, side.of_cell), N) - Grid::product(Grid::at(y, side.of_face), N);
      in_cells[side.cell][Flux::opposite(side.local_face)] -= spring * side.resistance / grid.area(side) * jump;
      for (std::size_t k = 0; k < N.size(); ++k) {
        more[side.of_cell[k]][0] += spring * jump * N[k];
        more[side.of_face[k]][0] -= spring * jump * N[k];
      }
    });
    grid.places.sum_over_ranks(more);
    for (std::size_t p = 0; p < more.size(); ++p) at_places[p][0] += more[p][0];
  }
  /// Transposes the means at places. Adds coefficients of the flows and returns the coefficient of the mean.
  template <class Entity, class Flows>
  Real add_means(const Entity& entity, Flows& on_flows) const {
    using In = std::decay_t<decltype(entity.flux)>;
    typename In::AtPlaces shares{};
    Real on_mean = 0;
    for (std::size_t j = 0; j < shares.size(); ++j) {
      const auto& sum = sums[entity.place[j]];
      if (sum[constrained] == 0) shares[j] = entity.weight / sum[weight] * at_places[entity.place[j]][0];
      on_mean += shares[j];
    }
    for (int k = 0; k < In::n; ++k) {
      typename In::Flows one{};
      one[k] = 1;
      on_flows[k] += Grid::product(shares, entity.flux.potential(one, 0, {}));
    }
    return on_mean;
  }
  HybridError::Forces forces() {
    const auto& mesh = *grid.mesh;
    grid.places.sum_over_ranks(at_places);
    for (int k = 0; k < Grid::n_sweeps; ++k) transpose_improvement();
    HybridError::Forces all{{}, std::vector<Real>(mesh.facets->id.size(), 0), {}};
    for (LocalIndex c = 0; c < mesh.n_owned_cells; ++c) {
      all.on_cells.push_back(-add_means(grid.cells[c], in_cells[c]));
      for (int k = 0; k < n; ++k) all.on_flows.in_cells.push_back(-in_cells[c][Flux::opposite(k)]);
    }
    for (LocalIndex f = 0; f < mesh.n_owned_fracture_faces; ++f) {
      all.on_facets[mesh.facets->fracture_face[f]] -= add_means(grid.faces[f], in_faces[f]);
      for (int k = 0; k < dim; ++k) all.on_flows.in_faces.push_back(-in_faces[f][Flux::opposite_ridge(k)]);
    }
    for (const auto& one : grid.constrained_places)
      if (one.holds) all.on_facets[one.facet] -= at_places[one.place][0] / sums[one.place][constrained];
    return all;
  }
};

}  // namespace sprekk::transport
